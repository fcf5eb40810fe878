"""A strut given by its admittance: what it is worth, and the network that has it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from inerter.suspension.admittance import ladder, stiffness_of
from inerter.suspension.commands import app
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.netlist import is_positive_real, read_netlist
from inerter.suspension.rational import Rational
from typer.testing import CliRunner

VALUES = {
    "S1": (2e4, 1500.0), "S2": (2e4, 1500.0, 60.0), "S3": (2e4, 1500.0, 160.0),
    "S4": (2e4, 1500.0, 60.0, 2e5), "S5": (2e4, 1500.0, 160.0, 2e5),
    "S6": (2e4, 1500.0, 160.0, 8e3), "SR": (2e4, 1500.0, 0.0, 9e4),
}  # fmt: skip


def admittance(stiffness: Rational) -> Rational:
    return Rational(stiffness.numerator, np.append(0.0, stiffness.denominator))


@pytest.mark.parametrize("layout", VALUES)
def test_a_layout_comes_back_with_its_values(layout: str) -> None:
    found = ladder(admittance(LAYOUTS[layout].stiffness(*VALUES[layout])))
    assert found is not None
    usual = [x for x in VALUES[layout] if x]
    assert sorted(e.value for e in found.elements) == pytest.approx(sorted(usual), rel=1e-6)


def test_drawn_ladders_come_back_as_something_that_is_the_same() -> None:
    """Other values may have the same admittance; as many elements at most."""
    draw = np.random.default_rng(3)
    known = 0
    for _ in range(40):
        lines, node = [f"spring k0 body wheel {draw.uniform(1e4, 5e4)}"], "body"
        sizes = {"spring": (5e3, 3e5), "damper": (300.0, 5e3), "inerter": (10.0, 500.0)}
        kinds = draw.permutation(["spring", "damper", "inerter"])
        for n, kind in enumerate(kinds):
            size = np.exp(draw.uniform(*np.log(sizes[kind])))
            beside = n < 2 and draw.random() < 0.5
            other = "wheel" if beside or n == 2 else f"n{n}"
            lines.append(f"{kind} e{n} {node} {other} {size}")
            node = node if beside else other
        strut = read_netlist(lines).stiffness()
        found = ladder(admittance(strut))
        if found is None:
            continue
        known += 1
        assert len(found.elements) <= len(lines)
        s = 2j * np.pi * np.geomspace(0.05, 80.0, 30)
        assert found.stiffness()(s) == pytest.approx(strut(s), rel=1e-6)
    assert known >= 35


def test_what_has_no_ladder_is_used_as_it_is(tmp_path: Path) -> None:
    strut = LAYOUTS["SW7"].stiffness(2e4, 1500.0, 160.0, centring_share=0.3, centring_ratio=0.7)
    assert ladder(admittance(strut)) is None
    assert stiffness_of(admittance(strut))(2j) == pytest.approx(complex(strut(2j)))
    path = tmp_path / "strut.toml"
    top, below = (p.tolist() for p in (strut.numerator, strut.denominator))
    path.write_text(f"[admittance]\nnumerator = {top}\ndenominator = {[0.0, *below]}\n")
    answer = CliRunner().invoke(app, ["network", str(path), "--json"], catch_exceptions=False)
    assert answer.exit_code == 0, answer.output
    found = json.loads(answer.stdout)
    assert found["network"] is None
    assert found["stiffness"] == pytest.approx(2e4)


def test_the_command_tells_the_indices_of_a_layout(tmp_path: Path) -> None:
    c, b = 7544.2, 366.52
    top, below = [120e3, 120e3 * b / c, b], [0.0, 1.0, b / c]
    (tmp_path / "s3.toml").write_text(f"[admittance]\nnumerator = {top}\ndenominator = {below}\n")
    answer = CliRunner().invoke(app, ["network", str(tmp_path / "s3.toml")], catch_exceptions=False)
    # wang and su's table 1
    assert "J1 = 2.428" in answer.output
    assert "inerter b2 body n1 366.52" in answer.output
    assert "damper c3 n1 wheel 7544.2" in answer.output


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("numerator = [2e4, -5.0]\ndenominator = [0.0, 1.0]", "not positive real"),
        ("numerator = [1.0, 5.0]\ndenominator = [1.0, 1.0]", "no pole at s = 0"),
        ("numerator = [1.0]", "write numerator and denominator"),
        ("numerator = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]\ndenominator = [0.0, 1.0]", "degree 5"),
    ],
)
def test_what_is_no_strut_is_refused(text: str, told: str, tmp_path: Path) -> None:
    path = tmp_path / "strut.toml"
    path.write_text(f"[admittance]\n{text}\n")
    answer = CliRunner().invoke(app, ["network", str(path)], catch_exceptions=False)
    assert answer.exit_code == 2
    assert told in answer.output.replace("\n", " ")


def test_an_admittance_that_brings_energy_is_not_positive_real() -> None:
    assert not is_positive_real(Rational(np.array([2e4, -1.0, 60.0]), np.array([0.0, 1.0])))
