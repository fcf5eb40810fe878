"""Runs of the shipped models, and what their files say."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import mujoco
import numpy as np
from inerter.models import model_path
from numpy.typing import NDArray

Array = NDArray[np.float64]


def configuration(name: str, file: str, instance: str) -> dict[str, str]:
    """The configuration of a plugin instance of a shipped model."""
    spec = mujoco.MjSpec.from_file(str(model_path(name, file)))
    (found,) = [plugin for plugin in spec.plugins if plugin.name == instance]
    return dict(found.config)


def stated(name: str, file: str, instance: str) -> dict[str, float | str]:
    """The configuration with numbers as numbers."""

    def value(text: str) -> float | str:
        try:
            return float(text)
        except ValueError:
            return text

    return {key: value(text) for key, text in configuration(name, file, instance).items()}


def compiled(name: str, file: str, integrator: str, step: float) -> Any:
    """A shipped model with another integrator and step [s]."""
    spec = mujoco.MjSpec.from_file(str(model_path(name, file)))
    spec.option.timestep = step
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    return spec.compile()


def path(
    model: Any,
    times: Array,
    read: Callable[[Any], Sequence[float] | Array],
    *,
    velocities: Mapping[str, float] | None = None,
    positions: Mapping[str, float] | None = None,
    controls: Mapping[str, Callable[[float], float]] | None = None,
) -> Array:
    """What `read` sees at the times, which start at 0 and are multiples of the step.

    A control is held over a step at its value in the middle: an error of second order.
    """
    data = mujoco.MjData(model)
    for joint, value in (positions or {}).items():
        data.joint(joint).qpos = value
    for joint, value in (velocities or {}).items():
        data.joint(joint).qvel = value
    driven = [(data.actuator(name), drive) for name, drive in (controls or {}).items()]
    step = model.opt.timestep
    rows = [np.array(read(data))]
    for count in np.diff(np.rint(times / step).astype(int)):
        for _ in range(count if driven else 0):
            for actuator, drive in driven:
                actuator.ctrl = drive(data.time + 0.5 * step)
            mujoco.mj_step(model, data)
        if not driven:
            mujoco.mj_step(model, data, int(count))
        rows.append(np.array(read(data)))
    return np.array(rows)


def error(found: Array, true: Array) -> float:
    """Largest error over the largest value, the worst of all columns."""
    scale = np.abs(true).max(axis=0)
    return float((np.abs(found - true).max(axis=0) / scale).max())
