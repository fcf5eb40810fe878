"""A case in MuJoCo: the shipped file, the law in its plugin instances, inputs at every stage.

A control that is held over a step costs RK4 its order: the stages want the input at their own
times. `mjcb_control` is called in each of them with the time of the stage, so the input is written
there; it is one callback for the whole process, put back when the run ends.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from inerter.core import Device
from inerter.models import model_path
from inerter.plugin import load_plugin
from inerter.simulate.checks import engine_warnings
from inerter.validate.case import SAMPLE, Case
from inerter.validate.inputs import Signal
from inerter.validate.run import Array, RunError, ValidationRun

ORDERS = {"Euler": 1.0, "implicit": 1.0, "implicitfast": 1.0, "discrete": 1.0, "RK4": 4.0}
"""The integrators and their nominal orders."""

INTEGRATORS = tuple(ORDERS)


@dataclass(frozen=True)
class Beside:
    """What a plugin instance carries beside the inerter: N s/m, N/m; `device` is all of it."""

    viscous: float
    stiffness: float
    device: Device


def run_mujoco(case: Case, file: str, integrator: str, step: float) -> ValidationRun:
    """Run a case.

    Parameters
    ----------
    case
        What to run.
    file
        File in the model's folder.
    integrator
        One of `INTEGRATORS`.
    step
        Time step [s]; samples are a multiple of it.

    Raises
    ------
    RunError
        The engine stopped or diverged.
    """
    setup = case.setup
    with engine_warnings():
        model, beside = compiled(case, file, integrator, step)
        data = mujoco.MjData(model)
        told = case.command(setup.scale)
        if not math.isnan(told):
            for name in setup.inerters:
                data.ctrl[model.actuator_ctrladr[model.actuator(name).id]] = told
        try:
            with control(model, case.signals(setup.scale)):
                return _sampled(case, model, data, beside)
        except mujoco.FatalError as error:
            raise RunError(" ".join(str(error).split())) from None


def compiled(case: Case, file: str, integrator: str, step: float) -> tuple[Any, list[Beside]]:
    """The model with the case's law, and what its instances carry, in the order of the inerters."""
    load_plugin()
    setup = case.setup
    spec: Any = mujoco.MjSpec.from_file(str(model_path(setup.folder, file)))
    spec.option.timestep = step
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    law, found = case.device(setup.scale), []
    for name in setup.inerters:
        (instance,) = [plugin for plugin in spec.plugins if plugin.name == name]
        stated = {key: _value(value) for key, value in instance.config.items()}
        own = stated.keys() - {"rest_length"} if setup.own is None else setup.own
        kept = {key: value for key, value in stated.items() if key not in own}
        given = stated if law is None else merged(kept, law)
        device = Device(**given)
        instance.config = {key: str(value) for key, value in given.items()}
        spec.actuator(name).actdim = device.nstate
        spring, damper = (float(kept.get(key, 0.0)) for key in ("stiffness", "viscous"))
        found.append(Beside(damper, spring, device))
    return spec.compile(), found


def merged(
    kept: Mapping[str, float | str], law: Mapping[str, float | str]
) -> dict[str, float | str]:
    """Spring and damper of a strut with an inerter beside them: what both state adds up."""
    total: dict[str, float | str] = {**kept, **law}
    for key in ("viscous", "stiffness"):
        if key in kept and key in law:
            total[key] = float(kept[key]) + float(law[key])
    return total


@contextmanager
def control(model: Any, signals: Mapping[str, Signal]) -> Iterator[None]:
    """Inputs written by the engine's callback, wherever it evaluates forces."""
    driven = [(model.actuator(name).id, drive) for name, drive in signals.items()]

    def write(_: Any, data: Any) -> None:
        t = data.time
        for actuator, drive in driven:
            data.ctrl[actuator] = drive(t)

    before = mujoco.get_mjcb_control()
    mujoco.set_mjcb_control(write)
    try:
        yield
    finally:
        mujoco.set_mjcb_control(before)


def _sampled(case: Case, model: Any, data: Any, beside: list[Beside]) -> ValidationRun:
    """Step through the case; at each sample everything is evaluated at that instant."""
    setup, times = case.setup, case.times
    every = round(SAMPLE / model.opt.timestep)
    joints = [_addresses(model, names) for names in setup.coordinates.values()]
    actuators = [model.actuator(name).id for name in setup.inerters]
    sensors = [data.sensor(name).data for name in setup.inerters]
    qpos, qvel = np.empty((times.size, model.nq)), np.empty((times.size, model.nv))
    acts = np.empty((times.size, model.na))
    devices = np.empty((times.size, len(beside), 4))
    for row in range(times.size):
        if row:
            mujoco.mj_step(model, data, every)
        # a step leaves forces of its first instant or of a stage behind, not those of its end
        mujoco.mj_forward(model, data)
        qpos[row], qvel[row], acts[row] = data.qpos, data.qvel, data.act
        for column, (part, actuator, values) in enumerate(
            zip(beside, actuators, sensors, strict=True)
        ):
            x = data.actuator_length[actuator] - float(part.device.rest_length)
            energy = values[3 + part.device.nstate]
            devices[row, column] = values[0], energy, x, data.actuator_velocity[actuator]
    if not (np.isfinite(qpos).all() and np.isfinite(devices).all()):
        raise RunError("the run diverges")
    if abs(data.time - times[-1]) > 1e-6:
        raise RunError(f"the engine started again before {times[-1]:g} s: the run diverges")
    return _run(case, model, joints, (qpos, qvel, acts, devices), beside)


def _addresses(model: Any, names: tuple[str, ...]) -> list[int]:
    """Places in qpos of the first alternative that the model has; each joint is one number."""
    there = {model.joint(i).name for i in range(model.njnt)}
    for alternative in names:
        joints = alternative.split("+")
        if there.issuperset(joints):
            return [int(model.joint(name).qposadr[0]) for name in joints]
    raise RunError(f"the model has none of the joints {', '.join(names)}")


def _run(
    case: Case,
    model: Any,
    joints: list[list[int]],
    rows: tuple[Array, Array, Array, Array],
    beside: list[Beside],
) -> ValidationRun:
    """In the words of the comparison, at the size of the reference's motion."""
    qpos, qvel, acts, devices = rows
    size = case.setup.scale
    total, energy, x, v = (devices[:, :, i] for i in range(4))
    springs = np.array([part.stiffness for part in beside])
    dampers = np.array([part.viscous for part in beside])
    state = {}
    for i, (name, part) in enumerate(zip(case.setup.inerters, beside, strict=True)):
        first = model.actuator(name).actadr[0]
        for column, state_name in enumerate(part.device.state_names):
            unit = case.state_size(state_name, size)
            state[i, state_name] = acts[:, first + column] / unit
    return ValidationRun(
        time=case.times,
        displacement=np.column_stack([qpos[:, at].sum(axis=1) for at in joints]) / size,
        velocity=np.column_stack([qvel[:, at].sum(axis=1) for at in joints]) / size,
        force=(total - springs * x - dampers * v) / size,
        state=state,
        energy=(energy - 0.5 * springs * x * x) / size**2,
    )


def _value(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
