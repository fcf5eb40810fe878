"""A tone that the motion does not contain: where to look for it.

What rings in an actuator is in the motion, but may lie above its band, or be lost in the noise of
the displacement. The displacement as measured is a witness: it has the tone, it has not, or its
noise hides what it has. Then only a tone at a frequency of the mains is taken for one from outside.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag
from scipy.ndimage import median_filter

from inerter.catalogue.coordinates import LOWEST_TONE
from inerter.catalogue.scales import Scales
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.decision import CRITERIA
from inerter.identify.channel_filter import ORDERS, Filter, filter_of
from inerter.identify.fit import Fit, Problem
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun

Array = NDArray[np.float64]

# power of a bin per local median, mean over the runs: chance exceeds it once in e^15 bins and runs
_REQUIRED = 15.0
# share of power in a few bins from which on the motion has the line itself; friction along it has
# one wherever it stands out from what is beside it
_OWN_LINE = {"velocity": 0.1, "acceleration": 0.1, "friction": 1e-4}
_STANDS_OUT = 15.0
# power of the displacement's line per what its noise has, from which on the line may be there:
# chance exceeds it once in e^6
_MAY_BE_THERE = 6.0
_NEIGHBOURS = 2
# samples of a run below which it tells nothing of lines
_FEWEST = 64
# bins about a line whose power is its own, and farther ones that tell the noise
_WIDTH, _BESIDE = 3, (-8, -7, -6, -5, -4, 4, 5, 6, 7, 8)
# share of a frequency about it where a drive that rings has its lines, and of the power of the
# highest of them that another one has
_ABOUT, _AS_HIGH = 0.05, 0.25
# the same about a line of the mains, and power of it per that of the highest beside it from which
# on it is none of what rings there: such lines are of like size, and one may be there by chance
_NEAR, _HIGHER = 0.1, 4.0
# lines that are asked about, one after another; the highest harmonic of one sine that is no tone
_ASKED, _HARMONICS = 8, 9

MAINS = (50.0, 60.0)
"""Frequencies of the mains [Hz]."""
MAINS_DRIFT = 0.2
"""By how much the mains stray from it [Hz]."""
MOST_HARMONICS = 7
"""Multiples of it that are heard."""
_PADDING = 2
_TONE = ("disturbance_amplitude", "disturbance_frequency")


def strongest_line(
    runs: Sequence[BenchRun],
    residual: Sequence[Array],
    masks: Sequence[NDArray[np.bool_]],
    lowest: float = LOWEST_TONE,
    highest: float = np.inf,
    but: Sequence[float] = (),
) -> tuple[float, float] | None:
    """Frequency [Hz] and amplitude [N] of the clearest line in what a model leaves, or None.

    Lines that the motion has, or friction along it, do not count.

    Parameters
    ----------
    runs
        Motions.
    residual, masks
        Of every run: measured minus predicted force [N], and the samples that count.
    lowest, highest
        Band to look in [Hz].
    but
        Lines that do not count either [Hz].
    """
    used = [i for i, mask in enumerate(masks) if mask.sum() > _FEWEST]
    if not used:
        return None
    longest = max(runs[i].spacing * runs[i].force.size for i in used)
    top = min(highest, *(min(0.45 / runs[i].spacing, 2 * runs[i].cutoff) for i in used))
    frequency = np.arange(lowest, top, 1 / (_PADDING * longest))
    if frequency.size < 8:
        return None
    clear, amplitude = np.zeros(frequency.size), np.zeros(frequency.size)
    free = np.zeros(frequency.size)
    for i in used:
        run, mask = runs[i], masks[i]
        window = np.hanning(mask.size) * mask
        power = _power(np.where(mask, residual[i], 0.0) * window, run.spacing, frequency, longest)
        floor = _typical(power) / np.log(2) + 1e-300
        own = np.zeros(frequency.size, bool)
        motion = {"velocity": run.velocity, "acceleration": run.acceleration,
                  "friction": np.sign(run.velocity)}  # fmt: skip
        for name, values in motion.items():
            line = _power(values * window, run.spacing, frequency, longest)
            near = np.convolve(line, np.ones(2 * _NEIGHBOURS * _PADDING + 1), "same")
            has = near > _OWN_LINE[name] * np.sum(line)
            if name == "friction":
                has &= near > _STANDS_OUT * _typical(near)
            own |= has
        clear += np.where(own, 0.0, power / floor)
        amplitude += np.where(own, 0.0, 2 * np.sqrt(power) / window.sum())
        free += ~own
    shortest = min(runs[i].spacing * runs[i].force.size for i in used)
    for line in but:
        free[np.abs(frequency - line) < _WIDTH / shortest] = 0
    clear = np.where(2 * free >= len(used), clear / np.maximum(free, 1), 0.0)
    best = int(np.argmax(clear))
    if clear[best] < _REQUIRED:
        return None
    return float(frequency[best]), float(amplitude[best] / free[best])


def _typical(power: Array) -> Array:
    """Local median."""
    return median_filter(power, min(81, power.size))


def _power(values: Array, spacing: float, frequency: Array, longest: float) -> Array:
    """Power at frequencies that all runs share."""
    count = round(_PADDING * longest / spacing)
    power = np.abs(np.fft.rfft(values, count)) ** 2
    return np.interp(frequency, np.fft.rfftfreq(count, spacing), power)


@dataclass(frozen=True)
class Witness:
    """The displacements as measured, which may have a tone that the force shows.

    Attributes
    ----------
    raw
        The fit data at the measured rate with the force as measured.
    displacements
        Of every run, at the times of its samples [m].
    """

    raw: Problem
    displacements: Sequence[Array]

    def clears(self, model: Model, frequency: float) -> bool:
        """Whether a tone in what a model leaves is none of the motion, as far as can be told."""
        follows = complex(_follows(model, np.array([frequency]))[0])
        lost = _may_be_lost(model, frequency) if self.raw.scales.one_tone else 1.0
        shown = left = hidden = own = 0.0
        errors = self.raw.errors(model)
        if self._rings(model, frequency, errors):
            return False
        everything = zip(
            self.raw.runs, self.raw.masks, errors, self.displacements, strict=True
        )  # fmt: skip
        for run, mask, error, displacement in everything:
            if mask.sum() <= _FEWEST or displacement.size != error.size:
                continue
            # what the smoothing leaves of the motion is in the prediction already
            moved, window = displacement - run.displacement, np.hanning(mask.size) * mask
            bin_ = 1 / (run.spacing * int(mask.sum()))
            (line, there), *beside = (
                (wave @ error, follows * (wave @ moved))
                for offset in (0, *_BESIDE)
                for wave in [window * np.exp(-2j * np.pi * (frequency + offset * bin_) * run.time)]
            )
            # a run counts by how clearly it tells
            of_error, of_motion = np.mean(np.abs(beside) ** 2, axis=0) + 1e-300
            noise = of_error + of_motion
            shown += abs(line) ** 2 / noise
            left += abs(line - there) ** 2 / noise
            hidden += lost * of_motion / noise
            own += lost * abs(there) ** 2 / noise
        if left < CRITERIA.tone_of_motion * shown:
            return False
        longest = max(run.spacing * run.force.size for run in self.raw.runs)
        # a line that the displacement has may be told badly: in coarse steps, for one
        may_have_one = own > max(CRITERIA.tone_hidden * shown, _MAY_BE_THERE * hidden)
        told = hidden < CRITERIA.tone_hidden * shown and not may_have_one
        hum = of_mains(frequency, 1 / longest) is not None
        return bool(told) or (hum and self._stands_out(frequency, errors))

    def _stands_out(self, frequency: float, errors: Sequence[Array]) -> bool:
        """Whether a line is far higher than those near it: else it may be of what rings there."""
        high = beside = 0.0
        for run, mask, error in zip(self.raw.runs, self.raw.masks, errors, strict=True):
            if mask.sum() <= _FEWEST:
                continue
            power = np.abs(np.fft.rfft(np.hanning(mask.size) * mask * error)) ** 2
            grid = np.fft.rfftfreq(mask.size, run.spacing)
            off, bin_ = np.abs(grid - frequency), 1 / (run.spacing * mask.size)
            own = off <= _WIDTH * bin_
            high += np.max(power[own], initial=0.0)
            beside += np.max(power[(off < _NEAR * frequency) & ~own], initial=0.0)
        return high > _HIGHER * beside

    def _rings(self, model: Model, frequency: float, errors: Sequence[Array]) -> bool:
        """Whether lines about a frequency are, all together, those of the displacement.

        A drive that rings has some side by side, and the noise may have hidden one of them.
        """
        shown = left = 0.0
        lines = 0
        for run, mask, error, displacement in zip(
            self.raw.runs, self.raw.masks, errors, self.displacements, strict=True
        ):
            if mask.sum() <= _FEWEST or displacement.size != error.size:
                continue
            window = np.hanning(mask.size) * mask
            grid = np.fft.rfftfreq(mask.size, run.spacing)
            near = np.abs(grid - frequency) < _ABOUT * frequency
            force, motion = (
                np.fft.rfft(window * each)[near]
                for each in (error, displacement - run.displacement)
            )
            there = _follows(model, grid[near]) * motion
            power = np.abs(force) ** 2
            high = power > _AS_HIGH * np.max(power, initial=0.0)
            lines = max(lines, int(np.sum(np.diff(np.flatnonzero(high)) > 2)) + 1)
            shown += float(power[high].sum())
            left += float(np.sum(np.abs(force - there)[high] ** 2))
        return lines > 1 and left < CRITERIA.tone_of_motion * shown


def _follows(model: Model, frequency: NDArray[np.floating]) -> NDArray[np.complex128]:
    """Force [N] that follows a displacement of 1 m at frequencies [Hz], as the channels show it."""
    omega, values = 2 * np.pi * frequency, model.values
    late = np.exp(-1j * omega * values.get("delay", 0.0))
    found = np.asarray(-values.get("inertance", 0.0) * omega**2 * late, dtype=np.complex128)
    for channel, way in (("force", 1), ("displacement", -1)):
        if (low_pass := filter_of(values, channel)) is not None:
            found = found * low_pass.response(frequency) ** way
    return found


def _may_be_lost(model: Model, frequency: float) -> float:
    """How many times the power of a line in the displacement the motion's own may have.

    Along one sine a displacement that is late may have gone through a low-pass as well.
    """
    late = -model.values.get("delay", 0.0)
    if late <= 0 or filter_of(model.values, "displacement") is not None:
        return 1.0
    steepest = Filter.as_late_as(late, order=ORDERS[-1])
    return float(np.abs(steepest.response(np.array([frequency]))[0]) ** -2)


def of_mains(frequency: float, resolution: float = 0.0) -> tuple[int, float] | None:
    """Which multiple of which mains [Hz] a tone is, told to a resolution [Hz]; None of none."""
    for mains in MAINS:
        times = round(frequency / mains)
        off = abs(frequency - times * mains)
        if 1 <= times <= MOST_HARMONICS and off < times * MAINS_DRIFT + resolution:
            return times, mains
    return None


def is_harmonic(model: Model, sizes: Scales, longest: float) -> bool:
    """Whether a model's tone is a harmonic of one sine, told to 1 / the longest run [s]."""
    if not sizes.one_tone or _TONE[0] not in model.free:
        return False
    frequency = model.values[_TONE[1]]
    order = round(frequency / sizes.frequency)
    off = abs(frequency - order * sizes.frequency)
    return 1 <= order <= _HARMONICS and off < 1.0 / longest


def tone_candidate(
    runs: Sequence[BenchRun], problem: Problem, fit: Fit, witness: Witness | None
) -> list[Candidate]:
    """The tone that what a fit leaves shows and the motion does not contain, if any."""
    if _TONE[0] in fit.model.values:
        return []
    line = _line(runs, problem, fit.model, witness)
    if line is None:
        return []
    start = fit.model.adding(disturbance_amplitude=line[1], disturbance_frequency=line[0])
    return [Candidate("periodic_disturbance", None, (start,))]


def _line(
    runs: Sequence[BenchRun],
    problem: Problem,
    model: Model,
    witness: Witness | None,
    lowest: float = LOWEST_TONE,
) -> tuple[float, float] | None:
    """Frequency [Hz] and amplitude [N] of the clearest line that is none of the motion."""
    sizes, errors = problem.scales, problem.errors(model)
    # what bends makes harmonics of one sine
    but = [n * sizes.frequency for n in range(2, _HARMONICS + 1)] if sizes.one_tone else []
    for _ in range(_ASKED):
        line = strongest_line(runs, errors, problem.masks, lowest, but=but)
        if line is None or witness is None or witness.clears(model, line[0]):
            return line
        but.append(line[0])
    return None


def with_tone_above(witness: Witness, fit: Fit, lowest: float) -> Fit | None:
    """A fit with a tone at frequencies that the fits' band does not hold, or None.

    Parameters
    ----------
    witness
        The fit data with force and displacement as measured.
    fit
        What is found in the band; it stays as it is.
    lowest
        From where on to look [Hz].
    """
    model, raw = fit.model, witness.raw
    if _TONE[0] in model.values:
        return None
    line = _line(raw.runs, raw, model, witness, lowest)
    if line is None:
        return None
    frequency, amplitude = line
    start = model.adding(disturbance_amplitude=amplitude, disturbance_frequency=frequency)
    tone = raw.fit(replace(start, free=_TONE))
    both = replace(start, values=tone.model.values)
    covariance = np.asarray(block_diag(fit.covariance, tone.covariance))
    return replace(fit, model=both, covariance=covariance)


def with_tone_from_raw(raw: Problem, fit: Fit) -> Fit:
    """A fit whose tone, if any, is fitted anew to the force as measured.

    Of a tone at the edge of the fits' band little is left there, hardly more than what the ends of
    a record leave.
    """
    if not all(name in fit.model.free for name in _TONE):
        return fit
    tone = raw.fit(replace(fit.model, free=_TONE))
    places = [fit.model.free.index(name) for name in _TONE]
    covariance = fit.covariance.copy()
    covariance[places, :] = covariance[:, places] = 0.0
    covariance[np.ix_(places, places)] = tone.covariance
    model = replace(fit.model, values=tone.model.values)
    return replace(fit, model=model, covariance=covariance)
