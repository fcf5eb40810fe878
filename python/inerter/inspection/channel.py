"""One channel by itself: range, noise, quantisation, band, hum, filters that its spectrum shows."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import welch

from inerter.records.motion import white_noise
from inerter.records.steps import converter_step

Array = NDArray[np.float64]

SEGMENT = 4096  # samples of a segment of the spectrum, at most
ABOVE = 4.0  # times the floor: there is a signal
FALL = 15.0  # decibels per octave by which a spectrum falls behind a low-pass, at least
BEND = 10.0  # and by which more than before it
PER_OCTAVE = 4
HUM = 10.0  # times its neighbours: a line of the mains
MAINS = (50.0, 60.0)


@dataclass(frozen=True, kw_only=True)
class ChannelFacts:
    """What one channel [SI] shows.

    low, high: its range; noise: rms of its white noise; step: of its quantisation, None where none
    is seen; band [Hz]: up to where it stands above its noise; hum: frequencies [Hz] and rms of
    lines of the mains; corner [Hz]: of a low-pass that its noise went through, None where none
    shows.
    """

    name: str
    unit: str
    low: float
    high: float
    noise: float
    step: float | None
    band: float
    hum: tuple[tuple[float, float], ...]
    corner: float | None


def channel_facts(name: str, unit: str, values: Array, spacing: float) -> ChannelFacts:
    """The facts of a channel (n,) on an even clock of a spacing [s]."""
    frequency, power = spectrum(values, spacing)
    band = _band(frequency, power)
    return ChannelFacts(
        name=name,
        unit=unit,
        low=float(values.min()),
        high=float(values.max()),
        noise=white_noise(values),
        step=converter_step(values),
        band=band,
        hum=_hum(frequency, power, band),
        corner=_corner(frequency, power) if name.endswith(("force", "acceleration")) else None,
    )


def spectrum(values: Array, spacing: float) -> tuple[Array, Array]:
    """Frequencies [Hz] and power per hertz of a channel without its mean."""
    length = min(values.size, SEGMENT)
    return welch(values - values.mean(), 1 / spacing, nperseg=length, detrend="linear")


def _band(frequency: Array, power: Array) -> float:
    """Up to where the spectrum stands above its floor."""
    top = power[2 * len(power) // 3 :]
    above = np.flatnonzero(power > ABOVE * max(float(np.median(top)), 1e-300))
    above = above[above > 0]
    if not len(above):
        return 0.0
    # the highest frequency of the block that begins at the lowest
    gaps = np.flatnonzero(np.diff(above) > 4)
    return float(frequency[above[gaps[0]] if len(gaps) else above[-1]])


def _hum(frequency: Array, power: Array, band: float) -> tuple[tuple[float, float], ...]:
    """Lines of 50 or 60 Hz and their harmonics, outside the band of the motion."""
    found: list[tuple[float, float]] = []
    width = float(frequency[1])
    for mains in MAINS:
        lines = []
        for harmonic in range(1, 6):
            at = mains * harmonic
            if at <= max(1.5 * band, 4 * width) or at > 0.9 * frequency[-1]:
                continue
            line = np.abs(frequency - at) <= max(1.5 * width, 0.005 * at)
            beside = (np.abs(frequency - at) <= 20 * width + 0.1 * at) & ~line
            floor = float(np.median(power[beside])) if beside.any() else 0.0
            if line.any() and floor > 0 and power[line].max() > HUM * floor:
                lines.append((at, float(np.sqrt(np.sum(power[line] - floor) * width))))
        found += lines if (lines and lines[0][0] == mains) or len(lines) > 1 else []
    return tuple(found)


def _corner(frequency: Array, power: Array) -> float | None:
    """Where the spectrum above the motion bends down as behind a low-pass, by two straight lines.

    A motion that ends there looks alike: what is told is where to look.
    """
    start = 3 * float(frequency[np.argmax(power)])
    top = 0.95 * float(frequency[-1])
    if start <= 0 or 8 * start > top:
        return None
    edges = start * 2 ** np.arange(0, np.log2(top / start), 1 / PER_OCTAVE)
    middle = [
        (float(np.log2(a * b) / 2), 10 * float(np.log10(max(np.mean(power[inside]), 1e-300))))
        for a, b in itertools.pairwise(edges)
        if (inside := (frequency >= a) & (frequency < b)).any()
    ]
    if not middle:
        return None
    place, level = (np.array(part) for part in zip(*middle, strict=True))
    # down to the floor, where all spectra are level
    floor = np.flatnonzero(level > np.min(level) + 6.0)
    if floor.size == 0 or floor[-1] + 1 < 4 * PER_OCTAVE:
        return None
    place, level = place[: floor[-1] + 1], level[: floor[-1] + 1]
    best = (np.inf, 0.0, 0.0, 0.0)
    for knee in place[PER_OCTAVE:-PER_OCTAVE]:
        matrix = np.column_stack(
            [np.ones(len(place)), np.minimum(place - knee, 0), np.maximum(place - knee, 0)]
        )
        weights, *_ = np.linalg.lstsq(matrix, level, rcond=None)
        error = float(np.sum((level - matrix @ weights) ** 2))
        best = min(best, (error, float(knee), float(weights[1]), float(weights[2])))
    _, knee, before, behind = best
    return 2.0**knee if behind < -FALL and before - behind > BEND else None
