"""One corner of a vehicle in Exudyn: wheel, tyre, road, and a strut up to the body.

The wheel is a mass point that moves along z only; strut and inerter act between points of wheel
and body, so that large motions bend the geometry as in the MJCF models.

Directions are locked by an inertia that nothing moves, which every solver bears. Coordinate
constraints would not do: Exudyn's explicit solvers solve with the whole mass matrix and put the
constrained coordinates back afterwards. That is wrong where the mass matrix couples them to others,
and it does: an inerter that stands aslant joins z to x and y, a body that pitches joins roll to yaw
(measured: 4e-5 of the motion after a kerb at 0.5 m/s, at any step).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from exudyn import graphics
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2

from inerter.exudyn import CreateInerter
from inerter.exudyn.model_parts import Drive, flywheel_at_rest, tyre
from inerter.model_parameters import AxleParameters, FullCarParameters, HalfCarParameters

Z = 2
"""The coordinate of a node that is its displacement upward."""

LOCKED = 1e12
"""Inertia of a locked direction [kg, kg m^2]: it moves by 1e-12 of what it else would."""


def lock(mbs: Any, node: Any, locked: Sequence[float]) -> None:
    """Give those coordinates of a node that are marked by 1 an inertia that nothing moves."""
    mbs.AddObject(
        ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=np.diag(LOCKED * np.array(locked)),
            visualization=VObjectGenericODE2(show=False),
        )
    )


def add_corner(
    mbs: Any,
    name: str,
    body: Any,
    car: HalfCarParameters | FullCarParameters,
    axle: AxleParameters,
    place: tuple[float, float],
    *,
    layout: str,
    device: Mapping[str, Any],
    road: Drive | None,
    velocity: float,
    symbolic: bool | None,
    static_load: float | None = None,
) -> tuple[Any, dict[str, Any]]:
    """Add wheel, tyre and strut at `place` (x, y) [m] below a body whose centre is over (0, 0).

    Layouts: "S1" spring and damper; "S2" an inerter beside them; "S3" the spring, beside it the
    device with the damper as its `series_damping`. `velocity` [m/s] of the wheel at the start.
    With a `static_load` [N] the tyre leaves the road where it would have to pull by more.
    Returns the wheel's node and the inerter by name, none in S1.

    Raises
    ------
    ValueError
        S3 with a device that has a series element of its own.
    """
    x, y = place
    side = 1.0 if y >= 0.0 else -1.0
    wheel = mbs.CreateMassPoint(
        name=f"wheel_{name}",
        referencePosition=[x, y, car.wheel_height],
        initialVelocity=[0.0, 0.0, velocity],
        mass=axle.wheel_mass,
        graphicsDataList=[
            graphics.Cylinder(
                pAxis=[0.0, 0.17 * side, 0.0],
                vAxis=[0.0, 0.2 * side, 0.0],
                radius=car.wheel_height,
                color=graphics.color.darkgrey,
            )
        ],
        returnDict=True,
    )
    lock(mbs, wheel["nodeNumber"], (1.0, 1.0, 0.0))

    # tyre: k_t (zr - w), the road's part is a load
    node, stiffness = wheel["nodeNumber"], axle.tyre_stiffness
    tyre(mbs, f"_{name}", node, stiffness, road, Z, static_load)

    # strut: terminal 1 is the wheel, terminal 2 the body above it
    top = [x, y, car.wheel_height + car.strut_length - car.centre_height]
    mbs.CreateSpringDamper(
        name=f"strut_{name}",
        itemNumbers=[wheel["bodyNumber"], body],
        localPosition1=top,
        referenceLength=car.strut_length,
        stiffness=axle.stiffness,
        damping=0.0 if layout == "S3" else axle.damping,
        drawSize=0.1,
    )
    if layout == "S1":
        return node, {}
    parameters = {"rest_length": car.strut_length, **device}
    if layout == "S3":
        parameters |= _damper_in_series(device, axle.damping)
    inerter = CreateInerter(
        mbs,
        name=f"inerter_{name}",
        itemNumbers=[wheel["bodyNumber"], body],
        localPosition1=top,
        symbolic=symbolic,
        initialStates=flywheel_at_rest(parameters),
        **parameters,
    )
    return node, {f"strut_{name}": inerter}


def _damper_in_series(device: Mapping[str, Any], damping: float) -> dict[str, float]:
    """The damper as the device's series element, if it has none yet."""
    for key in ("series_stiffness", "series_damping", "series_hardening", "backlash"):
        if float(device.get(key, 0.0)):
            raise ValueError(
                f"device: {key} {device[key]} cannot be given in S3, where the series element is "
                "the strut's damper; choose S2, or leave it out"
            )
    return {"series_damping": damping}
