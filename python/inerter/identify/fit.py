"""Bounded least squares of a device's force along measured motions, run on the C core."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import (
    CHANNEL_UNITS,
    parameters_of,
)
from inerter.catalogue.scales import Scales
from inerter.estimation.covariance import robust_weight, sandwich, usual_size
from inerter.estimation.least_squares import Tolerances, minimise
from inerter.estimation.secants import Secants
from inerter.estimation.variables import Variables
from inerter.identify.apart import Apart
from inerter.identify.columns import Columns, ResidualAt
from inerter.identify.kept import last_kept
from inerter.identify.model import Model
from inerter.identify.prediction import force_along, settled
from inerter.identify.runs import BenchRun, head, head_size, scales
from inerter.identify.smoothness import smoothness
from inerter.records.motion import Shaft

Array = NDArray[np.float64]
# evaluations that are left for a search over everything, at least
_LAST = 4

Masks = Sequence[NDArray[np.bool_]]
# lower and upper limits of search variables, (p,) each
Limits = tuple[Array, Array]


@dataclass(frozen=True)
class Fit:
    """A fitted model.

    Attributes
    ----------
    residual : list of ndarray
        Measured minus predicted force per run [N].
    covariance : ndarray (p, p)
        Of the free coordinates, robust against correlated residuals.
    evaluations : int
        How often the optimiser asked for the residual.
    cost : float
        What was minimised, without unit.
    rough : bool
        Whether the covariance is as near as the search needed it.
    """

    model: Model
    residual: list[Array]
    covariance: Array
    evaluations: int
    cost: float = 0.0
    rough: bool = False

    def rmse(self, masks: Masks) -> float:
        """Root mean square residual over masked samples [N]."""
        return rms(self.residual, masks)


@dataclass(frozen=True)
class Near:
    """Derivatives of a residual near those at the start of a fit, over all samples, shape (n, p).

    Those by the coordinates `bending` bend most on the way, and are the first to be worked out
    anew; where it is not known by which, all of them are.
    """

    columns: Array
    bending: tuple[str, ...] | None = None

    def bending_in(self, free: Sequence[str]) -> list[str] | None:
        """Which of some free coordinates these are."""
        return None if self.bending is None else [name for name in free if name in self.bending]


def narrowed(bounds: Limits, within: Limits | None) -> Limits:
    """Bounds, and the limits within them."""
    if within is None:
        return bounds
    return np.maximum(bounds[0], within[0]), np.minimum(bounds[1], within[1])


def rms(residual: Sequence[Array], masks: Masks) -> float:
    """Root mean square over the masked samples of all runs; infinite if one is not a number."""
    square = sum(float(np.sum(r[m] ** 2)) for r, m in zip(residual, masks, strict=True))
    error = float(np.sqrt(square / max(sum(int(m.sum()) for m in masks), 1)))
    return np.inf if np.isnan(error) else error


def typical(residual: Sequence[Array], masks: Masks) -> float:
    """Size of a masked residual from which on a robust fit lets it count less [N]."""
    return usual_size(masked(residual, masks))


def masked(arrays: Sequence[Array], masks: Masks) -> Array:
    """The masked samples of all runs, one run after another."""
    return np.concatenate([a[m] for a, m in zip(arrays, masks, strict=True)])


class Problem:
    """Runs, and which of their samples count."""

    def __init__(self, runs: Sequence[BenchRun], masks: Masks, sizes: Scales | None = None) -> None:
        self.runs = list(runs)
        self.masks = [mask & run.inner for mask, run in zip(masks, runs, strict=True)]
        self.scales = sizes or scales(runs)
        self._derivatives = Columns(self)
        self._variables: dict[tuple[str, ...], Variables] = {}

    def with_masks(self, masks: Masks) -> Problem:
        """The same runs with other samples counting."""
        return Problem(self.runs, masks, self.scales)

    def head(self, share: float) -> Problem:
        """The first part of every run."""
        return Problem(
            [head(run, share) for run in self.runs],
            [
                mask[: head_size(run, share)]
                for mask, run in zip(self.masks, self.runs, strict=True)
            ],
            self.scales,
        )

    def residual(self, model: Model, pressed: float = 0.0, *, counted: bool = False) -> list[Array]:
        """Errors as they count against noise, of every run [N]."""
        shaft = model.shaft if model.is_possible else None
        return self.weighted(self.errors(model, pressed, counted=counted), shaft)

    def errors(self, model: Model, pressed: float = 0.0, *, counted: bool = False) -> list[Array]:
        """Measured minus predicted force of every run [N].

        States begin where a first force puts them that is the measured one and `pressed` [N].
        Where only what is `counted` is asked for, runs that have no such samples are 0.
        """
        if not model.is_possible:
            # a search may try what no device can be: an inertance below 0 at a place, say
            return [np.full(run.force.size, np.inf) for run in self.runs]
        return [
            np.zeros(run.force.size)
            if counted and not mask.any()
            else settled(model, run, run.force - force_along(model, run, pressed), mask)
            for run, mask in zip(self.runs, self.masks, strict=True)
        ]

    def weighted(self, arrays: Sequence[Array], shaft: Shaft | None = None) -> list[Array]:
        """Arrays of every run as they count, see `BenchRun.weighted`."""
        everything = zip(self.runs, arrays, self.masks, strict=True)
        return [run.weighted(values, mask, shaft) for run, values, mask in everything]

    def masked(self, arrays: Sequence[Array]) -> Array:
        """What counts of arrays of every run, one run after another."""
        return masked(arrays, self.masks)

    def variables(self, model: Model) -> Variables:
        """The search variables of the model's free coordinates."""
        known = self._variables.get(model.free)
        if known is None:
            known = self._variables[model.free] = Variables.of(model.free, self.scales)
        return known

    def jacobian(self, model: Model, names: Sequence[str] | None = None) -> Array:
        """Derivatives of the residual [N] by the search variables, shape (n, p).

        `names` are the free coordinates asked for, by default all.
        """
        return self.derivatives(model, names, counted=True)[np.concatenate(self.masks)]

    def derivatives(
        self, model: Model, names: Sequence[str] | None = None, *, counted: bool = False
    ) -> Array:
        """The same over all samples, those that do not count among them unless told otherwise."""
        here = self.variables(model).encode(model.values)
        wanted = model.free if names is None else names

        def at(point: Array, pressed: float = 0.0) -> list[Array]:
            return self.residual(self.decoded(model, point), pressed, counted=counted)

        return self._columns(model, here, wanted, at)

    def _columns(
        self, model: Model, point: Array, names: Sequence[str], residual: ResidualAt
    ) -> Array:
        columns = self._derivatives.of(model, point, names, residual)
        samples = sum(run.force.size for run in self.runs)
        return np.column_stack(columns) if columns else np.zeros((samples, 0))

    def columns_at(self, model: Model, point: Array, residual: ResidualAt) -> Array:
        """Derivatives of what counts by the search variables of free coordinates at a point (p,).

        Shape (n, p) [N]; `residual` is that at points of these.
        """
        columns = self._columns(self.decoded(model, point), point, model.free, residual)
        return columns[np.concatenate(self.masks)]

    def moved(self, model: Model, step: Array) -> Model:
        """The model with its search variables moved, within their bounds."""
        return self.decoded(model, self.variables(model).encode(model.values) + step)

    def units(self, model: Model) -> Array:
        """Coordinate per search variable, shape (p,)."""
        return self.variables(model).units(model.values)

    def decoded(self, model: Model, point: Array) -> Model:
        """The model at a point (p,) of the search variables of its free coordinates."""
        return replace(model, values={**model.values, **self.variables(model).decode(point)})

    def fit(
        self,
        model: Model,
        evaluations: int = 40,
        loss: str = "linear",
        tolerance: float = 1e-9,
        give_up: Callable[[int, float], bool] | None = None,
        rough: bool = False,
        near: Near | None = None,
        within: Limits | None = None,
    ) -> Fit:
        """Bounded least squares over the model's free coordinates, from its present values.

        A robust `loss` (see `scipy.optimize.least_squares`) lets samples far off count less. The
        search ends where a step lowers the cost by less than `tolerance` of it, or where `give_up`
        says so of the evaluations so far and the rms of the masked residual [N]. A `rough` one is
        only compared: its derivatives where it ends are not worked out. Derivatives, where given,
        are `near` those at the start. Search variables stay `within` limits (p,).
        """
        if not model.free:
            return Fit(model, self.residual(model), np.zeros((0, 0)), 1)
        size, selected = self.scales.force, np.concatenate(self.masks)
        near = replace(near, columns=near.columns[selected]) if near else None
        spent = 0
        apart = self._derivatives.apart(model) if loss == "linear" else None
        if apart and (
            found := self._near(apart, model, evaluations, tolerance, give_up, near, within)
        ):
            model, spent, near = found
        variables, at, smooth = self.variables(model), self.residual_at(model), smoothness(model)
        samples = int(selected.sum())

        def jacobian(point: Array) -> Array:
            return np.concatenate([self.columns_at(model, point, at) / size, smooth])

        def hopeless(done: int, error: float) -> bool:
            return bool(give_up and give_up(spent + done, size * error))

        def flat_at(point: Array) -> Array:
            return np.concatenate([self.masked(at(point)) / size, smooth @ point])

        def bending(point: Array) -> tuple[list[int], Array]:
            which = [model.free.index(name) for name in bent or ()]
            columns = self._columns(self.decoded(model, point), point, bent or (), at)[selected]
            return which, np.concatenate([columns / size, smooth[:, which]])

        first = np.concatenate([near.columns / size, smooth]) if near else None
        bent = near.bending_in(model.free) if near else None
        secants = Secants(
            flat_at, jacobian, tolerance, rough, first, None if bent is None else bending
        )
        solution = minimise(
            flat_at,
            variables.encode(model.values),
            narrowed(variables.bounds, within),
            jacobian,
            tolerances=Tolerances(1e-7, tolerance, 1e-10),
            evaluations=max(evaluations - spent, _LAST) if spent else evaluations,
            loss=loss,
            give_up=hopeless if give_up else None,
            secants=secants,
        )
        fitted = self.decoded(model, solution.variables)
        residual = at(solution.variables)
        flat = self.masked(residual)
        weight = robust_weight(flat, usual_size(flat), loss)
        # a robust loss scales the derivatives
        true = rough or not (secants.stale or loss != "linear")
        columns = solution.jacobian if true else jacobian(solution.variables)
        covariance = self._covariance(fitted, columns[:samples] * size, flat, weight)
        if not all(mask.any() for mask in self.masks):
            residual = self.residual(fitted)
        spent += solution.evaluations
        return Fit(fitted, residual, covariance, spent, solution.cost, rough)

    def _near(
        self,
        apart: Apart,
        model: Model,
        evaluations: int,
        tolerance: float,
        give_up: Callable[[int, float], bool] | None,
        near: Near | None,
        within: Limits | None,
    ) -> tuple[Model, int, Near] | None:
        """A search in which what the residual is linear in is solved for at every point.

        The model where it ends, evaluations, and derivatives there, masked and near. None where no
        such model is possible or better: what is solved for may be beyond its bounds.
        """
        inner = replace(model, free=tuple(n for n in model.free if n not in apart.names))
        begin, at = self.variables(inner).encode(inner.values), self.residual_at(inner)
        size, selected = self.scales.force, np.concatenate(self.masks)
        which = [model.free.index(name) for name in inner.free]
        smooth, whole = smoothness(model), self.variables(model).encode(model.values)
        last = np.empty((int(selected.sum()), 0))

        def counted(point: Array) -> Array:
            now = whole.copy()
            now[which] = point
            return np.concatenate([self.masked(at(point)), size * (smooth @ now)])

        if apart.solved(model, counted(begin), self.scales) is None:
            return None

        def beside(columns: Array) -> Array:
            columns = np.concatenate([columns, size * smooth[:, which]])
            return apart.rest(columns) / size

        def jacobian(point: Array) -> Array:
            nonlocal last
            last = self.columns_at(inner, point, at)
            return beside(last)

        def bending(point: Array) -> tuple[list[int], Array]:
            found = [inner.free.index(name) for name in bent or ()]
            columns = self._columns(self.decoded(inner, point), point, bent or (), at)
            last[:, found] = columns[selected]
            return found, beside(last)[:, found]

        def flat_at(point: Array) -> Array:
            return apart.rest(counted(point)) / size

        def hopeless(done: int, error: float) -> bool:
            return bool(give_up and give_up(done, size * error))

        here, spent = begin, 0
        if inner.free:
            first = None
            bent = near.bending_in(inner.free) if near else None
            if near:
                last = near.columns[:, which]
                first = beside(last)
            limits = within and (within[0][which], within[1][which])
            found = minimise(
                flat_at, begin, narrowed(self.variables(inner).bounds, limits), jacobian,
                tolerances=Tolerances(1e-7, tolerance, 1e-10), evaluations=evaluations,
                give_up=hopeless if give_up else None,
                secants=Secants(
                    flat_at, jacobian, tolerance, True, first, None if bent is None else bending
                ),
            )  # fmt: skip
            here, spent = found.variables, found.evaluations
        reached = replace(self.decoded(inner, here), free=model.free)
        reached = apart.solved(reached, counted(here), self.scales)
        if reached is None or not reached.is_possible:
            return None
        before, after = (
            float(np.sum(self.masked(self.residual(each, counted=True)) ** 2))
            for each in (model, reached)
        )
        if not after < before:
            return None
        columns = np.empty((last.shape[0], len(model.free)))
        columns[:, which] = last
        others = [model.free.index(name) for name in apart.names]
        columns[:, others] = apart.columns(reached, self.scales)[: last.shape[0]]
        return reached, spent, Near(columns, near.bending if near else None)

    def residual_at(self, model: Model) -> ResidualAt:
        """The residual at a point of a model's variables; the last one asked for is kept."""

        @last_kept
        def last(point: Array) -> list[Array]:
            return self.residual(self.decoded(model, point), counted=True)

        def at(point: Array, pressed: float = 0.0) -> list[Array]:
            if pressed:
                return self.residual(self.decoded(model, point), pressed, counted=True)
            return last(point)

        return at

    def told(self, fit: Fit, derivatives: Array, left_out: bool = False) -> Fit:
        """A rough fit with the covariance that the derivatives at its end tell, see `sandwich`."""
        flat = self.masked(fit.residual)
        columns = derivatives[np.concatenate(self.masks)]
        covariance = self._covariance(fit.model, columns, flat, np.ones_like(flat), left_out)
        return replace(fit, covariance=covariance, rough=False)

    def _covariance(
        self, model: Model, jacobian: Array, flat: Array, weight: Array, left_out: bool = False
    ) -> Array:
        """Covariance of the free coordinates, see `sandwich`."""
        held = self.scales.force * smoothness(model)
        covariance = sandwich(jacobian, flat, weight, held if len(held) else None, left_out)

        # a coordinate without effect on the force is not known at all, whatever the sandwich says
        effect = np.sum(jacobian**2, axis=0)
        smallest = 1e-12 * max(float(np.max(effect)), self.scales.force**2)
        least = np.mean(flat**2) / np.maximum(effect, smallest)
        covariance[np.diag_indices_from(covariance)] = np.maximum(np.diag(covariance), least)

        factor = self.units(model)
        return covariance * np.outer(factor, factor)


def parameter_errors(fit: Fit) -> dict[str, tuple[float, float]]:
    """Value and standard error of every device parameter (and delay) that the fit decided."""
    here, gradient = _parameter_gradient(fit)
    errors = {
        name: float(np.sqrt(max(row @ fit.covariance @ row, 0)))
        for name, row in zip(here, gradient, strict=True)
        if np.any(row != 0)
    }
    return {name: (here[name], error) for name, error in errors.items()}


def parameter_correlation(fit: Fit, names: Sequence[str]) -> Array:
    """Correlation of the named device parameters (and the delay) of a fit, shape (names, names)."""
    here, gradient = _parameter_gradient(fit)
    rows = gradient[[list(here).index(name) for name in names]]
    covariance = rows @ fit.covariance @ rows.T
    errors = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    return covariance / np.outer(errors, errors)


def _parameter_gradient(fit: Fit) -> tuple[dict[str, float], Array]:
    """Parameters of a fit by name, and their derivatives by its free coordinates."""
    names = fit.model.free

    def parameters(coordinates: Mapping[str, float]) -> dict[str, float]:
        channel = {n: coordinates[n] for n in CHANNEL_UNITS if n in coordinates}
        return parameters_of(coordinates) | channel

    here = parameters(fit.model.values)
    errors = np.sqrt(np.maximum(np.diag(fit.covariance), 0))
    gradient = np.zeros((len(here), len(names)))
    for i, name in enumerate(names):
        value = fit.model.values[name]
        step = 1e-6 * (abs(value) or errors[i] or 1.0)
        there = parameters({**fit.model.values, name: value + step})
        gradient[:, i] = [(there[key] - here[key]) / step for key in here]
    return here, gradient
