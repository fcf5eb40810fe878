"""From fitted coordinates to parameters that people state, with standard errors."""

from __future__ import annotations

import re

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import NUISANCES, parameter_names
from inerter.core import parameters
from inerter.diagnose.result import ParameterValue, StatedValue
from inerter.diagnose.vehicle.build import UserModel
from inerter.diagnose.vehicle.model import TYRES, VehicleModel
from inerter.diagnose.vehicle.search import VehicleScored
from inerter.estimation.covariance import sandwich

Array = NDArray[np.float64]

_UNITS = {
    "tyre_damping": "N*s/m",
    "tyre_static_load": "N",
    "tyre_stiffness": "N/m",
    "rebound_damping": "N*s/m",
    "bump_damping": "N*s/m",
    "damping": "N*s/m",
    "stiffness": "N/m",
    "stiffness_cubic": "N/m^3",
    "mass": "kg",
    "joint_friction": "N",
    "joint_damping": "N*s/m",
    "actuator_gain": "1",
    "actuator_lag": "s",
    "gain": "1",
    "delay": "s",
    "filter_frequency": "Hz",
    "mount_frequency": "Hz",
    "mount_loss": "1",
    "angle_toward_x": "rad",
    "angle_toward_y": "rad",
    "angle_toward_z": "rad",
    "patch_length": "m",
    "patch_time": "s",
    "damping_gradient": "1/m",
}
# elements that are named even where there is one of them
NAMED = ("joint", "actuator", "channel")
_MASSES = {"body_mass_error": "body_mass", "wheel_mass_error": "wheel_mass"}
# the same of a hinge
_TURNED = {"N": "N*m", "m": "rad", "kg": "kg*m^2"}


def parameter_values(
    user: UserModel, scored: VehicleScored, finer: Array | None = None
) -> list[dict[str, ParameterValue]]:
    """Parameters of every effect of a fitted model, in the order of its effects.

    Names have their element before them ("strut_front.viscous") where a model has several alike.
    finer: the fit's residual with steps half as long, whose parameters the errors reach then.
    """
    model = scored.model
    used = np.abs(scored.fit.residual) > 0
    units = scored.fit.units() if model.free else np.empty(0)
    covariance = (
        sandwich(scored.fit.jacobian[used], scored.fit.residual[used], np.ones(int(used.sum())))
        * np.outer(units, units)
        if model.free
        else np.empty((0, 0))
    )
    if finer is not None and model.free:
        moved = np.linalg.pinv(scored.fit.jacobian) @ (finer - scored.fit.residual) * units
        # errors of the step fall with its square: all of them are 4/3 of what half of it changes
        covariance += np.outer(moved, moved) * (4.0 / 3.0) ** 2
    found = []
    for added in model.effects:
        values: dict[str, ParameterValue] = {}
        own = [name for name in model.free if name in added.coordinates]
        now = _read(user, model, added.element, own)
        slopes = {name: np.zeros(len(model.free)) for name in now}
        for i, name in enumerate(model.free):
            if not name.startswith(f"{added.element}."):
                continue
            step = 1e-5 * (abs(model.values[name]) or units[i])
            if model.values[name] + step > scored.fit.sizes[name].upper:
                step = -step
            moved = model.at({name: model.values[name] + step})
            for key, value in _read(user, moved, added.element, own).items():
                if key in slopes:
                    slopes[key][i] = (value - now[key]) / step
        prefix = _prefix(user, added.element)
        for name, value in now.items():
            error = float(np.sqrt(max(slopes[name] @ covariance @ slopes[name], 0.0)))
            shown = _MASSES.get(added.effect, name) if name == "mass" else name
            values[prefix + shown] = StatedValue(
                value, error, _unit(user, added.element, name), _stated(user, added.element, name)
            )
        found.append(values)
    return found


def _read(
    user: UserModel, model: VehicleModel, element: str, coordinates: list[str]
) -> dict[str, float]:
    """Parameters of an element that some of its coordinates stand for."""
    names = [name.removeprefix(f"{element}.") for name in coordinates]
    values = model.of(element)
    if element not in {device.name for device in user.devices}:
        return {name: values[name] for name in names}
    found = {
        n: values[n] for n in names if n in ("rebound_damping", "bump_damping", "damping_gradient")
    }
    device = user.device_of(element, model)
    # of a gas the area is a choice, and stands beside the pressure
    others = {"gas_pressure": ("gas_pressure", "gas_area")}
    for name in (each for n in names for each in others.get(n) or parameter_names(n)):
        if name in device.given and name not in NUISANCES and name not in found:
            found[name] = float(device.given[name])
    return found


def _unit(user: UserModel, element: str, name: str) -> str:
    known = parameters().get(name)
    unit = known.unit if known else _UNITS.get(name, "")
    kind, _, joint = element.partition(":")
    hinge = kind == "joint" and (user.model.joint(joint).type[0] == mujoco.mjtJoint.mjJNT_HINGE)
    if hinge or any(d.name == element and _turns(user.model, d.actuator) for d in user.devices):
        return re.sub(r"[A-Za-z]+", lambda word: _TURNED.get(word.group(), word.group()), unit)
    return unit


def _turns(model: mujoco.MjModel, actuator: int) -> bool:
    """Whether an actuator acts on a hinge."""
    if model.actuator_trntype[actuator] != mujoco.mjtTrn.mjTRN_JOINT:
        return False
    joint = model.actuator_trnid[actuator, 0]
    return bool(model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE)


def _stated(user: UserModel, element: str, name: str) -> float | None:
    if name in ("rebound_damping", "bump_damping"):
        part = next(p for p in user.parts.suspensions if p.device == element)
        return user.damping(part)
    for device in user.devices:
        if device.name == element:
            value = device.stated(user.model).get(name)
            return float(value) if isinstance(value, int | float) else None
    return user.stated.get(f"{element}.{name}")


def _prefix(user: UserModel, element: str) -> str:
    """The element's name where the model has several of its kind."""
    names = {device.name for device in user.devices}
    if element in names:
        return f"{element}." if len(names) > 1 else ""
    kind, _, name = element.partition(":")
    if kind == TYRES:
        return ""
    if kind in NAMED:
        return f"{name}."
    alike = {
        "tyre": len(user.parts.tyres),
        "body": 1 if _is_the_body(user, element) else len(user.parts.suspensions),
    }.get(kind, len(user.parts.suspensions))
    return f"{name}." if alike > 1 else ""


def _is_the_body(user: UserModel, element: str) -> bool:
    return len({p.body for p in user.parts.suspensions}) == 1 and any(
        user.body(p.body) == element for p in user.parts.suspensions
    )
