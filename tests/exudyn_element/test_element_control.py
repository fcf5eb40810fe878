"""A control that sets a parameter of the element: laws as the core's, runs as closed forms."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest
from inerter import Device

pytest.importorskip("exudyn.itemInterface")

from element_systems import bodies, line, push, settings, solve
from inerter.core import controls
from inerter.exudyn import CreateInerter, control
from inerter.exudyn import device as law
from inerter.exudyn.functions import NUMBERS
from inerter.exudyn.parameters import Parameters

BASE: dict[str, Any] = {
    "inertance": 3.0, "viscous": 20.0, "quadratic_damping": 8.0, "flywheel_viscous": 2.0,
    "stiffness": 400.0, "inertance_gradient": 2.0,
}  # fmt: skip
SPECIAL: dict[str, dict[str, Any]] = {
    "coulomb_force": {"friction": "lugre", "coulomb_force": 5.0},
    "static_force": {"friction": "stribeck", "coulomb_force": 2.0, "static_force": 5.0},
    "bw_stiffness": {"friction": "bouc_wen", "bw_stiffness": 600.0, "bw_ratio": 0.3},
    "minor_loss": {"piston_area": 1e-3, "channel_area": 2e-4, "channel_length": 0.6,
                   "minor_loss": 2.0, "fluid_viscosity": 1e-3},
}  # fmt: skip
SERIES = {"series_stiffness": 4e3, "series_damping": 20.0}
SETS = tuple(name for name in controls() if name != "force")


def values(name: str, lag: float, **more: Any) -> dict[str, Any]:
    p = BASE | SPECIAL.get(name, {}) | more
    if name == "minor_loss":
        del p["inertance"]
    least = 2.0 if name == "static_force" else 0.3 * p[name]
    return p | {"control": name, "control_lower": least, "control_upper": 2.5 * p[name],
                "control_lag": lag}  # fmt: skip


@pytest.mark.parametrize("name", SETS)
@pytest.mark.parametrize("more", [{}, SERIES, {**SERIES, "friction_side": "flywheel"}])
@pytest.mark.parametrize("lag", [0.0, 0.05])
def test_forces_rates_and_energies_are_the_cores(name: str, more: dict, lag: float) -> None:
    rng = np.random.default_rng(3)
    device = Device(**values(name, lag, **more))
    for _ in range(8):
        x, v, a = (rng.normal(size=3) * [0.02, 0.5, 4.0]).tolist()
        z = rng.normal(size=device.nstate) * 1e-3
        command = float(rng.uniform(-0.5, 4.0) * BASE.get(name, 5.0))
        if lag:
            z[-1] = rng.normal() * (device.control_upper - device.control_lower)
        p = control.present(NUMBERS, Parameters.of(device, False, command), z.tolist())
        true = device.evaluate(x, v, a, z if device.nstate else 0.0, command=command)
        said = law.forces(p, x, v, a, z.tolist())
        said["stored_energy"] = law.stored_energy(p, x, v, z.tolist())
        through = said["inertance"]
        said["dissipated_power"] = law.dissipated_power(NUMBERS, p, x, v, z.tolist(), through)
        for key, value in said.items():
            assert value == pytest.approx(true[key][0], rel=1e-11, abs=1e-10), key
        rates = np.zeros(device.nstate)
        for term in law.terms(NUMBERS, p, x, v, z.tolist()):
            for place, share in term.rates:
                rates[place] += share * term.value
        np.testing.assert_allclose(rates, true["state_rate"].ravel()[: device.nstate], rtol=1e-11)


@pytest.mark.parametrize("solver", ["GeneralizedAlpha", "TrapezoidalIndex2", "RK44", "RK67"])
def test_a_mass_behind_a_damper_that_rises(solver: str) -> None:
    # m v' = -c v, c = c1 + (c0 - c1) exp(-t / T)
    system = line([4.0], [1.5])
    made = CreateInerter(
        system.mbs, "d", [None, system.parts[0]], inertance=1.0, viscous=2.0, control="viscous",
        control_lower=1.0, control_upper=50.0, control_lag=0.1,
    )  # fmt: skip
    made.SetControl(30.0)
    solve(system.mbs, settings(0.3, 1e-3 if "RK" in solver else 1e-4), solver)
    spent = 30.0 * 0.3 - 28.0 * 0.1 * (1.0 - np.exp(-3.0))
    assert system.velocities[0] == pytest.approx(1.5 * np.exp(-spent / 5.0), rel=1e-6)
    assert made.GetStates()[0] == pytest.approx(28.0 * (1.0 - np.exp(-3.0)), rel=1e-6)


@pytest.mark.parametrize("lag", [0.0, 0.1])
@pytest.mark.parametrize("place", ["line", "space"])
def test_an_inertance_that_rises(lag: float, place: str) -> None:
    # 6 N on m + b(t)
    rise = {"inertance": 1.0, "control": "inertance", "control_lower": 1.0, "control_upper": 9.0}
    if place == "line":
        system = line([2.0], [0.0])
        push(system.mbs, system.parts[0], 6.0)
        made = CreateInerter(system.mbs, "d", [None, system.parts[0]], control_lag=lag, **rise)
        made.SetControl(9.0)
        solve(system.mbs, settings(0.4, 1e-3))
        mass = 11.0 - 8.0 * np.exp(-np.linspace(0, 0.4, 4001) / lag) if lag else np.full(4001, 11.0)
        speed = np.trapezoid(6.0 / mass, dx=1e-4)
        assert system.velocities[0] == pytest.approx(speed, rel=1e-6)
        return
    system = bodies("Point")
    made = CreateInerter(system.mbs, "d", system.parts, control_lag=lag, **rise)
    system.mbs.Assemble()
    before = made.Evaluate()
    made.SetControl(5.0)
    after = made.Evaluate()
    assert after["stored_energy"] == pytest.approx(before["stored_energy"] * (1 if lag else 5))


def test_a_control_changes_as_the_run_goes_on() -> None:
    # from 0.1 s on a second damping, at once
    system = line([4.0], [1.0])
    made = CreateInerter(
        system.mbs, "d", [None, system.parts[0]], viscous=4.0, control="viscous",
        control_lower=4.0, control_upper=80.0,
    )  # fmt: skip

    def decide(mbs: Any, t: float) -> bool:
        made.SetControl(40.0 if t > 0.1 + 1e-6 else 4.0)
        return True

    system.mbs.SetPreStepUserFunction(decide)
    solve(system.mbs, settings(0.2, 1e-3))
    assert system.velocities[0] == pytest.approx(np.exp(-0.1 - 1.0), rel=1e-5)


def test_set_keeps_the_command() -> None:
    system = line([4.0], [1.0])
    made = CreateInerter(
        system.mbs, "d", [None, system.parts[0]], viscous=4.0, control="viscous",
        control_lower=4.0, control_upper=80.0,
    )  # fmt: skip
    system.mbs.Assemble()
    made.SetControl(500.0)
    made.set(stiffness=3.0)
    assert made.Evaluate()["total"] == pytest.approx(80.0)


def test_rate_and_state_friction_is_the_cores() -> None:
    rng = np.random.default_rng(4)
    law_of = {"friction": "rate_state", "coulomb_force": 7.0, "transition_velocity": 1e-3}
    for more in ({}, SERIES, {**SERIES, "friction_side": "flywheel"}):
        device = Device(**{**BASE, **law_of, **more})
        for _ in range(20):
            x, v, a = (rng.normal(size=3) * [0.02, 0.5, 4.0]).tolist()
            z = rng.normal(size=device.nstate) * 1e-3
            z[0] = rng.normal() * 4.0
            p, true = Parameters.of(device), device.evaluate(x, v, a, z)
            for key, value in law.forces(p, x, v, a, z.tolist()).items():
                assert value == pytest.approx(true[key][0], rel=1e-11, abs=1e-10), key
            rates = np.zeros(device.nstate)
            for term in law.terms(NUMBERS, p, x, v, z.tolist()):
                for place, share in term.rates:
                    rates[place] += share * term.value
            np.testing.assert_allclose(
                rates, true["state_rate"].ravel()[: device.nstate], rtol=1e-11
            )


def test_refusals() -> None:
    system = line([4.0], [1.0])
    plain = CreateInerter(system.mbs, "d", [None, system.parts[0]], inertance=4.0)
    with pytest.raises(ValueError, match='its control is "force"'):
        plain.SetControl(3.0)
    semi = CreateInerter(
        system.mbs, "e", [None, system.parts[0]], control="viscous", control_lower=4.0,
        control_upper=80.0, control_lag=0.1,
    )  # fmt: skip
    assert not semi.symbolic
    with pytest.raises(ValueError, match="finite"):
        semi.SetControl(float("nan"))


def test_a_command_is_taken_in_little_time() -> None:
    # recorded anew: one part in a thousand of a second, more on a busy machine
    system = line([4.0], [1.0])
    made = CreateInerter(
        system.mbs, "d", [None, system.parts[0]], viscous=4.0, control="viscous",
        control_lower=4.0, control_upper=80.0, control_lag=0.1,
    )  # fmt: skip
    system.mbs.Assemble()
    start = time.process_time()
    for i in range(50):
        made.SetControl(5.0 + i)
    assert (time.process_time() - start) / 50 < 0.02
