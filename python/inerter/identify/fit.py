"""Bounded least squares of a device's force along measured motions, run on the C core."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, least_squares

from inerter.identify.bench import Run, scales
from inerter.identify.channel import (
    UNITS,
    clips,
    delayed,
)
from inerter.identify.coordinates import LINEAR, Scales, coordinate, device_values
from inerter.identify.model import Model
from inerter.identify.prediction import force_along, settled
from inerter.identify.residual import robust_weight, sandwich
from inerter.records.motion import Shaft

Array = NDArray[np.float64]
Masks = Sequence[NDArray[np.bool_]]

# with one of these the force is no longer the inertance times the acceleration
ENTANGLED = (
    "load_friction",
    "inertance_gradient",
    "inertance_curvature",
    "inertance_speed_gradient",
    "flywheel_viscous",
    "gas_pressure",
    "series_frequency",
    "series_stiffness",
    "series_damping",
)
# residuals beyond this many standard deviations count less in robust fits
ROBUST = 1.345


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
    """

    model: Model
    residual: list[Array]
    covariance: Array
    evaluations: int
    cost: float = 0.0

    def rmse(self, masks: Masks) -> float:
        """Root mean square residual over masked samples [N]."""
        return rms(self.residual, masks)


def rms(residual: Sequence[Array], masks: Masks) -> float:
    """Root mean square over the masked samples of all runs."""
    square = sum(float(np.sum(r[m] ** 2)) for r, m in zip(residual, masks, strict=True))
    return float(np.sqrt(square / max(sum(int(m.sum()) for m in masks), 1)))


def typical(residual: Sequence[Array], masks: Masks) -> float:
    """Size of a masked residual from which on a robust fit lets it count less [N]."""
    flat = np.concatenate([r[m] for r, m in zip(residual, masks, strict=True)])
    return ROBUST * 1.4826 * float(np.median(np.abs(flat))) + 1e-300


class Problem:
    """Runs, and which of their samples count."""

    def __init__(self, runs: Sequence[Run], masks: Masks, sizes: Scales | None = None) -> None:
        self.runs = list(runs)
        self.masks = [mask & run.inner for mask, run in zip(masks, runs, strict=True)]
        self.scales = sizes or scales(runs)

    def with_masks(self, masks: Masks) -> Problem:
        """The same runs with other samples counting."""
        return Problem(self.runs, masks, self.scales)

    def residual(self, model: Model) -> list[Array]:
        """Errors as they count against noise, of every run [N]."""
        return self.weighted(self.errors(model), model.shaft)

    def errors(self, model: Model) -> list[Array]:
        """Measured minus predicted force of every run [N]."""
        return [
            settled(model, run, run.force - force_along(model, run), mask)
            for run, mask in zip(self.runs, self.masks, strict=True)
        ]

    def weighted(self, arrays: Sequence[Array], shaft: Shaft | None = None) -> list[Array]:
        """Arrays of every run as they count, see `Run.weighted`."""
        everything = zip(self.runs, arrays, self.masks, strict=True)
        return [run.weighted(values, mask, shaft) for run, values, mask in everything]

    def _masked(self, arrays: Sequence[Array]) -> Array:
        return np.concatenate([a[m] for a, m in zip(arrays, self.masks, strict=True)])

    def _column(self, name: str, model: Model, variables: Array, base: list[Array]) -> Array:
        """Derivative of the residual by one search variable, over all samples of all runs."""
        index = model.free.index(name)
        how = coordinate(name, self.scales)
        if (
            name in LINEAR
            # a state begins where the first force puts it, and so hangs on every term
            and not model.device().nstate
            and not clips(model.values)
            and all(np.isinf(run.far) for run in self.runs)
            and not (name == "inertance" and any(other in model.values for other in ENTANGLED))
        ):
            columns = []
            for run in self.runs:
                v = run.velocity
                stretch = run.displacement - model.values.get("rest_length", 0.0)
                column = {
                    "inertance": run.acceleration,
                    "viscous": v,
                    "stiffness": stretch,
                    "stiffness_cubic": stretch**3,
                    "force_offset": np.ones_like(v),
                    "quadratic_damping": v * np.abs(v),
                    "force_drift": run.elapsed,
                }[name]
                columns.append(-delayed(column, model.delay, run.spacing) * how.size)
            return np.concatenate(self.weighted(columns))
        step = 1e-4
        if variables[index] + step > how.bounds[1]:
            step = -step
        moved = variables.copy()
        moved[index] += step
        there = self.residual(self._decode(model, moved))
        return (np.concatenate(there) - np.concatenate(base)) / step

    def variables(self, model: Model) -> Array:
        """The search variables of the model's free coordinates, shape (p,)."""
        how = [coordinate(name, self.scales) for name in model.free]
        return np.array([c.encode(model.values[n]) for c, n in zip(how, model.free, strict=True)])

    def jacobian(self, model: Model, names: Sequence[str] | None = None) -> Array:
        """Derivatives of the residual [N] by the search variables, shape (n, p).

        `names` are the free coordinates asked for, by default all.
        """
        here, base = self.variables(model), self.residual(model)
        selected = np.concatenate(self.masks)
        wanted = model.free if names is None else names
        columns = [self._column(name, model, here, base)[selected] for name in wanted]
        return np.column_stack(columns) if columns else np.zeros((int(selected.sum()), 0))

    def moved(self, model: Model, step: Array) -> Model:
        """The model with its search variables moved, within their bounds."""
        return self._decode(model, self.variables(model) + step)

    def units(self, model: Model) -> Array:
        """Coordinate per search variable, shape (p,)."""
        how = [coordinate(name, self.scales) for name in model.free]
        return np.array(
            [
                model.values[name] if each.logarithmic else each.size
                for name, each in zip(model.free, how, strict=True)
            ]
        )

    def _decode(self, model: Model, variables: Array) -> Model:
        values = {
            name: coordinate(name, self.scales).decode(variable)
            for name, variable in zip(model.free, variables, strict=True)
        }
        return replace(model, values={**model.values, **values})

    def fit(
        self,
        model: Model,
        evaluations: int = 40,
        loss: str = "linear",
        tolerance: float = 1e-9,
        give_up: Callable[[int, float], bool] | None = None,
    ) -> Fit:
        """Bounded least squares over the model's free coordinates, from its present values.

        A robust `loss` (see `scipy.optimize.least_squares`) lets samples far off count less. The
        search ends where a step lowers the cost by less than `tolerance` of it, or where `give_up`
        says so of the evaluations so far and the rms of the masked residual [N].
        """
        how = [coordinate(name, self.scales) for name in model.free]
        start = self.variables(model)
        lower, upper = np.array([c.bounds for c in how]).reshape(-1, 2).T
        if not model.free:
            return Fit(model, self.residual(model), np.zeros((0, 0)), 1)
        size = self.scales.force
        cache: dict[bytes, list[Array]] = {}

        def at(variables: Array) -> list[Array]:
            key = variables.tobytes()
            if key not in cache:
                cache.clear()
                cache[key] = self.residual(self._decode(model, variables))
            return cache[key]

        def jacobian(variables: Array) -> Array:
            base, here = at(variables), self._decode(model, variables)
            selected = np.concatenate(self.masks)
            return (
                np.column_stack(
                    [self._column(name, here, variables, base)[selected] for name in model.free]
                )
                / size
            )

        def watch(intermediate_result: OptimizeResult) -> None:
            error = size * float(np.sqrt(np.mean(intermediate_result.fun**2)))
            if give_up and give_up(intermediate_result.nfev, error):
                raise StopIteration

        # strictly inside the bounds, as the trust region needs
        inside = np.clip(
            start,
            np.where(np.isfinite(lower), lower + 1e-9, lower),
            np.where(np.isfinite(upper), upper - 1e-9, upper),
        )
        solution = least_squares(
            lambda variables: self._masked(at(variables)) / size,
            inside,
            jac=jacobian,  # pyright: ignore[reportArgumentType]
            bounds=(lower, upper),
            loss=loss,
            f_scale=typical(at(inside), self.masks) / size if loss != "linear" else 1.0,
            xtol=1e-7,
            ftol=tolerance,
            gtol=1e-10,
            max_nfev=evaluations,
            callback=watch if give_up else None,
        )
        fitted = self._decode(model, solution.x)
        residual = at(solution.x)
        flat = self._masked(residual)
        weight = robust_weight(flat, typical(residual, self.masks), loss)
        # a robust loss scales the derivatives
        columns = solution.jac if loss == "linear" else jacobian(solution.x)
        covariance = self._covariance(fitted, columns * size, flat, weight)
        return Fit(fitted, residual, covariance, int(solution.nfev), float(solution.cost))

    def _covariance(self, model: Model, jacobian: Array, flat: Array, weight: Array) -> Array:
        """Covariance of the free coordinates, see `sandwich`."""
        covariance = sandwich(jacobian, flat, weight)

        # a coordinate without effect on the force is not known at all, whatever the sandwich says
        effect = np.sum(jacobian**2, axis=0)
        smallest = 1e-12 * max(float(np.max(effect)), self.scales.force**2)
        least = np.mean(flat**2) / np.maximum(effect, smallest)
        covariance[np.diag_indices_from(covariance)] = np.maximum(np.diag(covariance), least)

        factor = self.units(model)
        return covariance * np.outer(factor, factor)


def parameter_errors(fit: Fit) -> dict[str, tuple[float, float]]:
    """Value and standard error of every device parameter (and delay) that the fit decided."""
    names = fit.model.free

    def parameters(coordinates: Mapping[str, float]) -> dict[str, float]:
        return device_values(coordinates) | {n: coordinates[n] for n in UNITS if n in coordinates}

    here = parameters(fit.model.values)
    errors = np.sqrt(np.maximum(np.diag(fit.covariance), 0))
    gradients: dict[str, Array] = {name: np.zeros(len(names)) for name in here}
    for i, name in enumerate(names):
        value = fit.model.values[name]
        step = 1e-6 * (abs(value) or errors[i] or 1.0)
        there = parameters({**fit.model.values, name: value + step})
        for key in here:
            gradients[key][i] = (there[key] - here[key]) / step
    return {
        key: (value, float(np.sqrt(max(gradients[key] @ fit.covariance @ gradients[key], 0))))
        for key, value in here.items()
        if np.any(gradients[key] != 0)
    }


def parameter_correlation(fit: Fit, names: Sequence[str]) -> Array:
    """Correlation of the named device parameters (and the delay) of a fit, shape (names, names)."""

    def parameters(values: Mapping[str, float]) -> Array:
        found = device_values(values) | {"delay": values.get("delay", 0.0)}
        return np.array([found[name] for name in names])

    here = parameters(fit.model.values)
    gradient = np.zeros((len(names), len(fit.model.free)))
    for i, free in enumerate(fit.model.free):
        value = fit.model.values[free]
        step = 1e-6 * (abs(value) or np.sqrt(max(fit.covariance[i, i], 0.0)) or 1.0)
        gradient[:, i] = (parameters({**fit.model.values, free: value + step}) - here) / step
    covariance = gradient @ fit.covariance @ gradient.T
    errors = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    return covariance / np.outer(errors, errors)
