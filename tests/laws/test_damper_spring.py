"""Dampers behind a spring: the tellings agree; a Maxwell element, limits, order, energy."""

from typing import Any

import numpy as np
import pytest
from core_draws import around
from inerter.core import Device, DeviceError
from inerter.exudyn import device as element
from inerter.exudyn.functions import NUMBERS
from inerter.exudyn.parameters import Parameters
from inerter.reference import ReferenceDevice, response, sine_motion
from tellings import told_alike

VALVE: dict[str, Any] = {
    "viscous": 3e3, "quadratic_damping": 200.0, "damping_asymmetry": 0.4, "damping_knee": 0.05,
    "damping_beyond": 0.2, "damper_stiffness": 2e5,
}  # fmt: skip
SHAPES: dict[str, dict[str, Any]] = {
    "straight": {},
    "quadratic": {"quadratic_damping": 500.0},
    "digressive": {"damping_knee": 0.05, "damping_beyond": 0.1},
    "progressive": {"damping_knee": 0.05, "damping_beyond": 3.0, "damping_sharpness": 6.0},
    "a power": {"damping_knee": 0.05, "damping_beyond": 0.0, "damping_exponent": 0.4},
    "each way": {"damping_knee": 0.05, "damping_beyond": 0.1, "damping_knee_back": 0.1,
                 "damping_beyond_back": 0.3, "damping_asymmetry": -0.3},
    "levels off": {"damping_knee": 0.05, "damping_beyond": 0.0, "damping_sharpness": 4.0},
}  # fmt: skip


def moving(h: float, size: float = 0.02, frequency: float = 2.0, count: int = 0) -> tuple[Any, ...]:
    """A sine: displacement, velocity, acceleration, every h seconds for a second."""
    t, w = h * np.arange(count or round(1.0 / h) + 1), 2.0 * np.pi * frequency
    return size * np.sin(w * t), size * w * np.cos(w * t), -size * w * w * np.sin(w * t)


def draw(rng: np.random.Generator) -> dict[str, Any]:
    """Dampers of any shape behind a spring, beside friction, a branch, a shaft."""
    p: dict[str, Any] = {
        "viscous": around(rng, 300.0), "damper_stiffness": around(rng, 1e4), "inertance": 20.0,
        "stiffness": 1e3,
    } | SHAPES[str(rng.choice(list(SHAPES)))]  # fmt: skip
    if rng.random() < 0.4:
        p |= {"friction": "dahl", "coulomb_force": 10.0, "bristle_stiffness": 1e5}
    if rng.random() < 0.4:
        p |= {"branch_stiffness_1": 2e4, "branch_damping_1": 800.0}
    if rng.random() < 0.4:
        p |= {"series_stiffness": 1e5, "series_damping": 100.0}
    if rng.random() < 0.4:
        p |= {"control": "stiffness", "control_lower": 500.0, "control_upper": 2e3}
        p |= {"control_lag": 0.1}
    return p


def test_three_tellings_are_one() -> None:
    rng = np.random.default_rng(3)
    for _ in range(100):
        p = draw(rng)
        sizes = {"friction_state": 1e-4, "damper_velocity": 0.3, "flywheel_velocity": 0.3}
        core, z, x, v, a, found = told_alike(rng, p, sizes)
        assert "damper_velocity" in core.state_names
        if "control" in p:
            continue
        own = Parameters.of(core)
        for i in range(20):
            row = z[i].tolist()
            forces = element.forces(own, x[i], v[i], a[i], row)
            heat = element.dissipated_power(NUMBERS, own, x[i], v[i], row, forces["inertance"])
            energy = element.stored_energy(own, x[i], v[i], row)
            rates = np.zeros(core.nstate)
            for term in element.terms(NUMBERS, own, x[i], v[i], row):
                for at, factor in term.rates:
                    rates[at] += factor * float(term.value)
            at = core.state_names.index("damper_velocity")
            assert rates[at] == pytest.approx(found["state_rate"].reshape(20, -1)[i, at], rel=1e-12)
            assert forces["total"] == pytest.approx(found["total"][i], rel=1e-9, abs=1e-6)
            assert energy == pytest.approx(found["stored_energy"][i], rel=1e-12)
            assert heat == pytest.approx(found["dissipated_power"][i], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("shape", SHAPES)
def test_the_slope_is_that_of_the_force(shape: str) -> None:
    """That of D in w' = k_d (v - w) / D'(w), by differences of the dampers without a spring."""
    rigid = Device(viscous=3e3, **SHAPES[shape])
    device = rigid.replace(damper_stiffness=1e5)
    w = np.linspace(-0.3, 0.3, 62)
    near = 1e-6
    slope = (
        rigid.evaluate(0.0, w + near, 0.0, 0.0)["total"]
        - rigid.evaluate(0.0, w - near, 0.0, 0.0)["total"]
    ) / (2.0 * near)
    found = device.evaluate(0.0, 1.0, 0.0, w)["state_rate"]
    assert np.allclose(found, 1e5 * (1.0 - w) / slope, rtol=1e-5)


def test_a_straight_damper_is_a_maxwell_element() -> None:
    x, v, a = moving(1e-3)
    one = Device(viscous=3e3, damper_stiffness=2e5)
    other = Device(branch_stiffness_1=2e5, branch_damping_1=3e3)
    mine, branch = one.along(1e-3, x, v, a), other.along(1e-3, x, v, a)
    size = np.ptp(branch["total"])
    assert np.max(np.abs(mine["total"] - branch["total"])) < 1e-12 * size
    # F = D(w) = K e
    assert np.allclose(mine["state"] * 3e3, branch["state"] * 2e5, rtol=0.0, atol=1e-12 * size)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("stiffness", [5e4, 2e6])
def test_along_a_motion_the_core_is_the_reference(shape: str, stiffness: float) -> None:
    p: dict[str, Any] = {"viscous": 3e3, "damper_stiffness": stiffness, **SHAPES[shape]}
    motion, h = sine_motion(0.02, 2.0), 2e-3
    t = h * np.arange(251, dtype=np.float64)
    start = float(motion.velocity(0.0))
    told = Device(**p).along(
        h, motion.displacement(t), motion.velocity(t), motion.acceleration(t), start
    )
    true = response(ReferenceDevice(**p), motion, t, initial_state=np.array([start]))
    assert np.max(np.abs(told["total"] - true.force)) < 5e-5 * np.ptp(true.force)


def test_a_stiff_spring_is_none() -> None:
    x, v, a = moving(1e-3)
    rigid = Device(**VALVE | {"damper_stiffness": 0.0}).along(1e-3, x, v, a)["total"]
    errors = []
    for stiffness in (1e7, 1e8, 1e9):
        device = Device(**VALVE | {"damper_stiffness": stiffness})
        found = device.along(1e-3, x, v, a, v[0])["total"]
        errors.append(np.max(np.abs(found - rigid)) / np.ptp(rigid))
    assert errors[0] < 0.02
    # late by D' / k: the error goes with 1 / k
    assert errors[1] == pytest.approx(0.1 * errors[0], rel=0.2)
    assert errors[2] == pytest.approx(0.1 * errors[1], rel=0.2)


def test_the_force_over_a_step_never_falls_and_is_that_of_the_instant_in_the_limit() -> None:
    device = Device(**VALVE)
    now = device.evaluate(0.0, 0.2, 0.0, 0.1)["total"][0]
    found = device.over_step(0.0, 0.2, 0.0, [0.1], 1e-9, 1.0)[0]["total"]
    assert found == pytest.approx(now, rel=1e-5)
    for h in (1e-5, 1e-3, 1e-1, 10.0):
        for mobility in (1e-3, 1.0, 1e3):
            force = [
                device.over_step(0.0, 0.2, a, [0.1], h, mobility)[0]["total"]
                for a in np.linspace(-9.0, 9.0, 37) / h
            ]
            assert np.all(np.diff(force) >= -1e-9 * np.ptp(force))


def test_steps_at_constant_velocity_are_those_of_the_equation() -> None:
    device = Device(**VALVE)
    whole = device.step(0.0, 0.3, 0.0, 0.02)
    part = 0.0
    for _ in range(2000):
        part = device.step(0.0, 0.3, part, 1e-5)
    assert whole == pytest.approx(part, rel=1e-5)
    assert device.step(0.0, 0.3, 0.0, 1e3) == pytest.approx(0.3, rel=1e-12)


def test_a_damper_that_has_levelled_off_follows_at_once() -> None:
    """Its slope there is below any number."""
    level = Device(viscous=1e3, damping_knee=1e-3, damping_beyond=0.0, damping_sharpness=64.0,
                   damper_stiffness=1e5)  # fmt: skip
    assert level.step(0.0, 20.0, 1e3, 1e-3) == 20.0
    assert level.over_step(0.0, 20.0, 0.0, [1e3], 1e-3, 1.0)[0]["total"] == pytest.approx(1.0)


def test_work_is_stored_or_heat() -> None:
    x, v, a = moving(1e-4)
    device = Device(**VALVE)
    found = device.along(1e-4, x, v, a)
    told = device.evaluate(x, v, a, found["states"])
    work = np.trapezoid(found["total"] * v, dx=1e-4)
    heat = np.trapezoid(told["dissipated_power"], dx=1e-4)
    stored = told["stored_energy"][-1] - told["stored_energy"][0]
    assert np.all(told["dissipated_power"] >= 0.0)
    assert work == pytest.approx(heat + stored, rel=1e-5)


def test_a_first_force_finds_the_dampers_moving() -> None:
    device = Device(**VALVE, friction="dahl", coulomb_force=100.0, bristle_stiffness=1e5)
    rigid = device.replace(damper_stiffness=0.0)
    z = device.state_of_force(0.0, 0.2, 0.0, 700.0)
    assert isinstance(z, np.ndarray)
    assert z[1] == 0.2
    assert z[0] == pytest.approx(rigid.state_of_force(0.0, 0.2, 0.0, 700.0))


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"viscous": 0.0}, "viscous is 0 N.s/m"),
        ({"damping_exponent": -0.5}, "damping_exponent -0.5"),
        (
            {"damping_exponent": -0.5, "damping_knee": 0.0, "damping_knee_back": 0.1},
            "exponent -0.5",
        ),
        ({"viscous_periods": "0.1 10 0"}, "along the stroke"),
        ({"control": "viscous", "control_lower": 1.0, "control_upper": 9e3}, "control"),
    ],
)
def test_what_cannot_be_behind_a_spring_is_refused(values: dict[str, Any], message: str) -> None:
    with pytest.raises(DeviceError, match=message) as caught:
        Device(**VALVE | values)
    assert "damper_stiffness is 200000 N/m" in str(caught.value)
    with pytest.raises(ValueError, match="damper_stiffness"):
        ReferenceDevice(**VALVE | values)
