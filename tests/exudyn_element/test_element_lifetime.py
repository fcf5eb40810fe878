"""Systems are freed with their devices, and devices do not get into each other's way by names."""

from __future__ import annotations

import gc
import weakref
from typing import Any

import pytest

pytest.importorskip("exudyn.itemInterface")

import numpy as np
from element_systems import LUGRE, System, bodies, line, settings, solve
from inerter.exudyn import CreateInerter

DEVICE: dict[str, Any] = {"inertance": 4.0, **LUGRE}


def finished_run(symbolic: bool | None) -> System:
    """A run with sensors of all kinds, over."""
    system = bodies("RigidBodyRxyz") if symbolic is None else line([2.0, 3.0], [0.3, 0.0])
    inerter = CreateInerter(system.mbs, "d", system.parts, symbolic=symbolic, **DEVICE)
    for quantity in ("total", "states", "friction_state"):
        inerter.AddSensor(quantity)
    system.mbs.Assemble()
    solve(system.mbs, settings(0.01, 1e-3), "RK44")
    return system


@pytest.mark.parametrize("symbolic", [True, False, None], ids=["symbolic", "python", "points"])
def test_a_system_that_nobody_holds_is_freed(symbolic: bool | None) -> None:
    """Python cannot collect a circle through Exudyn's C++: there must be none."""
    system = finished_run(symbolic)
    known = weakref.ref(system.mbs)
    assert known() is not None
    del system
    gc.collect()
    assert known() is None


def test_the_recorded_forces_outlive_what_python_holds() -> None:
    """Only the system is kept, not what `CreateInerter` returned."""
    system, other = (line([2.0, 3.0], [0.3, 0.0]) for _ in range(2))
    kept = CreateInerter(system.mbs, "d", system.parts, symbolic=True, **DEVICE)
    CreateInerter(other.mbs, "d", other.parts, symbolic=True, **DEVICE)
    for made in (system, other):
        made.mbs.Assemble()
        gc.collect()
        solve(made.mbs, settings(0.1, 1e-4), "RK44")
    assert abs(kept.Evaluate()["friction"]) > 1.0
    np.testing.assert_array_equal(system.positions, other.positions)


def test_devices_without_a_name() -> None:
    """Each gets one of its own, for its states, drawing and sensors."""
    system = bodies("RigidBodyRxyz")
    made = [CreateInerter(system.mbs, itemNumbers=system.parts, **DEVICE) for _ in range(2)]
    sensors = [inerter.AddSensor("total") for inerter in made]
    names = [system.mbs.GetObject(inerter.objectNumber)["name"] for inerter in made]
    assert names == [inerter.name for inerter in made]
    assert len({*names}) == len({*map(int, sensors)}) == 2
    system.mbs.Assemble()


def test_the_variables_of_the_user_are_left_alone() -> None:
    system = line([2.0, 3.0], [0.3, 0.0])
    system.mbs.variables["inerter"] = "mine"
    CreateInerter(system.mbs, "d", system.parts, **DEVICE)
    assert system.mbs.variables["inerter"] == "mine"
