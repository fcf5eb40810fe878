"""What the columns of a control table may hold: the quantity that each driven thing takes.

An engine without units takes any number for a control. Here a control is known to be
- of an inerter.device, a force beside it;
- of a motor (gain 1, gear 1), its force; of a position or velocity servo (gear 1), what it holds:
  on a slide joint or a spatial tendon along a line, on a hinge about an axis.
Any other control (a gear that is a mass, so that the control is an acceleration) may be anything.
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from inerter.device_in_model import devices_of
from inerter.records.units import FORCE, LENGTH, SPEED, Quantity
from inerter.unit_text import parse_unit

_ANGLE = Quantity("an angle", "rad", "rad, deg")
_TORQUE = Quantity("a torque", "N*m", "N*m, kN*m, N*mm")
_TURNING = Quantity("an angular velocity", "rad/s", "rad/s, deg/s, rpm")

# position, velocity and force along a line, and about an axis
_LINE = (LENGTH, SPEED, FORCE)
_AXIS = (_ANGLE, _TURNING, _TORQUE)
_POSITION, _VELOCITY, _FORCE = range(3)

_SCALAR = (mujoco.mjtJoint.mjJNT_SLIDE, mujoco.mjtJoint.mjJNT_HINGE)
_JOINT = (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT)
_FILTERS = (mujoco.mjtDyn.mjDYN_NONE, mujoco.mjtDyn.mjDYN_FILTER, mujoco.mjtDyn.mjDYN_FILTEREXACT)
_UNIT_GEAR = np.array([1.0, 0, 0, 0, 0, 0])


def quantity_of_joint(model: mujoco.MjModel, joint: int) -> Quantity:
    """Position of a slide or hinge joint."""
    return _of_joint(model, joint)[_POSITION]


def quantity_of_control(model: mujoco.MjModel, actuator: int) -> Quantity | None:
    """What the control of an actuator is; None where the model does not say."""
    along = _transmission(model, actuator)
    if along is None:
        return None
    if actuator in {found.actuator for found in devices_of(model)}:
        return along[_FORCE]
    gear = np.abs(model.actuator_gear[actuator])
    fixed = mujoco.mjtGain(model.actuator_gaintype[actuator]) == mujoco.mjtGain.mjGAIN_FIXED
    if not fixed or (gear != _UNIT_GEAR).any():
        return None
    kind = mujoco.mjtBias(model.actuator_biastype[actuator])
    dynamics = mujoco.mjtDyn(model.actuator_dyntype[actuator])
    gain, bias = float(model.actuator_gainprm[actuator, 0]), model.actuator_biasprm[actuator]
    if kind == mujoco.mjtBias.mjBIAS_NONE and dynamics == mujoco.mjtDyn.mjDYN_NONE:
        return along[_FORCE] if gain == 1 else None
    if kind != mujoco.mjtBias.mjBIAS_AFFINE or dynamics not in _FILTERS or not gain:
        return None
    if bias[1] == -gain:
        return along[_POSITION]
    return along[_VELOCITY] if bias[1] == 0 and bias[2] == -gain else None


def no_control(unit: Any) -> str | None:
    """What a unit measures, in words, where no actuator of a model takes that.

    pint reads the g of an accelerogram as a gram where it stands in a longer unit, too.
    """
    for what, measured in (("a mass", "kg"), ("a volume", "m^3")):
        if unit.dimensionality == parse_unit(measured).dimensionality:
            return what
    return None


def _transmission(model: mujoco.MjModel, actuator: int) -> tuple[Quantity, ...] | None:
    """Along a line or about an axis; None for what may be either, as a sum of joints may."""
    kind = mujoco.mjtTrn(model.actuator_trntype[actuator])
    target = int(model.actuator_trnid[actuator, 0])
    if kind in _JOINT:
        scalar = mujoco.mjtJoint(model.jnt_type[target]) in _SCALAR
        return _of_joint(model, target) if scalar else None
    if kind != mujoco.mjtTrn.mjTRN_TENDON:
        return None
    first = mujoco.mjtWrap(model.wrap_type[model.tendon_adr[target]])
    return None if first == mujoco.mjtWrap.mjWRAP_JOINT else _LINE


def _of_joint(model: mujoco.MjModel, joint: int) -> tuple[Quantity, ...]:
    return _AXIS if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE else _LINE
