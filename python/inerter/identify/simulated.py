"""Identification by simulation: the measured force drives the model, its motion is compared.

A bench that measures the motion badly, or so fast that its acceleration is noise, still has a good
force. Then the model is simulated from the force, on a carriage that moves freely against the
ground, and the displacement is what is fitted: no signal is differentiated. The device is the
MuJoCo plugin, integrated by RK4 (behind a series element, which is stiff without a mass before it,
by implicitfast, of first order); all simulations that a derivative needs run in one batch.

Between samples the force is band-limited (resampled by FFT); a step holds the value of its middle.
How a run begins, its first displacement and velocity, is fitted with the device: a free inerter
never forgets it. A series element begins with the first force; a bristle's state is not known, and
the first part of a record does not count.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import NOT_OF_DEVICE
from inerter.catalogue.scales import Scales
from inerter.core import Device, DeviceError
from inerter.device_in_model import device_of
from inerter.engine_batch import batch
from inerter.estimation.covariance import sandwich
from inerter.estimation.least_squares import Tolerances, inside, minimise
from inerter.estimation.variables import Variables
from inerter.identify.model import Model
from inerter.identify.runs import scales, thin
from inerter.mjspec import add_device
from inerter.records import Record
from inerter.records.preparation import prepare

Array = NDArray[np.float64]
Progress = Callable[[str], None]

# a step of the search variables for derivatives, and what a search stops at
_STEP = 1e-4
_ENOUGH = 1e-8
_CHUNK = 4000
_CARRIAGE = 1e-6
# least samples that say how a run begins
_FIRST = 8


@dataclass(frozen=True, kw_only=True)
class SimulatedFit:
    """A model fitted by simulation.

    Attributes
    ----------
    model
        The fit.
    begins
        Displacement [m] and velocity [m/s] with which each run begins, shape (runs, 2).
    displacement
        Simulated [m], one array (n,) for each run, as long as the run.
    error
        Rms of measured less simulated displacement [m] over the samples fitted.
    covariance
        Of the free coordinates (p, p), robust against correlated residuals.
    evaluations
        Simulations of the record.
    converged
        Whether the search ended by itself.
    """

    model: Model
    begins: Array
    displacement: list[Array]
    error: float
    covariance: Array
    evaluations: int
    converged: bool


class Simulator:
    """A record whose force drives a device.

    Parameters
    ----------
    record
        Uniformly sampled, with force and displacement.
    finer
        Steps per sample.
    settle
        Seconds at the beginning that do not count.
    delay
        Time by which the force channel is late [s]; the device is driven by the force in time.
    threads
        0 for every processor.

    Raises
    ------
    ValueError
        The record is not uniform, or shorter than `settle`.
    """

    def __init__(
        self,
        record: Record,
        finer: int = 8,
        settle: float = 0.5,
        threads: int = 0,
        delay: float = 0.0,
    ) -> None:
        steps = np.diff(record.time)
        self.spacing = float(np.mean(steps))
        if np.ptp(steps) > 0.02 * self.spacing:
            raise ValueError(f"{record.name}: not uniformly sampled; run inerter prepare first")
        self.settle = round(settle / self.spacing)
        # of a late force the last part has not arrived
        self.end = record.samples - math.ceil(max(delay, 0.0) / self.spacing)
        if self.settle >= self.end - 2:
            raise ValueError(
                f"{record.name}: {record.duration:.3g} s are no longer than the {settle:g} s left "
                "to settle; give a longer record, or a shorter settle"
            )
        self.record, self.finer, self.threads = record, finer, threads
        self.force = _in_the_middle(record.force, finer, delay / self.spacing)

    @cached_property
    def begin(self) -> tuple[Array, Array]:
        """First displacement [m] and velocity [m/s], from a cubic through the first samples.

        And their errors per error of a sample, 1 and 1/s.
        """
        count = max(_FIRST, self.settle // 10)
        powers = np.vander(self.spacing * np.arange(count), 4, increasing=True)
        inverse = np.linalg.pinv(powers)[:2]
        return inverse @ self.record.displacement[:count], np.linalg.norm(inverse, axis=1)

    def displacements(self, models: Sequence[Model], begins: Array | None = None) -> Array:
        """Simulated displacement [m] of every model, shape (models, n); NaN where it diverged.

        `begins` are first displacement [m] and velocity [m/s], shape (models, 2); None: 0.
        """
        begins = np.zeros((len(models), 2)) if begins is None else begins
        first = models[0].device()
        # behind a series element the flywheel is the device's; else the engine integrates it
        inside = first.series_stiffness > 0 or first.series_damping > 0
        keys = [
            key
            for key, value in first.given.items()
            if not isinstance(value, str) and (key != "inertance" or inside)
        ]
        compiled = _compiled(first, tuple(keys), self.spacing / self.finer)
        device = device_of(compiled, "device")
        worlds = batch.Batch(compiled, len(models), self.threads)
        devices = [model.device() for model in models]
        for key in keys:
            column = [float(getattr(each, key)) for each in devices]
            worlds.expand("numeric_data")[:, device.live[key]] = column
        if not inside:
            inertances = [each.inertance for each in devices]
            worlds.expand("actuator_armature")[:, device.actuator] = inertances
        worlds.set_const()
        worlds.bind("qpos")[:, 0], worlds.bind("qvel")[:, 0] = begins.T
        if inside:
            pairs = zip(devices, begins, strict=True)
            states = [
                each.state_of_force(x, v, 0.0, float(self.force[0])) for each, (x, v) in pairs
            ]
            worlds.bind("act")[:, [device.act[name] for name in first.state_names]] = states
        found = np.empty((len(models), self.record.samples))
        found[:, 0] = begins[:, 0]
        count = self.finer * (self.record.samples - 1)
        chunk = _CHUNK * self.finer
        for begin in range(0, count, chunk):
            number = min(chunk, count - begin)
            inputs = np.zeros((len(models), number, compiled.nu))
            inputs[:, :, 0] = self.force[begin : begin + number]
            before = worlds.bind("qpos").copy()
            state = worlds.rollout(number, inputs, record=("qpos",))["qpos"][:, :, 0]
            if inside:
                # this integrator's velocity is the step's last: its path is half a step ahead
                state = 0.5 * (state + np.hstack([before, state[:, :-1]]))
            at = begin // self.finer + 1
            part = state[:, self.finer - 1 :: self.finer]
            found[:, at : at + part.shape[1]] = part
        # a simulation that the engine began anew is not one of this device
        late = np.abs(worlds.bind("time").reshape(len(models)) - count * self.spacing / self.finer)
        found[late > 0.5 * self.spacing] = np.nan
        return found

    def residuals(
        self, models: Sequence[Model], begins: Array, until: float | None = None
    ) -> Array:
        """Measured less simulated displacement [m] after settling, shape (models, samples).

        Up to `until` [s] from the beginning; `begins` as in `displacements`.

        Raises
        ------
        ValueError
            Nothing is left.
        """
        end = self.end if until is None else min(round(until / self.spacing), self.end)
        if end <= self.settle + 1:
            raise ValueError(f"until is {until:g} s, not after {self.settle * self.spacing:g} s")
        part = slice(self.settle, end)
        return self.record.displacement[part] - self.displacements(models, begins)[:, part]


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
        See `start_from`. Of one with nothing free only the beginnings of the runs are fitted.
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
    device = Variables.of(start.free, sizes)
    free, runs = len(device), len(simulators)
    unit = float(np.std(np.concatenate([s.record.displacement for s in simulators])))
    units = np.array([unit, sizes.velocity])
    count = 0

    # search variables: coordinates of the device, then displacement and velocity of each run
    begins_at = [simulator.begin[0] / units for simulator in simulators]
    first = np.concatenate([device.encode(start.values), *begins_at])
    endless = np.full(2 * runs, np.inf)
    lower = np.concatenate([device.bounds[0], -endless])
    upper = np.concatenate([device.bounds[1], endless])

    def at(point: Array) -> tuple[Model, Array]:
        model = replace(start, values={**start.values, **device.decode(point[:free])})
        return model, point[free:].reshape(runs, 2) * units

    def of_run(run: int, points: Sequence[Array]) -> Array:
        """Errors of a run and of how it begins, shape (points, rows)."""
        nonlocal count
        count += len(points)
        models, begins = zip(*map(at, points), strict=True)
        begin = np.array([each[run] for each in begins])
        rest = simulators[run].residuals(models, begin, until)
        # a device that forgets its beginning says nothing of it: its first samples do
        guessed, error = simulators[run].begin
        return np.hstack([rest, (guessed - begin) / error]) / unit

    def residual(point: Array) -> Array:
        found = np.concatenate([of_run(run, [point])[0] for run in range(runs)])
        progress(f"{unit * float(np.sqrt(np.mean(found**2))):.4g} m")
        return np.nan_to_num(found, nan=1e3)

    def jacobian(point: Array) -> Array:
        steps = np.diag(np.where(point + _STEP > upper, -_STEP, _STEP))
        tables = []
        for run in range(runs):
            # how other runs begin is no matter of this one
            own = [*range(free), *(free + 2 * run + np.arange(2))]
            ahead = [point + steps[i] for i in own]
            behind = [np.clip(point - steps[i], lower, upper) for i in own]
            rows = of_run(run, [*ahead, *behind])
            widths = np.array([np.sum(a - b) for a, b in zip(ahead, behind, strict=True)])
            table = np.zeros((rows.shape[1], point.size))
            table[:, own] = ((rows[: len(own)] - rows[len(own) :]) / widths[:, None]).T
            tables.append(table)
        return np.nan_to_num(np.concatenate(tables))

    begin = inside(first, (lower, upper))
    if not all(np.isfinite(of_run(run, [begin])).all() for run in range(runs)):
        raise ValueError("the start does not lead to a finite motion; start from a better fit")
    found = minimise(
        residual, first, (lower, upper), jacobian, scaled=True, evaluations=evaluations,
        tolerances=Tolerances(_ENOUGH, _ENOUGH, 1e-8),
    )  # fmt: skip
    model, begins = at(found.variables)
    factor = device.units(model.values)
    rest = unit * np.concatenate([of_run(run, [found.variables])[0] for run in range(runs)])
    spread = sandwich(found.jacobian * unit, rest, np.ones_like(rest))[:free, :free]
    both = list(zip(simulators, begins, strict=True))
    errors = [each.residuals([model], begin[None], until)[0] for each, begin in both]
    return SimulatedFit(
        model=model,
        begins=begins,
        displacement=[each.displacements([model], begin[None])[0] for each, begin in both],
        error=float(np.sqrt(np.mean(np.concatenate(errors) ** 2))),
        covariance=spread * np.outer(factor, factor),
        evaluations=count,
        converged=found.ended,
    )


def _sizes(records: Sequence[Record]) -> Scales:
    return scales([thin(motion) for motion in prepare(records).motions])


def _in_the_middle(force: Array, finer: int, late: float = 0.0) -> Array:
    """Force in the middle of each of `finer` steps between samples, `late` samples on.

    It is band-limited, and the record is continued backwards in time, so that its ends meet.
    """
    n = force.size
    wave = np.concatenate([force, force[-2:0:-1]])
    spectrum = np.fft.rfft(wave)
    wide = np.zeros(finer * wave.size // 2 + 1, dtype=complex)
    wide[: spectrum.size] = spectrum
    # half a step later
    k = np.arange(wide.size)
    wide *= np.exp(1j * np.pi * k * (1 + 2 * finer * late) / (finer * wave.size)) * finer
    return np.fft.irfft(wide, finer * wave.size)[: finer * (n - 1)]


def _compiled(device: Device, keys: tuple[str, ...], step: float) -> mujoco.MjModel:
    """The device between ground and a carriage without mass to speak of, every parameter live."""
    if not device.inertance > 0:
        raise DeviceError("inertance is 0: the force has nothing to move; state an inertance")
    spec: mujoco.MjSpec = mujoco.MjSpec()
    # a carriage without mass at a series element is stiff; there the device is stepped exactly
    how = mujoco.mjtIntegrator
    spec.option.integrator = how.mjINT_IMPLICITFAST if "inertance" in keys else how.mjINT_RK4
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
    """A bench fit as a start. What is of the record and not of the device, as a delay, is held.

    A constant force is of the device here: it is in the measured force, and without it a free
    inerter would drift away.
    """
    return replace(model, free=tuple(name for name in model.free if name not in NOT_OF_DEVICE))


def device_from(fit: SimulatedFit) -> Device:
    """The device of a fit."""
    return fit.model.device()
