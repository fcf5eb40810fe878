"""Models that state the absurd: one line each, within bounds of memory."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import mujoco
import pytest
from hostile_files import Cost
from hostile_models import MODELS, made
from inerter.core import DeviceError
from inerter.diagnose.vehicle.build import read_model
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
        ("includes_endless", "Empty file '/dev/zero'"), ("mesh_stated", "number of faces"),
        ("mesh_endless", "no decoder found for mesh file"), ("texture_picture", "PNG file"),
        ("nested", "nesting is too deep"), ("not_xml", "EMPTY_DOCUMENT"), ("empty", "empty file"),
    ],
)  # fmt: skip
def test_an_absurd_model_is_one_line(name: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(SimulationError, match=words) as told:
        run_model(made(name, tmp_path), 0.01)
    assert "\n" not in str(told.value)


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
    assert found.memory < 500e6
    assert found.seconds < 20
