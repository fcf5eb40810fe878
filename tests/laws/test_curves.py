"""Curves and periods along the stroke: closed forms, smoothness, energy, what is refused."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from curve_draws import draw_curves
from inerter.core import Device, DeviceError
from inerter.device_file import device_text, read_device
from inerter.reference import ReferenceDevice

RANGE: dict[str, Any] = {"curve_lower": -0.05, "curve_upper": 0.07}
VALUES = (0.0, 0.2, -0.1, 0.3, 0.1, 0.0, 0.15)


def force(device: Device, x: Any, v: Any = 0.0, a: Any = 0.0) -> np.ndarray:
    return device.evaluate(x, v, a, 0.0)["total"]


def test_a_curve_runs_through_its_values_and_stays_beyond() -> None:
    device = Device(force_curve=VALUES, **RANGE)
    places = np.linspace(-0.05, 0.07, len(VALUES))
    np.testing.assert_allclose(force(device, places), VALUES, atol=1e-15)
    np.testing.assert_allclose(force(device, [-9.0, -0.0501, 0.0701, 9.0]), [0, 0, 0.15, 0.15])


def test_two_values_are_joined_by_the_cubic_that_is_level_at_both() -> None:
    device = Device(force_curve=(2.0, 5.0), curve_lower=0.0, curve_upper=1.0)
    u = np.linspace(0.0, 1.0, 11)
    np.testing.assert_allclose(force(device, u), 2.0 + 3.0 * u * u * (3.0 - 2.0 * u), rtol=1e-14)


def test_a_curve_has_two_derivatives() -> None:
    # b'(x) v^2 / 2 at v = 1 gives half the slope; its difference over a value is the second one
    device = Device(inertance=1.0, inertance_curve=VALUES, **RANGE)
    near = 1e-7
    for place in np.linspace(-0.05, 0.07, len(VALUES))[1:-1]:
        x = place + near * np.array([-2.0, -1.0, 1.0, 2.0])
        half_slope = force(device, x, 1.0) - force(device, x, 0.0)
        before, after = np.diff(half_slope)[[0, 2]] / near
        assert before == pytest.approx(after, rel=1e-4, abs=0.1)
    ends = force(device, [-0.05, 0.07, -0.05 + 1e-9, 0.07 - 1e-9], 1.0)
    np.testing.assert_allclose(ends, 0.0, atol=1e-4)


def test_a_period_of_the_inertance_by_hand() -> None:
    # b (1 + A sin q) a + b A (2 pi / L) cos(q) v^2 / 2,  q = 2 pi x / L + phase
    device = Device(inertance=50.0, inertance_periods=[[0.02, 0.004, 0.3]])
    x, v, a = 0.0113, 0.7, -2.0
    q = 2 * np.pi * x / 0.02 + 0.3
    expected = 50.0 * (1 + 0.004 * np.sin(q)) * a
    expected += 50.0 * 0.004 * 2 * np.pi / 0.02 * np.cos(q) * v * v / 2
    assert force(device, x, v, a)[0] == pytest.approx(expected, rel=1e-14)


def test_the_ripple_of_a_rack_inerter() -> None:
    # 0.4 % of 113 kg over 20 mm at 0.7 m/s: 2 pi / L * b A v^2 / 2 = 34.8 N at most
    device = Device(inertance=113.0, inertance_periods=(0.02, 0.004, 0.0))
    x = np.linspace(0.0, 0.02, 200)
    largest = abs(force(device, x, 0.7) - force(device, x, 0.0)).max()
    assert largest == pytest.approx(113 * 0.004 * np.pi / 0.02 * 0.49, rel=1e-3)


@pytest.mark.parametrize("law", ["coulomb", "stribeck", "brown_mcphee", "dahl", "lugre"])
def test_friction_slides_at_its_level_of_the_place_and_direction(law: str) -> None:
    level: dict[str, Any] = {"friction": law, "coulomb_force": 20.0}
    level |= {"friction_curve": VALUES, "friction_back_periods": (0.03, 0.4, 1.0), **RANGE}
    device, plain = Device(**level), Device(friction=law, coulomb_force=20.0)
    for x in (-0.05, 0.01, 0.03):
        for v in (0.5, -0.5):
            z = 0.0
            if device.nstate:
                z = device.step(x, v, 0.0, 1e3)
            share = device.evaluate(x, v, 0.0, z)["friction"][0]
            full = plain.evaluate(x, v, 0.0, plain.step(x, v, 0.0, 1e3))["friction"][0]
            back = 1 + 0.4 * np.sin(2 * np.pi * x / 0.03 + 1.0)
            forth = 1 + float(np.interp(x, np.linspace(-0.05, 0.07, 7), VALUES))
            expected = forth if v > 0 else back
            assert share / full == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("n", [1.0, 1.7, 3.0])
def test_bouc_wen_yields_at_its_level_and_keeps_its_stiffness(n: float) -> None:
    shape: dict[str, Any] = {
        "friction": "bouc_wen",
        "bw_stiffness": 2e4,
        "bw_beta": 300.0**n,
        "bw_gamma": 0.0,
    }
    plain = Device(**shape, bw_exponent=n)
    half = Device(**shape, bw_exponent=n, friction_curve=(-0.5, -0.5), **RANGE)
    for v in (0.3, -0.3):
        far = [device.step(0.0, v, 0.0, 10.0) for device in (plain, half)]
        assert far[1] == pytest.approx(0.5 * far[0], rel=1e-6)
    assert half.evaluate(0.0, 1.0, 0.0, 0.0)["state_rate"][0] == pytest.approx(1.0)


CONSERVATIVE: dict[str, dict[str, Any]] = {
    "force": {"force_curve": VALUES, **RANGE, "force_periods": [[0.03, 0.4, 0.5], [0.011, 1, 2]]},
    "inertance": {"inertance": 3.0, "inertance_curve": VALUES, **RANGE},
    "periods": {"inertance": 3.0, "inertance_periods": [[0.05, 0.05, 1.0], [0.02, 0.02, -2.0]]},
    "directions": {
        "inertance": 3.0, "inertance_curve": VALUES, **RANGE,
        "inertance_back_periods": (0.05, 0.1, 0.0),
    },
}  # fmt: skip


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_the_work_of_any_motion_is_what_is_stored(name: str) -> None:
    """To 1e-12, by a quadrature that is exact between the turns and the values of a curve.

    tests/plugin/test_stroke_in_engine.py has the long runs.
    """
    device = Device(**CONSERVATIVE[name])
    nodes, weights = np.polynomial.legendre.leggauss(24)

    def motion(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return 0.01 + 0.07 * np.sin(3 * t), 0.21 * np.cos(3 * t), -0.63 * np.sin(3 * t)

    # where x passes a value of the curve, or turns
    fine = np.linspace(0.0, 4.0, 100_001)
    x, v, _ = motion(fine)
    marks = [*np.linspace(-0.05, 0.07, len(VALUES))]
    crossed = [np.flatnonzero(np.diff(np.sign(x - mark))) for mark in marks]
    places = fine[np.unique(np.concatenate([*crossed, np.flatnonzero(np.diff(np.sign(v)))]))]
    edges = np.unique(np.concatenate([[0.0, 4.0], places, np.linspace(0.0, 4.0, 400)]))
    half = np.diff(edges) / 2.0
    t = (edges[:-1] + half)[:, None] + half[:, None] * nodes
    x, v, a = motion(t.ravel())
    power = (force(device, x, v, a) * v).reshape(t.shape)
    work = np.concatenate([[0.0], np.cumsum(half * (power @ weights))])
    energy = device.evaluate(*motion(edges), 0.0)["stored_energy"]
    np.testing.assert_allclose(energy - energy[0], work, atol=2e-9 * abs(energy).max())


def test_nothing_gives_energy() -> None:
    rng = np.random.default_rng(5)
    for _ in range(60):
        law = str(rng.choice(["coulomb", "dahl", "bouc_wen"]))
        p: dict[str, Any] = {"friction": law, "inertance": 10.0}
        p |= {"bw_stiffness": 1e4} if law == "bouc_wen" else {"coulomb_force": 10.0}
        device = Device(**p, **draw_curves(rng))
        x, v = rng.normal(0.0, 0.1, 50), rng.normal(0.0, 1.0, 50)
        z = rng.uniform(-1e-4, 1e-4, 50)
        found = device.evaluate(x, v, 0.0, z)
        assert np.all(found["dissipated_power"] >= -1e-9 * abs(found["total"] * v))


BAD: dict[str, tuple[dict[str, Any], list[str]]] = {
    "inertance falls": (
        {"inertance": 1.0, "inertance_curve": (0, 0, -1.2, 0), **RANGE},
        ["inertance_curve", "at x = 0.028", "below 0.01"],
    ),
    "inertance falls by periods": (
        {"inertance": 1.0, "inertance_periods": (0.02, 1.1, 0.0)},
        ["inertance_periods", "at x = ", "-0.1", "below 0.01"],
    ),
    "backwards": (
        {"inertance": 1.0, "inertance_back_periods": (0.02, 1.1, 0.0)},
        ["inertance_back_periods", "at x = "],
    ),
    "level falls": (
        {"friction": "dahl", "coulomb_force": 2.0, "friction_curve": (0, -1.5), **RANGE},
        ["friction_curve", "at x = 0.07 m", "-0.5", "below 0.001"],
    ),
    "damping falls": (
        {"viscous": 3.0, "viscous_periods": (0.02, 4.0, 0.0)},
        ["viscous_periods", "-1", "below 0"],
    ),
    "no law": ({"friction_periods": (0.02, 0.1, 0.0)}, ["friction_periods", '"none"']),
    "twice": (
        {
            "friction": "coulomb", "coulomb_force": 1.0, "friction_asymmetry": 0.1,
            "friction_back_periods": (0.02, 0.1, 0.0),
        },
        ["friction_back_periods", "friction_asymmetry is 0.1"],
    ),
    "no range": ({"force_curve": VALUES}, ["force_curve", "curve_lower"]),
    "half a range": ({"force_curve": VALUES, "curve_lower": 0.0}, ["curve_upper"]),
    "range of nothing": ({"curve_lower": 0.0, "curve_upper": 1.0}, ["curve_lower", "no curve"]),
    "range the wrong way": (
        {"force_curve": VALUES, "curve_lower": 1.0, "curve_upper": 0.0}, ["curve_lower is 1 m"],
    ),
    "one value": ({"force_curve": (1.0,), **RANGE}, ["force_curve has 1 numbers", "2 to 64"]),
    "too many": ({"force_curve": range(65), **RANGE}, ["force_curve has 65 numbers", "2 to 64"]),
    "two of three": ({"force_periods": (0.02, 1.0)}, ["force_periods has 2 numbers", "three"]),
    "nine periods": ({"force_periods": [[0.02, 1, 0]] * 9}, ["has 27 numbers", "8 periods"]),
    "no length": ({"force_periods": (0.0, 1.0, 0.0)}, ["number 1 is 0", "length", ">= 1e-09"]),
    "infinite": ({"force_periods": (0.1, np.inf, 0.0)}, ["number 2 is inf"]),
    "too large": ({"force_periods": (0.1, 1e200, 0.0)}, ["number 2 is 1e+200", "1e+150"]),
    "endless": (
        {"force_curve": VALUES, "curve_lower": -1.5e308, "curve_upper": 1.5e308}, ["curve_upper"],
    ),
    "a word": ({"force_periods": "0.1 one 0"}, ['"one" is not a number', "blanks"]),
    "nothing": ({"force_periods": " "}, ["force_periods is empty"]),
    "words": ({"force_periods": ["0.1", 1, 2]}, ["force_periods"]),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_what_cannot_be_is_refused_in_one_line(name: str) -> None:
    keys, parts = BAD[name]
    with pytest.raises(DeviceError) as error:
        Device(**keys)
    text = str(error.value)
    assert "\n" not in text
    for part in parts:
        assert part in text


def test_the_reference_refuses_what_the_core_refuses() -> None:
    for name, (keys, _) in BAD.items():
        if name not in ("nothing", "words", "too large", "endless"):
            with pytest.raises(ValueError):  # noqa: PT011
                ReferenceDevice(**keys)


def test_a_curve_that_periods_save_is_taken() -> None:
    # each alone would fail, the sum does not: the places count
    dip: dict[str, Any] = {
        "inertance": 1.0,
        "inertance_curve": (0, -0.9, 0),
        "curve_lower": 0,
        "curve_upper": 1,
    }
    with pytest.raises(DeviceError):
        Device(**dip, inertance_periods=(2.0, -0.2, 0.0))
    Device(**dip, inertance_periods=(2.0, 0.2, 0.0))


def test_a_device_with_lists_is_copied_and_written(tmp_path: Path) -> None:
    device = Device(
        inertance=3.0, inertance_curve=VALUES, **RANGE, force_periods=[[0.03, 4.0, 0.5]]
    )
    assert device.inertance_curve == VALUES
    assert device.force_periods == (0.03, 4.0, 0.5)
    for again in (pickle.loads(pickle.dumps(device)), Device(**device.given)):
        assert again.given == device.given
        assert again == device
        assert hash(again) == hash(device)
        assert force(again, 0.01, 0.2, 1.0) == force(device, 0.01, 0.2, 1.0)
    assert device != device.replace(inertance=3.5)
    path = tmp_path / "device.toml"
    path.write_text(device_text(device))
    assert "force_periods = [[0.03, 4.0, 0.5]]" in path.read_text()
    assert read_device(path).given == device.given
    path.write_text('[device]\nforce_periods = ["a", 1, 2]\n')
    with pytest.raises(DeviceError, match="force_periods"):
        read_device(path)
