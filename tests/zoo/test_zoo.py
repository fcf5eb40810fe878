"""The zoo on models of our own: every kind of case, some seconds; `make zoo` takes public models.

What the zoo's checks would find is tested too: a device that is told a wrong inertance is found.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from zoo import checks, report  # noqa: E402
from zoo.campaign import load, order  # noqa: E402
from zoo.case import run_case  # noqa: E402
from zoo.draw import Case, Drawn, added  # noqa: E402
from zoo.models import bare, found_in, started  # noqa: E402

MODELS = Path(__file__).parent / "models"
NAMES = sorted(path.stem for path in MODELS.glob("*.xml"))


@pytest.fixture(autouse=True)
def quiet():
    """The engine's warnings go to the results, and back to where they went before."""
    before = mujoco.get_mju_user_warning()
    yield
    mujoco.set_mju_user_warning(before)


@pytest.mark.parametrize("number", [1, 2])
@pytest.mark.parametrize("name", NAMES)
def test_devices_drawn_into_our_models(name: str, number: int) -> None:
    found = run_case(MODELS / f"{name}.xml", 1, number)
    assert found["status"] in ("ran", "refused"), found
    assert not report.failures_of(found), report.text([{**found, **IDENTITY}])


IDENTITY = {"package": "ours", "path": "model.xml", "number": 0, "seed": 1}


# ------------------------------ the checks find what is wrong ------------------------------


def forces_of(told: float) -> dict[str, float]:
    """Figures of a line between two branches whose inertance, 2 kg, is told as another."""
    spec, small = bare(MODELS / "crawler.xml")
    points = (("front", np.array([0, 0, -0.2])), ("back", np.array([0, 0, -0.2])))
    case = Case([Drawn("zoo_0", {"between": points}, {"inertance": 2.0}, points=points)])
    model = added(spec, case).compile()
    case.devices[0].keys["inertance"] = told
    data = checks.same_state(small, started(small, np.random.default_rng(1), 5), model)
    forces = checks.Forces(small, model, case)
    for _ in range(5):
        forces.step(data)
    return forces.result()


def test_a_wrong_inertance_is_found() -> None:
    assert forces_of(2.0)["force"] < 1e-9
    assert forces_of(2.02)["force"] > 1e-3
    wrong = {"status": "ran", "figures": {**forces_of(2.02), "diverges": 1.0}}
    assert {"force", "diverges"} <= {text.split()[0] for text in report.failures_of(wrong)}


def test_forces_that_do_not_belong_to_the_motion_are_found() -> None:
    """The bare model moves otherwise without them."""
    spec, small = bare(MODELS / "loop.xml")
    spec.delete(spec.equalities[0])
    small = spec.compile()
    case = Case([Drawn("zoo_0", {"joint": "crank"}, {"inertance": 2.0}, joint="crank")])
    model = added(spec, case).compile()
    data = checks.same_state(small, mujoco.MjData(small), model)
    data.joint("crank").qpos[:] = 1.0
    forces = checks.Forces(small, model, case)
    forces.step(data)
    assert forces.result()["same_forces"] < 1e-9
    case.devices[0].gear = 0.5
    forces.step(data)
    assert forces.result()["same_forces"] > 1e-3


# ------------------------------ the campaign ------------------------------


def test_a_campaign_goes_on_where_it_was_broken_off(tmp_path: Path) -> None:
    path = str(MODELS / "loop.xml")
    earlier = {"seed": 1, "number": 0, "package": "models", "path": path, "status": "ran",
               "figures": {"force": 1e-12}}  # fmt: skip
    log = tmp_path / "cases.jsonl"
    log.write_text(json.dumps(earlier) + '\n{"seed": 1, "number": 7, "cut off')
    command = [sys.executable, "-m", "zoo", "--folder", str(MODELS), "--only", "loop",
               "--jobs", "1", "--cases", "2", "--out", str(tmp_path)]  # fmt: skip
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert "1 MJCF files of 1 packages" in done.stdout, done.stdout + done.stderr
    found = load(log)
    assert found[0] == earlier
    assert [each["number"] for each in found[:2]] == [0, 1]
    assert found[1]["status"] == "ran"
    assert "cases in 1 models" in (tmp_path / "report.txt").read_text()


def test_the_order_is_the_seed_s() -> None:
    models = found_in([MODELS])
    assert [path.stem for _, path in models] == NAMES
    turns = [[next(each)[2].stem for _ in NAMES] for each in (order(models, 1), order(models, 1))]
    assert turns[0] == turns[1]
    assert sorted(turns[0]) == NAMES
