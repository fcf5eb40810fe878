"""Networks of any shape: against series and parallel rules, a bridge by hand, positive reality."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from inerter.suspension.commands import app
from inerter.suspension.indices import ride_comfort
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.netlist import NetlistError, is_positive_real, read_netlist
from inerter.suspension.optimum import optimise
from inerter.suspension.problem import SuspensionProblem
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.rational import Rational
from typer.testing import CliRunner

S = 1j * np.geomspace(0.3, 400.0, 30)
TEXT = {
    "S1": "spring k body wheel 3e4\ndamper c body wheel 1500",
    "S2": "spring k body wheel 3e4\ndamper c body wheel 1500\ninerter b body wheel 40",
    "S3": "spring k body wheel 3e4\ndamper c body n 1500\ninerter b n wheel 40",
    "S4": "spring k body wheel 3e4\nspring kb body n 8e4\ndamper c n wheel 1500\n"
          "inerter b n wheel 40",
    "S5": "spring k body wheel 3e4\nspring kb body m 8e4\ndamper c m n 1500\ninerter b n wheel 40",
    "S6": "spring k body wheel 3e4\nspring kb body n 8e4\ndamper c body n 1500\n"
          "inerter b n wheel 40",
    "SR": "spring k body wheel 3e4\nspring kb body n 8e4\ndamper c n wheel 1500",
}  # fmt: skip


@pytest.mark.parametrize("name", TEXT)
def test_a_netlist_is_the_layout(name: str) -> None:
    found = read_netlist(TEXT[name].splitlines()).stiffness()
    expected = LAYOUTS[name].stiffness(3e4, 1500.0, 40.0, 8e4)
    assert found(S) == pytest.approx(expected(S), rel=1e-11)
    # the same order, so the same norm: nothing is left that cancels
    car, road = QuarterCar(), Road()
    assert float(ride_comfort(car, road, found)) == pytest.approx(
        float(ride_comfort(car, road, expected)), rel=1e-9
    )


BRIDGE = """# a bridge is neither series nor parallel
spring  k1 body a 2e4
damper  c1 body b 900
inerter b1 a b 30
damper  c2 a wheel 1400   # remark
spring  k2 b wheel 5e4
"""


def test_a_bridge_is_what_its_nodes_balance_to() -> None:
    found = read_netlist(BRIDGE.splitlines()).stiffness()
    for s in S:
        y = {"k1": 2e4, "c1": 900 * s, "b1": 30 * s**2, "c2": 1400 * s, "k2": 5e4}
        # body at 1, wheel held: forces on a and b vanish
        inner = np.array([[y["k1"] + y["b1"] + y["c2"], -y["b1"]],
                          [-y["b1"], y["c1"] + y["b1"] + y["k2"]]])  # fmt: skip
        a, b = np.linalg.solve(inner, np.array([y["k1"], y["c1"]]))
        force = y["k1"] * (1 - a) + y["c1"] * (1 - b)
        assert complex(found(s)) == pytest.approx(force, rel=1e-11)


def test_values_may_be_arrays_and_have_derivatives() -> None:
    netlist = read_netlist(BRIDGE.splitlines())
    several = netlist.stiffness({"b1": np.array([30.0, 60.0])})
    one = netlist.stiffness({"b1": 60.0})
    assert several(2.0j)[1] == pytest.approx(complex(one(2.0j)), rel=1e-13)
    step = netlist.stiffness({"c1": 900.0 + 1e-20j})
    high, low = (netlist.stiffness({"c1": 900.0 + d}) for d in (0.1, -0.1))
    # at a real s the values are real, so the imaginary part is the derivative
    slope = np.imag(complex(step(3.0))) / 1e-20
    assert slope == pytest.approx(float(np.real(high(3.0) - low(3.0))) / 0.2, rel=1e-6)


def test_what_springs_dampers_and_inerters_make_is_positive_real() -> None:
    for text in [*TEXT.values(), BRIDGE]:
        d = read_netlist(text.splitlines()).stiffness()
        below = np.concatenate([[0.0], d.denominator])
        assert is_positive_real(Rational(d.numerator, below))


def test_what_they_cannot_make_is_not() -> None:
    def ratio(top: list[float], below: list[float]) -> Rational:
        return Rational(np.array(top), np.array(below))

    # bicubic over bicubic of no network: gains energy at some frequency, or grows
    assert not is_positive_real(ratio([1.0, 1.0, -3.0, 1.0], [1.0, 2.0, 2.0, 1.0]))
    assert not is_positive_real(ratio([1.0, 0.1], [1.0, -0.5, 1.0]))
    assert not is_positive_real(ratio([0.0, 0.0, 1.0], [1.0]))
    assert not is_positive_real(ratio([1.0], [0.0, 0.0, 1.0]))
    assert not is_positive_real(ratio([-1.0, -1.0], [1.0, 2.0]))
    assert is_positive_real(ratio([1.0, 2.0, 1.0], [1.0, 0.5, 1.0]))
    # (s^2 + B s + A)/(s^2 + D s + C): if and only if (sqrt(A) - sqrt(C))^2 <= B D
    for a, expected in ((2.0, True), (9.0, False)):
        edge = (np.sqrt(a) - 1.0) ** 2 <= 0.5 * 0.5
        assert edge == expected
        assert is_positive_real(ratio([a, 0.5, 1.0], [1.0, 0.5, 1.0])) == expected


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("mass m body wheel 3", "'mass': an element is spring, damper, inerter"),
        ("spring k body wheel", "line 1: 'spring k body wheel': write KIND NAME NODE NODE VALUE"),
        ("spring k body wheel x", "line 1: 'x' is no number"),
        ("spring k body wheel -3", "k is -3: give a positive number"),
        ("spring k body body 3", "leads from 'body' to itself"),
        ("spring k body wheel 3\nspring k body wheel 3", "'k' is there twice"),
        ("spring k body wheel 3\ndamper c body n 3", "node 'n' leads nowhere"),
        ("spring k body top 3\ndamper c body top 3", "nothing leads from 'body' to 'wheel'"),
    ],
)
def test_what_is_no_strut_is_refused(text: str, said: str) -> None:
    with pytest.raises(NetlistError, match=said):
        read_netlist(text.splitlines())


def test_the_best_values_of_a_network_are_those_of_the_layout(tmp_path: Path) -> None:
    text = TEXT["S6"].replace("8e4", "?").replace("1500", "?").replace("40", "?")
    (tmp_path / "strut.net").write_text(text)
    run = CliRunner().invoke(app, ["network", str(tmp_path / "strut.net"), "--json"])
    assert run.exit_code == 0, run.output
    row = json.loads(run.stdout)
    best = optimise(
        SuspensionProblem(car=QuarterCar(), road=Road(), layout="S6", index="J1", stiffness=3e4)
    )
    assert row["value"] == pytest.approx(best.value, rel=1e-9)
    assert row["design"]["b"] == pytest.approx(best.inertance, rel=1e-4)
    words = ["network", str(tmp_path / "strut.net"), "--limit", "J3=340"]
    run = CliRunner().invoke(app, words)
    assert run.exit_code == 0, run.output
    assert "held back by the limit of J3" in run.output


@pytest.mark.parametrize(
    ("text", "words", "said"),
    [
        (TEXT["S1"], [], "0 values are sought: write ?"),
        (TEXT["S1"].replace("1500", "?"), ["--index", "J5"], "J5 is of the layouts"),
        (TEXT["S1"].replace("1500", "?"), ["--car", "half"], "is sought for a quarter-car"),
    ],
)
def test_networks_that_cannot_be_sought(
    text: str, words: list[str], said: str, tmp_path: Path
) -> None:
    (tmp_path / "strut.net").write_text(text)
    run = CliRunner().invoke(app, ["network", str(tmp_path / "strut.net"), *words])
    assert run.exit_code == 2
    assert said in run.stderr
