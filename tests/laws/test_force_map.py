"""A force over displacement and velocity: closed forms, edges, energy, three tellings, refusals."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inerter.core import Device, DeviceError
from inerter.device_file import device_text, read_device
from inerter.exudyn import device as element
from inerter.exudyn.parameters import Parameters as ElementParameters
from inerter.reference import ReferenceDevice
from map_draws import draw_map

TOLERANCE = 1e-12
PLACE: dict[str, Any] = {
    "force_map_lower": -0.05, "force_map_upper": 0.07, "force_map_speed": 0.6,
}  # fmt: skip
VALUES = np.random.default_rng(3).normal(0.0, 10.0, (7, 5))
MAP: dict[str, Any] = {"force_map": VALUES.tolist(), "force_map_columns": 5, **PLACE}


def force(device: Device, x: Any, v: Any = 0.0) -> np.ndarray:
    return device.evaluate(x, v, 0.0, 0.0)["total"]


@pytest.mark.parametrize("scale", [None, 0.05])
def test_it_runs_through_its_values_and_stays_beyond(scale: float | None) -> None:
    device = Device(**MAP, **({} if scale is None else {"force_map_scale": scale}))
    x, v = np.linspace(-0.05, 0.07, 7), np.linspace(-0.6, 0.6, 5)
    if scale:
        v = scale * np.sinh(np.linspace(-1.0, 1.0, 5) * np.arcsinh(0.6 / scale))
    np.testing.assert_allclose(force(device, x[:, None], v), VALUES, atol=1e-12)
    beyond = force(device, [-9.0, -9.0, 9.0, 0.07, 0.07], [-0.6, -7.0, 0.6, 1e9, -1e9])
    expected = [VALUES[0, 0], VALUES[0, 0], VALUES[-1, -1], VALUES[-1, -1], VALUES[-1, 0]]
    np.testing.assert_allclose(beyond, expected, atol=1e-12)


def test_two_by_two_is_a_product_of_the_cubics_that_are_level_at_both_ends() -> None:
    corners = np.array([[1.0, -2.0], [5.0, 3.0]])
    device = Device(force_map=corners.tolist(), force_map_columns=2, **PLACE)
    u, w = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 9))
    down, across = u * u * (3 - 2 * u), w * w * (3 - 2 * w)
    expected = (1 - down) * ((1 - across) * corners[0, 0] + across * corners[0, 1])
    expected += down * ((1 - across) * corners[1, 0] + across * corners[1, 1])
    found = force(device, -0.05 + 0.12 * u, -0.6 + 1.2 * w)
    np.testing.assert_allclose(found, expected, atol=1e-13)


def test_rows_that_are_alike_are_a_curve_and_one_column_repeated_is_a_force_curve() -> None:
    values = VALUES[:, 0]
    device = Device(**{**MAP, "force_map": np.repeat(values, 5)})
    curve = Device(force_curve=values.tolist(), curve_lower=-0.05, curve_upper=0.07)
    x, v = np.linspace(-0.08, 0.1, 40), np.linspace(-0.9, 0.9, 40)
    for name in ("total", "stored_energy", "dissipated_power"):
        found, expected = (d.evaluate(x, v, 0.0, 0.0)[name] for d in (device, curve))
        np.testing.assert_allclose(found, expected, atol=1e-12)


def test_core_reference_and_element_say_the_same() -> None:
    rng = np.random.default_rng(30)
    for _ in range(40):
        p = {"inertance": 3.0, "rest_length": 0.01, **draw_map(rng)}
        core, reference = Device(**p), ReferenceDevice(**p)
        told = ElementParameters.of(core)
        speed = p["force_map_speed"]
        x, a = rng.uniform(-0.3, 0.3, 60), rng.normal(0.0, 3.0, 60)
        v = speed * rng.normal(0.0, 0.7, 60) * rng.choice([1.0, 1e-2], 60)
        found = core.evaluate(x, v, a, 0.0)
        expected = {
            "total": reference.force(x, v, a),
            "stored_energy": reference.stored_energy(x, v),
            "dissipated_power": reference.dissipated_power(x, v, a),
        }
        # splines of random values overshoot them
        size = 30.0 * np.abs(p["force_map"]).max() + 3.0 * abs(a)
        sizes = {
            "total": size, "stored_energy": size * 0.5 + 1.5 * v * v,
            "dissipated_power": size * abs(v),
        }  # fmt: skip
        for name, value in expected.items():
            assert np.all(abs(found[name] - value) <= TOLERANCE * sizes[name]), (p, name)
        for i in range(0, 60, 6):
            motion = float(x[i]) - 0.01, float(v[i])
            total = element.forces(told, *motion, float(a[i]), [])["total"]
            energy = element.stored_energy(told, *motion, [])
            assert abs(total - found["total"][i]) <= TOLERANCE * sizes["total"][i]
            error = abs(energy - found["stored_energy"][i])
            assert error <= TOLERANCE * sizes["stored_energy"][i]


def test_work_is_what_is_stored_and_what_becomes_heat() -> None:
    rng = np.random.default_rng(31)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    for _ in range(10):
        p = draw_map(rng) | {"force_map_passive": 0.0}
        device, fast, middle = Device(**p), p["force_map_speed"], p["force_map_lower"]
        edges = np.linspace(0.0, 3.0, 4001)
        half = np.diff(edges) / 2
        t = (edges[:-1] + half)[:, None] + half[:, None] * nodes
        reach = p["force_map_upper"] - middle
        rate = 1.2 * fast / reach
        x, v = middle + reach * np.sin(rate * t), reach * rate * np.cos(rate * t)
        found = device.evaluate(x, v, 0.0, 0.0)
        power = (found["total"] * v - found["dissipated_power"]) @ weights * half
        ends = device.evaluate(middle + reach * np.sin(rate * edges[[0, -1]]), 0.0, 0.0, 0.0)
        stored = np.diff(ends["stored_energy"])[0]
        size = np.sum(abs(found["total"] * v) @ weights * half)
        assert abs(power.sum() - stored) <= 1e-6 * size


def test_a_passive_one_never_gives_energy_and_keeps_what_takes_it() -> None:
    rng = np.random.default_rng(32)
    gave = 0
    for _ in range(30):
        p = draw_map(rng)
        x, v = rng.uniform(-0.3, 0.3, 200), rng.normal(0.0, p["force_map_speed"], 200)
        free = Device(**{**p, "force_map_passive": 0}).evaluate(x, v, 0.0, 0.0)
        held = Device(**{**p, "force_map_passive": 1}).evaluate(x, v, 0.0, 0.0)
        assert np.all(held["dissipated_power"] >= 0.0)
        takes = free["dissipated_power"] > 0.0
        gave += int(np.sum(~takes))
        np.testing.assert_array_equal(held["total"][takes], free["total"][takes])
        still = force(Device(**{**p, "force_map_passive": 0}), x)
        np.testing.assert_allclose(held["total"][~takes], still[~takes], atol=1e-10)
    assert gave > 500


def test_over_a_step_what_rises_with_speed_is_taken_at_its_end() -> None:
    device = Device(**MAP, force_map_scale=0.1, inertance=2.0)
    rng, h, near = np.random.default_rng(33), 1e-3, 1e-7
    for x, v in zip(rng.uniform(-0.06, 0.08, 50), rng.uniform(-0.7, 0.7, 50), strict=True):
        slope = (force(device, x, v + near) - force(device, x, v - near))[0] / (2 * near)
        now = device.evaluate(x, v, 3.0, 0.0)["total"][0]
        over, _ = device.over_step(x, v, 3.0, 0.0, h, 0.1)
        assert over["total"] == pytest.approx(now + max(0.0, slope) * h * 3.0, abs=1e-6)


def test_it_goes_through_a_file_and_a_text(tmp_path: Path) -> None:
    device = Device(**MAP, inertance=2.0, force_map_scale=0.03)
    path = tmp_path / "device.toml"
    path.write_text(device_text(device, {"force_map": "fitted, no cause"}))
    text = path.read_text()
    assert "# fitted, no cause\nforce_map = [\n  [" in text
    assert read_device(path).given == device.given
    assert Device(**device.given).given == device.given


BAD: dict[str, tuple[dict[str, Any], list[str]]] = {
    "no range": ({"force_map": [1, 2, 3, 4]}, ["force_map_lower", "force_map_speed"]),
    "no columns": ({**PLACE, "force_map": [1] * 8}, ["but not force_map_columns"]),
    "no map": ({"force_map_scale": 0.1}, ["force_map_scale", "no force_map"]),
    "passive nothing": ({"force_map_passive": 1}, ["force_map_passive", "no force_map"]),
    "columns": ({**MAP, "force_map_columns": 6}, ["35 numbers", "columns is 6", "2 to 24 rows"]),
    "half a column": ({**MAP, "force_map_columns": 2.5}, ["force_map_columns is 2.5"]),
    "one row": ({**MAP, "force_map": [1] * 5}, ["5 numbers", "2 to 24 rows"]),
    "many rows": ({**MAP, "force_map": [1] * 125}, ["125 numbers", "2 to 24 rows"]),
    "too many": ({**MAP, "force_map": [1] * 385}, ["385 numbers", "4 to 384"]),
    "wrong way": ({**MAP, "force_map_lower": 0.1}, ["force_map_lower is 0.1 m", "upper 0.07"]),
    "half passive": ({**MAP, "force_map_passive": 0.5}, ["force_map_passive is 0.5", "1", "0"]),
    "standing": ({**MAP, "force_map_speed": 0}, ["force_map_speed", "> 0"]),
    "no number": ({**MAP, "force_map": [np.nan] * 35}, ["force_map", "number 1"]),
}


@pytest.mark.parametrize("name", BAD)
def test_what_cannot_be_is_refused_in_one_line(name: str) -> None:
    keys, parts = BAD[name]
    with pytest.raises(DeviceError) as error:
        Device(**keys)
    text = str(error.value)
    assert "\n" not in text
    for part in parts:
        assert part in text
    with pytest.raises(ValueError, match="force_map"):
        ReferenceDevice(**keys)
