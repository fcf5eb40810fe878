"""A control that sets a parameter: closed forms, energy with the actuator, both tellings."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from core_draws import draw_branches, draw_friction, draw_series
from inerter.core import Device, DeviceError, controls, parameters
from inerter.reference import ReferenceDevice
from scipy.integrate import solve_ivp

SETS = tuple(name for name in controls() if name != "force")
CHANNEL = {
    "piston_area": 1.6e-3, "channel_area": 3e-5, "channel_length": 1.3, "fluid_density": 998.0,
    "fluid_viscosity": 1e-3,
}  # fmt: skip


def bounds(name: str, p: dict[str, Any]) -> tuple[float, float]:
    """Around the value that a device has."""
    value = p.get(name, 1.0) or 1.0
    if name == "coulomb_force":
        return 0.5 * value, min(2.0 * value, p.get("static_force", np.inf))
    if name == "static_force":
        return p["coulomb_force"], 3.0 * p["coulomb_force"]
    return (0.2 * value, 3.0 * value) if value > 0 else (3.0 * value, 0.2 * value)


def drawn(rng: np.random.Generator, name: str, lag: float, series: bool = False) -> dict[str, Any]:
    """A device with the parameter that the control sets, and others around it."""
    law = {"coulomb_force": "lugre", "static_force": "stribeck", "bw_stiffness": "bouc_wen"}
    p = draw_friction(rng, law.get(name, str(rng.choice(["none", "coulomb", "dahl"]))))
    p |= draw_branches(rng) | {"flywheel_viscous": float(rng.uniform(1.0, 50.0))}
    if name == "minor_loss":
        del p["inertance"]
        p |= CHANNEL | {"minor_loss": 1.0}
    if series:
        p |= draw_series(rng, backlash=False)
        p |= {"friction_side": str(rng.choice(["terminals", "flywheel"]))}
        p["load_friction"] = min(p["load_friction"], 0.9)
    if rng.random() < 0.5:
        p |= {"branch_stiffness_1": 1e4, "branch_damping_1": 200.0}
    lower, upper = bounds(name, p)
    start = float(np.clip(p.get(name, lower), lower, upper))
    return p | {
        name: start, "control": name, "control_lower": lower, "control_upper": upper,
        "control_lag": lag,
    }  # fmt: skip


def points(rng: np.random.Generator, device: Device, count: int = 20) -> tuple[Any, ...]:
    """Motions and states, that of the control within its bounds and beyond."""
    x, v, a = rng.normal(size=(3, count)) * [[0.01], [0.3], [5.0]]
    z = rng.normal(size=(count, device.nstate)) * 1e-4
    if device.nstate and device.state_names[-1] == "control_change":
        z[:, -1] = rng.normal(size=count) * (device.control_upper - device.control_lower)
    return x, v, a, z


@pytest.mark.parametrize("name", SETS)
@pytest.mark.parametrize("lag", [0.0, 0.02])
def test_a_device_at_a_command_is_that_device(name: str, lag: float) -> None:
    rng = np.random.default_rng(5)
    for series in (False, True):
        p = drawn(rng, name, lag, series)
        device = Device(**p)
        x, v, a, z = points(rng, device)
        commands = rng.uniform(p["control_lower"], p["control_upper"], len(x))
        said = device.evaluate(x, v, a, z, command=commands)
        for i, command in enumerate(commands):
            change = z[i, -1] if lag else 0.0
            value = np.clip(p[name] + change if lag else command,
                            p["control_lower"], p["control_upper"])  # fmt: skip
            plain = {key: kept for key, kept in p.items() if not key.startswith("control")}
            fixed = Device(**{**plain, name: float(value)})
            inner = z[i, : fixed.nstate]
            expected = fixed.evaluate(x[i], v[i], a[i], inner)
            for key in ("total", "inertance", "friction", "stored_energy", "dissipated_power"):
                np.testing.assert_allclose(said[key][i], expected[key][0], rtol=1e-12, err_msg=key)
            again = device.commanded(float(command), z[i])
            assert getattr(again, name) == pytest.approx(value, rel=1e-15)
            rates = np.atleast_1d(said["state_rate"][i])
            np.testing.assert_allclose(
                rates[: fixed.nstate], expected["state_rate"].ravel()[: fixed.nstate], rtol=1e-12
            )
            if lag:
                assert rates[-1] == pytest.approx((command - p[name] - change) / lag, rel=1e-12)


@pytest.mark.parametrize("name", SETS)
@pytest.mark.parametrize("lag", [0.0, 0.02])
def test_the_tellings_agree(name: str, lag: float) -> None:
    rng = np.random.default_rng(6)
    for k in range(6):
        p = drawn(rng, name, lag, series=k % 2 == 1)
        command = float(rng.uniform(p["control_lower"], p["control_upper"]))
        device, told = Device(**p), ReferenceDevice(**p, command=command)
        assert device.state_names == told.state_names
        x, v, a, z = points(rng, device)
        said = device.evaluate(x, v, a, z, command=command)
        states = told.state_argument(z)
        expected = {
            "total": told.force(x, v, a, states),
            "inertance": told.inertance_force(x, v, a, states),
            "stored_energy": told.stored_energy(x, v, states),
            "dissipated_power": told.dissipated_power(x, v, a, states),
            "control_power": told.control_power(x, v, states),
        }
        for key, value in expected.items():
            size = np.max(np.abs(value)) + 1e-9
            np.testing.assert_allclose(said[key], value, rtol=1e-9, atol=1e-10 * size, err_msg=key)
        if device.nstate:
            rates = np.asarray(told.state_rate(x, v, states, a=a)).reshape(len(x), device.nstate)
            found = said["state_rate"].reshape(rates.shape)
            np.testing.assert_allclose(found, rates, rtol=1e-9, atol=1e-10 * np.abs(rates).max())


def test_the_lag_is_stepped_exactly() -> None:
    device = Device(inertance=10, viscous=100, control="viscous", control_lower=50,
                    control_upper=900, control_lag=0.03)  # fmt: skip
    h, n = 0.01, 40
    found = device.along(h, np.zeros(n), np.full(n, 0.2), np.zeros(n), command=2000.0)
    t = h * np.arange(n)
    exact = 800.0 * (1 - np.exp(-t / 0.03))
    np.testing.assert_allclose(found["states"][1:, 0], exact[1:], rtol=1e-12)
    np.testing.assert_allclose(found["total"], 0.2 * (100 + found["states"][:, 0]), rtol=1e-12)


def test_without_lag_the_value_is_there_at_once() -> None:
    device = Device(inertance=10, control="inertance", control_lower=5, control_upper=20)
    command = np.array([5.0, 12.0, 1e3, -3.0, np.nan])
    n = len(command)
    found = device.along(0.01, np.zeros(n), np.zeros(n), np.full(n, 2.0), command=command)
    np.testing.assert_array_equal(found["total"], [10.0, 24.0, 40.0, 10.0, 20.0])


@pytest.mark.parametrize("name", ["inertance", "stiffness", "bw_stiffness", "viscous"])
def test_work_is_stored_lost_or_the_actuators(name: str) -> None:
    # F v + P = dE/dt + heat along a motion, integrated
    p: dict[str, Any] = {"inertance": 20.0, "stiffness": 300.0, "viscous": 5.0}
    p |= {"friction": "bouc_wen", "bw_stiffness": 800.0, "bw_beta": 30.0, "bw_gamma": 20.0,
          "bw_ratio": 0.3}  # fmt: skip
    p |= {"control": name, "control_lower": p[name] / 3, "control_upper": 4 * p[name],
          "control_lag": 0.15}  # fmt: skip
    device = Device(**p)
    command = 2.5 * p[name]

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        x, v, a = 0.1 * np.sin(5 * t), 0.5 * np.cos(5 * t), -2.5 * np.sin(5 * t)
        said = device.evaluate(x, v, a, y[:2], command=command)
        work = said["total"] * v + said["control_power"] - said["dissipated_power"]
        return np.concatenate([said["state_rate"][0], work, said["control_power"]])

    path = solve_ivp(rates, (0, 0.7), np.zeros(4), rtol=1e-10, atol=1e-12)
    z = path.y[:2, -1]
    at = device.evaluate(0.1 * np.sin(3.5), 0.5 * np.cos(3.5), 0.0, z, command=command)
    begin = device.evaluate(0.0, 0.5, 0.0, [0.0, 0.0], command=command)
    gained = at["stored_energy"][0] - begin["stored_energy"][0]
    assert path.y[2, -1] == pytest.approx(gained, rel=1e-7)
    # what the actuator gave is no small part, and nothing where nothing is stored
    given = path.y[3, -1]
    assert given == 0.0 if name == "viscous" else abs(given) > 1e-3 * gained


def test_an_inertance_that_is_raised_at_speed_is_paid_for() -> None:
    # steady speed: no force, all of the energy comes from the actuator
    device = Device(inertance=10, control="inertance", control_lower=10, control_upper=30,
                    control_lag=0.1)  # fmt: skip
    n, h, v = 4001, 1e-3, 2.0
    t = h * np.arange(n)
    found = device.along(h, v * t, np.full(n, v), np.zeros(n), command=30.0)
    assert np.abs(found["total"]).max() == 0.0
    said = device.evaluate(v * t, v, 0.0, found["states"], command=30.0)
    paid = np.trapezoid(said["control_power"], dx=h)
    stored = said["stored_energy"][-1] - said["stored_energy"][0]
    assert stored == pytest.approx(0.5 * 20 * v**2, rel=1e-9)
    assert paid == pytest.approx(stored, rel=1e-4)


def test_dampers_and_friction_are_passive_at_any_command() -> None:
    rng = np.random.default_rng(8)
    for name in ("viscous", "quadratic_damping", "flywheel_viscous", "coulomb_force"):
        device = Device(**drawn(rng, name, 0.02))
        x, v, a, z = points(rng, device)
        # no state of a bristle beyond what it can hold
        z[:, :-1] = 0.0
        said = device.evaluate(x, v, a, z, command=rng.uniform(-1e3, 1e4, len(x)))
        np.testing.assert_array_equal(said["control_power"], 0.0)
        size = np.abs(said["total"] * v).max()
        assert said["dissipated_power"].min() >= -1e-12 * size


def test_a_step_with_a_lag_keeps_the_energy_of_the_tellings() -> None:
    # force over a step moves the control's state as the plain step does
    device = Device(inertance=10, viscous=100, control="viscous", control_lower=50,
                    control_upper=900, control_lag=0.03)  # fmt: skip
    _, end = device.over_step(0.0, 0.1, 0.0, [40.0], 0.01, 0.1)
    assert end[0] == pytest.approx(40.0 * np.exp(-0.01 / 0.03), rel=1e-14)
    assert device.step(0.0, 0.1, 40.0, 0.01) == pytest.approx(end[0], rel=1e-15)


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"control": "vicous"}, "choose one of force viscous"),
        ({"control": "viscous"}, "control_lower is not given"),
        ({"control": "viscous", "control_lower": 3.0}, "control_upper is not given"),
        ({"control_lag": 0.1}, 'control is "force"'),
        ({"control_upper": 4.0}, 'control is "force"'),
        ({"viscous": 4, "control": "viscous", "control_lower": 5, "control_upper": 6}, "from 5 to"),
        ({"control": "viscous", "control_lower": 6, "control_upper": 5}, "not below"),
        ({"control": "viscous", "control_lower": -6, "control_upper": 5}, "control_lower is -6"),
        ({"control": "coulomb_force", "control_lower": 1, "control_upper": 5}, "friction"),
        ({"control": "minor_loss", "control_lower": 1, "control_upper": 5}, "channel"),
    ],
)
def test_refusals(values: dict[str, Any], says: str) -> None:
    with pytest.raises(DeviceError, match=says):
        Device(**values)
    if values.get("control") != "coulomb_force":
        # the reference leaves a parameter that no law reads alone
        with pytest.raises(ValueError, match=r"control|channel|viscous"):
            ReferenceDevice(**values)


def test_a_friction_level_may_open_but_no_bristle() -> None:
    values = {"control": "coulomb_force", "control_lower": 0.0, "control_upper": 5.0}
    open_clutch = Device(friction="coulomb", **values)
    ReferenceDevice(friction="coulomb", **values)
    assert open_clutch.evaluate(0, 1.0, 0, 0)["total"][0] == 0.0
    assert open_clutch.evaluate(0, 1.0, 0, 0, command=3.0)["total"][0] == pytest.approx(3.0)
    for make in (Device, ReferenceDevice):
        with pytest.raises(ValueError, match="coulomb_force"):
            make(friction="lugre", **values)


def test_every_control_is_a_parameter() -> None:
    assert set(SETS) < set(parameters())
