"""Smoothing chosen from the data: the cut-off whose motion predicts the measured force best."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from inerter.core import Device
from inerter.motion_units import ROTATION
from inerter.records.motion import (
    Motion,
    apply_weight,
    force_noise,
    has_one_line,
    lowpass,
    smooth,
    weight_above,
    white_noise,
)
from inerter.records.record import Record

Array = NDArray[np.float64]
Masks = Sequence[NDArray[np.bool_]]

# the lowest cut-off that predicts the force this nearly as well as the best one is taken
TOLERANCE = 0.005
# ratio of neighbouring cut-offs tried, the highest one [Hz], and that of faster motions per their
# dominant frequency
STEP = 1.3
HIGHEST = 200.0
WIDEST = 8.0
# cut-offs per sample rate: the highest that is always tried, and the highest of all, which leaves
# nearly everything up to half of the rate
USUAL, EVERYTHING = 0.2, 0.8
# samples that every run must keep away from its ends: so many, and this share of what the highest
# cut-off leaves
SMALLEST = 50
KEPT = 0.5
# warnings of a measured velocity or acceleration with which it is left out
WRONG = ("sign_flip", "unit_suspect", "constant_channel")
# share of its range within which a force is at the end of it: a channel that clips tells nothing
# of the motion there
AT_LIMIT = 1e-3
# share of its samples that a force which is not switched has between these ends
SWITCHED = 0.2
# travel of a joint [rad], about, from which on gravity is no stiffness
BENT_TURN = 1.0
# rms displacement of a run that moves, per noise
MOVES = 10.0


@dataclass(frozen=True, kw_only=True)
class Preparation:
    """Smoothed motions and how they came about.

    Attributes
    ----------
    cutoffs, errors : ndarray (m,)
        Cut-offs tried [Hz] and the rms force error of a broad linear model on each [N].
    channels : tuple of str
        Measured channels used beside the displacement.
    widest : float
        The highest cut-off that may be tried [Hz].
    noise_floor : float
        Rms of the force channel's white noise [N].
    corner : float
        Frequency [Hz] above which errors were taken to count less, see `weighed`.
    force_band : float
        Band [Hz] in which forces are compared where it is wider than that of the motion, else 0.
    one_line : bool
        Whether the motion has one frequency.
    """

    motions: list[Motion]
    cutoff: float
    cutoffs: Array
    errors: Array
    channels: tuple[str, ...]
    widest: float
    noise_floor: float
    corner: float = np.inf
    force_band: float = 0.0
    one_line: bool = False


def prepare(records: Sequence[Record], learnt: Masks | None = None) -> Preparation:
    """Smooth every record at one cut-off, chosen so that the motion predicts the force best.

    Only samples of `learnt`, a mask per record, tell how well it does; all where these are too few,
    and by default.

    Too low a cut-off takes acceleration away, too high a one lets noise in; both make the force
    error grow. The force is an independent witness of the acceleration, so no assumption about the
    noise of the displacement is needed, and coloured noise does no harm.
    """
    rate = min(record.sample_rate for record in records)
    # of a run at rest, the dominant frequency is that of its noise
    moving = [r for r in records if np.std(r.displacement) > MOVES * white_noise(r.displacement)]
    dominant = max(dominant_frequency(record) for record in moving or records)
    limit = max(HIGHEST, WIDEST * dominant)
    highest = min(USUAL * rate, limit)
    lowest = min(2 * dominant, highest / 2)
    count = int(np.ceil(np.log(highest / lowest) / np.log(STEP))) + 1
    cutoffs = np.geomspace(lowest, highest, count)
    measured = [name for name in ("velocity", "acceleration") if usable(name, records)]
    choices = [use for count in range(len(measured) + 1) for use in combinations(measured, count)]

    wide = [smooth(record, float(cutoffs[-1]), ()) for record in records]
    one_line = has_one_line(wide, [motion.velocity_noise for motion in wide])

    def error(motions: Sequence[Motion], masks: Masks) -> float:
        return _force_error(motions, _both(masks, learnt), one_line)

    widest = min(EVERYTHING * rate, limit)
    rows = [_errors(records, cutoffs, use, error, widest) for use in choices]
    cutoffs = max((tried for tried, _ in rows), key=lambda tried: tried.size)
    # what was not tried is no better
    errors = np.array(
        [np.pad(r, (0, cutoffs.size - r.size), constant_values=np.inf) for _, r in rows]
    )
    if not np.isfinite(errors).any():
        if learnt is not None:
            return prepare(records)
        shortest = min(records, key=lambda record: record.duration)
        raise ValueError(
            f"{shortest.name}: {shortest.samples} samples over {shortest.duration:.3g} s are too "
            "few to tell motion from noise; record at least some periods of the motion"
        )
    best_choice = int(np.argmin(errors.min(axis=1)))
    row = errors[best_choice]
    index = int(np.flatnonzero(row <= row.min() * (1 + TOLERANCE))[0])
    cutoff, use = float(cutoffs[index]), choices[best_choice]
    return Preparation(
        motions=[smooth(record, cutoff, use) for record in records],
        cutoff=cutoff,
        cutoffs=cutoffs,
        errors=row,
        widest=widest,
        channels=use,
        noise_floor=float(np.sqrt(np.mean([force_noise(record.force) ** 2 for record in records]))),
        one_line=one_line,
    )


def _both(masks: Masks, learnt: Masks | None) -> Masks:
    """Samples of both."""
    return masks if learnt is None else [m & n for m, n in zip(masks, learnt, strict=True)]


def weighed(
    records: Sequence[Record], preparation: Preparation, learnt: Masks | None = None
) -> Preparation:
    """The records smoothed at the cut-off that is best where errors count by the motion's noise.

    Only samples of `learnt`, a mask per record, tell; by default all.

    White noise of the displacement is one of b a that grows with the square of the frequency.
    Residuals that count less from the corner on, where it outweighs the force's own noise, bear a
    higher cut-off, which blurs less of what is not linear in the motion. Where measured velocities
    or accelerations are weighed in, their noise is not known and nothing changes.
    """
    if preparation.channels:
        return preparation
    motions = preparation.motions
    pairs = list(zip(motions, _both([m.inner for m in motions], learnt), strict=True))
    a = np.concatenate([m.acceleration[mask] for m, mask in pairs])
    force = np.concatenate([lowpass(m.force, m.spacing, m.cutoff)[mask] for m, mask in pairs])
    inertance = abs(float(a @ force)) / float(a @ a)
    noise = inertance * np.sqrt(np.mean([white_noise(r.displacement) ** 2 for r in records]))
    if not (noise > 0 and preparation.noise_floor > 0):
        # a force without noise is one that was commanded
        return preparation
    corner = float(np.sqrt(preparation.noise_floor / noise) / (2 * np.pi))

    def error(motions: Sequence[Motion], masks: Masks) -> float:
        return _force_error(motions, _both(masks, learnt), preparation.one_line, corner)

    return replace(prepare_again(records, preparation, error), corner=corner)


def refuse_unusable(records: Sequence[Record]) -> None:
    """Raise ValueError for a run that says nothing about a device: still, or moving evenly."""
    for record in records:
        for name, what in (("displacement", "does not move"), ("force", "does not change")):
            values = getattr(record, name)
            if np.ptp(values) == 0:
                raise ValueError(
                    f"{record.name}: column '{name}' {what} ({values[0]:g} throughout); leave this "
                    "run out"
                )
        x = record.displacement
        away = x - np.linspace(x[0], x[-1], x.size)
        if np.ptp(away) < 1e-6 * np.ptp(x):
            raise ValueError(
                f"{record.name}: column 'displacement' grows evenly and never accelerates, which "
                "says nothing about an inerter; leave this run out"
            )


def prepare_again(
    records: Sequence[Record],
    preparation: Preparation,
    error: Callable[[Sequence[Motion], Masks], float],
) -> Preparation:
    """The records smoothed at the cut-off at which a fitted model predicts the raw force best.

    A broad linear model does not know a device's resonances, whose force may lie far above its
    motion. `error` gives the model's force error [N] along motions over masked samples.
    """
    use = preparation.channels
    cutoffs, errors = _errors(records, preparation.cutoffs, use, error, preparation.widest)
    if not np.isfinite(errors).any():
        return preparation
    best = float(np.nanmin(np.where(np.isfinite(errors), errors, np.nan)))
    cutoff = float(cutoffs[np.flatnonzero(errors <= best * (1 + TOLERANCE))[0]])
    if cutoff == preparation.cutoff:
        return preparation
    motions = [smooth(record, cutoff, use) for record in records]
    return replace(preparation, motions=motions, cutoff=cutoff, cutoffs=cutoffs, errors=errors)


def usable(name: str, records: Sequence[Record]) -> bool:
    """Whether every record has a channel, and in none it was found to be dead or wrong."""
    return all(
        getattr(record, name) is not None
        and not any(w.code in WRONG and f"{name!r}" in w.text for w in record.warnings)
        for record in records
    )


def dominant_frequency(record: Record) -> float:
    """Frequency below which half of the velocity's power lies [Hz]."""
    x = record.displacement - np.mean(record.displacement)
    power = np.abs(np.fft.rfft(x * np.hanning(x.size))) ** 2
    frequency = np.fft.rfftfreq(x.size, record.sample_interval)
    cumulative = np.cumsum(power * frequency**2 / (1 + (frequency / 20.0) ** 4))
    return float(max(frequency[np.searchsorted(cumulative, 0.5 * cumulative[-1])], frequency[1]))


def _errors(
    records: Sequence[Record],
    cutoffs: Array,
    use: tuple[str, ...],
    error: Callable[[Sequence[Motion], Masks], float],
    widest: float,
) -> tuple[Array, Array]:
    """Errors at some cut-offs, all on the same samples; infinite where too few would be left.

    Where the highest of them is the best, higher ones follow up to the `widest` [Hz], as long as
    each is better: the motion fills what the sample rate leaves. Cut-offs tried, and their errors.

    The lower a cut-off, the more is unsure at the ends. Judged on what it leaves itself, a low one
    would look good for leaving out how the motion begins. The motions keep their own beginnings: a
    flywheel behind a play remembers how it was thrown.
    """

    def smoothed(cutoff: float) -> list[Motion]:
        return [smooth(record, float(cutoff), use) for record in records]

    most = [int(motion.inner.sum()) for motion in smoothed(cutoffs[-1])]
    common: list[NDArray[np.bool_]] = []
    tried, found = [float(cutoff) for cutoff in cutoffs], list[float]()
    for cutoff in tried:
        motions = smoothed(cutoff)
        if not common:
            left = [int(motion.inner.sum()) for motion in motions]
            if any(n < max(SMALLEST, KEPT * m) for n, m in zip(left, most, strict=True)):
                found.append(np.inf)
                continue
            common = [motion.inner for motion in motions]
        same = [motion.inner & c for motion, c in zip(motions, common, strict=True)]
        found.append(error(motions, same))
        best = len(found) == len(tried) and np.isfinite(found[-1]) and found[-1] == min(found)
        if best and STEP * cutoff <= widest:
            tried.append(STEP * cutoff)
    return np.array(tried), np.array(found)


def _inside(force: Array) -> NDArray[np.bool_]:
    """Where a force is not at the ends of its range (n,); everywhere, where it is there mostly.

    Such is no channel that clips, but a force that is switched on and off.
    """
    margin = AT_LIMIT * np.ptp(force)
    inside = (force > force.min() + margin) & (force < force.max() - margin)
    return inside if inside.mean() > SWITCHED else np.ones(force.size, bool)


def _force_error(
    motions: Sequence[Motion], masks: Masks, one_line: bool, corner: float = np.inf
) -> float:
    """Rms force error of a broad linear model: inertance, damping, stiffness, friction, memory.

    Of a joint that turns far the weight too: what gravity is missed by would hide all else.

    Above a `corner` [Hz] errors count less, see `weight_above`.
    """
    x_rms, v_rms = (
        np.std(np.concatenate([getattr(m, name)[m.inner] for m in motions]))
        for name in ("displacement", "velocity")
    )
    columns, forces = [], []
    # along one sine the displacement would foretell what the acceleration does, at any cut-off
    shares = (0.003, 0.03) if one_line else (0.003, 0.03, 0.3)
    for motion, mask in zip(motions, masks, strict=True):
        x, v, a = motion.displacement, motion.velocity, motion.acceleration
        rows = [a, v, np.ones_like(x), v * np.abs(v), np.tanh(v / (0.01 * v_rms))]
        if not one_line:
            rows.append(x)
            if motion.motion == ROTATION and 2.0 * x_rms > BENT_TURN:
                # a weight that is swung, not in balance
                rows += [np.sin(x), np.cos(x)]
        for share in shares:
            bristle = Device(
                friction="dahl", coulomb_force=1.0, bristle_stiffness=float(1 / (share * x_rms))
            )
            rows.append(bristle.along(motion.spacing, x, v, a)["friction"])
        table = np.array([*rows, motion.force])
        if np.isfinite(corner):
            table = apply_weight(table, weight_above(x.size, motion.spacing, corner))
        inside = mask & _inside(motion.force)
        columns.append(table[:-1].T[inside])
        forces.append(table[-1][inside])
    matrix, force = np.vstack(columns), np.concatenate(forces)
    matrix = matrix / (np.std(matrix, axis=0) + np.abs(np.mean(matrix, axis=0)) + 1e-300)
    gram, right = matrix.T @ matrix, matrix.T @ force
    solution = np.linalg.lstsq(gram, right, rcond=1e-12)[0]
    square = float(np.mean((force - matrix @ solution) ** 2))

    # a low-passed record has two free values per period of the cut-off; the fit takes some of them
    counts = [int(mask.sum()) for mask in masks]
    values = sum(2 * m.cutoff * m.spacing * n for m, n in zip(motions, counts, strict=True))
    left = values - matrix.shape[1]
    return float(np.sqrt(square * values / left)) if left > 0 else np.inf
