"""Full car in Exudyn: a body that heaves, pitches and rolls on four struts with inerters.

Coordinates, layouts and numbers: README.md; wheel, tyre, strut: `inerter.exudyn.model_corner`. Run
this file for a bump on the right.
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
from inerter.model_parameters import FULL_CAR

CORNERS = ("front_left", "front_right", "rear_left", "rear_right")
COORDINATES = ("heave", "pitch", "roll", *(f"wheel_{name}" for name in CORNERS))
INPUTS = tuple(f"road_{name}" for name in CORNERS)


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
    """Add the full car to an empty system.

    Parameters
    ----------
    mbs
        An empty `exudyn.MainSystem`; assemble it afterwards.
    layout
        "S1": spring and damper; "S2": beside an inerter; "S3": the spring, beside it the inerter
        with the damper in series, as the device's own `series_damping`.
    device
        Parameters of all four inerters; None for the ideal ones of `FULL_CAR`.
    inputs
        "road_front_left" and so on: time [s] -> height of the road [m].
    initial_velocities
        "heave", "wheel_front_left" and so on [m/s], "pitch", "roll" [rad/s].
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
    car = FULL_CAR
    drives = named("inputs", inputs, INPUTS)
    start = dict.fromkeys(COORDINATES, 0.0)
    start |= named("initial_velocities", initial_velocities, COORDINATES)

    # x forward, y left, z up; the node turns by roll about x, then by pitch about the new y.
    # Positive pitch lowers the front, positive roll the right
    body = mbs.CreateRigidBody(
        name="body",
        referencePosition=[0.0, 0.0, car.centre_height],
        initialVelocity=[0.0, 0.0, start["heave"]],
        initialAngularVelocity=[start["roll"], start["pitch"], 0.0],
        inertia=RigidBodyInertia(
            car.body_mass,  # pyright: ignore[reportArgumentType]
            np.diag([car.roll_inertia, car.pitch_inertia, car.yaw_inertia]),
        ),
        nodeType=exu.NodeType.RotationRxyz,
        graphicsDataList=[
            graphics.Brick(
                centerPoint=[-0.4, 0.0, 0.1],
                size=[4.2, 1.1, 0.5],
                color=[*graphics.color.brown[:3], 0.4],
            )
        ],
        returnDict=True,
    )
    lock(mbs, body["nodeNumber"], (1, 1, 0, 0, 0, 1))
    node = body["nodeNumber"]
    coordinates = {"heave": (node, 2), "pitch": (node, 4), "roll": (node, 3)}

    inerters = {}
    for name in CORNERS:
        front, left = name.startswith("front"), name.endswith("left")
        axle = car.front if front else car.rear
        place = (
            axle.distance if front else -axle.distance,
            car.track / 2 if left else -car.track / 2,
        )
        wheel, inerter = add_corner(
            mbs,
            name,
            body["bodyNumber"],
            car,
            axle,
            place,
            layout=layout,
            device=device_parameters(layout, device, axle.inertance),
            road=drives.get(f"road_{name}"),
            velocity=start[f"wheel_{name}"],
            symbolic=symbolic,
            static_load=(static_loads or {}).get(name),
        )
        coordinates[f"wheel_{name}"] = (wheel, 2)
        inerters |= inerter
    return Model(mbs, coordinates, inerters)


def bump(s: float) -> float:
    """A bump 60 mm high, a metre long, 3 m ahead."""
    return 0.06 * float(np.exp(-(((s - 3.0) / 0.5) ** 2)))


def main() -> None:
    """Drive over the bump with the right wheels at 15 m/s in the three layouts."""
    speed, wheelbase = 15.0, FULL_CAR.front.distance + FULL_CAR.rear.distance
    inputs = {
        "road_front_right": lambda t: bump(speed * t),
        "road_rear_right": lambda t: bump(speed * t - wheelbase),
    }
    for layout in ("S1", "S2", "S3"):
        SC = exu.SystemContainer()
        mbs = SC.AddSystem()
        run = simulate(build(mbs, layout=layout, inputs=inputs), 2.0, write_period=2e-3)
        heave, pitch, roll = (
            1e3 * np.abs(run.displacement[name]).max() for name in ("heave", "pitch", "roll")
        )
        print(f"{layout}: heave up to {heave:.1f} mm, pitch {pitch:.1f} mrad, roll {roll:.1f} mrad")
        print(f"    {save_picture(f'full_car_{layout.lower()}', run)}")


if __name__ == "__main__":
    main()
