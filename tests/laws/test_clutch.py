"""What slips before the inertance: the tellings agree; limits, order, energy, one way."""

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

SHAFT: dict[str, Any] = {"inertance": 50.0, "series_stiffness": 4e5, "series_damping": 200.0}
SLIPS: dict[str, dict[str, Any]] = {
    "clutch": {**SHAFT, "clutch_force": 150.0},
    "uneven": {**SHAFT, "clutch_force": 150.0, "clutch_asymmetry": 0.5},
    "one way": {**SHAFT, "clutch_force": 1e6, "clutch_asymmetry": -1.0},
    "laminar": {"inertance": 50.0, "leak_damping": 1500.0},
    "turbulent": {"inertance": 50.0, "leak_damping": 100.0, "leak_quadratic_damping": 4e4},
    "orifice": {"inertance": 50.0, "leak_quadratic_damping": 4e4},
    "behind a spring": {"inertance": 50.0, "series_stiffness": 2e5, "leak_damping": 800.0,
                        "leak_quadratic_damping": 4e4},
    "behind a soft one": {**SHAFT, "series_hardening": 30.0, "leak_damping": 800.0},
    "clutch that leaks": {**SHAFT, "clutch_force": 60.0, "leak_damping": 800.0},
    "undamped shaft": {"inertance": 50.0, "series_stiffness": 2e5, "clutch_force": 60.0,
                       "leak_damping": 800.0},
}  # fmt: skip


def draw(rng: np.random.Generator) -> dict[str, Any]:
    """What slips, beside friction on either side, a ratio that varies, a branch, a control."""
    p = SLIPS[str(rng.choice(list(SLIPS)))] | {"viscous": around(rng, 50.0)}
    p["inertance"] = around(rng, 40.0)
    if rng.random() < 0.4:
        p |= {"inertance_gradient": 2.0, "flywheel_viscous": 20.0}
    if rng.random() < 0.4:
        p |= {"friction": "dahl", "coulomb_force": 10.0, "bristle_stiffness": 1e5}
        p["friction_side"] = str(rng.choice(["terminals", "flywheel"]))
    if rng.random() < 0.4:
        p |= {"branch_stiffness_1": 2e4, "branch_damping_1": 800.0}
    if rng.random() < 0.3:
        p |= {"control": "stiffness", "control_lower": 0.0, "control_upper": 2e3}
        p |= {"control_lag": 0.1}
    return p


def test_three_tellings_are_one() -> None:
    rng = np.random.default_rng(4)
    for _ in range(150):
        p = draw(rng)
        sizes = {"friction_state": 1e-4, "flywheel_velocity": 0.3}
        core, z, x, v, a, found = told_alike(rng, p, sizes)
        at = core.state_names.index("slip_position")
        assert np.all(found["dissipated_power"] >= -1e-12 * np.abs(found["total"] * v).max())
        if "control" in p:
            continue
        own = Parameters.of(core)
        for i in range(20):
            row = z[i].tolist()
            forces = element.forces(own, x[i], v[i], a[i], row)
            heat = element.dissipated_power(NUMBERS, own, x[i], v[i], row, forces["inertance"])
            rates = np.zeros(core.nstate)
            for term in element.terms(NUMBERS, own, x[i], v[i], row):
                for place, factor in term.rates:
                    rates[place] += factor * float(term.value)
            assert rates[at] == pytest.approx(found["state_rate"][i, at], rel=1e-9, abs=1e-12)
            assert forces["total"] == pytest.approx(found["total"][i], rel=1e-9, abs=1e-6)
            assert heat == pytest.approx(found["dissipated_power"][i], rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("kind", SLIPS)
def test_along_a_motion_the_core_is_the_reference(kind: str) -> None:
    motion, h = sine_motion(0.02, 2.0), 1e-3
    t = h * np.arange(1001, dtype=np.float64)
    true = response(ReferenceDevice(**SLIPS[kind]), motion, t)
    told = Device(**SLIPS[kind]).along(
        h, motion.displacement(t), motion.velocity(t), motion.acceleration(t)
    )
    size = np.ptp(true.force)
    # one that begins to slip does so between two samples
    assert np.max(np.abs(told["total"] - true.force)) < 1e-3 * size
    assert np.sqrt(np.mean((told["total"] - true.force) ** 2)) < 1e-4 * size


@pytest.mark.parametrize("dashpot", ["leak_damping", "series_damping"])
def test_a_dashpot_alone_is_a_low_pass_of_the_first_order(dashpot: str) -> None:
    """B w' = c (v - w) - c_w w from rest, along a cosine: exact but for what a quintic misses."""
    motion, t = sine_motion(0.02, 2.0, 0.5 * np.pi), np.arange(0.0, 1.0, 2e-3)
    along = (2e-3, motion.displacement(t), motion.velocity(t), motion.acceleration(t))
    w = 4.0 * np.pi
    for size, own in ((1500.0, 0.0), (1500.0, 70.0), (1e7, 0.0), (1e-3, 0.0)):
        device = Device(inertance=50.0, flywheel_viscous=own, **{dashpot: size})
        found = device.along(*along)
        rate = (size + own) / 50.0
        peak = -0.02 * w * size / 50.0 / (rate * rate + w * w)
        flywheel = peak * (rate * np.sin(w * t) - w * (np.cos(w * t) - np.exp(-rate * t)))
        assert np.allclose(found["states"][:, 1], flywheel, rtol=0.0, atol=1e-10)
        assert np.allclose(found["total"], size * (along[2] - flywheel), rtol=0.0, atol=1e-3)


def test_a_leak_that_bends_is_followed_in_second_order() -> None:
    motion = sine_motion(0.02, 2.0, 0.5 * np.pi)
    device, errors = Device(**SLIPS["turbulent"]), []
    t = np.arange(0.0, 1.0, 4e-3)
    true = response(ReferenceDevice(**SLIPS["turbulent"]), motion, t, rtol=1e-11)
    for parts in (1, 16):
        fine = np.arange(0.0, 1.0, 4e-3 / parts)
        found = device.along(
            4e-3 / parts,
            motion.displacement(fine), motion.velocity(fine), motion.acceleration(fine),
        )  # fmt: skip
        errors.append(float(np.abs(found["total"][::parts] - true.force).max()))
    assert errors[0] < 1e-3 * np.ptp(true.force)
    # steps are divided where they are long
    assert errors[1] < 0.03 * errors[0]


@pytest.mark.parametrize("rate", [2.0, 20.0])
def test_a_leak_too_quick_for_the_samples_is_followed(rate: float) -> None:
    """Up to some hundred time constants of the leak in a sample of 2 ms."""
    motion, h = sine_motion(0.02, 2.0), 2e-3
    p: dict[str, Any] = {
        "inertance": 1.0,
        "leak_damping": 5e2 * rate,
        "leak_quadratic_damping": 2e5 * rate,
    }
    t = h * np.arange(501, dtype=np.float64)
    told = Device(**p).along(h, motion.displacement(t), motion.velocity(t), motion.acceleration(t))
    true = response(ReferenceDevice(**p), motion, t, rtol=1e-9)
    # the flywheel comes up to speed within the first samples
    assert np.max(np.abs(told["total"] - true.force)[5:]) < 1e-3 * np.ptp(true.force[5:])


def test_a_clutch_bears_its_force_and_no_more() -> None:
    device, motion = Device(**SLIPS["uneven"]), sine_motion(0.02, 2.0)
    t = np.arange(0.0, 2.0, 1e-3)
    found = device.along(1e-3, motion.displacement(t), motion.velocity(t), motion.acceleration(t))
    assert found["total"].max() == pytest.approx(225.0, rel=1e-12)
    assert found["total"].min() == pytest.approx(-75.0, rel=1e-12)
    slip = found["states"][:, 2]
    held = (found["total"] > -74.0) & (found["total"] < 224.0)
    assert np.all(np.diff(slip)[held[1:] & held[:-1]] == 0.0)


def test_one_that_is_never_reached_is_none() -> None:
    motion, t = sine_motion(0.02, 2.0), np.arange(0.0, 1.0, 1e-3)
    along = (1e-3, motion.displacement(t), motion.velocity(t), motion.acceleration(t))
    shaft = Device(**SHAFT).along(*along)
    clutch = Device(**SHAFT, clutch_force=1e6).along(*along)
    assert np.array_equal(clutch["total"], shaft["total"])
    assert not clutch["states"][:, 2].any()
    # a leak that is stiff lets little through: the flywheel is late by b / c
    errors = [
        np.abs(
            Device(inertance=50.0, leak_damping=c).along(*along, [0.0, 0.02 * 4 * np.pi, 0.0])[
                "total"
            ]
            - 50.0 * along[3]
        ).max()
        for c in (1e5, 1e6)
    ]
    assert errors[1] == pytest.approx(0.1 * errors[0], rel=0.1)


def test_a_one_way_clutch_spins_its_flywheel_up() -> None:
    """Held in compression alone: the flywheel keeps the greatest speed of the approach."""
    device, motion = Device(**SLIPS["one way"]), sine_motion(0.02, 2.0)
    t = np.arange(0.0, 2.0, 1e-3)
    found = device.along(1e-3, motion.displacement(t), motion.velocity(t), motion.acceleration(t))
    assert found["total"].max() < 1e-9
    speed = found["states"][:, 1]
    assert speed[600:].max() < 0.0
    # and what the shaft's spring gives it once more as it lets go
    assert -0.3 < speed[-1] < -0.02 * 4.0 * np.pi


def test_the_force_over_a_step_never_falls_and_is_that_of_the_instant_in_the_limit() -> None:
    for kind, p in SLIPS.items():
        device = Device(**p)
        z = [2e-4, 0.1, 0.0]
        now = device.evaluate(0.0, 0.2, 0.0, z)["total"][0]
        found = device.over_step(0.0, 0.2, 0.0, z, 1e-9, 1.0)[0]["total"]
        assert found == pytest.approx(now, rel=1e-4), kind
        for h in (1e-5, 1e-3, 1e-1, 10.0):
            for mobility in (1e-3, 1.0, 1e3):
                force = [
                    device.over_step(0.0, 0.2, a, z, h, mobility)[0]["total"]
                    for a in np.linspace(-9.0, 9.0, 37) / h
                ]
                assert np.all(np.diff(force) >= -1e-9 * np.ptp(force)), (kind, h, mobility)


def test_work_is_stored_or_heat() -> None:
    motion, t = sine_motion(0.02, 2.0), np.arange(0.0, 1.0, 1e-4)
    x, v, a = motion.displacement(t), motion.velocity(t), motion.acceleration(t)
    for kind, p in SLIPS.items():
        device = Device(**p)
        found = device.along(1e-4, x, v, a)
        told = device.evaluate(x, v, a, found["states"])
        work = float(np.trapezoid(found["total"] * v, dx=1e-4))
        heat = float(np.trapezoid(told["dissipated_power"], dx=1e-4))
        stored = told["stored_energy"][-1] - told["stored_energy"][0]
        size = float(np.trapezoid(np.abs(found["total"] * v), dx=1e-4))
        assert work == pytest.approx(heat + stored, abs=2e-3 * size), kind


def test_a_first_force_is_borne() -> None:
    for kind, p in SLIPS.items():
        device = Device(**p)
        force = -50.0 if kind == "one way" else 50.0
        z = device.state_of_force(0.0, 0.2, 0.0, force)
        assert device.evaluate(0.0, 0.2, 0.0, z)["total"][0] == pytest.approx(force), kind
    # no clutch bears more than its force
    clutch = Device(**SLIPS["clutch"])
    z = clutch.state_of_force(0.0, 0.2, 0.0, 500.0)
    assert clutch.evaluate(0.0, 0.2, 0.0, z)["total"][0] == pytest.approx(150.0)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({**SHAFT, "clutch_force": 10.0, "backlash": 1e-4}, "clutch_force is 10 N and backlash"),
        ({**SHAFT, "clutch_asymmetry": 0.5}, "clutch_asymmetry is 0.5, but clutch_force is 0 N"),
        ({"inertance": 1.0, "clutch_force": 10.0}, "series_stiffness is 0 N/m"),
        ({**SHAFT, "series_damping": 0.0, "clutch_force": 10.0}, "series_damping is 0 N.s/m"),
        ({"leak_damping": 10.0}, "leak_damping is 10 N.s/m, but inertance is 0 kg"),
        ({**SHAFT, "clutch_force": 10.0, "clutch_asymmetry": 1.5}, "clutch_asymmetry"),
    ],
)
def test_what_cannot_slip_is_refused(values: dict[str, Any], message: str) -> None:
    with pytest.raises(DeviceError, match=message):
        Device(**values)
    with pytest.raises(ValueError, match=r"clutch|leak|backlash"):
        ReferenceDevice(**values)
