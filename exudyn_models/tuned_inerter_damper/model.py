"""Tuned inerter damper in Exudyn: three storeys, and an inerter behind a spring and a damper.

    m u_i'' = -m a_g - V_i + V_(i+1) + (F on the lower, -F on the upper floor of the damper)

Coordinates and numbers: README.md. Run this file for an earthquake's pulse.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.itemInterface import Mass1D, Node1D
from inerter.exudyn import CreateInerter
from inerter.exudyn.model_parts import (
    Model,
    drive_coordinate,
    flywheel_at_rest,
    named,
    save_picture,
    simulate,
    spring_damper,
)
from inerter.model_parameters import FRAME

COORDINATES = ("floor_1", "floor_2", "floor_3")
INPUTS = ("ground",)


def build(
    mbs: Any,
    *,
    ground: bool = False,
    device: Mapping[str, Any] | None = None,
    inputs: Mapping[str, Callable[[float], float]] | None = None,
    initial_velocities: Mapping[str, float] | None = None,
    symbolic: bool | None = None,
) -> Model:
    """Add the frame and its damper to an empty system.

    Parameters
    ----------
    mbs
        An empty `exudyn.MainSystem`; assemble it afterwards.
    ground
        Where the damper is: between the ground and the first floor, or else between the first and
        the third floor.
    device
        Parameters of the damper; None for the one of `FRAME`, {"inertance": 0} for none.
    inputs
        "ground": time [s] -> acceleration of the ground [m/s^2].
    initial_velocities
        "floor_1", "floor_2", "floor_3" [m/s], against the ground.
    symbolic
        As in `CreateInerter`: None compiles the laws of the damper where that is possible.

    Raises
    ------
    ValueError
        An unknown name.
    """
    drives = named("inputs", inputs, INPUTS)
    start = named("initial_velocities", initial_velocities, COORDINATES)
    if device is None:
        device = {
            "inertance": FRAME.inertance,
            "series_stiffness": FRAME.series_stiffness,
            "series_damping": FRAME.series_damping,
        }

    # floors against the ground, each on the storey below; the ground pushes every floor by -m a_g
    floors: list[Any] = [None]
    for name, mass, stiffness, damping in zip(
        COORDINATES,
        FRAME.storey_mass,
        FRAME.storey_stiffness,
        FRAME.storey_damping,
        strict=True,
    ):
        velocity = [start.get(name, 0.0)]
        floor = mbs.AddNode(
            Node1D(name=name, referenceCoordinates=[0.0], initialVelocities=velocity)
        )
        mbs.AddObject(Mass1D(name=name, mass=mass, nodeNumber=floor))
        spring_damper(
            mbs, f"storey_{name}", (floors[-1], floor), stiffness=stiffness, damping=damping
        )
        drive_coordinate(mbs, f"ground_{name}", floor, drives.get("ground"), -mass)
        floors.append(floor)

    lower, upper = (floors[0], floors[1]) if ground else (floors[1], floors[3])
    damper = CreateInerter(
        mbs,
        name="damper",
        itemNumbers=[lower, upper],
        symbolic=symbolic,
        initialStates=flywheel_at_rest(device),
        **device,
    )
    coordinates = {name: (node, 0) for name, node in zip(COORDINATES, floors[1:], strict=True)}
    return Model(mbs, coordinates, {"damper": damper})


def pulse(t: float) -> float:
    """Acceleration of the ground [m/s^2]: a burst near the first mode."""
    return 3.0 * float(np.sin(2 * np.pi * 2.7 * t) * np.exp(-(((t - 0.8) / 0.3) ** 2)))


def main() -> None:
    """Shake the frame with the damper in its two places."""
    for place, ground in (("floors", False), ("ground", True)):
        SC = exu.SystemContainer()
        mbs = SC.AddSystem()
        run = simulate(build(mbs, ground=ground, inputs={"ground": pulse}), 4.0, write_period=2e-3)
        top = np.abs(run.displacement["floor_3"])
        print(f"{place}: top floor up to {1e3 * top.max():.1f} mm, ", end="")
        print(f"after 3 s {1e3 * top[run.time > 3.0].max():.2f} mm")
        print(f"    {save_picture(f'tuned_inerter_damper_{place}', run)}")


if __name__ == "__main__":
    main()
