"""Runs of which each has a value of its own: an inertance, a friction level, a damping.

One device has one inertance. Where what is left of a run goes with its acceleration, and otherwise
in each run, the runs are not of one device in one state: another flywheel, a pin that engages. A
friction level or a damping that differs has run in or warmed up between the runs. No effect
explains that, for an effect is the same in every run.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.composition import level_and_distance
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.measured_text import measured
from inerter.motion_units import TRANSLATION, Kind, words

Array = NDArray[np.float64]
Values = dict[str, tuple[float, float]]
"""Of each run by name its value and the standard error of that."""

# values differ from so many standard errors on, by this share, and where what goes with them is
# this share of what is missed beyond the noise, in power
SURE, LEAST, SHARE = 8.0, 0.02, 0.5
# the share of a friction level or a damping
LEAST_OF_FRICTION = 0.1
# stretches of a run that count as independent; share of its largest speed at which it turns
STRETCHES, TURNS = 12, 0.03
# correlation of a velocity with its sign above which it has one size (a sine's is 0.90)
ONE_SPEED = 0.95


@dataclass(frozen=True, kw_only=True)
class RunValues:
    """Inertances [kg], friction levels [N] and dampings [N s/m] of runs, each where they differ."""

    inertances: Values = field(default_factory=dict)
    levels: Values = field(default_factory=dict)
    dampings: Values = field(default_factory=dict)

    @property
    def method(self) -> dict[str, Values]:
        """As in diagnosis.json."""
        return {
            "run_inertances": self.inertances,
            "run_levels": self.levels,
            "run_dampings": self.dampings,
        }

    def in_words(self, motion: Kind = TRANSLATION) -> str:
        """A sentence about the runs; empty where they do not differ."""
        if self.inertances:
            return (
                "By itself each run has an inertance of its own: "
                f"{_each(self.inertances, words(motion, 'kg'))}. These are not runs of one device "
                "in one state, or not of one calibration: diagnose those apart that differ."
            )
        found = self.levels or self.dampings
        if not found:
            return ""
        what, unit = ("a friction level", "N") if self.levels else ("viscous damping", "N s/m")
        return (
            f"By itself each run has {what} of its own: {_each(found, words(motion, unit))}. It "
            "has run in, warmed up or was set otherwise between the runs, or goes with what else "
            "differs between them, their amplitude say. An effect is the same in every run: "
            "diagnose those apart that differ."
        )


def run_values(
    runs: Sequence[BenchRun], errors: Sequence[Array], noise: float, model: Model
) -> RunValues:
    """What every run has by itself, where that differs: one of the three at most.

    errors: measured minus predicted force of every run (n,) [N]; noise: rms [N].
    """
    if inertances := _inertances(runs, errors, noise, model):
        return RunValues(inertances=inertances)

    def way(run: BenchRun) -> Array:
        slow = TURNS * float(np.max(np.abs(run.velocity[run.inner])))
        return np.tanh(run.velocity / (slow or 1.0))

    def level(run: BenchRun) -> list[Array]:
        return [way(run), run.acceleration, run.displacement]

    def viscous(run: BenchRun) -> list[Array]:
        return [run.velocity, run.acceleration, run.displacement]

    known = level_and_distance(model)[0], model.device().viscous
    levels, dampings = (
        _apart(runs, errors, noise, value, LEAST_OF_FRICTION, columns, relative=True)
        for value, columns in zip(known, (level, viscous), strict=True)
    )
    # along one speed a damping is a level of friction
    rubs = model.friction != "none"
    if rubs and all(_one_speed(run.velocity[run.inner], way(run)[run.inner]) for run in runs):
        return RunValues(levels=levels[0])
    if levels[1] >= dampings[1]:
        return RunValues(levels=levels[0])
    return RunValues(dampings=dampings[0])


def _one_speed(velocity: Array, way: Array) -> bool:
    """Whether a velocity (n,) hardly differs in size, so that its sign (n,) says all of it."""
    power = float(np.sum(velocity**2) * np.sum(way**2))
    return float(np.sum(velocity * way)) ** 2 > ONE_SPEED**2 * power


def _inertances(
    runs: Sequence[BenchRun], errors: Sequence[Array], noise: float, model: Model
) -> Values:
    inertance = model.device().inertance
    driven = {"series_frequency", "series_stiffness"}.isdisjoint(model.values)
    if not (inertance > 0 and driven):
        return {}

    def columns(run: BenchRun) -> list[Array]:
        return [run.acceleration, run.velocity, run.displacement]

    return _apart(runs, errors, noise, inertance, LEAST * inertance, columns)[0]


def _each(found: Mapping[str, tuple[float, float]], unit: str) -> str:
    return ", ".join(
        f"{measured(value, error)} {unit} in {name}" for name, (value, error) in found.items()
    )


def _apart(
    runs: Sequence[BenchRun],
    errors: Sequence[Array],
    noise: float,
    value: float,
    least: float,
    columns: Callable[[BenchRun], list[Array]],
    *,
    relative: bool = False,
) -> tuple[Values, float]:
    """Values of the runs, where they differ, and what these take away [N^2].

    value: of all runs together; they differ by `least` at least, or `relative`, by that share of
    their mean. columns: of a run what the value multiplies, and what else a run may have.
    """
    if len(runs) < 2 or any(r.part or r.inner.sum() < 10 * STRETCHES for r in runs):
        return {}, 0.0
    rows = [_more(run, error, columns(run)) for run, error in zip(runs, errors, strict=True)]
    more, stderrs, taken = np.array(rows).T
    apart, own = float(np.ptp(more)), value + more
    pair = float(np.hypot(stderrs[np.argmax(more)], stderrs[np.argmin(more)]))
    missed = sum(float(np.sum(e[run.inner] ** 2)) for run, e in zip(runs, errors, strict=True))
    missed -= noise**2 * sum(int(run.inner.sum()) for run in runs)
    if relative:
        least *= abs(float(np.mean(own)))
    if apart < max(SURE * pair, least) or float(np.sum(taken)) < SHARE * missed:
        return {}, 0.0
    every = zip(runs, own, stderrs, strict=True)
    return {run.name: (float(v), float(error)) for run, v, error in every}, float(np.sum(taken))


def _more(run: BenchRun, error: Array, columns: Sequence[Array]) -> tuple[float, float, float]:
    """The value beyond the model's, its standard error, and what it takes away [N^2]."""
    inner = run.inner
    matrix = np.column_stack([column[inner] for column in columns])
    matrix = matrix - matrix.mean(axis=0)
    rest = error[inner] - error[inner].mean()
    scale = np.sqrt(np.mean(matrix**2, axis=0))
    matrix = matrix / np.where(scale > 0, scale, 1.0)
    solved, *_ = np.linalg.lstsq(matrix, rest, rcond=1e-9)
    left = rest - matrix @ solved
    bread = np.linalg.pinv(matrix.T @ matrix, rcond=1e-12)
    parts = np.array_split(np.arange(rest.size), STRETCHES)
    scores = np.array([matrix[part].T @ left[part] for part in parts])
    covariance = bread @ scores.T @ scores @ bread
    without = rest - matrix[:, 1:] @ np.linalg.lstsq(matrix[:, 1:], rest, rcond=1e-9)[0]
    taken = float(np.sum(without**2) - np.sum(left**2))
    size = float(scale[0]) or 1.0
    return float(solved[0]) / size, float(np.sqrt(max(covariance[0, 0], 0.0))) / size, taken
