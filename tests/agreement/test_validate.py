"""`inerter validate`: its oracles, its bounds, that it can fail, and the command."""

from __future__ import annotations

import json
import subprocess
import sys
from io import StringIO
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.commands import app
from inerter.core import Device
from inerter.reference import ReferenceDevice
from inerter.validate import Selection, bounds, mujoco_engine, plan
from inerter.validate.case import PUBLISHED, Case
from inerter.validate.inputs import INPUTS, signal
from inerter.validate.laws import INERTANCE, LAWS, exponents, in_units, state_exponents
from inerter.validate.models import models
from inerter.validate.mujoco_engine import run_mujoco
from inerter.validate.plan import ENGINES, SelectionError
from inerter.validate.result import Validation
from inerter.validate.run import QUANTITIES, RunError, errors
from inerter.validate.table import print_validation
from inerter.validate.task import Task, Wanted, run_task
from inerter.validate.truth import stepped, truth
from rich.console import Console
from scipy.linalg import expm
from typer.testing import CliRunner

CAR = "quarter_car/S2"


def case(law: str = "ideal", kind: str = "road", duration: float = 1.0, model: str = CAR) -> Case:
    return Case(model, law, kind, duration)


# ------------------------------ laws in other units ------------------------------


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("mass", "length"), [(1.0, 1e-5), (7.8, 1.0), (0.3, 20.0)])
def test_a_law_in_other_units_is_the_same_law(law: str, mass: float, length: float) -> None:
    """Forces go with mass * length, states and their rates with length, energy with its square.

    This is what similarity demands of a law, whatever it is; the units of the table are not asked.
    """
    here = Device(**LAWS[law].device)
    there = Device(**in_units(LAWS[law].device, mass=mass, length=length))
    rng = np.random.default_rng(3)
    x, v, a = rng.normal(size=(3, 50)) * [[5e-3], [0.1], [3.0]]
    z = rng.uniform(-1, 1, (50, here.nstate)) * [
        {"flywheel_velocity": 0.1, "gap_position": 5e-4}.get(name, 1e-3)
        for name in here.state_names
    ]
    one = here.evaluate(x, v, a, z)
    powers = [state_exponents(name, LAWS[law].device) for name in here.state_names]
    units = np.array([mass**m * length**n for m, n in powers])
    other = there.evaluate(length * x, length * v, length * a, units * z)
    rate = units if here.nstate > 1 else units.sum()
    sizes = {"total": mass * length, "stored_energy": mass * length**2, "state_rate": rate}
    for name, size in sizes.items():
        if name == "state_rate" and not here.nstate:
            continue
        scale = np.abs(one[name]).max(initial=0.0)
        np.testing.assert_allclose(other[name] / size, one[name], rtol=1e-9, atol=1e-9 * scale)


def test_the_units_of_some_parameters() -> None:
    assert exponents("inertance") == (1, 0)
    assert exponents("coulomb_force") == (1, 1)
    assert exponents("stiffness_cubic") == (1, -2)
    assert exponents("gas_pressure") == (1, -1)
    assert exponents("load_friction") == (0, 0)
    assert exponents("bw_beta", {"bw_exponent": 3.0}) == (0, -3)


# ------------------------------ inputs and laws ------------------------------


@pytest.mark.parametrize("kind", INPUTS)
def test_inputs_are_smooth(kind: str) -> None:
    """Differences of fourth order stay small: no jump, no kink, no seam of the pattern."""
    values = np.array([signal(kind, 4.0, 10.0, 0.1)(t) for t in np.arange(0, 10, 1e-3)])
    assert np.abs(values).max() <= 1.2
    # (2 pi f h)^4 of the highest frequency, that of ripple and sweep
    assert np.abs(np.diff(values, 4)).max() < (2 * np.pi * 12.5 * 1e-3) ** 4


def test_an_unknown_input() -> None:
    with pytest.raises(ValueError, match="'jolt' is not one of road, step, sine, sweep"):
        signal("jolt", 1.0, 1.0)


@pytest.mark.rarely("load_on_lugre", "load_on_maxwell_slip")
@pytest.mark.parametrize("law", [law for law in LAWS if law != "ideal"])
def test_every_law_acts(law: str) -> None:
    """The quarter-car moves otherwise than with the inertance alone, by far more than errors."""
    asked = case(law, duration=2.0)
    found, ideal = truth(asked, asked.times), truth(case(duration=2.0), asked.times)
    worst = errors(found, ideal)["displacement"]
    assert worst is not None
    assert worst > 3e-3


def travel(law: str) -> tuple[Any, Any, Any]:
    """Displacement and velocity of the strut, and the run."""
    asked = case(law, duration=2.0)
    run = truth(asked, asked.times)
    assert run.device_motion is not None
    return run.device_motion[0][:, 0], run.device_motion[1][:, 0], run


@pytest.mark.parametrize("law", ["coulomb", "stribeck", "lugre", "dahl"])
def test_friction_sticks_and_slides(law: str) -> None:
    _, v, run = travel(law)
    level, force = 200.0, np.abs(run.force[:, 0] - INERTANCE * np.gradient(v, run.time))
    # at rest at the end of the road, far above its transition in between
    assert np.mean(np.abs(v) < 2e-3) > 0.1
    assert np.abs(v).max() > 0.2
    assert np.median(force[np.abs(v) > 0.15]) == pytest.approx(level, rel=0.2)


def test_play_opens_on_both_sides_and_stops_are_hit() -> None:
    gap = travel("backlash")[2].state[0, "gap_position"] / 5e-4
    assert (gap == 1.0).any()
    assert (gap == -1.0).any()
    assert (np.abs(gap) < 0.9).any()
    x, _, _ = travel("end_stops")
    assert x.max() > 6.5e-3
    assert x.min() < -5.5e-3


# ------------------------------ the truth ------------------------------


@pytest.mark.parametrize("model", [CAR, "quarter_car/S1", "tuned_inerter_damper/floors"])
def test_the_truth_is_the_matrix_exponential(model: str) -> None:
    """A step on a linear model: y(t) = A^-1 (e^(A t) - 1) b, A from the rates of unit states."""
    asked = case(PUBLISHED, "step", model=model)
    structure = asked.setup.structure
    nothing = np.zeros(len(structure.mass))
    size = structure.nstate
    matrix = np.column_stack([structure.rates(unit, nothing) for unit in np.eye(size)])
    push = sum(
        part.push * part.size * asked.setup.amplitude for part in asked.setup.inputs.values()
    )
    extended = np.zeros((size + 1, size + 1))
    extended[:size, :size] = matrix
    extended[:size, size] = structure.rates(np.zeros(size), np.asarray(push))
    exact = np.array([expm(extended * t)[:size, size] for t in asked.times])
    found = truth(asked, asked.times)
    count = len(structure.mass)
    for values, part in (
        (found.displacement, exact[:, :count]),
        (found.velocity, exact[:, count : 2 * count]),
    ):
        assert np.abs(values - part).max() < 2e-9 * np.abs(part).max()


def test_stepping_the_reference_is_of_fourth_order() -> None:
    asked = case()
    true = truth(asked, asked.times)
    found = [errors(stepped(asked, h, 0.0), true)["velocity"] or 0.0 for h in (2.5e-3, 1.25e-3)]
    assert found[0] / found[1] == pytest.approx(16, rel=0.15)


@pytest.mark.parametrize(
    "law", ["ideal", "variable_inertance", "load_friction", "coulomb", "lugre", "end_stops"]
)
@pytest.mark.parametrize("file", models()[CAR].files.values())
def test_rk4_of_mujoco_is_the_formula_on_the_reference(law: str, file: str) -> None:
    """The same formula with the same steps on other equations gives the same numbers.

    Nothing of the step's own error is left in this comparison, corners of the laws or not: it is
    the sharpest one between the plugin and the reference.
    """
    asked = case(law)
    found = errors(run_mujoco(asked, file, "RK4", 1e-3), stepped(asked, 1e-3, 0.0))
    assert all(value is None or value < 1e-9 for value in found.values()), found


# ------------------------------ bounds ------------------------------


def rows_of(law: str, *integrators: str) -> list[Any]:
    wanted = tuple(Wanted("mujoco", name, "quarter_car_siblings") for name in integrators)
    return run_task(Task(case(law), wanted))


@pytest.mark.long
def test_a_wrong_device_is_out_of_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """An inertance that is off by 1 %: every law, integrators of first and of fourth order."""
    right = mujoco_engine.merged

    def wrong(kept: Any, law: Any) -> Any:
        found = right(kept, law)
        return found | {"inertance": 1.01 * float(found["inertance"])}

    for law in ("ideal", "lugre", "coulomb"):
        assert all(row.within for row in rows_of(law, "RK4", "implicitfast")), law
    monkeypatch.setattr(mujoco_engine, "merged", wrong)
    for law in ("ideal", "lugre", "coulomb"):
        (row,) = rows_of(law, "RK4")
        assert not row.within
        assert row.errors["displacement"] > 1e-4 > 2 * row.bound["displacement"]


def test_first_order_has_to_converge_to_the_right_motion() -> None:
    """Errors that do not shrink with the step are out of bounds, however small the step is."""
    (row,) = rows_of("ideal", "Euler")
    assert row.within
    assert row.order == pytest.approx(1.0, abs=0.1)
    assert row.bound["displacement"] < 3 * row.errors["displacement"]
    asked, own = case(), dict.fromkeys(QUANTITIES, 0.0)
    true = truth(asked, asked.times)
    still = bounds.bound(asked, 1.0, own, dict.fromkeys(QUANTITIES, 1e-5), true)
    assert not bounds.is_within(asked, dict.fromkeys(QUANTITIES, 1e-4), still, (0.1, 1.0))


def test_a_smooth_law_has_to_show_the_order() -> None:
    small = dict.fromkeys(QUANTITIES, 1e-8)
    wide = dict.fromkeys(QUANTITIES, 1e-6)
    assert bounds.is_within(case(), small, wide, (3.7, 4.0))
    assert not bounds.is_within(case(), small, wide, (2.0, 4.0))
    assert bounds.is_within(case("lugre"), small, wide, (2.0, 4.0))


def test_the_sensitivity_of_a_law_shrinks_with_the_step() -> None:
    asked = case("coulomb")
    true = truth(asked, asked.times)
    found = [bounds.sensitivity(asked, h, true)["velocity"] for h in (1e-3, 5e-4)]
    assert found[0] > 2 * found[1] > 0
    assert set(bounds.sensitivity(case(), 1e-3, true).values()) == {0.0}


def test_a_run_that_diverges_is_a_row_with_a_note(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: Any) -> Any:
        raise RunError("the run diverges")

    monkeypatch.setattr(mujoco_engine, "run_mujoco", fail)
    (row,) = rows_of("ideal", "RK4")
    assert not row.within
    assert row.note == "the run diverges"
    assert set(row.errors.values()) == {None}


def test_the_engine_is_left_as_it_was() -> None:
    before = mujoco.get_mjcb_control()
    run_mujoco(case(duration=0.05), "model.xml", "RK4", 1e-3)
    assert mujoco.get_mjcb_control() is before


def test_the_law_is_in_the_model() -> None:
    """Spring and damper of the strut stay, the law is added, in the units of the model."""
    asked = case("linear", model="half_car/S2")
    _, (front, _) = mujoco_engine.compiled(asked, "model.xml", "RK4", 1e-3)
    share = 30.0 / INERTANCE
    assert front.device.inertance == pytest.approx(30.0)
    assert front.device.viscous == pytest.approx(1290.0 + 500.0 * share)
    assert front.device.force_offset == pytest.approx(20.0 * share * 1e-5)
    assert (front.viscous, front.stiffness) == (1290.0, 19960.0)


def test_the_limit_of_the_element_is_said() -> None:
    """Load friction in Exudyn: explicit solvers are late by a stage, and converge all the same."""
    pytest.importorskip("exudyn")
    wanted = (Wanted("exudyn", "RK44", "quarter_car"), Wanted("exudyn", "DOPRI5", "quarter_car"))
    for row in run_task(Task(case("load_friction"), wanted)):
        assert row.note is not None
        assert "late by a stage" in row.note
        assert row.within
        assert (row.order or 0.0) > 0.9


# ------------------------------ selection ------------------------------


def test_the_plan_has_every_model_law_engine_integrator_and_input() -> None:
    tasks = plan.plan(Selection())
    cases = [task.case for task in tasks]
    assert {found.model for found in cases} == set(models())
    assert {found.law for found in cases} == {PUBLISHED, *LAWS}
    assert {found.input for found in cases} == set(INPUTS)
    assert {(w.engine, w.integrator) for task in tasks for w in task.wanted} == {
        (engine, name) for engine, names in ENGINES.items() for name in names
    }
    assert len({(c.model, c.law, c.input, c.headline) for c in cases}) == len(cases)
    smooth = {found.model for found in cases if found.headline}
    assert smooth == set(models())


def test_without_exudyn_it_is_left_out_with_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    tasks = plan.plan(Selection(), exudyn=False)
    assert {wanted.engine for task in tasks for wanted in task.wanted} == {"mujoco"}
    monkeypatch.setattr("inerter.validate.result.versions", lambda: {"exudyn": None})
    console = Console(record=True, width=200, file=StringIO())
    print_validation(Validation(Selection(), [], 0.0), console)
    assert "pip install exudyn" in console.export_text()


def test_exudyn_alone_without_exudyn() -> None:
    with pytest.raises(SelectionError, match="Exudyn, which is not installed: pip install"):
        plan.plan(Selection(engines=("exudyn",)), exudyn=False)


def test_names_that_are_none() -> None:
    with pytest.raises(SelectionError, match=r"--law: no 'lugra'.*did you mean lugre\?"):
        Selection(laws=("lugra",))
    with pytest.raises(SelectionError, match="no case is left"):
        plan.plan(Selection(models=("half_car",), laws=("gas_spring",)))


# ------------------------------ the command ------------------------------


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> tuple[Any, Path]:
    out = tmp_path_factory.mktemp("out") / "deep"
    names = ("Euler", "RK4", "DOPRI5", "GeneralizedAlpha")
    chosen = [word for name in names for word in ("--integrator", name)]
    command = [sys.executable, "-m", "inerter", "validate", "--quick", "--model", "quarter_car"]
    command += ["--law", "ideal", "--law", "lugre", *chosen, "--jobs", "2", "--json"]
    done = subprocess.run(
        [*command, "--out", str(out)], capture_output=True, text=True, check=False
    )
    return done, out


def test_json_alone_on_stdout_and_two_files(finished: tuple[Any, Path]) -> None:
    done, out = finished
    assert (done.returncode, done.stderr) == (0, ""), done.stdout[:2000]
    found = json.loads(done.stdout)
    assert found == json.loads((out / "validation.json").read_text())
    assert found["schema"] == "inerter.validation/1"
    assert found["within"] is True
    assert sorted(path.name for path in out.iterdir()) == ["validation.json", "validation.png"]
    assert (out / "validation.png").read_bytes().startswith(b"\x89PNG")


def test_every_row_is_within_its_bound(finished: tuple[Any, Path]) -> None:
    found = json.loads(finished[0].stdout)
    rows = found["rows"]
    models_found = {row["model"] for row in rows}
    assert models_found == {"quarter_car", "quarter_car_siblings"}
    assert {row["law"] for row in rows} == {"ideal", "lugre"}
    for row in rows:
        assert set(row["errors"]) == set(row["bound"]) == set(QUANTITIES)
        assert row["within"] is True
        for name, value in row["errors"].items():
            assert value is None or 0 < value <= row["bound"][name]
        if row["integrator"] in ("RK4", "DOPRI5") and row["law"] == "ideal":
            assert max(row["bound"].values()) == 1e-6
        if row["integrator"] == "Euler":
            assert row["order"] == pytest.approx(1.0, abs=0.15)
        if row["integrator"] == "GeneralizedAlpha" and row["law"] == "ideal":
            assert row["order"] == pytest.approx(2.0, abs=0.1)
        assert (row["errors"]["state"] is None) == (row["law"] == "ideal")
    for group in found["summary"]:
        there = [
            row["errors"]["velocity"]
            for row in rows
            if (row["engine"], row["integrator"]) == (group["engine"], group["integrator"])
            and (row["kind"] == "smooth") == (group["kind"] == "smooth")
        ]
        assert group["errors"]["velocity"] == max(there)
        assert group["rows"] == len(there)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--model", "quarter_cart"), "did you mean quarter_car"),
        (("--law", "friction"), "there is published, ideal, linear"),
        (("--engine", "drake"), "there is mujoco, exudyn"),
        (("--integrator", "rk4"), "did you mean RK4?"),
        (("--engine", "mujoco", "--integrator", "RK67"), "leave one of them out"),
    ],
)
def test_bad_options_are_one_line(arguments: tuple[str, ...], words: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(app, ["validate", *arguments, "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert words in done.stderr
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = CliRunner().invoke(app, ["validate", "--quick", "--out", str(tmp_path / "file")])
    assert done.exit_code == 2
    assert "choose --out" in done.stderr


def test_the_reference_takes_every_law() -> None:
    """The same parameters are legal there, in any units."""
    for law in LAWS.values():
        ReferenceDevice(**in_units(law.device, mass=0.2, length=1e-5))  # type: ignore[arg-type]
