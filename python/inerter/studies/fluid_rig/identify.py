"""Identification of one configuration from its measured tests."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from inerter.estimation.least_squares import (
    Solution,
    Tolerances,
    polish,
    search_in_batches,
)
from inerter.studies.fluid_rig.objective import OBJECTIVES, Measured, Objective
from inerter.studies.fluid_rig.rig import Configuration, Rig
from inerter.studies.fluid_rig.signals import Noise, Signals
from inerter.studies.fluid_rig.sweeps import Sweep
from inerter.studies.fluid_rig.unknowns import (
    COMPLETE_LIVE,
    DRY_LIVE,
    Unknowns,
    device_values,
    unknowns,
)

Array = NDArray[np.float64]

# normal quantile of a 95 % interval
_QUANTILE = 1.959964
# relative half width of an interval from which on a parameter is not determined
UNDETERMINED = 0.2
# from here on two parameters are hardly told apart
CORRELATED = 0.95
# what ends a search from far, on the first part of the tests
_FAR = Tolerances(1e-4, 1e-4, 1e-12)
_EVALUATIONS = 15
# a cost so many times what noise explains asks for another start
_POOR = 2.0
SEARCH_PART = {"dry": 16.0, "complete": 26.0}
"""The first part of the tests that the search from far runs on [s]: to 3.6 and 5.5 Hz."""


@dataclass(frozen=True)
class Held:
    """Parameters that a fit takes as known, and their covariance (p, p)."""

    values: Mapping[str, float] = field(default_factory=dict)
    covariance: Array = field(default_factory=lambda: np.zeros((0, 0)))


@dataclass(frozen=True, kw_only=True)
class IdentifiedRig:
    """What a fit found.

    names, values, covariance: of the parameters, SI units, in one order. held: what was taken as
    known; its uncertainty is part of the covariance. cost_ratio: cost over what noise alone
    explains. together: standard errors by noise alone, held values taken as exact; alone: those if
    only one part of the features were compared. noise: as estimated. step_shift: by how many
    standard errors half the time step moved the parameters at most. signals: the fitted model's
    own. searches: from how many starts, start: of the best. simulations: of one test each.
    seconds: wall time.
    """

    configuration: Configuration
    objective: str
    names: tuple[str, ...]
    values: Array
    covariance: Array
    held: Held
    cost_ratio: float
    together: Array
    alone: Mapping[str, Array]
    noise: Noise
    step_shift: float
    signals: tuple[Signals, ...]
    start: Mapping[str, float]
    searches: int
    simulations: int
    seconds: float

    @property
    def parameters(self) -> dict[str, float]:
        """Values by name."""
        return dict(zip(self.names, map(float, self.values), strict=True))

    @property
    def errors(self) -> Array:
        """Standard errors, shape (p,)."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def intervals(self) -> Array:
        """95 % intervals, shape (p, 2)."""
        half = _QUANTILE * self.errors
        return np.column_stack([self.values - half, self.values + half])

    @property
    def correlation(self) -> Array:
        """Correlation of the parameters, shape (p, p)."""
        errors = np.maximum(self.errors, 1e-300)
        return self.covariance / np.outer(errors, errors)

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Parameters whose interval is wider than a fifth of their value to either side."""
        wide = _QUANTILE * self.errors > UNDETERMINED * np.abs(self.values)
        return tuple(name for name, each in zip(self.names, wide, strict=True) if each)

    @property
    def hardly_apart(self) -> tuple[tuple[str, str, float], ...]:
        """Pairs of parameters that make up for each other, with their correlation."""
        matrix, count = self.correlation, len(self.names)
        return tuple(
            (self.names[i], self.names[j], float(matrix[i, j]))
            for i in range(count)
            for j in range(i)
            if abs(matrix[i, j]) > CORRELATED
        )


class Fitting:
    """A configuration's fit: the rig, what is searched and what is held."""

    def __init__(
        self, configuration: Configuration, objective: Objective, held: Held, threads: int = 0
    ) -> None:
        live = DRY_LIVE if configuration == "dry" else COMPLETE_LIVE
        rate = objective.measured.signals[0].rate
        self.rig = Rig(configuration, live, rate, threads=threads)
        self.objective, self.held = objective, held
        self.unknowns: Unknowns = unknowns(configuration, objective.measured.sweeps)
        self.simulations = 0
        self._last: tuple[dict[str, float], list[Signals | None]] | None = None

    def halve_the_step(self) -> None:
        """From here on simulate with half the time step."""
        self.rig = replace(self.rig, step=0.5 * self.rig.step)
        self._last = None

    def simulate(self, sets: Sequence[Mapping[str, float]]) -> list[list[Signals | None]]:
        """Every test with every set of parameters, in one batch."""
        # one set is often asked for twice in a row
        if len(sets) == 1 and self._last and self._last[0] == sets[0]:
            return [self._last[1]]
        sweeps = self.objective.measured.sweeps
        tests: list[tuple[Sweep, dict[str, float]]] = [
            (sweep, {**self.held.values, **device_values(values, sweep)})
            for values in sets
            for sweep in sweeps
        ]
        self.simulations += len({(s, tuple(sorted(v.items()))) for s, v in tests})
        found = self.rig.simulate(tests)
        runs = [found[i : i + len(sweeps)] for i in range(0, len(found), len(sweeps))]
        if len(sets) == 1:
            self._last = dict(sets[0]), runs[0]
        return runs

    def residuals(self, sets: Array) -> Array:
        """Weighted residuals of sets of search variables, (sets, p) to (sets, features)."""
        runs = self.simulate([self.unknowns.parameters(row) for row in sets])
        return np.array([self.objective.residual(run) for run in runs])

    def effect_of_held(self, variables: Array) -> Array:
        """Derivatives of the residuals by the held parameters, shape (features, held)."""
        names, step = list(self.held.values), 1e-3
        here = self.unknowns.parameters(variables)
        base = dict(self.held.values)
        sets = [{**here, name: base[name] * (1 + step)} for name in names]
        there = [self.objective.residual(run) for run in self.simulate([here, *sets])]
        sizes = step * np.array([base[name] for name in names])
        return ((np.array(there[1:]) - there[0]) / sizes[:, None]).T


def identify(
    configuration: Configuration,
    measured: Measured,
    objective: str,
    starts: Sequence[Mapping[str, float]],
    held: Held | None = None,
    threads: int = 0,
) -> IdentifiedRig:
    """Fit a configuration's parameters to its measured tests.

    Parameters
    ----------
    configuration
        "dry" or "complete".
    measured
        The tests.
    objective
        "spectra" or "time".
    starts
        Parameters to start from, the next one only where the fit explains the tests badly.
    held
        What is known: of the complete device its dry friction.
    threads
        That simulations run on, 0 for one per processor.

    Raises
    ------
    ValueError
        No start leads to a simulation that reaches its end.
    """
    begin, held = perf_counter(), held or Held()
    part = OBJECTIVES[objective](measured.shortened(SEARCH_PART[configuration]))
    best: tuple[Solution, Mapping[str, float]] | None = None
    coarse = Fitting(configuration, part, held, threads)
    fine = Fitting(configuration, OBJECTIVES[objective](measured), held, threads)
    bounds, tried = fine.unknowns.bounds, 0
    for start in starts:
        tried += 1
        found = search_in_batches(
            coarse.residuals, fine.unknowns.encode(start), bounds, _FAR, _EVALUATIONS
        )
        if best is None or found.squares < best[0].squares:
            best = found, start
        if best[0].squares < _POOR * part.expected_cost + _count(part):
            break
    if best is None:
        raise ValueError("starts: give at least one set of parameters")
    # with a model near, noise is what is left when it is taken off
    (near,) = fine.simulate([fine.unknowns.parameters(best[0].variables)])
    whole = OBJECTIVES[objective](replace(measured, near=_complete(near)))
    fine.objective = whole
    solution = polish(fine.residuals, best[0].variables, bounds)
    covariance = by_noise = whole.covariance(solution.jacobian)
    effect = np.zeros((len(bounds[0]), 0))
    if held.values and held.covariance.size:
        effect = np.linalg.pinv(solution.jacobian) @ fine.effect_of_held(solution.variables)
    variables, signals, shift = _finer(fine, solution, bounds)
    ratio = solution.squares / max(whole.expected_cost, 1e-300)
    covariance = covariance * max(1.0, ratio)
    if effect.size:
        covariance = covariance + effect @ held.covariance @ effect.T
    gradient = fine.unknowns.gradient(variables)
    alone = {
        part: np.sqrt(np.diag(gradient @ whole.covariance(solution.jacobian, part) @ gradient.T))
        for part in whole.parts
    }
    parameters = fine.unknowns.parameters(variables)
    return IdentifiedRig(
        configuration=configuration,
        objective=objective,
        names=tuple(parameters),
        values=np.array(list(parameters.values())),
        covariance=gradient @ covariance @ gradient.T,
        held=held,
        cost_ratio=ratio,
        together=np.sqrt(np.diag(gradient @ by_noise @ gradient.T)),
        alone=alone,
        noise=whole.measured.noise,
        step_shift=shift,
        signals=signals,
        start=dict(best[1]),
        searches=tried,
        simulations=coarse.simulations + fine.simulations,
        seconds=perf_counter() - begin,
    )


def _finer(
    fine: Fitting, solution: Solution, bounds: tuple[Array, Array]
) -> tuple[Array, tuple[Signals, ...], float]:
    """Corrected by a run with half the time step: variables, signals, shift in standard errors."""
    fine.halve_the_step()
    inverse = np.linalg.pinv(solution.jacobian)
    (residual,) = fine.residuals(solution.variables[None])
    if not np.isfinite(residual).all():
        raise ValueError("the simulation with half the time step does not reach its end")
    change = -inverse @ (residual - solution.residual)
    errors = np.sqrt(np.diag(inverse @ inverse.T))
    variables = np.clip(solution.variables + change, *bounds)
    (signals,) = fine.simulate([fine.unknowns.parameters(variables)])
    return variables, _complete(signals), float(np.max(np.abs(change) / errors))


def _complete(signals: Sequence[Signals | None]) -> tuple[Signals, ...]:
    found = tuple(each for each in signals if each is not None)
    if len(found) < len(signals):
        raise ValueError("the simulation does not reach its end where the search ended")
    return found


def _count(objective: Objective) -> float:
    """What the simulation's own error may add to the cost."""
    return math.sqrt(objective.target.size)
