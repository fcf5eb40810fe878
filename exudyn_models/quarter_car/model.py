"""Quarter-car of Wang and Su in Exudyn: two masses, a strut with an inerter, a tyre.

    m_s zs'' = -u,   m_u zu'' = u - k_t (zu - zr),   u: strut force at the elongation zs - zu

Coordinates, layouts and numbers: README.md. Run this file for a bump.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.itemInterface import Mass1D, Node1D
from inerter.core import Device
from inerter.exudyn import CreateInerter
from inerter.exudyn.model_parts import (
    Model,
    device_parameters,
    flywheel_at_rest,
    named,
    save_picture,
    simulate,
    spring_damper,
    tyre,
)
from inerter.model_parameters import QUARTER_CAR

COORDINATES = ("body", "wheel")
INPUTS = ("road",)


def build(
    mbs: Any,
    *,
    layout: str = "S2",
    device: Mapping[str, Any] | None = None,
    inputs: Mapping[str, Callable[[float], float]] | None = None,
    initial_velocities: Mapping[str, float] | None = None,
    symbolic: bool | None = None,
    static_load: float | None = None,
) -> Model:
    """Add the quarter-car to an empty system.

    Parameters
    ----------
    mbs
        An empty `exudyn.MainSystem`; assemble it afterwards.
    layout
        "S1": spring and damper; "S2": beside an inerter; "S3": the inerter in series with the
        damper, a node without mass between them.
    device
        Parameters of the inerter; None for the ideal one of `QUARTER_CAR`.
    inputs
        "road": time [s] -> height of the road [m].
    initial_velocities
        "body", "wheel" [m/s]; in S3 the inerter starts at rest, its node with the wheel.
    symbolic
        As in `CreateInerter`: None compiles the laws of the inerter where that is possible.
    static_load
        Weight on the tyre [N], by which it may pull on the road; None: by any force.

    Raises
    ------
    ValueError
        An unknown layout or name, a device for S1, an S3 whose inerter is not rigid.
    """
    car = QUARTER_CAR
    strut = car.struts.get(layout, car.struts["S1"])
    parameters = device_parameters(layout, device, strut.inertance)
    drives = named("inputs", inputs, INPUTS)
    start = named("initial_velocities", initial_velocities, COORDINATES)
    if layout == "S3":
        _check_rigid(parameters)

    # body and wheel, upward from equilibrium
    nodes = {
        name: mbs.AddNode(
            Node1D(name=name, referenceCoordinates=[0.0], initialVelocities=[start.get(name, 0.0)])
        )
        for name in COORDINATES
    }
    body, wheel = nodes["body"], nodes["wheel"]
    mbs.AddObject(Mass1D(name="body", mass=car.sprung_mass, nodeNumber=body))
    mbs.AddObject(Mass1D(name="wheel", mass=car.unsprung_mass, nodeNumber=wheel))

    # tyre: k_t (zr - zu), the road's part is a load
    tyre(mbs, "", wheel, car.tyre_stiffness, drives.get("road"), 0, static_load)

    # strut; the damper's upper end is the body, its lower end the wheel or the inerter
    spring_damper(mbs, "spring", (wheel, body), stiffness=car.stiffness)
    upper, lower = body, wheel
    if layout == "S3":
        velocity = [start.get("wheel", 0.0)]
        upper = lower = mbs.AddNode(
            Node1D(name="node", referenceCoordinates=[0.0], initialVelocities=velocity)
        )
    spring_damper(mbs, "damper", (lower, body), damping=strut.damping)
    inerters = {}
    if layout != "S1":
        inerters["strut"] = CreateInerter(
            mbs,
            name="strut",
            itemNumbers=[wheel, upper],
            symbolic=symbolic,
            initialStates=flywheel_at_rest(parameters),
            **parameters,
        )
    return Model(mbs, {name: (node, 0) for name, node in nodes.items()}, inerters)


def _check_rigid(parameters: Mapping[str, Any]) -> None:
    """In S3 the node between inerter and damper moves by the inertance alone."""
    given = Device(**parameters)
    if given.series_stiffness or given.series_damping or not given.inertance > 0:
        raise ValueError(
            "device: in S3 it needs an inertance above 0 and no series_stiffness or "
            "series_damping (the node between inerter and damper has no mass of its own); "
            "choose S2 for an elastic inerter"
        )


def bump(t: float) -> float:
    """A bump 40 mm high, half a metre long at 10 m/s."""
    return 0.04 * float(np.exp(-(((t - 0.2) / 0.025) ** 2)))


def main() -> None:
    """Drive over the bump in the three layouts."""
    for layout in ("S1", "S2", "S3"):
        SC = exu.SystemContainer()
        mbs = SC.AddSystem()
        run = simulate(build(mbs, layout=layout, inputs={"road": bump}), 1.5, write_period=2e-3)
        body = run.displacement["body"]
        squeezed = [bump(t) for t in run.time] - run.displacement["wheel"]
        print(
            f"{layout}: body up to {1e3 * body.max():.1f} mm, "
            f"tyre squeezed by up to {1e3 * squeezed.max():.1f} mm"
        )
        path = save_picture(f"quarter_car_{layout.lower()}", run)
        print(f"    {path}")


if __name__ == "__main__":
    main()
