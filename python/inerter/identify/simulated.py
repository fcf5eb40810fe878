"""Identification by simulation: the measured force drives the model, its motion is compared.

A bench that measures the motion badly, or so fast that its acceleration is noise, still has a good
force. Then the model is simulated from the force, on a carriage that moves freely against the
ground, and the displacement is what is fitted: no signal is differentiated. The device is the
MuJoCo plugin, integrated by RK4; all simulations that a derivative needs run in one batch.

Between samples the force is band-limited (resampled by FFT); a step holds the value of its middle.
The first part of a record, where the motion comes from before it, does not count.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np
from mujoco import batch
from numpy.typing import NDArray
from scipy.optimize import least_squares

from inerter.core import Device, DeviceError
from inerter.device_in_model import device_of
from inerter.identify.bench import scales, thin
from inerter.identify.coordinates import NOT_OF_DEVICE, Scales, coordinate, device_values
from inerter.identify.model import Model
from inerter.identify.preparation import prepare
from inerter.identify.residual import sandwich
from inerter.mjspec import add_device
from inerter.records import Record

Array = NDArray[np.float64]
Progress = Callable[[str], None]

# a step of the search variables for derivatives, and what a search stops at
_STEP = 1e-4
_ENOUGH = 1e-8
_CHUNK = 4000
_CARRIAGE = 1e-6


@dataclass(frozen=True)
class SimulatedFit:
    """A model fitted by simulation.

    Attributes
    ----------
    model
        The fit.
    displacement
        Simulated [m], one array (n,) for each run, as long as the run.
    error
        Rms of measured less simulated displacement [m] over the samples fitted.
    covariance
        Of the free coordinates (p, p), robust against correlated residuals.
    evaluations
        Simulations of the record.
    """

    model: Model
    displacement: list[Array]
    error: float
    covariance: Array
    evaluations: int


class Simulator:
    """A record whose force drives a device.

    Parameters
    ----------
    record
        Uniformly sampled, with force and displacement; starts near rest.
    finer
        Steps per sample.
    settle
        Seconds at the beginning that do not count.
    threads
        0 for every processor.

    Raises
    ------
    ValueError
        The record is not uniform, or shorter than `settle`.
    """

    def __init__(
        self, record: Record, finer: int = 8, settle: float = 0.5, threads: int = 0
    ) -> None:
        steps = np.diff(record.time)
        self.spacing = float(np.mean(steps))
        if np.ptp(steps) > 0.02 * self.spacing:
            raise ValueError(f"{record.name}: not uniformly sampled; run inerter prepare first")
        self.settle = round(settle / self.spacing)
        if self.settle >= record.samples - 2:
            raise ValueError(
                f"{record.name}: {record.duration:.3g} s are no longer than the {settle:g} s left "
                "to settle; give a longer record, or a shorter settle"
            )
        self.record, self.finer, self.threads = record, finer, threads
        self.force = _in_the_middle(record.force, finer)

    def displacements(self, models: Sequence[Model]) -> Array:
        """Simulated displacement [m] of every model, shape (models, n); NaN where it diverged."""
        first = models[0].device()
        keys = [k for k, v in first.given.items() if not isinstance(v, str) and k != "inertance"]
        compiled = _compiled(first, tuple(keys), self.spacing / self.finer)
        device = device_of(compiled, "device")
        worlds = batch.Batch(compiled, len(models), self.threads)
        devices = [model.device() for model in models]
        for key in keys:
            column = [float(getattr(each, key)) for each in devices]
            worlds.expand("numeric_data")[:, device.live[key]] = column
        inertances = [each.inertance for each in devices]
        if "inertance" in device.live:
            worlds.expand("numeric_data")[:, device.live["inertance"]] = inertances
        else:
            worlds.expand("actuator_armature")[:, device.actuator] = inertances
        worlds.set_const()
        found = np.empty((len(models), self.record.samples))
        found[:, 0] = 0.0
        count = self.finer * (self.record.samples - 1)
        chunk = _CHUNK * self.finer
        for begin in range(0, count, chunk):
            number = min(chunk, count - begin)
            inputs = np.zeros((len(models), number, compiled.nu))
            inputs[:, :, 0] = self.force[begin : begin + number]
            state = worlds.rollout(number, inputs, record=("qpos",))["qpos"][:, :, 0]
            at = begin // self.finer + 1
            part = state[:, self.finer - 1 :: self.finer]
            found[:, at : at + part.shape[1]] = part
        # a simulation that the engine began anew is not one of this device
        late = np.abs(worlds.bind("time").reshape(len(models)) - count * self.spacing / self.finer)
        found[late > 0.5 * self.spacing] = np.nan
        return found

    def residuals(self, models: Sequence[Model], until: float | None = None) -> Array:
        """Measured less simulated displacement [m] after settling, its mean taken out.

        Shape (models, samples); up to `until` [s] from the beginning.

        Raises
        ------
        ValueError
            Nothing is left.
        """
        end = None if until is None else round(until / self.spacing)
        if end is not None and end <= self.settle + 1:
            raise ValueError(f"until is {until:g} s, not after {self.settle * self.spacing:g} s")
        part = slice(self.settle, end)
        rest = self.record.displacement[part] - self.displacements(models)[:, part]
        # where zero is, is the bench's choice
        return rest - rest.mean(axis=1, keepdims=True)


def fit_simulated(
    simulators: Sequence[Simulator],
    start: Model,
    until: float | None = None,
    evaluations: int = 20,
    progress: Progress = lambda text: None,
) -> SimulatedFit:
    """Least squares on the displacements, from a start that is near, such as a bench fit's.

    Parameters
    ----------
    simulators
        The runs, fitted together.
    start
        See `start_from`.
    until
        Time [s] from the beginning of each run after which it does not count, to be judged on.
    evaluations
        Most steps of the search.
    progress
        Told the error so far.

    Raises
    ------
    ValueError
        Nothing is left to fit, or the start does not lead to a finite motion.
    """
    sizes = _sizes([simulator.record for simulator in simulators])
    how = [coordinate(name, sizes) for name in start.free]
    first = np.array([c.encode(start.values[n]) for c, n in zip(how, start.free, strict=True)])
    lower, upper = np.array([each.bounds for each in how]).T
    unit = float(np.std(np.concatenate([s.record.displacement for s in simulators])))
    count = 0

    def at(point: Array) -> Model:
        pairs = zip(start.free, how, point, strict=True)
        values = {name: each.decode(value) for name, each, value in pairs}
        return replace(start, values={**start.values, **values})

    def residuals(points: Sequence[Array]) -> Array:
        nonlocal count
        count += len(points)
        models = [at(point) for point in points]
        return np.concatenate([s.residuals(models, until) for s in simulators], axis=1) / unit

    def residual(point: Array) -> Array:
        found = residuals([point])[0]
        progress(f"{unit * float(np.sqrt(np.mean(found**2))):.4g} m")
        return np.nan_to_num(found, nan=1e3)

    def jacobian(point: Array) -> Array:
        steps = np.diag(np.where(point + _STEP > upper, -_STEP, _STEP))
        ahead = [point + move for move in steps]
        behind = [np.clip(point - move, lower, upper) for move in steps]
        rows = residuals([*ahead, *behind])
        widths = np.array([np.sum(a - b) for a, b in zip(ahead, behind, strict=True)])
        return np.nan_to_num(((rows[: point.size] - rows[point.size :]) / widths[:, None]).T)

    inside = np.clip(first, lower + 1e-9, upper - 1e-9)
    if not np.isfinite(residuals([inside])).all():
        raise ValueError("the start does not lead to a finite motion; start from a better fit")
    found = least_squares(
        residual, inside, jac=jacobian,  # pyright: ignore[reportArgumentType]
        bounds=(lower, upper), x_scale="jac", xtol=_ENOUGH, ftol=_ENOUGH, max_nfev=evaluations,
    )  # fmt: skip
    model, rest = at(found.x), unit * residuals([found.x])[0]
    units = np.array(
        [
            model.values[name] if each.logarithmic else each.size
            for name, each in zip(start.free, how, strict=True)
        ]
    )
    spread = sandwich(found.jac * unit, rest, np.ones_like(rest))
    return SimulatedFit(
        model,
        [simulator.displacements([model])[0] for simulator in simulators],
        float(np.sqrt(np.mean(rest**2))),
        spread * np.outer(units, units),
        count,
    )


def _sizes(records: Sequence[Record]) -> Scales:
    return scales([thin(motion) for motion in prepare(records).motions])


def _in_the_middle(force: Array, finer: int) -> Array:
    """Force in the middle of each of `finer` steps between samples, band-limited.

    The record is continued backwards in time, so that its ends meet.
    """
    n = force.size
    wave = np.concatenate([force, force[-2:0:-1]])
    spectrum = np.fft.rfft(wave)
    wide = np.zeros(finer * wave.size // 2 + 1, dtype=complex)
    wide[: spectrum.size] = spectrum
    # half a step later
    k = np.arange(wide.size)
    wide *= np.exp(1j * np.pi * k / (finer * wave.size)) * finer
    return np.fft.irfft(wide, finer * wave.size)[: finer * (n - 1)]


def _compiled(device: Device, keys: tuple[str, ...], step: float) -> mujoco.MjModel:
    """The device between ground and a carriage without mass to speak of, every parameter live."""
    if not device.inertance > 0:
        raise DeviceError("inertance is 0: the force has nothing to move; state an inertance")
    spec: mujoco.MjSpec = mujoco.MjSpec()
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.timestep = step
    spec.option.gravity = [0.0, 0.0, 0.0]
    body = spec.worldbody.add_body(name="carriage")
    body.add_joint(name="carriage", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
    body.mass, body.inertia, body.explicitinertial = _CARRIAGE, [_CARRIAGE] * 3, True
    drive = spec.add_actuator(name="drive", target="carriage", trntype=mujoco.mjtTrn.mjTRN_JOINT)
    drive.set_to_motor()
    add_device(spec, "device", device, joint="carriage", sensor=False, live=keys)
    return spec.compile()


def start_from(model: Model) -> Model:
    """A bench fit as a start: without delay and constant force, which a motion does not show."""
    dropped = (*NOT_OF_DEVICE, "force_offset")
    values = {name: value for name, value in model.values.items() if name not in dropped}
    return Model(
        model.friction, values, tuple(n for n in model.free if n not in dropped), model.texts
    )


def device_from(fit: SimulatedFit) -> Device:
    """The device of a fit."""
    return Device(friction=fit.model.friction, **device_values(fit.model.values), **fit.model.texts)
