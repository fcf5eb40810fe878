"""Bounded least squares of a device's force along measured motions, run on the C core."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from inerter.core import Device, DeviceError, parameters
from inerter.identify.bench import Run, forces_along, held, scales
from inerter.identify.channel import UNITS, clips, delayed, through_channel, without_tone
from inerter.identify.coordinates import LINEAR, Scales, coordinate, device_values
from inerter.identify.residual import robust_weight, sandwich, without_transient

Array = NDArray[np.float64]
Masks = Sequence[NDArray[np.bool_]]

# free coordinates that make up for how a law is smoothed or how a run begins, and name no effect
NUISANCES = ("transition_velocity", "friction_place")
# share of what the bristle holds from which on the first force tells the side of its free play
_TELLING = 0.1
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
class Model:
    """A device and a channel delay as coordinates, and which of them are free.

    Attributes
    ----------
    friction : str
        Friction law.
    values : mapping
        Coordinates by name (see `coordinates`), SI units.
    free : tuple of str
        Names that a fit may change.
    texts : mapping
        What a device states in words beside the friction law, such as gas_law.
    """

    friction: str
    values: Mapping[str, float]
    free: tuple[str, ...]
    texts: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", MappingProxyType(dict(self.values)))

    def device(self) -> Device:
        """The device these coordinates stand for."""
        return self._device

    def without_friction(self) -> Device:
        """The device's terms that are smooth in the motion."""
        return self._smooth_device

    # worked out once, for all runs
    @cached_property
    def _device(self) -> Device:
        values = {name: float(value) for name, value in device_values(self.values).items()}
        return Device(friction=self.friction, **values, **self.texts)

    @cached_property
    def _smooth_device(self) -> Device:
        whole, known = self._device.given, parameters()
        names = [n for n in whole if n in known and not known[n].laws and n != "load_friction"]
        return Device(**{n: whole[n] for n in names}, **self.texts)

    @property
    def delay(self) -> float:
        """Time by which the force channel is late [s]."""
        return self.values.get("delay", 0.0)

    @property
    def complexity(self) -> int:
        """Number of free coordinates that say something about the device."""
        return sum(name not in NUISANCES for name in self.free)

    def adding(self, friction: str | None = None, **values: float) -> Model:
        """The model with further free coordinates, under another friction law if given."""
        law = friction or self.friction
        names = tuple(name for name in values if name not in self.free)
        return Model(law, {**self.values, **values}, _useful(self.free + names, law), self.texts)

    def without(self, names: Sequence[str], friction: str | None = None) -> Model:
        """The model without some coordinates."""
        law = friction or self.friction
        free = tuple(name for name in self.free if name not in names)
        values = {name: value for name, value in self.values.items() if name not in names}
        return Model(law, values, _useful(free, law), self.texts)


def stated_values(device: Device) -> tuple[dict[str, float], dict[str, str]]:
    """What a device states in numbers, and in words beside its friction law.

    Raises
    ------
    DeviceError
        The inertance comes from a channel: a fit has to be able to change it.
    """
    if device.inertance and "piston_area" in device.given and "inertance" not in device.given:
        raise DeviceError(
            f"inertance follows from piston_area {device.piston_area:g} m^2 and the channel; a "
            f"diagnosis varies it: state inertance = {device.inertance:g} in their place"
        )
    given = {name: value for name, value in device.given.items() if name != "friction"}
    words = {name: value for name, value in given.items() if isinstance(value, str)}
    return {name: float(value) for name, value in given.items() if name not in words}, words


def _useful(free: tuple[str, ...], friction: str) -> tuple[str, ...]:
    # only laws without memory read the width of sign(v), only those with one begin in a play
    unread = "friction_place" if friction in ("coulomb", "stribeck") else "transition_velocity"
    return tuple(name for name in free if name != unread)


def first_state(device: Device, run: Run, place: float = 0.0) -> float | Array:
    """State at a run's sample `first`, read off the force, within what the friction law can hold.

    A force near 0 does not tell where in a free play before the friction a run begins: that is
    `place`, -1 ... 1 of half the play. A number for a device with at most one state, else an array
    (nstate,).
    """
    if device.nstate == 0:
        return 0.0
    i = run.first
    state = device.state_of_force(
        run.displacement[i], run.velocity[i], run.acceleration[i], run.first_force
    )
    if not device.friction_backlash:
        return state
    bent, side = _bent(device, float(np.atleast_1d(state)[0]))
    told = min(1.0, abs(bent) / (_TELLING * _held(device)))
    found = bent + device.friction_backlash * (told * side + (1.0 - told) * place)
    return np.array([found, *np.atleast_1d(state)[1:]]) if device.nstate > 1 else found


def _bent(device: Device, state: float) -> tuple[float, float]:
    """Deflection of the bristle [m] behind its free play, and its side, -1, 0 or 1."""
    half = device.friction_backlash
    return state - float(np.clip(state, -half, half)), float(np.sign(state))


def _held(device: Device) -> float:
    """Deflection of the bristle [m] at which it slides; for Bouc-Wen without one, a play."""
    if device.friction != "bouc_wen":
        return device.coulomb_force / device.bristle_stiffness
    narrowing = device.bw_beta + device.bw_gamma
    if narrowing <= 0:
        return device.friction_backlash
    return float((device.bw_alpha / narrowing) ** (1 / device.bw_exponent))


def force_along(model: Model, run: Run) -> Array:
    """Force that the model predicts for a run's force channel, shape (n,)."""
    device, values = model.device(), model.values
    state = first_state(device, run, values.get("friction_place", 0.0))
    if run.measured is not None and (clips(values) or device.backlash or device.stop_stiffness):
        # what a limit cuts off and what an impact adds pass the low-pass of the measured force
        found = run.at_measured_rate(device, state)
        fine = run.fine_elapsed
        force = with_friction_drift(values, found, fine)
        return run.in_band(through_channel(values, force, fine, run.spacing / run.thinned))
    x, v, a = (c[run.first :] for c in (run.displacement, run.velocity, run.acceleration))
    if np.isinf(run.cutoff) or (device.friction == "none" and not device.load_friction):
        found = forces_along(device, run.spacing, (x, v, a), state, run.force.size)
        total = with_friction_drift(values, found, run.elapsed)
    else:
        # friction is not linear in the motion: it has to pass the low-pass of the measured force
        smooth_device = model.without_friction()
        rest = np.atleast_1d(state)[-smooth_device.nstate :] if smooth_device.nstate else 0.0
        smooth = smooth_device.along(run.spacing, x, v, a, rest)["total"]
        friction = run.friction(device, state)
        level = 1 + values.get("friction_drift", 0.0) * run.elapsed
        total = held(smooth, run.force.size) + level * friction
    return through_channel(values, total, run.elapsed, run.spacing)


def with_friction_drift(
    values: Mapping[str, float], forces: Mapping[str, Array], elapsed: Array
) -> Array:
    """Total force of a device whose friction level changes with time [N], shape (n,)."""
    drift = values.get("friction_drift", 0.0)
    return forces["total"] + drift * elapsed * forces["friction"] if drift else forces["total"]


def settled(model: Model, run: Run, residual: Array, mask: NDArray[np.bool_]) -> Array:
    """A residual without what only the record itself can tell, read off its masked samples.

    That is how the flywheel turned as the record began, and the phase of a tone. Of a run left out
    of a fit (nothing masked) everything is read off the run.
    """
    mask = mask if mask.any() else run.inner
    device, values = model.device(), model.values
    if device.series_stiffness and not device.backlash:
        residual = without_transient(device, residual, run.spacing, mask)
    if amplitude := values.get("disturbance_amplitude", 0.0):
        frequency = values["disturbance_frequency"]
        seen = amplitude * run.gain(frequency)
        residual = without_tone(residual, run.elapsed, mask, seen, frequency)
    return residual


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
        """Measured minus predicted force of every run [N]."""
        return [
            settled(model, run, run.force - force_along(model, run), mask)
            for run, mask in zip(self.runs, self.masks, strict=True)
        ]

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
            return np.concatenate(columns)
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

    def jacobian(self, model: Model) -> Array:
        """Derivatives of the residual [N] by the search variables, shape (n, p)."""
        here, base = self.variables(model), self.residual(model)
        selected = np.concatenate(self.masks)
        columns = [self._column(name, model, here, base)[selected] for name in model.free]
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
        self, model: Model, evaluations: int = 40, loss: str = "linear", tolerance: float = 1e-9
    ) -> Fit:
        """Bounded least squares over the model's free coordinates, from its present values.

        A robust `loss` (see `scipy.optimize.least_squares`) lets samples far off count less. The
        search ends where a step lowers the cost by less than `tolerance` of it.
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
            f_scale=self._typical(at(inside)) / size if loss != "linear" else 1.0,
            xtol=1e-7,
            ftol=tolerance,
            gtol=1e-10,
            max_nfev=evaluations,
        )
        fitted = self._decode(model, solution.x)
        residual = at(solution.x)
        flat = self._masked(residual)
        weight = robust_weight(flat, self._typical(residual), loss)
        covariance = self._covariance(fitted, jacobian(solution.x) * size, flat, weight)
        return Fit(fitted, residual, covariance, int(solution.nfev), float(solution.cost))

    def _typical(self, residual: list[Array]) -> float:
        """Size of a residual from which on a robust fit lets it count less [N]."""
        return ROBUST * 1.4826 * float(np.median(np.abs(self._masked(residual)))) + 1e-300

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
