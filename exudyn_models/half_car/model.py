"""Half-car in Exudyn: a body that heaves and pitches on two struts with inerters.

Coordinates, layouts and numbers: README.md; wheel, tyre, strut: `inerter.exudyn.model_corner`. Run
this file for a bump.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import graphics
from exudyn.rigidBodyUtilities import RigidBodyInertia
from inerter.exudyn.model_corner import add_corner, lock
from inerter.exudyn.model_parts import Model, device_parameters, named, save_picture, simulate
from inerter.model_parameters import HALF_CAR

COORDINATES = ("heave", "pitch", "wheel_front", "wheel_rear")
INPUTS = ("road_front", "road_rear")


def build(
    mbs: Any,
    *,
    layout: str = "S2",
    device: Mapping[str, Any] | None = None,
    inputs: Mapping[str, Callable[[float], float]] | None = None,
    initial_velocities: Mapping[str, float] | None = None,
    symbolic: bool | None = None,
    static_loads: Mapping[str, float] | None = None,
) -> Model:
    """Add the half-car to an empty system.

    Parameters
    ----------
    mbs
        An empty `exudyn.MainSystem`; assemble it afterwards.
    layout
        "S1": spring and damper; "S2": beside an inerter; "S3": the spring, beside it the inerter
        with the damper in series, as the device's own `series_damping`.
    device
        Parameters of both inerters; None for the ideal ones of `HALF_CAR`.
    inputs
        "road_front", "road_rear": time [s] -> height of the road [m].
    initial_velocities
        "heave", "wheel_front", "wheel_rear" [m/s], "pitch" [rad/s].
    symbolic
        As in `CreateInerter`: None compiles the laws of the inerters where that is possible.
    static_loads
        Weight on the tyre of each wheel [N], "front" ..., by which it may pull on the road; a
        tyre without one pulls by any force.

    Raises
    ------
    ValueError
        An unknown layout or name, a device for S1, a series element in the device for S3.
    """
    car = HALF_CAR
    drives = named("inputs", inputs, INPUTS)
    start = dict.fromkeys(COORDINATES, 0.0)
    start |= named("initial_velocities", initial_velocities, COORDINATES)

    # x forward, y left, z up; pitch is the angle about y, positive lowers the front.
    # Roll and yaw are locked: their inertias count for nothing
    body = mbs.CreateRigidBody(
        name="body",
        referencePosition=[0.0, 0.0, car.centre_height],
        initialVelocity=[0.0, 0.0, start["heave"]],
        initialAngularVelocity=[0.0, start["pitch"], 0.0],
        inertia=RigidBodyInertia(
            car.body_mass,  # pyright: ignore[reportArgumentType]
            car.pitch_inertia * np.eye(3),
        ),
        nodeType=exu.NodeType.RotationRxyz,
        graphicsDataList=[
            graphics.Brick(
                centerPoint=[-0.4, 0.25, 0.1],
                size=[4.2, 0.3, 0.5],
                color=[*graphics.color.steelblue[:3], 0.3],
            )
        ],
        returnDict=True,
    )
    lock(mbs, body["nodeNumber"], (1, 1, 0, 1, 0, 1))
    coordinates = {"heave": (body["nodeNumber"], 2), "pitch": (body["nodeNumber"], 4)}

    inerters = {}
    for name, axle, x in (
        ("front", car.front, car.front.distance),
        ("rear", car.rear, -car.rear.distance),
    ):
        node, inerter = add_corner(
            mbs,
            name,
            body["bodyNumber"],
            car,
            axle,
            (x, 0.0),
            layout=layout,
            device=device_parameters(layout, device, axle.inertance),
            road=drives.get(f"road_{name}"),
            velocity=start[f"wheel_{name}"],
            symbolic=symbolic,
            static_load=(static_loads or {}).get(name),
        )
        coordinates[f"wheel_{name}"] = (node, 2)
        inerters |= inerter
    return Model(mbs, coordinates, inerters)


def bump(s: float) -> float:
    """A bump 60 mm high, a metre long, 3 m ahead."""
    return 0.06 * float(np.exp(-(((s - 3.0) / 0.5) ** 2)))


def main() -> None:
    """Drive over the bump at 15 m/s in the three layouts."""
    speed, wheelbase = 15.0, HALF_CAR.front.distance + HALF_CAR.rear.distance
    inputs = {
        "road_front": lambda t: bump(speed * t),
        "road_rear": lambda t: bump(speed * t - wheelbase),
    }
    for layout in ("S1", "S2", "S3"):
        SC = exu.SystemContainer()
        mbs = SC.AddSystem()
        run = simulate(build(mbs, layout=layout, inputs=inputs), 2.0, write_period=2e-3)
        heave, pitch = (np.abs(run.displacement[name]).max() for name in ("heave", "pitch"))
        print(f"{layout}: heave up to {1e3 * heave:.1f} mm, pitch up to {1e3 * pitch:.1f} mrad")
        print(f"    {save_picture(f'half_car_{layout.lower()}', run)}")


if __name__ == "__main__":
    main()
