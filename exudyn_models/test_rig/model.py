"""Test rig in Exudyn: a bench that imposes a motion on a device.

The device stands between the frame and a table so heavy that no device moves it. Numbers:
README.md. Run this file for the loops of an ideal and of a rubbing inerter.
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
)
from inerter.model_parameters import TEST_RIG

COORDINATES = ("table",)
INPUTS = ("shaker",)


def build(
    mbs: Any,
    *,
    device: Mapping[str, Any] | None = None,
    inputs: Mapping[str, Callable[[float], float]] | None = None,
    initial_velocities: Mapping[str, float] | None = None,
    symbolic: bool | None = None,
) -> Model:
    """Add the rig and a device to an empty system.

    Parameters
    ----------
    mbs
        An empty `exudyn.MainSystem`; assemble it afterwards.
    device
        Parameters of the device; None for an ideal inerter with the inertance of `TEST_RIG`.
    inputs
        "shaker": time [s] -> acceleration of the table [m/s^2].
    initial_velocities
        "table" [m/s].
    symbolic
        As in `CreateInerter`: None compiles the laws of the device where that is possible.

    Raises
    ------
    ValueError
        An unknown name.
    """
    drives = named("inputs", inputs, INPUTS)
    start = named("initial_velocities", initial_velocities, COORDINATES)
    parameters: dict[str, Any] = (
        {"inertance": TEST_RIG.inertance} if device is None else dict(device)
    )
    table = mbs.AddNode(
        Node1D(
            name="table",
            referenceCoordinates=[0.0],
            initialVelocities=[start.get("table", 0.0)],
        )
    )
    mbs.AddObject(Mass1D(name="table", mass=TEST_RIG.table_mass, nodeNumber=table))
    drive_coordinate(mbs, "shaker", table, drives.get("shaker"), TEST_RIG.table_mass)
    inerter = CreateInerter(
        mbs,
        name="device",
        itemNumbers=[None, table],
        symbolic=symbolic,
        initialStates=flywheel_at_rest(parameters),
        **parameters,
    )
    return Model(mbs, {"table": (table, 0)}, {"device": inerter})


def shaker(t: float) -> float:
    """Acceleration [m/s^2] of 3 mm at 3 Hz."""
    return -3e-3 * (6 * np.pi) ** 2 * float(np.sin(6 * np.pi * t))


def main() -> None:
    """Run the device of Wang and Su, without and with its friction."""
    friction = {"friction": "coulomb", "coulomb_force": TEST_RIG.coulomb_force}
    start = {"table": 3e-3 * 6 * np.pi}
    for name, losses in (("ideal", {}), ("rubbing", friction)):
        SC = exu.SystemContainer()
        mbs = SC.AddSystem()
        device = {"inertance": TEST_RIG.inertance, **losses}
        model = build(mbs, device=device, inputs={"shaker": shaker}, initial_velocities=start)
        run = simulate(model, 1.0, write_period=2e-3)
        force, velocity = run.force["device"], run.velocity["table"]
        lost = np.sum(0.5 * (force * velocity)[1:] + 0.5 * (force * velocity)[:-1]) * 2e-3
        print(f"{name}: force up to {np.abs(force).max():.1f} N, {lost / 3:.3f} J lost in a cycle")
        print(f"    {save_picture(f'test_rig_{name}', run)}")


if __name__ == "__main__":
    main()
