"""Own cars and networks, Smith and Wang's layouts, limits, fronts, and roads as fine as modes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inerter.suspension.car_file import read_car
from inerter.suspension.comfort_weighting import WK, weighting
from inerter.suspension.front import front_of
from inerter.suspension.front_files import fronts
from inerter.suspension.indices import comfort_function, travel, travel_function, weighted_comfort
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.network import Element, Network, NetworkError
from inerter.suspension.network_file import read_network
from inerter.suspension.optimum import NoDesignError, optimise
from inerter.suspension.problem import SuspensionProblem
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.rational import damper, inerter, parallel, series, spring
from inerter.suspension.time_domain.fine import line_value, linear_value, parts_for, slowest_decay
from inerter.suspension.time_domain.linear import exact_index, spectrum
from inerter.suspension.time_domain.model import Design
from inerter.suspension.time_domain.road import paper_road
from scipy.integrate import quad

CAR, ROAD = QuarterCar(sprung_mass=320.0, unsprung_mass=42.0, tyre_stiffness=210e3), Road()
PROBLEM = SuspensionProblem(car=CAR, road=ROAD, layout="S1", index="Wk", stiffness=25e3)

CAR_TEXT = """[car]
kind = "quarter"
sprung_mass_kg = 320
unsprung_mass = "42 kg"
tyre_stiffness_kN_per_m = 210
spring_stiffness = "40 N/mm"
motion_ratio = 0.8
"""


def test_wk_is_the_table_of_the_standard() -> None:
    """ISO 2631-1:1997, Table 3, factors in thousandths at one-third octaves."""
    table = {0.5: 418, 1: 482, 2: 531, 4: 967, 5: 1039, 8: 1036, 10: 988, 16: 768, 31.5: 405}
    assert 1000 * weighting(np.array(list(table))) == pytest.approx(list(table.values()), abs=1.0)


def test_weighted_comfort_and_travel_against_quadrature() -> None:
    strut = LAYOUTS["S3"].stiffness(25e3, 1500.0, 200.0)

    def rms(gain) -> float:
        parts = [(0.0, 2.0), (2.0, 20.0), (20.0, 2000.0)]
        total = sum(quad(lambda f: 2 * abs(gain(2j * np.pi * f)) ** 2, *p, limit=500)[0]
                    for p in parts)  # fmt: skip
        return ROAD.slope * np.sqrt(total)

    comfort, rattle = comfort_function(CAR, strut), travel_function(CAR, strut)
    weighted = float(weighted_comfort(CAR, ROAD, strut))
    assert weighted == pytest.approx(rms(lambda s: comfort(s) * WK(s)), rel=1e-6)
    assert float(travel(CAR, ROAD, strut)) == pytest.approx(rms(rattle), rel=1e-6)


def test_a_netlist_is_its_series_and_parallel_form() -> None:
    k, c, b, kb = spring(3e4), damper(1200.0), inerter(80.0), spring(9e4)
    s = 2j * np.pi * np.array([0.3, 1.0, 8.0, 40.0])
    for name, network in {
        "S4": parallel(k, series(kb, parallel(c, b))),
        "SW6": parallel(k, series(kb, c, b)),
        "S6": parallel(k, series(parallel(kb, c), b)),
        "SW2": parallel(k, series(kb, c)),
    }.items():
        found = LAYOUTS[name].stiffness(3e4, 1200.0, 80.0, 9e4)(s)
        assert found == pytest.approx(network(s), rel=1e-12), name


def test_a_bridge_against_its_nodal_matrix() -> None:
    """A Wheatstone bridge, which no series and parallel form has."""
    values = (("spring", 2e4), ("damper", 900.0), ("inerter", 40.0), ("spring", 5e4),
              ("damper", 300.0))  # fmt: skip
    ends = (("body", "a"), ("body", "b"), ("a", "wheel"), ("b", "wheel"), ("a", "b"))
    network = Network(tuple(Element(k, x, *e) for (k, x), e in zip(values, ends, strict=True)))
    s, power = 2j * np.pi * 2.3, {"spring": 0, "damper": 1, "inerter": 2}
    nodes = ["body", "a", "b", "wheel"]
    matrix = np.zeros((4, 4), dtype=complex)
    for (kind, x), pair in zip(values, ends, strict=True):
        i, j = (nodes.index(e) for e in pair)
        matrix[np.ix_([i, j], [i, j])] += x * s ** power[kind] * np.array([[1, -1], [-1, 1]])
    # displacement 1 of the body, wheel held, inner nodes free of force
    inner = np.linalg.solve(matrix[1:3, 1:3], -matrix[1:3, 0])
    force = matrix[0, 0] + matrix[0, 1:3] @ inner
    assert complex(network.stiffness({})(s)) == pytest.approx(force, rel=1e-12)


def test_networks_that_are_none_are_named(tmp_path: Path) -> None:
    with pytest.raises(NetworkError, match="do not join"):
        Network((Element("spring", 1.0, "body", "a"),))
    with pytest.raises(NetworkError, match="leads nowhere"):
        Network((Element("spring", 1.0, "body", "wheel"), Element("damper", 1.0, "body", "x")))
    path = tmp_path / "n.toml"
    path.write_text('[[element]]\nkind = "lever"\nbetween = ["body", "wheel"]\nvalue = 3\n')
    with pytest.raises(ValueError, match=r"n\.toml: lever 3.0 between body and wheel: a kind is"):
        read_network(path)


def test_centring_springs_keep_the_strut_at_rest() -> None:
    layout = LAYOUTS["SW7"]
    assert set(layout.centring) == {"damper_centring_stiffness", "inerter_centring_stiffness"}
    sought = {"damping": 900.0, "inertance": 90.0, "damper_centring_stiffness": 8e4,
              "inerter_centring_stiffness": 3e3}  # fmt: skip
    values = layout.values(25e3, sought)
    assert values["stiffness"] > 0.0
    strut = layout.stiffness(**values)
    assert strut.numerator[0] / strut.denominator[0] == pytest.approx(25e3, rel=1e-12)


@pytest.mark.parametrize(("inner", "outer"), [("S3", "S5"), ("S3", "S6"), ("SW2", "S4")])
def test_a_layout_is_never_worse_than_one_that_it_contains(inner: str, outer: str) -> None:
    for index in ("J3", "J5"):
        values = [
            optimise(replace(PROBLEM, layout=name, index=index, stiffness=60e3)).value
            for name in (inner, outer)
        ]
        assert values[1] <= values[0] * (1.0 + 1e-9), index


def test_limits_fixed_values_and_catalogues() -> None:
    free = optimise(PROBLEM)
    bounded = optimise(replace(PROBLEM, limits=(("J3", 650.0),)))
    # one variable: the limit decides
    at_limit = replace(PROBLEM, index="J3", fixed=(("damping", bounded.damping),))
    assert optimise(at_limit).value == pytest.approx(650.0, rel=1e-5)
    assert bounded.value > free.value
    with pytest.raises(NoDesignError, match="no design of S1 keeps J3 <= 100"):
        optimise(replace(PROBLEM, limits=(("J3", 100.0),)))
    choices = (("inertance", (2.0, 6.0, 40.0)),)
    best = optimise(replace(PROBLEM, layout="S2", choices=choices))
    values = [
        optimise(replace(PROBLEM, layout="S2", fixed=(("inertance", b),))).value
        for b in choices[0][1]
    ]
    assert best.value == min(values)


def test_a_front_rises_on_one_side_only_and_is_resumed(tmp_path: Path) -> None:
    points = front_of(PROBLEM, "J3", {"travel": 0.02}, 4)
    pairs = np.array([[p.found.indices[name] for name in ("Wk", "J3")] for p in points])
    assert len(pairs) == 4
    assert (np.diff(pairs[:, 0]) > 0).all()
    assert (np.diff(pairs[:, 1]) < 0).all()
    first = fronts([PROBLEM], "J3", {}, 3, tmp_path)
    # a mark that only a resumed run keeps
    text = json.loads((tmp_path / "pareto.json").read_text())
    text["rows"][0]["indices"]["J1"] = 123.0
    (tmp_path / "pareto.json").write_text(json.dumps(text))
    assert fronts([PROBLEM], "J3", {}, 3, tmp_path)["rows"][0]["indices"]["J1"] == 123.0
    other = fronts([PROBLEM], "J3", {"travel": 0.03}, 3, tmp_path)
    assert other["rows"][0]["indices"]["J1"] == pytest.approx(first["rows"][0]["indices"]["J1"])


def test_a_car_file_and_its_errors(tmp_path: Path) -> None:
    path = tmp_path / "car.toml"
    path.write_text(CAR_TEXT)
    found = read_car(path)
    assert found.car == CAR
    assert found.stiffnesses == pytest.approx((40e3 * 0.64,))
    for before, after, said in (
        ("= 320", "= 320000", r"sprung_mass is 320000 kg: of vehicles it is 20 to 20000"),
        ("= 210", "= 0.21", r"tyre_stiffness is 210 N/m"),
        ('"42 kg"', '"42 m"', r"unsprung_mass = '42 m': give a number in kg"),
        ("motion_ratio", "bump_stop", r"bump_stop is not linear"),
        ("motion_ratio", "colour", r"colour is not known: choose from"),
        ("sprung_mass_kg = 320\n", "", r"sprung_mass is missing"),
    ):
        path.write_text(CAR_TEXT.replace(before, after, 1))
        with pytest.raises(ValueError, match=said):
            read_car(path)


def test_lines_as_fine_as_the_slowest_mode() -> None:
    """The design whose interval was false: lines 0.1 Hz apart miss it by far, finer ones do not."""
    car, road, design = QuarterCar(), paper_road(), Design(120e3, 4500.0, 60.0)
    exact = exact_index("J1", "S3", design, None, car, spectrum(road))
    assert exact == pytest.approx(8.129, abs=1e-3)
    assert linear_value("J1", "S3", design, None, car, road) == pytest.approx(exact, rel=1e-4)
    assert abs(line_value("J1", "S3", design, None, car, road) / exact - 1.0) > 0.1
    parts = parts_for(road, slowest_decay("S3", design, None, car))
    assert parts == 7
    fine = road.finer(parts)
    assert line_value("J1", "S3", design, None, car, fine) == pytest.approx(exact, rel=2e-3)
    # the band is the same
    edges = [(r.first - 0.5) * r.spacing for r in (road, fine)]
    assert edges[0] == pytest.approx(edges[1])
