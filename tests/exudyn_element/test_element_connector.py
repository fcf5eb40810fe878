"""Memoryless laws on 1D coordinates, which a connector of Exudyn's evaluates."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

import exudyn
from element_systems import LUGRE, Array, System, bodies, coordinate, line, settings, solve
from inerter.exudyn import CreateInerter, connector
from inerter.exudyn.engine import version

COULOMB: dict[str, Any] = {
    "friction": "coulomb", "coulomb_force": 10.0, "transition_velocity": 0.01,
}  # fmt: skip
STOPS: dict[str, Any] = {"stop_stiffness": 1e4, "stop_upper": 0.02, "stop_lower": -0.02}
pytestmark = pytest.mark.skipif(
    version(exudyn) < connector.OLDEST, reason="this Exudyn takes no expressions there"
)


def items(system: System, which: str) -> list[Any]:
    """Terminals of a kind."""
    first, second = system.parts
    if which == "markers":
        return [coordinate(system.mbs, first), coordinate(system.mbs, second)]
    return {"pair": [first, second], "ground first": [None, second], "ground last": [first, None]}[
        which
    ]


def test_who_has_one() -> None:
    def has(symbolic: bool | None = None, **device: Any) -> bool:
        system = line([2.0, 3.0], [0.5, -0.2])
        made = CreateInerter(
            system.mbs, "d", system.parts, inertance=4.0, symbolic=symbolic, **device
        )
        return made.functions.connector is not None

    assert has(**COULOMB)
    assert has(**STOPS)
    assert has(**COULOMB, inertance_gradient=1.0)
    assert not has(stiffness=100.0, viscous=3.0)
    assert not has(**LUGRE)
    assert not has(**COULOMB, dissipatedEnergy=True)
    assert not has(False, **COULOMB)


@pytest.mark.parametrize("device", [COULOMB, STOPS], ids=["coulomb", "stops"])
@pytest.mark.parametrize("which", ["pair", "ground first", "ground last", "markers"])
def test_it_moves_as_the_tape_does(which: str, device: dict[str, Any]) -> None:
    ends = []
    for symbolic in (True, False):
        system = line([2.0, 3.0], [0.5, -0.2], spring=300.0)
        made = CreateInerter(
            system.mbs, "d", items(system, which), inertance=4.0, symbolic=symbolic, viscous=2.0,
            **device, rest_length=0.01,
        )  # fmt: skip
        assert (made.functions.connector is not None) is symbolic
        solve(system.mbs, settings(0.3, 1e-3), "RK44")
        ends.append([*system.positions, *system.velocities])
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-12, atol=1e-14)


def test_between_coordinates_of_bodies() -> None:
    """The connector takes the coordinates that the device takes."""
    ends = []
    for symbolic in (True, False):
        system = bodies("Point")
        nodes = [system.mbs.GetObject(body)["nodeNumber"] for body in system.parts]
        pairs = zip(nodes, (2, 1), strict=True)
        markers = [coordinate(system.mbs, node, which) for node, which in pairs]
        CreateInerter(system.mbs, "d", markers, inertance=4.0, symbolic=symbolic, **COULOMB)
        solve(system.mbs, settings(0.1, 1e-3), "RK44")
        ends.append(system.mbs.systemData.GetODE2Coordinates_t())
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize(
    ("before", "change"),
    [
        (COULOMB, {"coulomb_force": 3.0}),
        ({"stiffness_cubic": 1e6}, {"stiffness_cubic": 0.0}),
        ({"viscous": 1.0}, COULOMB),
    ],
    ids=["other", "gone", "come"],
)
def test_parameters_change(before: dict[str, Any], change: dict[str, Any]) -> None:
    """After a change it is as the device that was made so."""

    def run(made_with: dict[str, Any], changed: dict[str, Any]) -> Array:
        system = line([2.0, 3.0], [0.5, -0.2], spring=300.0)
        strut = CreateInerter(system.mbs, "d", system.parts, inertance=4.0, **made_with)
        force = strut.AddSensor("total")
        system.mbs.Assemble()
        if changed:
            strut.set(**changed)
        solve(system.mbs, settings(0.2, 1e-3), "RK44")
        return np.array(system.mbs.GetSensorStoredData(force))

    np.testing.assert_allclose(
        run(before, change), run({**before, **change}, {}), rtol=1e-12, atol=1e-12
    )
