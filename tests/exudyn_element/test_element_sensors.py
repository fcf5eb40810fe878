"""Sensors: every quantity, in memory and in a file, and all of them consistent with each other."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inerter.reference import ReferenceDevice

pytest.importorskip("exudyn.itemInterface")

from element_systems import LUGRE, PLAY, Array, System, bodies, body, line, settings, solve
from inerter.exudyn import CreateInerter, sensors
from inerter.exudyn.inerter import QUANTITIES

END, STEP = 0.2, 1e-3
DEVICE: dict[str, Any] = {
    "inertance": 4.0, "viscous": 2.0, "stiffness": 50.0, "inertance_gradient": 3.0, **LUGRE,
}  # fmt: skip
SOLVERS = pytest.mark.parametrize(
    "solver", ["RK44", "GeneralizedAlpha", "DOPRI5", "VelocityVerlet"]
)


def build(kind: str, **device: Any) -> tuple[System, Any]:
    system = line([2.0, 3.0], [0.5, -0.4], 300.0) if kind == "line" else bodies(kind)
    rest = 0.0 if kind == "line" else 0.5
    return system, CreateInerter(system.mbs, "strut", system.parts, rest_length=rest, **device)


def stored(system: System, sensor: Any) -> Array:
    """Values of a sensor (times, columns), without the time."""
    return np.array(system.mbs.GetSensorStoredData(sensor))[:, 1:]


@pytest.mark.parametrize("kind", ["line", "RigidBodyRxyz"])
def test_memory_file_and_evaluate_agree(kind: str, tmp_path: Path) -> None:
    system, inerter = build(kind, **DEVICE, **PLAY, dissipatedEnergy=True)
    names = [*QUANTITIES, *inerter.stateNames, "states", "forces"]
    assert "dissipated_energy" in names
    sensors = {
        name: inerter.AddSensor(name, fileName=str(tmp_path / f"{name}.txt")) for name in names
    }
    chosen = settings(END, STEP)
    chosen.solution.precision = 16
    solve(system.mbs, chosen)
    last = inerter.Evaluate()
    last |= dict(zip(inerter.stateNames, last["states"], strict=True))
    last["forces"] = [last[name] for name in ("total", "inertance", "friction")]
    for name, sensor in sensors.items():
        rows = stored(system, sensor)
        assert rows.shape == (round(END / STEP) + 1, np.size(last[name]))
        np.testing.assert_array_equal(rows[-1], np.ravel(last[name]))
        np.testing.assert_array_equal(system.mbs.GetSensorValues(sensor), np.ravel(last[name]))
        assert np.abs(rows).max() > 0.0
        file = np.loadtxt(tmp_path / f"{name}.txt", delimiter=",", comments="#")
        np.testing.assert_allclose(file[:, 1:], rows, rtol=1e-14)
        np.testing.assert_allclose(file[:, 0], STEP * np.arange(len(rows)), atol=1e-12)


@SOLVERS
@pytest.mark.parametrize("kind", ["line", "RigidBodyRxyz"])
def test_forces_belong_to_the_motion(kind: str, solver: str) -> None:
    """At every step but the first, what the reference device says at the same x, v, a, z."""
    system, inerter = build(kind, **DEVICE)
    names = (*QUANTITIES, "states")
    sensors = {name: inerter.AddSensor(name) for name in names}
    solve(system.mbs, settings(END, STEP), solver)
    rows = {name: stored(system, sensor)[1:] for name, sensor in sensors.items()}
    x, v, a = (rows[name][:, 0] for name in ("displacement", "velocity", "acceleration"))
    assert len(x) >= 20
    true = ReferenceDevice(**DEVICE)
    z = rows["states"][:, 0]
    for name, expected in {
        "total": true.force(x, v, a, z),
        "inertance": true.inertance_force(x, v, a, z),
        "friction": true.friction_force(x, v, z),
        "stored_energy": true.stored_energy(x, v, z),
        "dissipated_power": true.dissipated_power(x, v, a, z),
    }.items():
        np.testing.assert_allclose(rows[name][:, 0], expected, rtol=1e-10, atol=1e-9, err_msg=name)
    # the velocity is the rate of the displacement
    if solver != "DOPRI5":
        middle = np.gradient(x, STEP)[1:-1]
        np.testing.assert_allclose(middle, v[1:-1], atol=2e-3 * np.abs(v).max())


@pytest.mark.parametrize("solver", ["RK44", "GeneralizedAlpha"])
def test_the_force_moves_the_mass(solver: str) -> None:
    """Newton's law of one mass with nothing else: m a = -F, at every step."""
    system = line([2.0], [0.5])
    inerter = CreateInerter(system.mbs, "d", [None, system.parts[0]], **DEVICE)
    sensors = [inerter.AddSensor(name) for name in ("acceleration", "total")]
    solve(system.mbs, settings(END, STEP), solver)
    a, total = (stored(system, sensor)[1:, 0] for sensor in sensors)
    np.testing.assert_allclose(2.0 * a, -total, rtol=1e-9, atol=1e-9)
    assert np.abs(total).max() > 1.0


def test_dissipated_energy_is_the_integral_of_the_power() -> None:
    system, inerter = build("line", **DEVICE, dissipatedEnergy=True)
    power, energy = (inerter.AddSensor(name) for name in ("dissipated_power", "dissipated_energy"))
    solve(system.mbs, settings(END, 1e-4))
    p, e = stored(system, power)[:, 0], stored(system, energy)[:, 0]
    added = np.concatenate([[0.0], np.cumsum(0.5 * (p[1:] + p[:-1]) * 1e-4)])
    np.testing.assert_allclose(e, added, atol=1e-4 * e[-1])
    assert np.all(np.diff(e) > 0.0)


def test_without_memory() -> None:
    system, inerter = build("line", **DEVICE)
    sensor = inerter.AddSensor("total", storeInternal=False)
    solve(system.mbs, settings(0.01, STEP))
    assert system.mbs.GetSensorValues(sensor) == inerter.Evaluate()["total"]


def test_names() -> None:
    """Sensors carry the inerter's name; several inerters do not mix."""
    system = line([2.0, 3.0], [0.5, -0.4], 300.0)
    pair = [
        CreateInerter(system.mbs, name, system.parts, inertance=b, viscous=b)
        for name, b in (("a", 1.0), ("b", 3.0))
    ]
    sensors = [inerter.AddSensor("total") for inerter in pair]
    assert system.mbs.GetSensor(pair[0].AddSensor("total"))["name"] not in ("a_total", "b_total")
    solve(system.mbs, settings(END, STEP))
    assert [system.mbs.GetSensor(s)["name"] for s in sensors] == ["a_total", "b_total"]
    first, second = (stored(system, sensor)[1:, 0] for sensor in sensors)
    np.testing.assert_allclose(second, 3.0 * first, rtol=1e-12)


@pytest.mark.parametrize("most", [0, 2000])
def test_a_system_that_grows(most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is read stays the device's when a system is assembled again, however large it is."""
    monkeypatch.setattr(sensors, "MOST", most)
    system, inerter = build("line", **DEVICE)
    names = ("displacement", "total", "states")
    read = [inerter.AddSensor(name) for name in names]
    solve(system.mbs, settings(END, STEP))
    for place in (1, 0):
        body(system.mbs, "RigidBodyRxyz", place)
    second = CreateInerter(system.mbs, "other", [system.parts[0], None], inertance=1.0)
    force = second.AddSensor("total")
    solve(system.mbs, settings(END, STEP))
    last = inerter.Evaluate()
    assert abs(last["total"]) > 1.0
    for name, sensor in zip(names, read, strict=True):
        np.testing.assert_array_equal(stored(system, sensor)[-1], np.ravel(last[name]))
    np.testing.assert_array_equal(stored(system, force)[-1], second.Evaluate()["total"])
