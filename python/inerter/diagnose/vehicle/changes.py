"""Edits of an MjSpec: dampers by direction, tyres, guides, forces that a record drives."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from inerter.diagnose.vehicle.model import VehicleModel
from inerter.diagnose.vehicle.parts import Tyre, VehicleLink

_HARD = 0.9999, 0.9999, 1e-3  # of `solimpfriction`
_FAR = 1e12  # a force that no one-sided actuator reaches [N]


def split_damping(device: str, change: VehicleModel) -> tuple[float, float] | None:
    values = change.of(device)
    if "rebound_damping" not in values:
        return None
    return values["rebound_damping"], values["bump_damping"]


def add_one_sided(spec: mujoco.MjSpec, link: VehicleLink, rebound: float, bump: float) -> None:
    """The part of a damper that acts in one direction: a velocity actuator that is cut at zero."""
    extra = abs(rebound - bump)
    # the force on the length is -extra v: negative while it grows
    growing = (rebound > bump) == (link.direction > 0)
    limits = [-_FAR, 0.0] if growing else [0.0, _FAR]
    if link.kind == "tendon":
        target, kind = spec.tendons[link.index].name, mujoco.mjtTrn.mjTRN_TENDON
        gear = [1.0, 0, 0, 0, 0, 0]
    elif link.kind == "joint":
        target, kind = spec.joints[link.index].name, mujoco.mjtTrn.mjTRN_JOINT
        gear = [1.0, 0, 0, 0, 0, 0]
    else:
        own = spec.actuators[link.index]
        target, kind, gear = own.target, own.trntype, list(own.gear)
    bias = np.zeros(10)
    bias[2] = -extra
    actuator = spec.add_actuator(
        name=f"{link.name}_{'rebound' if rebound > bump else 'bump'}",
        target=target,
        trntype=kind,
        gear=gear,
        gaintype=mujoco.mjtGain.mjGAIN_FIXED,
        biastype=mujoco.mjtBias.mjBIAS_AFFINE,
        forcelimited=True,
        forcerange=limits,
    )
    actuator.gainprm = np.zeros_like(actuator.gainprm)
    actuator.biasprm = bias


def set_first(element: Any, name: str, value: float, place: int = 0) -> None:
    """Set one number of a column of an element, the first one by default."""
    column = np.array(getattr(element, name))
    column[place] = value
    setattr(element, name, column)


def change_guide(joint: mujoco.MjsJoint, values: dict[str, float], step: float) -> None:
    """Friction and damping of a joint; the model's step [s] bounds how hard friction can be."""
    if "joint_friction" in values:
        if not joint.frictionloss:
            # as dry as a step allows; where the user has some, it stays as soft as it is
            joint.solimp_friction[:3] = _HARD
            joint.solref_friction = [2.0 * step, 1.0]
        joint.frictionloss = values["joint_friction"]
    if "joint_damping" in values:
        set_first(joint, "damping", values["joint_damping"])


def change_force(actuator: mujoco.MjsActuator, values: dict[str, float]) -> bool:
    """Gain and lag of a force that a record drives; whether it has a state now."""
    if "actuator_gain" in values:
        set_first(actuator, "gainprm", actuator.gainprm[0] * values["actuator_gain"])
    if not values.get("actuator_lag", 0.0) > 0:
        return False
    actuator.dyntype = mujoco.mjtDyn.mjDYN_FILTEREXACT
    set_first(actuator, "dynprm", values["actuator_lag"])
    return True


def change_tyre(spec: mujoco.MjSpec, tyre: Tyre, values: dict[str, float]) -> None:
    actuator = spec.actuators[tyre.actuator]
    if "tyre_stiffness" in values:
        set_first(actuator, "gainprm", values["tyre_stiffness"])
        set_first(actuator, "biasprm", -values["tyre_stiffness"], 1)
    if "tyre_static_load" in values:
        load = values["tyre_static_load"]
        actuator.forcelimited = True
        actuator.forcerange = [-load, _FAR] if tyre.pull > 0 else [-_FAR, load]
    own = spec.actuator(rate_actuator(tyre))
    if "tyre_damping" in values and own is not None:
        # the user's model has one
        set_first(own, "gainprm", values["tyre_damping"])
        set_first(own, "biasprm", -values["tyre_damping"], 2)
    elif "tyre_damping" in values:
        extra = spec.add_actuator(
            name=rate_actuator(tyre),
            target=actuator.target,
            refsite=actuator.refsite,
            trntype=actuator.trntype,
            gear=list(actuator.gear),
            gaintype=mujoco.mjtGain.mjGAIN_FIXED,
            biastype=mujoco.mjtBias.mjBIAS_AFFINE,
        )
        gain, bias = np.zeros(10), np.zeros(10)
        gain[0], bias[2] = values["tyre_damping"], -values["tyre_damping"]
        extra.gainprm, extra.biasprm = gain, bias
        spec.add_sensor(
            name=rate_actuator(tyre),
            type=mujoco.mjtSensor.mjSENS_ACTUATORFRC,
            objtype=mujoco.mjtObj.mjOBJ_ACTUATOR,
            objname=rate_actuator(tyre),
        )


def rate_actuator(tyre: Tyre) -> str:
    """Name of the actuator of a tyre's damping; its control is the road's rate [m/s]."""
    return f"{tyre.name}_rate"
