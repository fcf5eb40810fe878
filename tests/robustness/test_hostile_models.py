"""Models that state the absurd: one line each, within bounds of memory."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
import pytest
from hostile_files import Cost
from hostile_models import MODELS, made
from inerter.core import DeviceError
from inerter.diagnose.vehicle.build import read_model
from inerter.models import model_path
from inerter.simulate.load import load_model
from inerter.simulate.run import SimulationError, run_model

TIMESTEPS = [name for name in MODELS if name.startswith("timestep_")]
pytestmark = pytest.mark.filterwarnings("ignore")


@pytest.mark.parametrize("name", TIMESTEPS)
def test_an_absurd_time_step_is_named_by_every_door(name: str, tmp_path: Path) -> None:
    path = made(name, tmp_path)
    stated = mujoco.MjSpec.from_file(str(path)).option.timestep
    words = f"the model's timestep is {stated:g} s; give one of 1e-09 to 1000 s"
    for error, door in ((SimulationError, load_model), (DeviceError, read_model)):
        with pytest.raises(error, match=re.escape(words)):
            door(path)
    assert load_model(path, timestep=0.001).opt.timestep == 0.001


def test_more_steps_than_anyone_waits_for_are_not_begun(tmp_path: Path) -> None:
    path = made("mass_nan", tmp_path)
    with pytest.raises(SimulationError, match=r"1e\+12 time steps of 1e-09 s, at most 1e\+09"):
        run_model(path, 1000, timestep=1e-9)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("gravity_huge", "diverged at t ="), ("mass_tiny", "must be larger than mjMINVAL"),
        ("inertance_nan", 'inertance is "nan"'), ("includes_itself", "already included"),
        ("includes_deep", "Empty include file 'part_299.xml'"),
        ("includes_endless", "names '/dev/zero': it is a device"),
        ("mesh_endless", "names '/dev/zero': it is a device"),
        ("names_pipe", "names 'mesh.stl': it is a pipe"), ("mesh_stated", "number of faces"),
        ("gravity_nan", "gravity in its <option> is not a number; correct it"),
        ("position_nan", "site_pos of site number 0 is not a number; correct it"),
        ("mass_huge", "acc0 of actuator 'strut' is not a number; look for masses"),
        ("texture_picture", "PNG file"),
        ("nested", "nesting is too deep"), ("not_xml", "EMPTY_DOCUMENT"), ("empty", "empty file"),
    ],
)  # fmt: skip
def test_an_absurd_model_is_one_line(name: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(SimulationError, match=words) as told:
        run_model(made(name, tmp_path), 0.01)
    assert "\n" not in str(told.value)


@pytest.mark.long
def test_a_model_that_is_never_done_is_given_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("INERTER_MOST_MODEL_SECONDS", "2")
    path = made("replicated", tmp_path)
    for error, door in ((SimulationError, load_model), (DeviceError, read_model)):
        with pytest.raises(error, match=r"is not done with it after 2 s.*INERTER_MOST_MODEL_SEC"):
            door(path)


def test_a_part_that_is_a_pipe_is_given_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Not named by the model itself, but by a part of it."""
    monkeypatch.setenv("INERTER_MOST_MODEL_SECONDS", "1")
    made("names_pipe", tmp_path).rename(tmp_path / "names_pipe" / "part.xml")
    path = tmp_path / "names_pipe" / "whole.xml"
    path.write_text('<mujoco><include file="part.xml"/></mujoco>')
    with pytest.raises(SimulationError, match="is not done with it after 1 s; a pipe among"):
        load_model(path)


def test_a_bound_that_is_none_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("INERTER_MOST_MODEL_BYTES", "-1")
    with pytest.raises(SimulationError, match="variable INERTER_MOST_MODEL_BYTES is '-1'"):
        load_model(made("replicated", tmp_path))


def test_random_bytes_are_no_compiled_model(tmp_path: Path) -> None:
    path = tmp_path / "model.mjb"
    path.write_bytes(np.random.default_rng(1).bytes(4000))
    with pytest.raises(SimulationError, match=r"^[^\n]*model\.mjb: [^\n]+$"):
        load_model(path)


def test_an_ordinary_model_is_compiled_where_it_is_wanted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A process of its own costs a second: only what may need one gets it, and once."""
    started: list[object] = []
    run = subprocess.run

    def counted(*args: object, **kwargs: object) -> object:
        started.append(args)
        return run(*args, **kwargs)  # type: ignore[call-overload]

    monkeypatch.setattr(subprocess, "run", counted)
    load_model(model_path("half_car"))
    load_model(made("inertance_huge", tmp_path))
    assert not started
    path = tmp_path / "whole.xml"
    path.write_text('<mujoco><include file="inertance_huge/model.xml"/></mujoco>')
    load_model(path)
    load_model(path)
    assert len(started) == 1


@pytest.mark.parametrize("name", MODELS)
def test_a_command_survives_it(name: str, tmp_path: Path, long_run: bool) -> None:
    """As `inerter simulate` gets it; the usual run takes what exhausts memory, once."""
    if not long_run and name != "users_stated":
        pytest.skip("--long takes every model")
    # from a small process: one counts what that had which it was forked from
    program = (
        "import json, sys; from pathlib import Path; from hostile_models import *\n"
        "found = cost(arguments(made(sys.argv[1], Path(sys.argv[2]))), limit=2 << 30)\n"
        "print(json.dumps([found.status, found.said, found.seconds, found.memory]))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, name, tmp_path], cwd=Path(__file__).parent,
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    found = Cost(*json.loads(done.stdout))
    assert found.status in (0, 2), found.said
    assert "Traceback" not in found.said
    # copies without number are given up where the bound on a model is
    assert found.memory < (1.2e9 if name == "replicated_twice" else 500e6)
    assert found.seconds < 20
