"""Samples the devices of a running model.

    x = l(q) - rest_length,   v = J(q) w,   a = J w' + (dJ/dt) w,   F = device(x, v, a, z)

l [m]: length of the actuator, J its row of moment arms, w [1/s or m/s] the velocities of the dofs,
z states of the device, F [N] its force by its own law. A record is what an ideal bench would have
measured: x, v and a are one motion, and F is the device's force along it.

RK4: w and w' are the engine's at that instant. The other integrators are semi-implicit,
q_k+1 = q_k + h w_k+1, so that w_k belongs to the middle of the step before. There w at the instant
of q_k is (w_k + w_k+1)/2 and w' is (w_k+1 - w_k)/h: the centred differences of q, of second order.
(dJ/dt) w is the difference of J w along the motion at +-1e-5 s, which also holds for tendons that
wrap around geoms; it is 0 for joints and fixed tendons.
Why not what the sensors show during the run: those integrators take stiff forces at the end of the
step, so that force and displacement would be of different instants, by up to a step.
Everything is evaluated in a second mjData: the run is bit for bit that of a loop over `mj_step`.
Not modelled: noise and filters of a measurement.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.device_in_model import DeviceInModel, devices_of, evaluate, motion_of
from inerter.motion_units import TRANSLATION, Kind
from inerter.simulate.load import scalar_joints
from inerter.simulate.vehicle import VehicleSensors

Array = NDArray[np.float64]

_DIFFERENCE = 1e-5  # [s]
_STATE = mujoco.mjtState.mjSTATE_INTEGRATION


@dataclass(frozen=True)
class DeviceRun:
    """What a device did: columns by name, arrays (samples,), SI units; see `record.py`.

    motion: "rotation" of a device on a hinge; read rad for m, N*m for N there.
    """

    place: DeviceInModel
    columns: dict[str, Array]
    motion: Kind = TRANSLATION


class Sampler:
    """Takes the devices, the joints and the vehicle's sensors at an instant."""

    def __init__(self, model: mujoco.MjModel, samples: int) -> None:
        self.model = model
        self.places = devices_of(model)
        self.probe, self.moved = mujoco.MjData(model), mujoco.MjData(model)
        self.rows = [int(model.actuator_outadr[place.actuator]) for place in self.places]
        self.straight = all(self._is_straight(place.actuator) for place in self.places)
        self.vehicle = VehicleSensors(model, samples)
        self.scalar = scalar_joints(model)
        self.count = 0

        # per sample joints, sensors, states; per device length, velocity, acceleration, control
        self.positions = np.empty((samples, len(self.scalar)))
        self.motion = np.empty((samples, len(self.places), 4))
        self.sensors = np.empty((samples, model.nsensordata))
        self.states = np.empty((samples, model.na))

    def _is_straight(self, actuator: int) -> bool:
        """Whether the moment arms never change."""
        model = self.model
        if model.actuator_trntype[actuator] != mujoco.mjtTrn.mjTRN_TENDON:
            return True
        tendon = int(model.actuator_trnid[actuator, 0])
        first = model.wrap_type[model.tendon_adr[tendon]]
        return first == mujoco.mjtWrap.mjWRAP_JOINT

    def state_of(self, data: mujoco.MjData) -> Array:
        """The present state of a run."""
        state = np.empty(mujoco.mj_stateSize(self.model, _STATE))
        mujoco.mj_getState(self.model, data, state, _STATE)
        return state

    def begin(self, data: mujoco.MjData) -> None:
        """Remember the present state of a run."""
        mujoco.mj_setState(self.model, self.probe, self.state_of(data), _STATE)

    def take(self, after: Array, imposed: tuple[Sequence[int], Sequence[float]]) -> None:
        """Sample the state remembered.

        after: velocities after the step from there. imposed: dofs whose motion is prescribed, and
        their acceleration.
        """
        model, probe, k = self.model, self.probe, self.count
        acceleration = None
        if model.opt.integrator != mujoco.mjtIntegrator.mjINT_RK4:
            dofs, prescribed = imposed
            middle = 0.5 * (probe.qvel + after)
            acceleration = (after - probe.qvel) / model.opt.timestep
            middle[dofs], acceleration[dofs] = probe.qvel[dofs], prescribed
            probe.qvel[:] = middle
        with _forces_of_the_instant(model):
            mujoco.mj_forward(model, probe)
        if acceleration is None:
            acceleration = probe.qacc

        self.positions[k] = probe.qpos[model.jnt_qposadr[self.scalar]]
        self.sensors[k], self.states[k] = probe.sensordata, probe.act
        turning = np.zeros(len(self.rows)) if self.straight else self._turning()
        for i, (place, row) in enumerate(zip(self.places, self.rows, strict=True)):
            ctrl = int(model.actuator_ctrladr[place.actuator])
            self.motion[k, i] = (
                probe.actuator_length[row],
                _along(model, probe, row, probe.qvel),
                _along(model, probe, row, acceleration) + turning[i],
                probe.ctrl[ctrl] if model.actuator_ctrlnum[place.actuator] else np.nan,
            )
        self.vehicle.take(probe)
        self.count += 1

    def _turning(self) -> Array:
        """The part of every device's acceleration that velocities alone cause: dJ/dt q'."""
        model, probe, moved = self.model, self.probe, self.moved
        found = np.zeros(len(self.rows))
        for sign in (1, -1):
            moved.qpos[:], moved.qvel[:] = probe.qpos, probe.qvel
            moved.mocap_pos[:], moved.mocap_quat[:] = probe.mocap_pos, probe.mocap_quat
            mujoco.mj_integratePos(model, moved.qpos, probe.qvel, sign * _DIFFERENCE)
            mujoco.mj_kinematics(model, moved)
            mujoco.mj_comPos(model, moved)
            mujoco.mj_tendon(model, moved)
            mujoco.mj_transmission(model, moved)
            speeds = [_along(model, moved, row, probe.qvel) for row in self.rows]
            found += sign * np.array(speeds) / (2 * _DIFFERENCE)
        return found

    def devices(self, time: Array) -> list[DeviceRun]:
        """The columns of every device."""
        runs = []
        for i, place in enumerate(self.places):
            length, velocity, acceleration, control = self.motion[:, i].T
            device = place.now(self.model)
            displacement = length - place.rest_length(self.model)
            states = {name: self.states[:, address] for name, address in place.act.items()}
            found = evaluate(device, displacement, velocity, acceleration, states, control)
            columns = {
                "time": time,
                "displacement": displacement,
                "force": found["total"],
                "velocity": velocity,
                "acceleration": acceleration,
                "inertance_force": found["inertance"],
                "friction_force": found["friction"],
                **states,
                "stored_energy": found["stored_energy"],
                "dissipated_energy": place.read(self.sensors)["dissipated_energy"],
            }
            if device.control != "force":
                columns["control_command"] = control
            elif np.nan_to_num(control).any():
                columns["control_force"] = control
            columns = {name: np.array(v) for name, v in columns.items()}
            runs.append(DeviceRun(place, columns, motion_of(self.model, place.actuator)))
        return runs

    def joints(self) -> dict[str, Array]:
        """Positions of slide and hinge joints."""
        names = [self.model.joint(i).name or f"joint {i}" for i in self.scalar]
        return dict(zip(names, self.positions.T, strict=True))


@contextmanager
def _forces_of_the_instant(model: mujoco.MjModel) -> Iterator[None]:
    """With the integrator that takes forces at the beginning of the step.

    Nothing is stepped here. What an engine about to take RK4's stages would warn of is not of the
    run, which warns for itself.
    """
    integrator, warn = model.opt.integrator, mujoco.get_mju_user_warning()
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    mujoco.set_mju_user_warning(lambda text: None)
    try:
        yield
    finally:
        mujoco.set_mju_user_warning(warn)
        model.opt.integrator = integrator


def _along(model: mujoco.MjModel, data: mujoco.MjData, row: int, vector: Array) -> float:
    """J times a vector of the dofs, for a row of the moment arms."""
    part = slice(data.moment_rowadr[row], data.moment_rowadr[row] + data.moment_rownnz[row])
    return float(data.actuator_moment[part] @ vector[data.moment_colind[part]])
