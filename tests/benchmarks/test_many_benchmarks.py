"""Benchmarks of many simulations, growth, identification and diagnosis: tiny, for shape only."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import mujoco
import pytest
from inerter.benchmark.rows import aims
from inerter.benchmark.timing import Timing
from test_benchmarks import check_rows, checkout  # noqa: F401 - a fixture of the module


def test_many(tmp_path: Path) -> None:
    from benchmarks import many

    rows = many.run(quick=True, sizes=(1, 3), total=6)
    check_rows(rows)
    questions = {row["question"] for row in rows}
    assert questions >= {"batch against one", "plugin against native"}
    assert {row["simulations"] for row in rows} == {1, 3}
    assert {row["way"] for row in rows} == {many.CALLED, many.AT_ONCE}
    many.picture(rows, tmp_path / "many.png")
    assert (tmp_path / "many.png").stat().st_size > 10_000


@pytest.mark.skipif(sys.platform != "linux", reason="resident memory is read from /proc")
def test_memory() -> None:
    from benchmarks import memory

    rows = memory.run(quick=True, share=1 / 16)
    assert {row["kind"] for row in rows} == set(memory.KINDS)
    for row in rows:
        # a simulation is more than the state that it holds
        assert row["bytes"] > row["state"] > 0


def test_growth(tmp_path: Path) -> None:
    from benchmarks import growth

    few = [s for s in growth.SUBJECTS if s.unit in ("cars", "bodies", "floors", "simulations")]
    rows = growth.run(quick=True, subjects=few, share=1 / 32)
    along = [s for s in growth.SUBJECTS if s.make is growth.growth_lab.along]
    rows += growth.run(quick=True, subjects=along, share=1 / 40)
    # at sizes as small as these an exponent can be anything
    check_rows([{k: v for k, v in row.items() if "exponent_" not in k} for row in rows])
    assert {row["aim"] for row in rows} == {None, growth.AIM}
    assert aims({"growth": rows})[0]["question"] == "growth of linear work"
    assert all(growth.summary(rows).values())
    growth.picture(rows, tmp_path / "growth.png")
    assert (tmp_path / "growth.png").stat().st_size > 10_000


@pytest.mark.parametrize("power", [0.5, 1.0, 3.0])
def test_exponent_of_a_power_is_the_power(power: float) -> None:
    from benchmarks.growth import exponent

    sizes = (2, 8, 32)
    times = [Timing((3.0 * size**power, 5.0 * size**power)) for size in sizes]
    spread = exponent(sizes, times)
    assert (spread.lower, spread.median, spread.upper) == pytest.approx((power,) * 3)


def test_growing_models_hold_as_many_devices_as_they_say() -> None:
    from benchmarks import growth_models

    for made in ("nested, device", "branches, device", "branches, stops, device"):
        model = mujoco.MjModel.from_xml_string(growth_models.cars(3, made))
        assert (model.nv, model.nplugin) == (6, 3)
        assert bool(model.jnt_limited.any()) == ("stops" in made)


def test_lab_tasks_of_growth_run() -> None:
    from benchmarks import growth_lab

    for make in (growth_lab.along, growth_lab.smoothing, growth_lab.jacobian):
        growth_lab.problem.cache_clear()
        make(2000).run()
    assert math.isfinite(growth_lab.starts(4).run().best.cost)  # type: ignore[attr-defined]


def test_identification() -> None:
    from benchmarks import diagnosis, identification

    rows = identification.run(quick=True, seconds=1.5, rounds=1)
    check_rows(rows)
    found: dict[tuple[str, str], dict[str, Any]] = {(r["device"], r["way"]): r for r in rows}
    plain = found["Coulomb", identification.ONE], found["Coulomb", identification.SCIPY]
    # what enters in proportion needs no differences, and the fit is the same
    assert plain[0]["evaluations"] < plain[1]["evaluations"]
    assert plain[0]["error"] == pytest.approx(plain[1]["error"], rel=0.05)
    asked = {row["question"] for row in rows}
    assert ("a fit against mujoco.sysid" in asked) == identification.has_sysid()
    assert bool(identification.notes()) != identification.has_sysid()
    record = diagnosis.made("viscous friction", 1.5)
    rows = identification.whole("viscous friction", record, [["ideal", "viscous"]])
    check_rows(rows)
    assert [(row["way"], row["samples"]) for row in rows] == [("2 laws", 6000)]
    assert rows[0]["met"] == (rows[0]["seconds"] <= 10)
    (told,) = aims({"identification": rows})
    assert told["least"] == told["most"] == rows[0]["seconds"]


def test_diagnosis(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from benchmarks import diagnosis

    monkeypatch.setenv("INERTER_RECORDS", str(tmp_path / "nowhere"))
    assert diagnosis.folder() is None
    assert "INERTER_RECORDS" in diagnosis.notes()[0]
    cases = diagnosis.cases(quick=True, seconds=2.0)
    assert [case.records for case in cases] == ["made"]
    rows = diagnosis.run(quick=True, chosen=cases, seconds=2.0)
    check_rows(rows)
    assert rows[0]["samples"] == 8_000
    assert rows[0]["found"] == "viscous_friction"
    assert diagnosis.long_record(2000).samples == 2000
