"""One channel by itself: range, noise, quantisation, band, hum, filters that its spectrum shows."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d
from scipy.signal import welch
from scipy.stats import chi2

from inerter.records.motion import white_noise
from inerter.records.steps import converter_step

Array = NDArray[np.float64]

SEGMENT = 4096  # samples of a segment of the spectrum, at most
# lines of a bench stand 80 dB above their noise: the skirts of other windows hide it
WINDOW = "blackmanharris"
CHANCE = 1e-4  # that noise alone stands above its floor somewhere
GAP = 3.2  # ratio of two lines within which a weak one is a harmonic: the third counts
FALL = 15.0  # decibels per octave by which a spectrum falls behind a low-pass, at least
BEND = 10.0  # and by which more than before it
HARMONIC, TONE = 1e-6, 1e-4  # of the power of the highest line: within that ratio, and beyond
LOBE = 4  # bins of a line on each of its sides
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


def channel_facts(
    name: str, unit: str, values: Array, spacing: float, written: Array | None = None
) -> ChannelFacts:
    """The facts of a channel (n,) on an even clock of a spacing [s].

    written: the channel as it stands in the file, where another clock was made even.
    """
    frequency, power = spectrum(values, spacing)
    band = _band(frequency, power, values.size)
    return ChannelFacts(
        name=name,
        unit=unit,
        low=float(values.min()),
        high=float(values.max()),
        noise=white_noise(values),
        step=converter_step(values if written is None else written),
        band=band,
        hum=_hum(frequency, power, band, values.size),
        corner=_corner(frequency, power) if name.endswith(("force", "acceleration")) else None,
    )


def spectrum(values: Array, spacing: float) -> tuple[Array, Array]:
    """Frequencies [Hz] and power per hertz of a channel without its mean."""
    length = min(values.size, SEGMENT)
    return welch(
        values - values.mean(), 1 / spacing, nperseg=length, detrend="linear", window=WINDOW
    )


def _surely(samples: int, bins: int) -> float:
    """Power, in medians of a flat noise, that none of so many bins of it has by chance.

    A bin is the mean over half-overlapping segments: chi-squared, with two degrees of freedom of
    each segment that counts, which is nearly all of them behind this window.
    """
    segments = max(1.0, 2 * samples / min(samples, SEGMENT) - 1)
    law = chi2(2 * segments)
    return float(law.isf(CHANCE / bins) / law.median())


def _band(frequency: Array, power: Array, samples: int) -> float:
    """Up to where the spectrum stands above its floor: from its highest line on, and those above.

    What lies apart belongs to the motion where it is strong and near, as harmonics and further
    tones are; weak lines far above it are another thing, and so are those of the mains.
    """
    floor = max(float(np.median(power[2 * len(power) // 3 :])), 1e-300)
    stands = power > _surely(samples, len(power)) * floor
    stands[0] = False
    highest = int(np.argmax(np.where(stands, power, 0.0)))
    width = float(frequency[1])
    for mains in MAINS:
        near = (
            np.abs(frequency - mains * np.maximum(np.round(frequency / mains), 1))
            < (LOBE + 0.5) * width
        )
        # no line of the mains, where the spectrum stands beside it, too
        if not near[highest]:
            stands[near & ~_beside(stands, near)] = False
    above = np.flatnonzero(stands)
    if not len(above):
        return 0.0
    above = above[above >= highest]
    far = np.diff(above) > 2 * LOBE
    near = frequency[above[1:]] < GAP * frequency[above[:-1]]
    lines = maximum_filter1d(power, 2 * LOBE + 1)
    weak = lines[above[1:]] < np.where(near, HARMONIC, TONE) * power[highest]
    apart = np.flatnonzero(far & weak)
    return float(frequency[above[apart[0]] if len(apart) else above[-1]])


def _beside(stands: NDArray[np.bool_], near: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Of each stretch of `near`, whether most of as many bins on both of its sides stand."""
    found = np.zeros_like(near)
    edges = np.flatnonzero(np.diff(np.r_[False, near, False].astype(np.int8)))
    for start, stop in edges.reshape(-1, 2):
        size = stop - start
        sides = np.r_[stands[max(0, start - size) : start], stands[stop : stop + size]]
        found[start:stop] = len(sides) > 0 and np.mean(sides) > 0.5
    return found


def _hum(
    frequency: Array, power: Array, band: float, samples: int
) -> tuple[tuple[float, float], ...]:
    """Lines of 50 or 60 Hz and their harmonics, outside the band of the motion."""
    found: list[tuple[float, float]] = []
    width = float(frequency[1])
    for mains in MAINS:
        lines = []
        for harmonic in range(1, 6):
            at = mains * harmonic
            if at <= max(1.5 * band, 2 * LOBE * width) or at > 0.9 * frequency[-1]:
                continue
            line = np.abs(frequency - at) <= max((LOBE - 0.5) * width, 0.005 * at)
            beside = (np.abs(frequency - at) <= 20 * width + 0.1 * at) & ~line
            floor = float(np.median(power[beside])) if beside.any() else 0.0
            sure = max(HUM, _surely(samples, 10))
            if line.any() and floor > 0 and power[line].max() > sure * floor:
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
