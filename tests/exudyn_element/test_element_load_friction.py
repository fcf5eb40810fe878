"""Load friction on a rigid inertance: its sign is that of the last known acceleration's N."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest
from inerter.reference import ReferenceDevice
from inerter.reference.structure import Structure
from inerter.reference.strut import Strut

pytest.importorskip("exudyn.itemInterface")

from element_systems import Array, line, settings, solve
from inerter.exudyn import CreateInerter

END, MASSES, START, SPRING = 0.5, [25.0, 180.0], [0.3, 0.0], 6e3
DEVICES: dict[str, dict[str, Any]] = {
    "plain": {"inertance": 110.0, "load_friction": 0.2, "transition_velocity": 1e-2},
    "strong, varying, damped": {
        "inertance": 110.0, "inertance_gradient": 5.0, "flywheel_viscous": 30.0,
        "load_friction": 0.6, "transition_velocity": 1e-2,
    },
}  # fmt: skip


@functools.cache
def truth(name: str) -> Array:
    """Displacements and velocities of both masses at the end."""
    made = Structure(
        mass=np.diag(MASSES),
        damping=np.zeros((2, 2)),
        stiffness=SPRING * np.eye(2),
        directions=np.array([[-1.0], [1.0]]),
        struts=(Strut(layout="S2", device=ReferenceDevice(**DEVICES[name])),),
    )
    state = np.zeros(made.nstate)
    state[2:4] = START
    run = made.simulate(
        lambda t: np.zeros(2),
        [0.0, END],
        initial=state,
        method="DOP853",
        rtol=1e-10,
        atol=1e-13,
        max_step=1e-3,
    )
    return np.concatenate([run.position[-1], run.velocity[-1]])


def run(name: str, solver: str, step: float) -> tuple[float, dict[str, Array]]:
    """Relative error of the end, and what sensors measured on the way."""
    system = line(MASSES, START, SPRING)
    made = CreateInerter(system.mbs, "d", system.parts, dissipatedEnergy=True, **DEVICES[name])
    quantities = ("velocity", "friction", "inertance", "stored_energy", "dissipated_energy")
    sensors = {name: made.AddSensor(name) for name in quantities}
    solve(system.mbs, settings(END, step), solver)
    found = np.concatenate([system.positions, system.velocities])
    true, rows = truth(name), {}
    for key, sensor in sensors.items():
        rows[key] = np.array(system.mbs.GetSensorStoredData(sensor))[:, 1]
    half = [slice(0, 2), slice(2, 4)]
    error = max(np.abs(found[h] - true[h]).max() / np.abs(true[h]).max() for h in half)
    kinetic = 0.5 * np.array(MASSES) @ system.velocities**2
    energy = kinetic + 0.5 * SPRING * system.positions @ system.positions
    rows["all"] = np.array([energy + rows["stored_energy"][-1] + rows["dissipated_energy"][-1]])
    return float(error), rows


@pytest.mark.parametrize("solver", ["RK44", "GeneralizedAlpha", "TrapezoidalIndex2"])
@pytest.mark.parametrize("name", DEVICES)
def test_it_converges_to_the_reference(name: str, solver: str) -> None:
    """Where the corner falls within a step makes errors uneven; all stay below one of 2nd order."""
    for step in (4e-3, 2e-3, 1e-3):
        assert run(name, solver, step)[0] < 100.0 * step**2


@pytest.mark.parametrize("name", DEVICES)
def test_its_power_is_never_negative(name: str) -> None:
    """Friction mu |N| tanh(v / v_t) has the velocity's sign; it is nearly all of mu |N|."""
    _, rows = run(name, "RK44", 5e-4)
    assert np.all(rows["friction"] * rows["velocity"] >= 0.0)
    share = DEVICES[name]["load_friction"] * np.abs(rows["inertance"])
    assert np.all(np.abs(rows["friction"]) <= share * (1.0 + 1e-12))
    fast = np.abs(rows["velocity"]) > 0.05
    assert fast.sum() > 100
    np.testing.assert_allclose(np.abs(rows["friction"][fast]), share[fast], rtol=1e-3)
    assert np.all(np.diff(rows["dissipated_energy"]) >= 0.0)


@pytest.mark.parametrize("name", DEVICES)
def test_energy_balance_within_what_the_late_sign_costs(name: str) -> None:
    before = 0.5 * MASSES[0] * START[0] ** 2 + 0.5 * DEVICES[name]["inertance"] * START[0] ** 2
    off = [abs(run(name, "RK44", step)[1]["all"][0] / before - 1.0) for step in (2e-3, 5e-4)]
    assert off[0] < 2e-2
    assert off[1] < off[0] / 3.0


def test_a_steady_pull() -> None:
    """By hand: F = (m + b (1 + mu)) a, once v is well above v_t; one coordinate alone."""
    system = line([4.0], [1.0])
    made = CreateInerter(
        system.mbs, "d", [None, system.parts[0]], inertance=2.0, load_friction=0.5,
        transition_velocity=1e-3, force_offset=-21.0,
    )  # fmt: skip
    solve(system.mbs, settings(0.1, 1e-3))
    said = made.Evaluate()
    assert said["acceleration"] == pytest.approx(21.0 / (4.0 + 2.0 * 1.5), rel=1e-12)
    assert said["inertance"] == pytest.approx(6.0, rel=1e-12)
    assert said["friction"] == pytest.approx(3.0, rel=1e-12)


DEVICES_WITH_MEMORY: dict[str, dict[str, Any]] = {
    "dahl": {"coulomb_force": 40.0, "bristle_stiffness": 2e4},
    "lugre": {"coulomb_force": 40.0, "bristle_stiffness": 2e4, "bristle_damping": 100.0},
}


@pytest.mark.parametrize("law", DEVICES_WITH_MEMORY)
def test_a_load_on_a_bristle(law: str) -> None:
    """The rate follows the latest acceleration: order one under RK44, two where it iterates."""
    given = DEVICES_WITH_MEMORY[law] | {"friction": law, "inertance": 110.0, "load_friction": 0.2}
    DEVICES[law] = given
    try:
        for solver, error in (("RK44", 4.0), ("GeneralizedAlpha", 0.3)):
            for step in (2e-3, 1e-3):
                bound = error * step if solver == "RK44" else error * step**2 * 1e3
                assert run(law, solver, step)[0] < bound
        before = 0.5 * MASSES[0] * START[0] ** 2 + 0.5 * 110.0 * START[0] ** 2
        rows = run(law, "RK44", 1e-3)[1]
        assert rows["all"][0] == pytest.approx(before, rel=1e-6)
        assert np.all(np.diff(rows["dissipated_energy"]) >= 0.0)
    finally:
        del DEVICES[law]
