"""Fits from many starting points, so that no local minimum is taken for the best one.

A Halton sequence covers the ranges of the coordinates that enter the force nonlinearly. With those
held, the force is linear in the rest (inertance, damping, stiffness, friction level ...), which a
bounded linear fit finds at once. The best few starts that differ are then fitted in full, and what
a simpler law found, where no fit is as good (see `nested`). Nothing is random: the same data give
the same answer.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear
from scipy.stats import qmc

from inerter.catalogue.coordinates import COORDINATES, FRICTION_SHARE, NUISANCES
from inerter.catalogue.friction import FRICTION
from inerter.core import DeviceError
from inerter.estimation.variables import Variables
from inerter.identify.fit import Fit, Problem
from inerter.identify.laws import FittedLaw
from inerter.identify.model import Model
from inerter.identify.nested import embedded
from inerter.identify.prediction import force_along

Array = NDArray[np.float64]

# starts per nonlinear coordinate, and how many are fitted in full
_STARTS = 24
_FITTED = 4
# starts closer than this in every coordinate (logarithms) count as one
_APART = 0.5
_ROUGH, _THOROUGH = 25, 200
# width of sign(v) in fits, per rms velocity
_TRANSITION = 0.005


@dataclass(frozen=True)
class Multistart:
    """`best` fit, and the rms errors [N] that the fits from the other starts ended at.

    `converged`: the best fit ended because no step lowered the error, not because it took too long.
    """

    best: Fit
    ends: tuple[float, ...]
    converged: bool = True


def search(
    problem: Problem,
    law: FittedLaw,
    fixed: Mapping[str, float | str],
    *,
    loss: str = "linear",
    starts: int | None = None,
    simpler: Sequence[Model] = (),
) -> Multistart:
    """The best fit of a law.

    Parameters
    ----------
    problem
        Runs and masks.
    law
        What to fit.
    fixed
        Parameters of the device that are known, SI units, or words such as gas_law.
    loss
        As in `scipy.optimize.least_squares`: "linear", or robust: "soft_l1", "huber", "cauchy".
    starts
        Points of the sequence; by default 24 per nonlinear coordinate.
    simpler
        What laws within this one were fitted as.

    Raises
    ------
    DeviceError
        What is fixed does not fit to the law.
    """
    models = list(_starts(problem, law, fixed, starts))
    scored = sorted(
        ((error, model) for model in models if math.isfinite(error := _error(problem, model))),
        key=_first,
    )
    if not scored:
        models[0].device()
        raise DeviceError(f"law {law.name}: no start gives a finite force; check what is fixed")
    chosen = _distinct([model for _, model in scored], law)[:_FITTED]
    fits = [problem.fit(model, _ROUGH, loss) for model in chosen]
    reached = min(_size(fit.residual, problem) for fit in fits)
    inside = [(_error(problem, m), m) for m in embedded(models[0], simpler, problem.scales)]
    known, simplest = min(inside, key=_first, default=(math.inf, models[0]))
    if known < reached:
        fits.append(problem.fit(simplest, _ROUGH, loss))
    order = sorted(range(len(fits)), key=lambda i: fits[i].cost)
    best = problem.fit(fits[order[0]].model, _THOROUGH, loss)
    if loss == "linear" and known < _size(best.residual, problem):
        # a fit keeps off the bounds, at which the simpler law may stand
        best = replace(best, model=simplest, residual=problem.residual(simplest))
    ends = tuple(fits[i].rmse(problem.masks) for i in order)
    return Multistart(best, ends, best.evaluations < _THOROUGH)


def _starts(
    problem: Problem, law: FittedLaw, fixed: Mapping[str, float | str], count: int | None
) -> list[Model]:
    """Models at the points of the sequence, linear coordinates fitted."""
    sizes = problem.scales
    free = {name: ends for name, ends in law.starts.items() if not _is_fixed(name, fixed)}
    spread = [name for name, (low, high) in free.items() if high > low]
    number = count or _STARTS * len(spread)
    points = np.zeros((1, 0))
    if spread:
        # the first point of the sequence is a corner
        points = qmc.Halton(len(spread), scramble=False).random(number + 1)[1:]
    models = []
    for point in points:
        units = {name: COORDINATES[name].start_unit(sizes) for name in free}
        values = {name: low * units[name] for name, (low, _) in free.items()}
        for name, share in zip(spread, point, strict=True):
            low, high = np.array(free[name]) * units[name]
            if low < 0:
                values[name] = float(low + share * (high - low))
            else:
                low, high = np.log((low, high))
                values[name] = float(np.exp(low + share * (high - low)))
        models.append(_with_linear(problem, law, values, fixed))
    return models


def _is_fixed(name: str, fixed: Mapping[str, float | str]) -> bool:
    """Whether what is known leaves nothing for this coordinate to say."""
    return name in fixed or any(parameter in fixed for parameter in COORDINATES[name].words)


def _with_linear(
    problem: Problem, law: FittedLaw, values: dict[str, float], fixed: Mapping[str, float | str]
) -> Model:
    """The model at these values, with inertance, damping and friction level fitted to the data."""
    sizes = problem.scales
    numbers = {name: float(v) for name, v in fixed.items() if not isinstance(v, str)}
    texts = {name: v for name, v in fixed.items() if isinstance(v, str)}
    level = None if "bw_stiffness" in law.linear else FRICTION[law.friction].level or None
    start = {"inertance": sizes.force / sizes.acceleration, **values, **numbers}
    if FRICTION[law.friction].smoothed:
        start.setdefault("transition_velocity", max(1e-4, _TRANSITION * sizes.velocity))
        values = {**values, "transition_velocity": start["transition_velocity"]}
    start.update({name: 0.0 for name in law.linear if name not in start})
    names = [name for name in law.linear if name not in fixed]
    if level and level not in fixed:
        start[level] = FRICTION_SHARE * sizes.force
        names.append(level)
    free = dict.fromkeys((*names, *values))
    model = Model(law.friction, start, tuple(n for n in free if n not in fixed), texts)
    return _solved(problem, model, names, level)


def _solved(problem: Problem, model: Model, names: Sequence[str], level: str | None) -> Model:
    """Linear coordinates by a bounded linear fit; what scales with them is scaled along."""
    if not names:
        return model
    sizes = problem.scales
    variables = Variables.of(names, sizes)
    units = variables.units(model.values)
    try:
        base = _masked(problem, _only(model, names, None))
        columns = [_masked(problem, _only(model, names, name)) - base for name in names]
    except DeviceError:
        return model
    matrix = np.column_stack(columns)
    size = np.array([model.values[n] or 1.0 for n in names]) / units
    target = problem.masked([run.force for run in problem.runs])
    if not np.isfinite(matrix).all():
        return model
    # where its reflected step meets no bound SciPy multiplies 0 by infinity and takes another step
    with np.errstate(invalid="ignore"):
        found = (
            lsq_linear(matrix / size, target - base, variables.bounds, lsmr_tol="auto").x * units
        )
    values = dict(model.values)
    for name, how, value in zip(names, variables.ranges, found, strict=True):
        # a bound is no place to start from
        least = 0.02 * how.size if how.lower >= 0 else -math.inf
        value = max(float(value), least)
        before = values[name] or 1.0
        for other in model.free:
            # what is proportional to the friction level, to the inertance
            of = COORDINATES[other].proportional_to
            if of and name == (level if of == "level" else of):
                values[other] *= value / before
        values[name] = value
    return replace(model, values=values)


def _only(model: Model, names: Sequence[str], chosen: str | None) -> Model:
    """The model with one of the linear coordinates, the others as good as absent."""
    values = dict(model.values)
    for name in names:
        if name != chosen:
            # an inertance and a friction level have to be there
            tiny = name in ("coulomb_force", "bw_level", "bw_stiffness") or (
                name == "inertance" and "series_frequency" in values
            )
            values[name] = 1e-9 * (values[name] or 1.0) if tiny else 0.0
            if tiny and name == "coulomb_force":
                for other in values:
                    if other in COORDINATES and COORDINATES[other].proportional_to == "level":
                        values[other] *= 1e-9
        elif values[name] == 0.0:
            values[name] = 1.0
    return replace(model, values=values)


def _masked(problem: Problem, model: Model) -> Array:
    return problem.masked([force_along(model, run) for run in problem.runs])


def _error(problem: Problem, model: Model) -> float:
    """Root of the squared error [N]; infinite where the device cannot be."""
    try:
        residual = problem.residual(model)
    except DeviceError:
        return math.inf
    value = _size(residual, problem)
    return value if math.isfinite(value) else math.inf


def _size(residual: Sequence[Array], problem: Problem) -> float:
    squares = [float(np.sum(r[m] ** 2)) for r, m in zip(residual, problem.masks, strict=True)]
    return math.sqrt(sum(squares))


def _first(pair: tuple[float, Model]) -> float:
    return pair[0]


def _distinct(models: Sequence[Model], law: FittedLaw) -> list[Model]:
    """Models that differ in a nonlinear coordinate, in their order."""
    names = [name for name in law.starts if name in models[0].free and name not in NUISANCES]
    kept: list[Array] = []
    chosen: list[Model] = []
    for model in models:
        at = np.log([abs(model.values[name]) + 1e-12 for name in names])
        if all(np.abs(at - other).max(initial=0.0) > _APART for other in kept):
            kept.append(at)
            chosen.append(model)
        if not names:
            break
    return chosen
