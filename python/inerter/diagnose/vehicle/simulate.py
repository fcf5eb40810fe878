"""The user's model in the loop: many variants along the recorded inputs, in batches.

A step holds the input of its middle, so that the motion follows the input to second order. Sensors
are read at the beginning of a step, with the input of the middle: what the difference does directly
to an acceleration or a force is taken out again (`_through`).
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from inerter.diagnose.vehicle.build import UserModel
from inerter.diagnose.vehicle.changes import rate_actuator
from inerter.diagnose.vehicle.drive import RecordedDrive
from inerter.diagnose.vehicle.inputs import (
    AXES,
    STATE,
    actuator_of,
    place_of,
    set_inputs,
    undriven,
)
from inerter.diagnose.vehicle.mapping import Channels
from inerter.diagnose.vehicle.model import TYRES, VehicleModel
from inerter.diagnose.vehicle.sensing import EVERY_CHANNEL, leaning, shown
from inerter.engine_batch import batch

Array = NDArray[np.float64]
_CHUNK = 2_000_000  # numbers recorded at once
# an angle [rad], what it has to change of a channel, and within how many seconds of a run
_LEANING, _SHOWS, _SOON = 0.1, 5e-3, 3.0


@dataclass(frozen=True)
class Start:
    """Where a simulation starts: positions and velocities; None: at rest."""

    qpos: Array
    qvel: Array | None = None


class VehicleSimulator:
    """Simulated outputs of variants of a user's model.

    Parameters
    ----------
    user, channels
        The model and the mapping.
    threads : int
        0 for every processor.
    """

    def __init__(self, user: UserModel, channels: Channels, threads: int = 0) -> None:
        self.user, self.channels, self.threads = user, channels, threads
        self.count = 0

    def compiled(self, model: VehicleModel) -> mujoco.MjModel | None:
        """A variant, compiled; None if MuJoCo refuses it."""
        try:
            return self.user.compile(model)
        except ValueError:
            return None

    def outputs(
        self,
        models: Sequence[VehicleModel],
        drive: RecordedDrive,
        starts: Sequence[Start] | None = None,
    ) -> Array:
        """Outputs of every variant at a drive's samples, shape (models, n, outputs).

        NaN where a variant cannot be built or its simulation fails. starts: one for each model;
        by default at rest in equilibrium (`start`).
        """
        found = np.full((len(models), drive.time.size, len(self.channels.outputs)), np.nan)
        compiled = [self.compiled(model) for model in models]
        self.count += len(models)
        groups: dict[tuple[int, ...], list[int]] = {}
        for i, each in enumerate(compiled):
            if each is not None:
                layout = (each.nq, each.na, each.nactuator, each.nsensordata)
                groups.setdefault(layout, []).append(i)
        for members in groups.values():
            group = [model for i in members if (model := compiled[i]) is not None]
            own = [starts[i] for i in members] if starts is not None else None
            felt = [self._felt(drive, models[i]) for i in members]
            shares = np.array([self._shares(group[0], models[i]) for i in members])
            found[members] = self._group(group, shares, drive, felt, own)
        for i, model in enumerate(models):
            for k, output in enumerate(self.channels.outputs):
                if np.isfinite(found[i, :, k]).all():
                    channel = model.of(f"channel:{output.column}")
                    if late := model.of(EVERY_CHANNEL).get("delay", 0.0):
                        channel["delay"] = channel.get("delay", 0.0) + late
                    found[i, :, k] = shown(drive.time, found[i, :, k], channel)
        return found

    def _felt(self, drive: RecordedDrive, model: VehicleModel) -> RecordedDrive:
        """A drive as a model's tyres feel it: what was recorded, less what its channel adds."""
        gains = np.array(
            [model.of(f"channel:{column}").get("gain", 1.0) for column in self.channels.inputs]
        )
        if np.any(gains != 1.0):
            drive = drive.scaled(1.0 / gains)
        patch = model.of(TYRES)
        if not any(patch.values()):
            return drive
        targets = list(self.channels.inputs.values())
        return drive.averaged(self.user.road_inputs(targets), **patch)

    def start(self, model: mujoco.MjModel, drive: RecordedDrive) -> Start:
        """At rest: in the first keyframe, else in static equilibrium with the first input."""
        if model.nkey:
            return Start(model.key_qpos[0].copy())
        return Start(_equilibrium(model, self._inputs(model, drive)[0]))

    def device_motion(
        self, model: VehicleModel, drive: RecordedDrive
    ) -> dict[str, tuple[Array, Array]]:
        """Displacement and velocity [m, m/s] of every device on the steps, by name."""
        compiled = self.user.compile(model)
        worlds = self._worlds([compiled], drive, None)
        wanted = ("actuator_length", "actuator_velocity")
        inputs = self._inputs(compiled, drive)[None]
        run = worlds.rollout(drive.steps, inputs, STATE, record=wanted)
        found = {}
        for device in self.user.devices:
            rest = device.rest_length(self.user.model)
            x, v = (run[name][0, :, device.actuator] for name in wanted)
            found[device.name] = (x - rest, v)
        return found

    def _worlds(
        self, models: list[mujoco.MjModel], drive: RecordedDrive, starts: list[Start] | None
    ) -> batch.Batch:
        worlds = batch.Batch(models[0], len(models), self.threads)
        worlds.set_models(models)
        own = starts if starts is not None else [self.start(m, drive) for m in models]
        worlds.bind("qpos")[:] = np.array([start.qpos for start in own])
        worlds.bind("qvel")[:] = np.array(
            [np.zeros(models[0].nv) if start.qvel is None else start.qvel for start in own]
        )
        return worlds

    def _group(
        self,
        models: list[mujoco.MjModel],
        shares: Array,
        drive: RecordedDrive,
        felt: list[RecordedDrive],
        starts: list[Start] | None,
    ) -> Array:
        """Outputs of models of one layout, whose sensors' `shares` are added up."""
        worlds = self._worlds(models, drive, starts)
        first, size = models[0], len(models)
        own = starts if starts is not None else [Start(q) for q in worlds.bind("qpos").copy()]
        alike = all(each is drive for each in felt)
        inputs = np.array([self._inputs(first, each) for each in (felt[:1] if alike else felt)])
        wrong = [self._difference(first, each) for each in (felt[:1] if alike else felt)]
        roads = [actuator_of(first, target) for target in self.channels.inputs.values()]
        clipped = [i for i in roads if i >= 0 and any(m.actuator_forcelimited[i] for m in models)]
        wanted = ("sensordata", "actuator_force") if clipped else ("sensordata",)
        parts = []
        chunk = max(_CHUNK // (size * max(first.nsensordata, 1)), 64)
        for begin in range(0, drive.steps, chunk):
            part = inputs[:, begin : begin + chunk]
            count = part.shape[1]
            run = worlds.rollout(
                count, np.broadcast_to(part, (size, *part.shape[1:])), STATE, record=wanted
            )
            data = run["sensordata"]
            values = data @ shares.transpose(0, 2, 1)
            free = np.ones((size, count), dtype=bool)
            for i in clipped:
                force = run["actuator_force"][:, :, first.actuator_outadr[i]]
                limits = np.array(
                    [m.actuator_forcerange[i] if m.actuator_forcelimited[i] else (-np.inf, np.inf)
                     for m in models]
                )  # fmt: skip
                free &= (force > limits[:, None, 0]) & (force < limits[:, None, 1])
            for k, model in enumerate(models):
                at = 0 if alike else k
                direct = _through(model, own[k], inputs[at, 0], shares[k])
                off = wrong[at][begin : begin + chunk]
                values[k] -= free[k][:, None] * (off @ direct.T)
            parts.append(values)
        found = drive.at_samples(np.concatenate(parts, axis=1))

        # a simulation that the engine stopped is no simulation of this model
        done = worlds.bind("time").reshape(size)
        found[np.abs(done - drive.steps * drive.step) > 0.5 * drive.step] = np.nan
        return found

    def _shares(self, model: mujoco.MjModel, variant: VehicleModel) -> Array:
        """What of `sensordata` is added up to every output, (outputs, numbers)."""
        found = np.zeros((len(self.channels.outputs), model.nsensordata))
        for row, output in zip(found, self.channels.outputs, strict=True):
            sensor = model.sensor(output.sensor)
            at, size = int(sensor.adr[0]), int(sensor.dim[0])
            row[at + output.component] = 1.0
            if size == len(AXES):
                channel = variant.of(f"channel:{output.column}")
                row[at : at + size] = leaning(output.component, channel)
            for tyre in self.user.parts.tyres if output.load else ():
                # a tyre's damper, where there is one, has a sensor of its own
                more = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SENSOR, rate_actuator(tyre))
                if more >= 0 and int(model.sensor_objid[sensor.id]) == tyre.actuator:
                    row[int(model.sensor_adr[more])] = 1.0
        return found

    def axes_beside(self, columns: Sequence[str], drive: RecordedDrive) -> dict[str, str]:
        """By column of a sensor with three components: axes that it would show if it leaned.

        An axis in which the sensor hardly moves is none: at 0.1 rad its share is below 0.5 %.
        """
        numbers = {output.column: k for k, output in enumerate(self.channels.outputs)}
        asked = [
            (column, i)
            for column in columns
            for i in range(len(AXES))
            if i != (output := self.channels.outputs[numbers[column]]).component
            and int(self.user.model.sensor(output.sensor).dim[0]) == len(AXES)
        ]
        leans = [
            VehicleModel({f"channel:{column}.angle_toward_{AXES[i]}": _LEANING})
            for column, i in asked
        ]
        straight, *leaning_run = self.outputs([VehicleModel(), *leans], drive.part(_SOON))
        found = dict.fromkeys(columns, "")
        for (column, i), run in zip(asked, leaning_run, strict=True):
            own = straight[:, numbers[column]]
            if np.std(run[:, numbers[column]] - np.cos(_LEANING) * own) > _SHOWS * np.std(own):
                found[column] += AXES[i]
        return found

    def _inputs(self, model: mujoco.MjModel, drive: RecordedDrive) -> Array:
        """Inputs of every step, (steps, inputs of the model)."""
        base = np.tile(undriven(model), (drive.steps, 1))
        return self._fill(model, base, drive.ahead, drive.rate)

    def _difference(self, model: mujoco.MjModel, drive: RecordedDrive) -> Array:
        """Inputs of a step less those at its beginning, (steps, inputs of the model)."""
        base = np.zeros((drive.steps, undriven(model).size))
        return self._fill(model, base, drive.ahead - drive.now, drive.rate - drive.rate_now)

    def _fill(self, model: mujoco.MjModel, base: Array, inputs: Array, rates: Array) -> Array:
        for column, target in enumerate(self.channels.inputs.values()):
            actuator, at = actuator_of(model, target), place_of(model, target)
            # a control is what is recorded, a mocap body moves by it from where it stands
            base[:, at] = inputs[:, column] + (base[:, at] if actuator < 0 else 0.0)
            for tyre in self.user.parts.tyres:
                name = rate_actuator(tyre)
                if tyre.actuator == actuator:
                    extra = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_ACTUATOR, name)
                    if extra >= 0:
                        base[:, model.actuator_ctrladr[extra]] = rates[:, column]
        return base


def _through(model: mujoco.MjModel, start: Start, inputs: Array, shares: Array) -> Array:
    """What inputs do to outputs at once, (outputs, inputs)."""
    data = mujoco.MjData(model)
    data.qpos[:] = start.qpos
    found = np.zeros((len(shares), inputs.size))

    def read(values: Array) -> Array:
        set_inputs(model, data, values)
        mujoco.mj_forward(model, data)
        return shares @ data.sensordata

    for i in range(inputs.size):
        move = np.zeros(inputs.size)
        move[i] = 1e-4
        found[:, i] = (read(inputs + move) - read(inputs - move)) / 2e-4
    return found


def _equilibrium(model: mujoco.MjModel, inputs: Array) -> Array:
    """Positions at which nothing accelerates; the initial ones where there are none such.

    Of all that dry friction of joints would hold, those that need none.
    """
    model = copy.copy(model)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS
    data = mujoco.MjData(model)
    set_inputs(model, data, inputs)
    initial = data.qpos.copy()

    def acceleration(move: Array) -> Array:
        data.qpos[:] = initial
        mujoco.mj_integratePos(model, data.qpos, move, 1.0)
        data.qvel[:] = 0.0
        mujoco.mj_forward(model, data)
        return data.qacc.copy()

    at_rest = np.zeros(model.nv)
    size = float(np.max(np.abs(acceleration(at_rest)), initial=0.0))
    if size < 1e-9:
        return initial
    found = least_squares(acceleration, at_rest, method="lm" if model.nv else "trf", max_nfev=200)
    if np.max(np.abs(found.fun)) > 1e-3 * size:
        return initial
    acceleration(found.x)
    return data.qpos.copy()
