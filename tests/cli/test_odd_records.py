"""Records that nobody meant to give: odd names, odd sizes, odd motions, odd devices.

Made without the package's own generator, so that an error common to both would show.
"""

from __future__ import annotations

import csv
import json
import tomllib
import warnings
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
import pytest
from inerter.commands import app
from typer.testing import CliRunner


class Made(NamedTuple):
    """Columns of one run."""

    time: np.ndarray
    displacement: np.ndarray
    force: np.ndarray


class Done(NamedTuple):
    """What a command left."""

    status: int
    printed: str
    stderr: str
    result: dict[str, Any]


def made(
    frequencies: tuple[float, ...] = (0.6, 1.9, 4.7),
    *,
    seed: int = 0,
    seconds: float = 4.0,
    rate: float = 250.0,
    size: float = 0.01,
    inertance: float = 100.0,
    coulomb: float = 0.0,
    noise: float = 0.01,
) -> Made:
    """A run of sines: force = inertance a + coulomb sign(v), white noise on both channels."""
    random = np.random.default_rng(seed)
    t = np.arange(0, seconds, 1 / rate)
    x, v, a = np.zeros((3, t.size))
    for f in frequencies:
        omega, phase = 2 * np.pi * f, random.uniform(0, 2 * np.pi)
        x += size / (1 + f) * np.sin(omega * t + phase)
        v += size / (1 + f) * omega * np.cos(omega * t + phase)
        a -= size / (1 + f) * omega**2 * np.sin(omega * t + phase)
    force = inertance * a + coulomb * np.sign(v)
    force = force + random.normal(0, 1, t.size) * noise * force.std()
    return Made(t, x + random.normal(0, 1, t.size) * 1e-3 * noise * x.std(), force)


def written(path: Path, runs: dict[str, Made]) -> Path:
    """One file with a run column."""
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["time", "displacement", "force", "run"])
        for name, run in runs.items():
            for row in zip(*run, strict=True):
                rows.writerow([*(f"{value:.12g}" for value in row), name])
    return path


def diagnosed(out: Path, *arguments: str | Path) -> Done:
    """`inerter diagnose`: 0 or 2, one line for 2, JSON without NaN, files that load."""
    command = ["diagnose", *map(str, arguments), "--json", "--out", str(out)]
    with warnings.catch_warnings():
        # as in the command: a warning is a line on stderr, not an error
        warnings.simplefilter("always")
        done = CliRunner().invoke(app, command)
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    assert done.exit_code in (0, 2)
    if done.exit_code == 2:
        assert len(done.stderr.strip().splitlines()) == 1, done.stderr
        return Done(2, done.stdout, done.stderr, {})

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    result = json.loads(done.stdout, parse_constant=refuse)
    tomllib.loads((out / "device.toml").read_text(encoding="utf-8"))
    assert mujoco.MjModel.from_xml_path(str(out / "model.xml")).nplugin == 1
    return Done(0, done.stdout, done.stderr, result)


def effects(done: Done) -> list[str]:
    return [finding["effect"] for finding in done.result["findings"]]


def test_names_are_kept_and_do_no_harm(tmp_path: Path) -> None:
    names = ["two words", "<script>alert(1)</script>", 'ünï → 😀 & "q" ]]>']
    runs = {name: made(seed=i, seconds=3) for i, name in enumerate(names)}
    record = written(tmp_path / "odd name (1).csv", runs)
    done = diagnosed(tmp_path / "out", record, "--holdout", f"odd name (1):{names[2]}")
    roles = {r["name"].partition(":")[2]: r["role"] for r in done.result["records"]}
    assert roles == {names[0]: "fit", names[1]: "fit", names[2]: "holdout"}
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "<script>alert" not in page


@pytest.mark.parametrize(
    ("size", "inertance", "coulomb"),
    [(0.003, 1.0, 0.1), (0.03, 1e4, 5e3)],
    ids=["small", "large"],
)
def test_coulomb_friction_of_any_size(
    tmp_path: Path, size: float, inertance: float, coulomb: float
) -> None:
    run = made(size=size, inertance=inertance, coulomb=coulomb)
    done = diagnosed(tmp_path / "out", written(tmp_path / "r.csv", {"a": run}))
    assert effects(done) == ["coulomb_friction"]
    finding = done.result["findings"][0]
    assert finding["parameters"]["coulomb_force"]["value"] == pytest.approx(coulomb, rel=0.06)
    assert done.result["extended"]["device"]["inertance"] == pytest.approx(inertance, rel=0.02)
    assert finding["gain"] > 0.4


def test_exact_data_bring_no_finding(tmp_path: Path) -> None:
    done = diagnosed(tmp_path / "out", written(tmp_path / "r.csv", {"a": made(noise=0)}))
    assert effects(done) == []
    assert done.result["baseline"]["nrmse"] < 1e-3
    assert done.result["baseline"]["device"]["inertance"] == pytest.approx(100, rel=1e-3)


@pytest.mark.parametrize("odd", ["60 samples", "drifts away"])
def test_record_that_no_cutoff_suits_is_refused(tmp_path: Path, odd: str) -> None:
    run = made(seconds=6)
    if odd == "60 samples":
        run = Made(*(channel[:60] for channel in run))
    else:
        run = run._replace(displacement=1e-3 * run.time)
    done = diagnosed(tmp_path / "out", written(tmp_path / "r.csv", {"a": run}))
    assert done.status == 2


@pytest.mark.long
def test_force_of_the_wrong_sign_is_not_called_right(tmp_path: Path) -> None:
    run = made(seconds=6)
    run = run._replace(force=-run.force)
    done = diagnosed(tmp_path / "out", written(tmp_path / "r.csv", {"a": run}))
    assert [w["code"] for w in done.result["records"][0]["warnings"]] == ["sign_flip"]
    assert done.result["baseline"]["nrmse"] > 0.5
    assert "simulation is right" not in done.result["verdict"]


def test_a_held_out_run_that_repeats_another_is_told_so(tmp_path: Path) -> None:
    runs = {"1": made(), "2": made(seed=1), "3": made()}
    record = written(tmp_path / "r.csv", runs)
    done = diagnosed(tmp_path / "out", record, "--holdout", "r:3")
    assert done.status == 2
    assert "no such run" not in done.stderr


def test_a_table_that_fits_badly_is_not_called_right(tmp_path: Path) -> None:
    table = tmp_path / "t.csv"
    table.write_text(
        "frequency,force_amplitude,acceleration_amplitude\n1,10,.1\n2,22,.2\n3,29,.3\n"
    )
    done = diagnosed(tmp_path / "out", table)
    assert "simulation is right" not in done.result["verdict"]
