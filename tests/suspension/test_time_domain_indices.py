"""Every index of the linear study in the time domain: filtered, of turning, and a user's own."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inerter.cars.read import shipped_car
from inerter.suspension.commands import app
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.cases import CASES
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.evaluate import evaluate
from inerter.suspension.time_domain.model import compiled
from inerter.suspension.time_domain.own_struts import evaluate_own
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.resolution import on_sinusoids
from inerter.suspension.time_domain.road import PeriodicRoad, iso_road
from inerter.suspension.time_domain.simulate import RunSettings, road_indices
from inerter.suspension.vehicle.cars import full_car, half_car
from typer.testing import CliRunner

SHORT = RunSettings(settle=8.0, jobs=2)
SEAT = '[index]\nsignal = "J1"\nnumerator = [1.0, 0.02, 1e-4]\ndenominator = [1.0, 0.05, 2e-3]\n'
GRIP = '[index]\nsignal = "J3"\nnumerator = [0.5, 0.01]\ndenominator = [1.0, 0.03]\nunit = "N"\n'
COST = "def cost(J1w, J3, travel):\n    return J1w + 1e-3 * J3 + 20.0 * travel\n"
QUARTER = Design(120e3, 4000.0, 80.0)
TWO_AXLES = Design(20e3, 2000.0, 30.0, rear=Design(17.5e3, 1800.0, 20.0))


def own(folder: Path) -> tuple[str, ...]:
    """Filters and a function in files."""
    (folder / "seat.toml").write_text(SEAT)
    (folder / "grip.toml").write_text(GRIP)
    (folder / "mine.py").write_text(COST)
    return str(folder / "seat.toml"), str(folder / "grip.toml"), f"{folder / 'mine.py'}:cost"


@pytest.mark.parametrize(
    ("car", "layout", "case", "design", "turns"),
    [
        (QuarterCar(), "S2", "ideal", QUARTER, ()),
        (QuarterCar(), "S3", "elastic", Design(120e3, 7544.2, 366.52), ()),
        (half_car(), "S2", "ideal", TWO_AXLES, ("pitch",)),
        (full_car(), "S2", "ideal", TWO_AXLES, ("pitch", "roll")),
    ],
)
def test_linear_cars_have_the_indices_of_their_transfer_functions(
    tmp_path: Path, car: Any, layout: str, case: str, design: Design, turns: tuple[str, ...]
) -> None:
    """Simulated on one road against the sum over that road's sinusoids."""
    road, names = iso_road("C"), ("J1w", "travel", *turns, *own(tmp_path))
    model = compiled(layout, CASES[case], car, design=design)
    found = road_indices(model, [design], road, range(4), SHORT, indices=names)
    for name in names:
        exact = on_sinusoids(name, layout, design, CASES[case].pair, car, road)
        # left and right of a full car are correlated by chance, besides
        near = 0.15 if name == "roll" else 0.03 if car == full_car() else 2e-3
        assert np.mean(found[name]) == pytest.approx(exact, rel=near), name


@pytest.mark.parametrize("signal", ["J1", "J3"])
def test_a_filter_that_is_a_number_multiplies(tmp_path: Path, signal: str) -> None:
    """Also what acts at once through a rigid inerter and is faster than the steps; with friction.

    Steps of 5 ms leave everything above 100 Hz to the closed form.
    """
    path = tmp_path / "twice.toml"
    path.write_text(f'[index]\nsignal = "{signal}"\nnumerator = [2.0]\ndenominator = [1.0]\n')
    model = compiled("S2", CASES["friction100"], QuarterCar(), one_sided=True, design=QUARTER)
    road = PeriodicRoad("rough", 1e-3, 1, 3000, 25.0)
    found = road_indices(
        model, [QUARTER], road, [1, 2], RunSettings(step=2e-3, jobs=2), indices=(str(path),)
    )
    assert found[str(path)] == pytest.approx(2.0 * found[signal], rel=1e-9)
    assert found["lift_off"].min() > 0.0


def test_rows_of_own_indices_are_sought_anew_and_exact(tmp_path: Path) -> None:
    """The exact value lies in the interval, and a search does not lose on the roads it used."""
    *_, cost = own(tmp_path)
    kept = Plan(
        layouts=("S2",),
        cases=(CASES["ideal"], CASES["friction100"]),
        indices=("J1w", cost),
        seeds=2,
        search_seeds=2,
        settings=RunSettings(step=2e-3, jobs=2),
    )
    anew = dataclasses.replace(kept, indices=(cost,), reoptimise=True)
    before, after = (
        {(row.index, row.case): row for row in evaluate(plan)} for plan in (kept, anew)
    )
    for name in ("J1w", cost):
        ideal, rubbed = before[name, "ideal"], before[name, "friction100"]
        assert ideal.exact == pytest.approx(ideal.value, rel=1e-3)
        assert rubbed.exact is None
        assert rubbed.linear == ideal.exact
    sought, rubbed = (rows[cost, "friction100"] for rows in (after, before))
    assert sought.value < rubbed.value
    assert sought.damping < rubbed.damping
    # they are different questions
    assert before["J1w", "ideal"].damping != pytest.approx(before[cost, "ideal"].damping, rel=0.01)


def run(words: str) -> Any:
    return CliRunner().invoke(app, words.split(), catch_exceptions=False)


def test_the_command_takes_the_indices_of_optimize(tmp_path: Path) -> None:
    seat, _, cost = own(tmp_path)
    words = f"evaluate --layout S2 --case ideal --damping 4000 --inertance 80 --out {tmp_path}"
    words += " --seeds 2"
    answer = run(f"{words} --index j1w,{seat},{cost} --road iso:C --json")
    assert answer.exit_code == 0, answer.output
    rows = json.loads(answer.stdout)["rows"]
    assert [row["index"] for row in rows] == ["J1w", seat, cost]
    for row in rows:
        assert row["value"] == pytest.approx(row["exact"], rel=0.02)
    # a table has a place for a long name
    shown = run(f"{words} --index {cost} --road iso:C")
    assert shown.exit_code == 0
    assert "value ± 95 %" in shown.output
    refused = run(f"{words} --index pitch")
    assert refused.exit_code != 0
    assert "a quarter-car has none" in refused.output
    refused = run(f"{words} --index travel")
    assert refused.exit_code == 2
    assert "travel_rms" in refused.output
    refused = run(f"{words} --index J9")
    assert refused.exit_code != 0
    assert "choose from J1" in refused.output


def test_a_car_as_its_file_states_it_tells_own_indices(tmp_path: Path) -> None:
    """A function of figures, a filter, and their exact values beside."""
    names = own(tmp_path)
    found = evaluate_own(shipped_car("half"), iso_road("C"), 2, RunSettings(jobs=2), indices=names)
    figures = {each.name: each for each in found.figures}
    for name in (*names, "J1", "J1w"):
        assert figures[name].value == pytest.approx(figures[name].linear, rel=0.02)
    assert figures[names[-1]].value == pytest.approx(
        figures["J1w"].value + 1e-3 * figures["J3"].value + 20.0 * figures["travel"].value, rel=1e-3
    )
    with pytest.raises(ValueError, match="J5"):
        evaluate_own(shipped_car("half"), iso_road("C"), 2, RunSettings(), indices=("J5",))
