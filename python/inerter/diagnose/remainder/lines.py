"""Lines of the residual's spectrum that go on through a run: tones, and harmonics of a motion.

Everything is within one run, whose tones have a phase of their own: a frequency is chosen on every
other stretch of the run, its sine is learnt there and judged on the stretches between, then the
other way round. What rings only for a while is no line.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.fft import rfft, rfftfreq
from numpy.typing import NDArray

from .learning import chance, share

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# alternating stretches per run, lines sought in each, and samples of the padded spectrum
STRETCHES = 16
LINES = 5
PADDING = 8
# share of the simulated force's power around its strongest line that makes a motion one tone, and
# how near to a whole multiple of it a harmonic lies
ONE_TONE = 0.9
NEAR = 0.03
# share of the simulated force's power at a line that makes it one of the motion
OF_MOTION = 0.02


@dataclass(frozen=True, kw_only=True)
class Lines:
    """Lines of all runs together.

    Attributes
    ----------
    values : list of ndarray (n_i,)
        Predicted residual per run [N].
    frequency : float
        Of the strongest line [Hz].
    multiple : int
        Which multiple of a motion of one tone that is; 0 for none.
    of_motion : bool
        Whether a motion of several tones has it.
    amplitude : float
        Of the strongest line [N].
    share, p : float
        As in `Prediction`.
    """

    values: list[Array]
    frequency: float
    multiple: int
    of_motion: bool
    amplitude: float
    share: float
    p: float


def lines(
    residual: Sequence[Array],
    model: Sequence[Array],
    spacing: Sequence[float],
    masks: Sequence[Mask],
) -> Lines:
    """The lines that the residuals (n_i,) [N] of all runs have throughout."""
    values, flat, numbers, strongest, count = [], [], [], [], 0
    for r, force, step, mask in zip(residual, model, spacing, masks, strict=True):
        stretch = np.minimum(np.arange(r.size) * STRETCHES // r.size, STRETCHES - 1)
        predicted = np.zeros(r.size)
        if mask.sum() > 8 * STRETCHES:
            for side in (0, 1):
                learnt, judged = mask & (stretch % 2 == side), mask & (stretch % 2 != side)
                found = _learn(r, step, learnt)
                predicted[judged] = _wave(found, step, r.size)[judged]
                strongest += [(a * a / 2, f, force, step, mask) for f, a in _amplitudes(found)]
        values.append(predicted)
        flat.append(r[mask])
        numbers.append((count + stretch)[mask])
        count += STRETCHES
    r = np.concatenate(flat)
    predicted = np.concatenate([v[m] for v, m in zip(values, masks, strict=True)])
    p = chance(r, predicted, np.concatenate(numbers))
    if not strongest:
        return Lines(
            values=values, frequency=0.0, multiple=0, of_motion=False, amplitude=0.0, share=0.0,
            p=1.0,
        )  # fmt: skip
    power, frequency, force, step, mask = max(strongest, key=lambda line: line[0])
    multiple = _multiple(frequency, force, step, mask)
    amplitude = float(np.sqrt(2 * power))
    return Lines(
        values=values,
        frequency=frequency,
        multiple=multiple,
        of_motion=not multiple and _is_of_motion(frequency, force, step, mask),
        amplitude=amplitude,
        share=share(r, predicted),
        p=p,
    )


def _learn(r: Array, step: float, mask: Mask) -> list[tuple[float, float, float]]:
    """Frequency [Hz] and coefficients of sine and cosine of a few lines, the strongest first."""
    time = step * np.arange(r.size)
    kept = np.flatnonzero(mask)
    rest = r[kept].copy()
    size = PADDING * r.size
    found: list[float] = []
    weights = np.zeros(0)
    for _ in range(LINES):
        padded = np.zeros(size)
        padded[kept] = rest
        power = np.abs(rfft(padded)) ** 2
        power[:PADDING] = 0
        found.append(float(rfftfreq(size, step)[int(np.argmax(power))]))
        columns = _columns(found, time[kept])
        weights = np.linalg.lstsq(columns, r[kept], rcond=None)[0]
        rest = r[kept] - columns @ weights
    pairs = weights.reshape(-1, 2)
    return [(f, float(s), float(c)) for f, (s, c) in zip(found, pairs, strict=True)]


def _columns(frequencies: Sequence[float], time: NDArray[np.floating]) -> Array:
    phases = [2 * np.pi * f * time for f in frequencies]
    return np.column_stack([g(phase) for phase in phases for g in (np.sin, np.cos)])


def _wave(found: Sequence[tuple[float, float, float]], step: float, count: int) -> Array:
    columns = _columns([f for f, _, _ in found], step * np.arange(count))
    return columns @ np.array([w for _, s, c in found for w in (s, c)])


def _amplitudes(found: Sequence[tuple[float, float, float]]) -> list[tuple[float, float]]:
    return [(f, float(np.hypot(s, c))) for f, s, c in found]


def _multiple(frequency: float, force: Array, step: float, mask: Mask) -> int:
    """Which multiple of the one tone of a motion a frequency [Hz] is; 0 for none."""
    grid, spectrum = _spectrum(force, step, mask)
    first = float(grid[int(np.argmax(spectrum))])
    near = np.abs(grid - first) <= 3 / (step * force.size)
    if first <= 0 or spectrum[near].sum() < ONE_TONE * spectrum.sum():
        return 0
    ratio = frequency / first
    return round(ratio) if abs(ratio - round(ratio)) < NEAR * max(ratio, 1) else 0


def _is_of_motion(frequency: float, force: Array, step: float, mask: Mask) -> bool:
    """Whether the simulated force has a line at a frequency [Hz] as well."""
    grid, spectrum = _spectrum(force, step, mask)
    near = np.abs(grid - frequency) <= 2 / (step * force.size)
    return bool(spectrum[near].sum() > OF_MOTION * spectrum[1:].sum())


def _spectrum(force: Array, step: float, mask: Mask) -> tuple[Array, Array]:
    """Frequencies [Hz] and power of the simulated force."""
    power = np.abs(rfft(np.where(mask, force, 0) * np.hanning(force.size))) ** 2
    return np.asarray(rfftfreq(force.size, step), np.float64), power
