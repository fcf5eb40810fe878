"""Parameters that go with a third channel: made up, measured, and what cannot be."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from inerter.commands import app
from inerter.identify.modulation import Modulation, modulation
from inerter.identify.modulation_output import law_in_words, write_modulation
from inerter.records import Record, read_records
from typer.testing import CliRunner

SEALS = Path(__file__).parents[3] / "shared" / "data" / "pneumatic"


def runs(
    values: tuple[float, ...] = (1.0, 3.0, 5.0, 7.0),
    *,
    scaled: float = 4.0,
    seed: int = 0,
    one: bool = False,
) -> list[Record]:
    """20 kg, 100 N s/m, 500 N/m; friction 10 N and `scaled` N more per bar; 30 N/bar beside."""
    random, made = np.random.default_rng(seed), []
    time = np.arange(0.0, 12.0, 0.004)
    for number, value in enumerate(values):
        speed, phase = 2 * np.pi * np.array([0.4, 1.1, 1.9]), random.uniform(0, 6, 3)
        size = np.array([0.03, 0.01, 0.005])
        angle = speed[:, None] * time + phase[:, None]
        x, v, a = (
            size @ np.sin(angle),
            (size * speed) @ np.cos(angle),
            -(size * speed**2) @ np.sin(angle),
        )
        bar = np.full(time.size, value) + (np.linspace(-2, 2, time.size) if one else 0.0)
        force = 20 * a + 100 * v + 500 * x + (10 + scaled * bar) * np.sign(v) + 30 * bar
        force = force + random.normal(0, 1.0, time.size)
        moved = x + random.normal(0, 1e-6, time.size)
        extra = {"Pressure [bar]": bar}
        made.append(
            Record(name=f"run {number}", time=time, displacement=moved, force=force, extra=extra)
        )
    return made


def within(found: Modulation, name: str, truth: tuple[float, float]) -> None:
    each = next(p for p in found.parameters if p.name == name)
    at_middle = truth[0] + truth[1] * found.middle
    assert abs(each.value - at_middle) < 0.02 * abs(at_middle) + 4 * each.stderr
    if truth[1]:
        assert abs(each.slope - truth[1]) < 0.03 * abs(truth[1]) + 4 * each.slope_stderr
        assert 0 < each.slope_stderr < 0.1 * abs(truth[1])
    else:
        assert (each.slope, each.slope_stderr) == (0.0, 0.0)


TRUTH = {
    "inertance": (20.0, 0.0), "viscous": (100.0, 0.0), "stiffness": (500.0, 0.0),
    "coulomb_force": (10.0, 4.0), "force_offset": (0.0, 30.0),
}  # fmt: skip


def test_what_goes_with_the_channel_is_told_from_what_does_not() -> None:
    found = modulation(runs(), "pressure")
    assert (found.channel, found.unit) == ("Pressure", "bar")
    assert found.means == pytest.approx({f"run {i}": 1.0 + 2 * i for i in range(4)})
    for name, truth in TRUTH.items():
        within(found, name, truth)
    # a run left out is predicted about as well as by a fit of its own, the outer ones too
    for name, error in found.left_out.items():
        assert error < 1.2 * found.own[name]
        assert found.constant[name] > 10 * error
    friction = next(p for p in found.parameters if p.name == "coulomb_force")
    assert friction.own["run 3"] == pytest.approx(38.0, rel=0.05)
    assert "N/bar * (Pressure - 4.00" in law_in_words(found, friction)


def test_one_run_in_which_the_channel_changes_is_enough() -> None:
    found = modulation(runs((4.0,), one=True), "Pressure [bar]")
    within(found, "coulomb_force", (10.0, 4.0))
    assert len(found.left_out) == 4


@pytest.mark.parametrize("seed", range(4))
def test_nothing_but_the_offset_is_scaled_where_nothing_else_is(seed: int) -> None:
    found = modulation(runs(scaled=0.0, seed=seed), "pressure")
    assert [p.name for p in found.parameters if p.slope] == ["force_offset"]


def test_what_is_known_is_taken_off_and_goes_with_nothing() -> None:
    found = modulation(runs(), "pressure", {"inertance": 20.0, "coulomb_force": 26.0})
    assert [p.name for p in found.parameters] == ["force_offset", "viscous", "stiffness"]
    assert found.fixed == {"coulomb_force": 26.0, "inertance": 20.0}
    # damping stands in for friction that is held where it does not stay
    assert found.parameters[1].slope > 10.0
    alone = modulation(runs(), "pressure", {"inertance": 20.0})
    within(alone, "coulomb_force", (10.0, 4.0))
    assert max(alone.left_out.values()) < 1.2
    wrong = modulation(runs(), "pressure", {"inertance": 25.0})
    assert min(wrong.left_out.values()) > 2.0 * max(alone.left_out.values())


@pytest.mark.parametrize(
    ("fixed", "said"),
    [
        ({"delay": 0.1}, "--fix delay=0.1: with --scaled-by the law has force_offset"),
        ({"viscous": float("nan")}, "--fix viscous=nan: give a finite number"),
    ],
)
def test_what_cannot_be_fixed_is_said(fixed: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=re.escape(said)):
        modulation(runs(), "pressure", fixed)


def test_options_of_the_other_way_are_not_ignored(tmp_path: Path) -> None:
    """They were, without a word."""
    given = ["identify", "no.csv", "--scaled-by", "pressure", "--out", str(tmp_path)]
    told = CliRunner().invoke(app, [*given, "--law", "dahl", "--starts", "5"])
    assert told.exit_code == 2
    assert "has no use for --law, --starts" in " ".join(told.output.replace("│", " ").split())


def test_files(tmp_path: Path) -> None:
    found = modulation(runs(), "pressure")
    assert write_modulation(found, tmp_path) == ("modulation.json", "modulation.png")
    told = json.loads((tmp_path / "modulation.json").read_text())
    assert told["schema"] == "inerter.modulation/1"
    assert told["parameters"][1]["name"] == "coulomb_force"
    assert told["notes"] == []


def test_what_cannot_be_is_said() -> None:
    with pytest.raises(ValueError, match=r"voltage: run 0 has no such column.*Pressure"):
        modulation(runs(), "voltage")
    with pytest.raises(ValueError, match="it is 3 in all runs"):
        modulation(runs((3.0, 3.0)), "pressure")


@pytest.mark.skipif(not SEALS.exists(), reason="no measured records beside the checkout")
@pytest.mark.parametrize(("seal", "most"), [("nap310", 0.8), ("o-ring257", 1.0)])
def test_seals_have_one_law_over_pressure(seal: str, most: float) -> None:
    read = read_records(sorted(map(str, SEALS.glob(f"{seal}_*.csv"))))
    found = modulation([record for record in read if isinstance(record, Record)], "pressure")
    assert max(found.left_out.values()) < most
    assert min(found.constant.values()) > 50
    grows = {p.name: p for p in found.parameters}["viscous"]
    assert grows.slope > 10 * grows.slope_stderr > 0
    assert "late" in found.notes[0]
