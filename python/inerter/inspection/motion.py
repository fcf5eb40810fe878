"""The motion of a bench record: strokes, speeds, rests, and how well the force repeats."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.records.motion import Motion

Array = NDArray[np.float64]

MOVING = 0.05  # of the highest speed
LONG = 0.2  # of the longest stroke: shorter ones are chatter
ALIKE = 0.05  # by which lengths and durations of strokes that repeat may differ
POINTS = 400


@dataclass(frozen=True, kw_only=True)
class MotionFacts:
    """Strokes and what they span, SI units.

    strokes: their number; stroke [m], period [s]: medians, None for fewer than two strokes; speed,
    acceleration: highest; rest: share of the time at rest; repeats [N]: rms by which the force
    differs between strokes that repeat, None where none do.
    """

    strokes: int
    stroke: float | None
    period: float | None
    speed: float
    acceleration: float
    rest: float
    repeats: float | None


def motion_facts(motion: Motion) -> MotionFacts:
    """What the motion of a record is made of."""
    parts = strokes(motion.displacement, motion.velocity)
    lengths = np.array([abs(motion.displacement[b] - motion.displacement[a]) for a, b in parts])
    starts = np.array([a for a, _ in parts])
    inner = motion.inner
    speed = float(np.max(np.abs(motion.velocity[inner])))
    return MotionFacts(
        strokes=len(parts),
        stroke=float(np.median(lengths)) if len(parts) > 1 else None,
        period=float(np.median(np.diff(starts)) * 2 * motion.spacing) if len(parts) > 2 else None,
        speed=speed,
        acceleration=float(np.max(np.abs(motion.acceleration[inner]))),
        rest=float(np.mean(np.abs(motion.velocity) < 0.01 * speed)),
        repeats=_repeats(motion, parts, lengths),
    )


def strokes(displacement: Array, velocity: Array) -> list[tuple[int, int]]:
    """First and last sample of each stroke: a stretch in one direction, rests at its ends."""
    moving = np.abs(velocity) > MOVING * np.max(np.abs(velocity))
    direction = np.where(moving, np.sign(velocity), 0)
    at = np.flatnonzero(direction)
    if not len(at):
        return []
    turns = np.flatnonzero(np.diff(direction[at]) != 0)
    bounds = [(int(part[0]), int(part[-1])) for part in np.split(at, turns + 1)]
    # one way in two parts, with a rest between, is two strokes
    apart: list[tuple[int, int]] = []
    for start, stop in bounds:
        inside = at[(at >= start) & (at <= stop)]
        breaks = np.flatnonzero(np.diff(inside) > max(5, (stop - start) // 10))
        apart += [(int(p[0]), int(p[-1])) for p in np.split(inside, breaks + 1)]
    lengths = [abs(displacement[b] - displacement[a]) for a, b in apart]
    longest = max(lengths)
    return [part for part, size in zip(apart, lengths, strict=True) if size > LONG * longest]


def _repeats(motion: Motion, parts: list[tuple[int, int]], lengths: Array) -> float | None:
    """Rms of the force's difference between each stroke and the last one like it, per stroke.

    Like it is one at the same places as it goes on, in as long a time.
    """
    differences = []
    seen: list[tuple[float, int, Array, Array]] = []
    for (start, stop), length in zip(parts, lengths, strict=True):
        if stop - start < 20:
            continue
        at, samples = np.linspace(start, stop, POINTS), np.arange(start, stop + 1)
        force, place = (
            np.interp(at, samples, channel[start : stop + 1])
            for channel in (motion.force, motion.displacement)
        )
        for k, (other, duration, earlier, there) in enumerate(seen):
            alike = abs(other / length - 1) < ALIKE
            apart = float(np.sqrt(np.mean((place - there) ** 2)))
            if alike and abs(duration / (stop - start) - 1) < ALIKE and apart < ALIKE * length:
                differences.append(float(np.mean((force - earlier) ** 2)))
                seen[k] = (length, stop - start, force, place)
                break
        else:
            seen.append((length, stop - start, force, place))
    if len(differences) < 2:
        return None
    return float(np.sqrt(np.median(differences) / 2))
