"""Every benchmark gives rows of one shape with finite numbers; what they compare is the same thing.

No time is asserted here. The settings are tiny: this asks whether the benchmarks work.
"""

from __future__ import annotations

import json
import math
import shutil
import sys
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter import Device
from inerter.benchmark.cars import CARS, INTEGRATORS, NATIVE, PLUGIN, car_xml, jolt
from inerter.benchmark.laws import LAWS, parameters_of
from inerter.benchmark.motion import SPACING, along_costs, samples
from inerter.benchmark.python_way import coupled_steps, passive_callback
from inerter.benchmark.step import CALLBACK, LOOP, step_costs, tables
from inerter.commands import app
from typer.testing import CliRunner

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module", autouse=True)
def checkout() -> Any:
    """The benchmarks are a package of the checkout, not of the installation."""
    sys.path.insert(0, str(ROOT))
    yield
    sys.path.remove(str(ROOT))


def check_rows(rows: list[dict[str, Any]]) -> None:
    """One shape, numbers finite, ratios between their quartiles."""
    assert rows
    for row in rows:
        assert row.keys() == rows[0].keys()
        for key, value in row.items():
            if isinstance(value, float):
                assert math.isfinite(value), key
            if key.endswith("_lower") and value is not None:
                name = key.removesuffix("_lower")
                assert 0 < value <= row[name] <= row[f"{name}_upper"]
    json.dumps(rows, allow_nan=False)


# ------------------------------ cars --------------------------------------------------------------


def moved(car: str, made: str, integrator: str, *, branches: bool, step: float) -> np.ndarray:
    """Heights of body and wheels after 0.05 s, and pitch and roll."""
    model = mujoco.MjModel.from_xml_string(car_xml(car, made, integrator, branches=branches))
    model.opt.timestep = step
    data = mujoco.MjData(model)
    data.qvel[:] = jolt(car)
    mujoco.mj_step(model, data, round(0.05 / step))
    wheels = len(CARS[car].wheels)
    heights = [data.body(f"wheel{i}").xpos[2] for i in range(wheels)]
    return np.array([*data.qpos[:-wheels], *heights])


@pytest.mark.parametrize("car", CARS)
def test_nested_and_branches_are_the_same_car(car: str) -> None:
    """Two topologies, two ways of the inertance, one motion; tyres are linear in small angles."""
    nested, branches = (
        moved(car, "plugin lugre", "RK4", branches=branches, step=5e-4)
        for branches in (False, True)
    )
    assert nested == pytest.approx(branches, abs=1e-12 if car == "quarter-car" else 2e-5)
    assert np.abs(nested).max() > 2e-3


def test_plugin_and_native_are_the_same_car() -> None:
    for own, native in (("plugin none", "armature"), ("plugin lugre", "native lugre")):
        runs = [
            moved("half-car", made, "Euler", branches=False, step=1e-4) for made in (own, native)
        ]
        assert runs[0] == pytest.approx(runs[1], abs=1e-5), own


def test_the_python_ways_are_the_same_car() -> None:
    """The callback and the loop do what the plugin does, to the order of their steps."""
    model = mujoco.MjModel.from_xml_string(car_xml("half-car", "armature", "Euler"))
    model.opt.timestep = 1e-4
    data = mujoco.MjData(model)
    data.qvel[:] = jolt("half-car")
    mujoco.set_mjcb_passive(passive_callback(model))
    try:
        mujoco.mj_step(model, data, 500)
    finally:
        mujoco.set_mjcb_passive(None)
    own = moved("half-car", "plugin lugre", "Euler", branches=False, step=1e-4)
    assert data.qpos[:2] == pytest.approx(own[:2], abs=5e-5)

    model = mujoco.MjModel.from_xml_string(car_xml("half-car", "bare", "Euler", branches=True))
    data = mujoco.MjData(model)
    data.qvel[:] = jolt("half-car")
    coupled_steps(model, data, 50)
    own = moved("half-car", "plugin none", "Euler", branches=True, step=1e-3)
    assert data.qpos[:2] == pytest.approx(own[:2], rel=1e-6, abs=1e-9)


def test_every_variant_loads() -> None:
    for made in (*NATIVE, *PLUGIN):
        for integrator in INTEGRATORS:
            mujoco.MjModel.from_xml_string(car_xml("full-car", made, integrator))


# ------------------------------ rows --------------------------------------------------------------


def test_one_step() -> None:
    rows = step_costs(["quarter-car"], ["Euler", "RK4"], rounds=1, steps=10)
    check_rows(rows)
    variants = {row["variant"] for row in rows}
    assert variants == {*NATIVE, *PLUGIN, CALLBACK, LOOP}
    # a loop of half steps cannot have stages
    assert {row["integrator"] for row in rows if row["variant"] == LOOP} == {"Euler"}
    for row in rows:
        assert (row["aim"] is None) or (row["question"] and row["met"] in (True, False))
    for title, lines in tables(rows).items():
        assert "quarter-car" in title
        assert {"Euler", "RK4"} <= lines[0].keys()


def test_along_motion_of_the_package() -> None:
    rows = along_costs(rounds=1, count=200)
    check_rows(rows)
    assert [row["law"] for row in rows] == list(LAWS)


def test_along_motion(checkout: None, monkeypatch: pytest.MonkeyPatch) -> None:
    from benchmarks import along_motion

    monkeypatch.setattr(along_motion.instructions, "lacking", lambda: "not here")
    monkeypatch.setattr(along_motion, "_has_numba", lambda: False)
    rows = along_motion.run(quick=True, laws=("none", "lugre"))
    check_rows(rows)
    assert [row["numba_ratio"] for row in rows] == [None, None]
    assert "pip install numba" in " ".join(along_motion.notes())


def test_the_laws_of_scipy_are_the_core_s() -> None:
    from benchmarks.along_motion import COMPARED, _scipy_work

    count = 400
    x, v, a = samples(count)
    for law in COMPARED:
        own = Device(**parameters_of(law)).along(SPACING, x, v, a)["total"]
        # steps of the core follow the mean velocity between samples
        found = np.asarray(_scipy_work(law, count).run(), dtype=np.float64)
        assert np.abs(found - own).max() < 2e-2 * np.abs(own).max(), law


def test_the_laws_of_numba_are_the_core_s() -> None:
    pytest.importorskip("numba")
    from benchmarks.along_motion import COMPARED
    from benchmarks.laws_numba import along

    x, v, a = samples(500)
    for law in COMPARED:
        own = Device(**parameters_of(law)).along(SPACING, x, v, a)["total"]
        assert along(law)(SPACING, x, v, a) == pytest.approx(own, rel=1e-10, abs=1e-9)


@pytest.mark.long
@pytest.mark.skipif(
    sys.platform != "linux" or shutil.which("valgrind") is None, reason="valgrind is not installed"
)
def test_instructions_are_counted() -> None:
    from benchmarks.instructions import counts

    found = counts(("coulomb", "lugre", "maxwell_slip"))
    for total, library, least in found.values():
        # several samples at once, where the processor can
        assert 0 <= library < least
        assert 0.2 * least < total < 4 * least
    # exp and tanh are the core's own
    assert found["coulomb"][1] == 0


def test_callgrind_s_output_is_read() -> None:
    from benchmarks.instructions import by_library

    profile = """
ob=(1) /lib/libcore.so
fn=(1) along
0 10
cob=(2) /lib/libm.so.6
cfn=(2) exp
calls=3 0
0 60
+3 5
ob=(2)
fn=(2)
0 60
"""
    assert by_library(profile) == {"libcore.so": 15, "libm.so.6": 60}


@pytest.mark.long
@pytest.mark.skipif(
    sys.platform != "linux" or shutil.which("valgrind") is None, reason="valgrind is not installed"
)
def test_instructions_of_a_step_have_an_owner() -> None:
    from benchmarks.step_instructions import counted

    native, plugin = (
        counted("quarter-car", made, "Euler", branches=False)
        for made in ("native lugre", "plugin lugre")
    )
    assert native.for_device == native.device == 0
    # the engine does as much as with its own friction, and some for the plugin's slots
    assert native.engine < plugin.engine < 1.2 * native.engine
    assert 100 < plugin.device < 0.3 * plugin.engine
    assert 0 < plugin.for_device < plugin.device


def test_what_a_device_lets_the_engine_do_counts_for_it() -> None:
    from benchmarks.step_instructions import by_owner

    profile = """
ob=(1) /lib/libmujoco.so
fn=(1) mj_step
0 100
cob=(2) /lib/libinerter_mujoco.so
cfn=(2) compute
calls=1 0
0 37
calls=2 0
0 50
ob=(2)
fn=(2) compute
0 30
cob=(1)
cfn=(3) mj_solveM
calls=1 0
0 7
ob=(1)
fn=(3) mj_solveM
0 7
fn=(4) mj_kinematics
0 50
"""
    assert by_owner(profile) == (150, 7, 30)


def test_exudyn_cost() -> None:
    pytest.importorskip("exudyn")
    from benchmarks import exudyn_cost

    rows = exudyn_cost.run(quick=True)
    check_rows(rows)


# ------------------------------ work against precision --------------------------------------------


def test_programs_agree_on_the_precision_car() -> None:
    """MuJoCo, SciPy and whatever else is installed end where the truth is, each to its order."""
    from benchmarks.precision_car import error_of
    from benchmarks.precision_solvers import solvers

    settings = {"RK4": 1e-3, "RK44": 1e-3, "Newmark": 1e-3, "DOPRI5": 1e-8, "odeint": 1e-8}
    limits = {"Newmark": 1e-2}
    for solver in solvers():
        method = solver.name.split()[-1]
        if method in settings:
            attempt = solver.attempt("ideal", settings[method])
            if attempt.work.prepare:
                attempt.work.prepare()
            attempt.work.run()
            assert error_of("ideal", attempt.end()) < limits.get(method, 1e-6), solver.name


@pytest.mark.parametrize("problem", ["ideal", "lugre"])
def test_the_truth_does_not_hang_on_its_step(problem: str) -> None:
    from benchmarks.precision_car import truth_error

    # the programs are compared down to 1e-9
    assert truth_error(problem) < 1e-11


@pytest.mark.long
def test_work_precision() -> None:
    from benchmarks import work_precision

    # on a slow machine 1e-6 takes longer than quick runs may
    rows = work_precision.run(quick=True, only=("plugin, RK4", "odeint"), longest=2.0)
    check_rows(rows)
    best = [row for row in rows if row["aim"]]
    questions = [f"{name}: ahead of the next at 1e-06" for name in ("ideal", "lugre")]
    assert [row["question"] for row in best] == questions
    assert all(row["error"] < 1.0 for row in rows if row["error"] is not None)
    assert all(work_precision.summary(rows).values())


@pytest.mark.parametrize(
    ("target", "expected"),
    [(1e-3, 1.0), (1e-4, math.sqrt(10.0)), (1e-5, 10.0), (1e-9, None)],
)
def test_time_for_an_error_is_interpolated(target: float, expected: float | None) -> None:
    from benchmarks.work_precision import time_for

    assert time_for(target, [1e-3, 1e-5], [1.0, 10.0]) == (expected and pytest.approx(expected))


def test_an_error_that_comes_back_counts_as_not_reached() -> None:
    from benchmarks.work_precision import time_for

    errors, times = [1e-2, 1e-5, 1e-3, 1e-5], [1.0, 2.0, 4.0, 8.0]
    found = time_for(1e-4, errors, times)
    assert found is not None
    assert 4.0 < found < 8.0


# ------------------------------ commands ----------------------------------------------------------


def test_make_bench_writes_json_and_a_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from rich.console import Console

    from benchmarks import __main__ as frame

    def few(quick: bool) -> list[dict[str, Any]]:
        return step_costs(tuple(CARS)[:1], ["Euler", "RK4"], 1, 10)

    chosen = frame.BENCHMARKS["one_step"]
    monkeypatch.setitem(
        frame.BENCHMARKS, "one_step", frame.Benchmark("a step", few, chosen.summary, None)
    )
    monkeypatch.setitem(
        frame.BENCHMARKS, "absent", frame.Benchmark("?", few, needs=("no_such_package",))
    )
    with (tmp_path / "log").open("w") as log:
        frame.run(["one_step", "absent"], True, tmp_path, Console(file=log, width=100))
    found = json.loads((tmp_path / "bench.json").read_text())
    assert found["schema"] == "inerter.benchmark/1"
    assert list(found["benchmarks"]) == ["one_step"]
    assert "pip install no_such_package" in (tmp_path / "log").read_text()


def test_pictures_are_drawn(tmp_path: Path) -> None:
    from benchmarks import along_motion, one_step, work_precision

    step = step_costs(tuple(CARS), ["Euler"], 1, 5)
    one_step.picture(step, tmp_path / "a.png")
    precision = work_precision.run(quick=True, only=("odeint",))
    work_precision.picture(precision, tmp_path / "b.png")
    row = dict.fromkeys(("numba_ratio", "scipy_ratio", "reference_ratio"), 2.0)
    along_motion.picture(
        [row | {"law": law, "million_samples_per_second": 1.0} for law in LAWS], tmp_path / "c.png"
    )
    assert all((tmp_path / f"{name}.png").stat().st_size > 10_000 for name in "abc")


def test_bench_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from inerter.benchmark import report

    monkeypatch.setattr(
        report, "step_costs", lambda *_: step_costs(["quarter-car"], ["Euler"], 1, 5)
    )
    monkeypatch.setattr(report, "along_costs", lambda *_: along_costs(1, 100))
    out = tmp_path / "out"
    done = CliRunner().invoke(app, ["bench", "--quick", "--out", str(out)])
    assert done.exit_code == 0, done.output
    assert "over the armature's" in done.output
    written = json.loads((out / "bench.json").read_text())
    done = CliRunner().invoke(app, ["bench", "--quick", "--json"])
    printed = json.loads(done.stdout)
    assert printed.keys() == written.keys() == {"schema", "quick", "machine", "benchmarks"}
    for part in printed["benchmarks"].values():
        check_rows(part["rows"])

    (tmp_path / "file").write_text("")
    done = CliRunner().invoke(app, ["bench", "--out", str(tmp_path / "file")])
    assert done.exit_code == 2
    assert "choose --out" in done.stderr
