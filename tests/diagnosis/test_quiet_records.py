"""Records without noise, where every trace is certain: only what a measurement could show counts.

And records from simulations of a fraction of a second, or with gaps.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from inerter import Device
from inerter.diagnose import Diagnosis, diagnose, diagnose_bench
from inerter.models import model_path
from inerter.records import Record
from inerter.reference import ReferenceDevice, response, sum_of_sines
from inerter.report.output import write_outputs
from inerter.simulate.record import device_csv
from inerter.simulate.run import run_model

IDEAL = {"inertance": 80.0, "viscous": 300.0, "stiffness": 1e4}
MOTION = sum_of_sines([0.01, 0.003, 0.001], [1.3, 3.1, 7.7], [0.0, 1.0, 2.0])


def quiet(stated: dict, true: dict, delay: float = 0.0) -> Diagnosis:
    """What is found against a stated device where the true one was sampled at 500 Hz, no noise."""
    time = np.arange(0, 8, 2e-3)
    truth = response(ReferenceDevice(**true), MOTION, time)
    force = response(ReferenceDevice(**true), MOTION, time - delay).force
    record = Record(name="run", time=time, displacement=truth.displacement, force=force)
    return diagnose_bench([record], Device(**stated))


def effects(diagnosis: Diagnosis) -> list[str]:
    return [finding.effect for finding in diagnosis.findings]


@pytest.mark.parametrize(("share", "found"), [(1.0001, []), (1.01, ["inertance_error"])])
def test_an_error_that_no_load_cell_shows_is_none(share: float, found: list[str]) -> None:
    assert effects(quiet(IDEAL, {**IDEAL, "inertance": share * IDEAL["inertance"]})) == found


@pytest.mark.parametrize(("delay", "found"), [(0.015 * 2e-3, []), (5e-4, ["sensor_delay"])])
def test_a_delay_of_a_hundredth_of_the_sample_spacing_is_none(
    delay: float, found: list[str]
) -> None:
    assert effects(quiet(IDEAL, IDEAL, delay)) == found


@pytest.mark.parametrize(
    ("excess", "found"), [(0.1, ["coulomb_friction"]), (8.0, ["stribeck_friction"])]
)
def test_a_law_must_differ_visibly_from_a_plainer_one(excess: float, found: list[str]) -> None:
    friction = {"friction": "stribeck", "coulomb_force": 12.0, "static_force": 12.0 + excess,
                "stribeck_velocity": 0.04}  # fmt: skip
    assert effects(quiet(IDEAL, {**IDEAL, **friction})) == found


def written(path: Path, time: np.ndarray) -> Path:
    device = ReferenceDevice(**IDEAL)  # type: ignore[arg-type]
    truth = response(device, MOTION, time)
    columns = np.column_stack([time, truth.displacement, truth.force])
    np.savetxt(path, columns, delimiter=",", header="time,displacement,force", comments="")
    return path


@pytest.mark.long
def test_a_simulated_fifth_of_a_second_gives_files_that_load(tmp_path: Path) -> None:
    (tmp_path / "road.csv").write_text("time,road[mm]\n0.0,0\n0.1,20\n0.2,0\n")
    car = model_path("quarter_car", "scene.xml")
    run = run_model(car, keyframe="kerb", control=tmp_path / "road.csv")
    (tmp_path / "strut.csv").write_text(device_csv(run, run.devices[0]), encoding="utf-8")
    diagnosis = diagnose([tmp_path / "strut.csv"])
    # too little is left inside the ends to judge the lowest cut-offs by
    assert not np.isfinite(diagnosis.method["force_error_at_cutoffs"]).all()
    write_outputs(diagnosis, tmp_path / "out")
    found = json.loads((tmp_path / "out" / "diagnosis.json").read_text(encoding="utf-8"))
    assert None in found["method"]["force_error_at_cutoffs"]
    assert (tmp_path / "out" / "report.html").stat().st_size > 0


@pytest.mark.long
@pytest.mark.parametrize("end", [1.5, 2.5])
def test_it_is_judged_on_what_was_measured(tmp_path: Path, end: float) -> None:
    """Most of a record is a gap."""
    time = np.arange(0, 10, 2e-3)
    time = time[(time < end) | (time > 9.3)]
    diagnosis = diagnose([written(tmp_path / "gaps.csv", time)])
    assert 0.2 * time.size < diagnosis.method["held_out_samples"] < 0.4 * time.size
    assert diagnosis.extended.device["inertance"] == pytest.approx(IDEAL["inertance"], rel=0.05)


def test_nothing_left_to_judge_on_is_said(tmp_path: Path) -> None:
    time = np.arange(0, 0.15, 2e-3)
    with pytest.raises(ValueError, match=r"75 samples over 0\.148 s are too few"):
        diagnose([written(tmp_path / "short.csv", time)])
