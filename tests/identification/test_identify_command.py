"""`inerter identify`: files, JSON, terminal, and what it refuses."""

from __future__ import annotations

import json
import os
import re
from inspect import signature
from pathlib import Path
from typing import get_type_hints

import mujoco
import numpy as np
import plain_benches
import pytest
from inerter import load_plugin
from inerter.commands import app
from inerter.device_file import read_device, read_filters
from inerter.identify.command import identify_command
from inerter.identify.laws import PARTS
from random_devices import Drawn, drawn
from scipy.integrate import solve_ivp
from typer.testing import CliRunner

RUNNER = CliRunner()


@pytest.fixture(scope="module")
def case() -> Drawn:
    return drawn("dahl", 3)


@pytest.fixture(scope="module")
def folder(case: Drawn, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("records")
    for record in case.records:
        columns = {"displacement": record.displacement, "force": record.force}
        rows = zip(record.time, *columns.values(), strict=True)
        lines = ["time,displacement,force", *(",".join(map(repr, map(float, r))) for r in rows)]
        (path / f"{record.name}.csv").write_text("\n".join(lines) + "\n")
    return path


@pytest.fixture(scope="module")
def filtered_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Runs whose force went through a low-pass that takes 0.3 % of the inertance away."""
    path = tmp_path_factory.mktemp("filtered")
    for record in FILTERED.records:
        rows = zip(record.time, record.displacement, record.force, strict=True)
        lines = ["time,displacement,force", *(",".join(map(repr, map(float, r))) for r in rows)]
        (path / f"{record.name}.csv").write_text("\n".join(lines) + "\n")
    return path


FILTERED = plain_benches.drawn(27)


def run(*arguments: object) -> tuple[int, str, str]:
    result = RUNNER.invoke(app, ["identify", *map(str, arguments)])
    return result.exit_code, result.stdout, result.stderr


def test_files_and_json_say_the_same(case: Drawn, folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    status, stdout, stderr = run(
        folder, "--law", "viscous", "--law", "dahl", "--out", out, "--json"
    )
    assert status == 0, stderr
    said = json.loads(stdout)
    assert said == json.loads((out / "identification.json").read_text())
    assert said["schema"] == "inerter.identification/1"
    assert [each["law"] for each in said["results"]] == ["dahl", "viscous"]
    best = said["results"][0]
    for name, truth in case.parameters.items():
        low, high = best["parameters"][name]["interval"]
        assert low < best["parameters"][name]["value"] < high
        assert abs(best["parameters"][name]["value"] / truth - 1) < 0.05
    assert set(os.listdir(out)) == {
        "identification.json", "identification.png", "device.toml", "model.xml",
    }  # fmt: skip
    device = read_device(out / "device.toml")
    assert device.coulomb_force == pytest.approx(best["device"]["coulomb_force"], rel=1e-12)
    load_plugin()
    mujoco.MjModel.from_xml_path(str(out / "model.xml"))
    assert (out / "identification.png").read_bytes().startswith(b"\x89PNG")


def test_the_terminal_shows_laws_and_parameters(folder: Path, tmp_path: Path) -> None:
    status, stdout, _ = run(
        folder, "--law", "viscous", "--intervals", "normal", "--fix", "viscous=3",
        "--out", tmp_path / "o",
    )  # fmt: skip
    assert status == 0
    assert "held out" in stdout
    assert "inertance" in stdout


@pytest.mark.long
def test_a_simulation_refines_the_best_law(tmp_path: Path) -> None:
    """The force drives a damped mass on a spring; its displacement is 20 um noisy."""
    t = np.linspace(0.0, 6.0, 3001)
    force = 40 * np.sin(2 * np.pi * 1.3 * t) * np.minimum(t / 0.5, 1) + 20 * np.sin(30 * t)
    rows = solve_ivp(
        lambda s, y: [y[1], (np.interp(s, t, force) - 60 * y[1] - 9e3 * y[0]) / 10],
        (0, 6), [0, 0], t_eval=t, rtol=1e-8, atol=1e-10, max_step=2e-3,
    ).y[0]  # fmt: skip
    rows = rows + 2e-5 * np.random.default_rng(0).standard_normal(t.size)
    path = tmp_path / "run.csv"
    table = np.column_stack([t, rows, force])
    np.savetxt(path, table, delimiter=",", header="time,displacement,force", comments="")
    status, stdout, stderr = run(
        path, "--law", "viscous+stiffness", "--simulate", "--intervals", "normal", "--json",
        "--out", tmp_path / "o",
    )  # fmt: skip
    assert status == 0, stderr
    best = json.loads(stdout)["results"][0]
    assert best["law"] == "viscous+stiffness, simulated"
    assert best["motion"]["rmse"] == pytest.approx(2e-5, rel=0.1)
    for name, truth in (("inertance", 10), ("viscous", 60), ("stiffness", 9e3)):
        each = best["parameters"][name]
        assert abs(each["value"] - truth) < 4 * each["stderr"] + 2e-3 * truth


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--law", "dhal"], "did you mean dahl"),
        (["--law", ","], "--law is empty"),
        (["--fix", "inertance"], "KEY=VALUE"),
        (["--fix", "inertance=heavy"], "not a number"),
        (["--fix", "inertance=-3"], "inertance"),
        (["--holdout", "nothing"], "nothing"),
        (["--loss", "huge"], "linear"),
    ],
)
def test_a_mistake_gets_one_line_and_no_files(
    folder: Path, tmp_path: Path, arguments: list[str], message: str
) -> None:
    status, _, stderr = run(folder, "--out", tmp_path / "o", *arguments)
    assert status == 2
    assert message in stderr
    assert "Traceback" not in stderr
    assert not (tmp_path / "o").exists()


def test_a_table_is_not_a_record(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("frequency,force_amplitude,acceleration_amplitude\n1,2,3\n2,3,4\n3,4,5\n")
    status, _, stderr = run(path, "--out", tmp_path / "o")
    assert status == 2
    assert "table.csv" in stderr


def test_the_help_names_every_law_and_part() -> None:
    (law,) = (p for p in signature(identify_command).parameters.values() if p.name == "law")
    text = get_type_hints(identify_command, include_extras=True)[law.name].__metadata__[0].help
    assert set(PARTS) <= set(re.findall(r"\w+", text))
    page = Path(__file__).parents[2] / "docs" / "identification.md"
    assert set(PARTS) <= set(re.findall(r"`(\w+)`", page.read_text(encoding="utf-8")))


@pytest.mark.parametrize("simulate", [False, pytest.param(True, marks=pytest.mark.long)])
def test_a_stated_filter_is_taken_out(
    simulate: bool, filtered_folder: Path, tmp_path: Path
) -> None:
    bessel, order, cutoff = FILTERED.bench.force_filter or (False, 0, 0.0)
    assert (bessel, order) == (True, 2)
    stated = f"force=bessel:{cutoff}:{order}"
    law, out = ["--law", "coulomb+stiffness", "--intervals", "normal"], tmp_path / "out"
    law += ["--simulate"] if simulate else []
    status, stdout, stderr = run(filtered_folder, *law, "--filter", stated, "--out", out, "--json")
    assert status == 0, stderr
    for each in json.loads(stdout)["results"]:
        assert each["filters"] == {"force": f"bessel:{cutoff}:{order}"}
        # without the filter, and with a delay in its place, 0.3 % are missing
        value, truth = each["parameters"]["inertance"]["value"], FILTERED.parameters["inertance"]
        assert value == pytest.approx(truth, rel=5e-4), each["law"]
    assert read_filters(out / "device.toml") == {"force": f"bessel:{cutoff}:{order}"}


@pytest.mark.parametrize("given", ["bessel:50", "torque=bessel:50", "force=50"])
def test_what_is_no_filter_is_refused(given: str, folder: Path, tmp_path: Path) -> None:
    status, _, stderr = run(folder, "--filter", given, "--out", tmp_path / "out")
    assert status == 2
    assert "--filter" in stderr
    assert not (tmp_path / "out").exists()
