"""`inerter simulate` as a user runs it: files, exit status, one line for a mistake, pictures."""

from __future__ import annotations

import importlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
import pytest
from inerter.commands import app
from inerter.engine_errors import SimulationError
from inerter.models import model_path
from inerter.records import read_records
from inerter.simulate.load import load_model
from inerter.simulate.output import write_run
from inerter.simulate.page import render_page
from inerter.simulate.run import SimulatedRun, run_model
from inerter.simulate.summary import summary
from inerter.simulate.video import refuse_video
from simulate_models import PULL, device, oscillator, written
from test_diagnose_command import inerter
from test_report import Reader, numbers
from test_report_browser import browse, needs_browser
from typer.testing import CliRunner

DOCUMENTATION = Path(__file__).resolve().parents[2] / "docs" / "simulate.md"

# ------------------------------ the command ------------------------------


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory):
    out = tmp_path_factory.mktemp("out") / "deep" / "run"
    path = model_path("quarter_car", "scene.xml")
    arguments = ("--keyframe", "kerb", "--duration", "0.5", "--integrator", "implicitfast",
                 "--timestep", "5e-4", "--rate", "400", "--json", "--out", out)  # fmt: skip
    return inerter("simulate", path, *arguments), out


def test_json_alone_on_stdout_and_four_files(finished) -> None:
    done, out = finished
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    found = json.loads(done.stdout)
    assert found == json.loads((out / "simulation.json").read_text())
    assert found["schema"] == "inerter.simulation/1"
    assert (found["timestep"], found["integrator"]) == (5e-4, "implicitfast")
    assert (found["duration"], found["sample_rate"], found["samples"]) == (0.5, 400.0, 201)
    (strut,) = found["devices"]
    assert strut["parameters"]["inertance"] == 128.57
    (record,) = read_records(out / strut["file"], "bench")
    assert strut["force"]["max"] == pytest.approx(record.force.max())
    assert record.sample_rate == pytest.approx(400)
    assert any("a row every 5 steps" in comment for comment in record.comments)
    assert sorted(path.name for path in out.iterdir()) == [
        "simulation.html", "simulation.json", "strut.csv", "vehicle"
    ]  # fmt: skip


def test_a_number_that_is_not_finite_is_null_in_the_file_and_on_stdout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def without_end(run: SimulatedRun) -> dict[str, object]:
        return {**summary(run), "duration": float("inf"), "spread": [float("nan")]}

    for place in ("inerter.simulate.summary.summary", "inerter.simulate.output.summary"):
        monkeypatch.setattr(place, without_end)
    path = written(tmp_path, oscillator(device(inertance=1)))
    words = ["simulate", str(path), "--duration", "0.1", "--json", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0
    found = json.loads(done.stdout)
    assert found == json.loads((tmp_path / "out" / "simulation.json").read_text())
    assert (found["duration"], found["spread"]) == (None, [None])


def test_a_model_without_device_runs_and_says_so(tmp_path: Path) -> None:
    path = written(tmp_path, oscillator("", extra=PULL))
    done = inerter("simulate", path, "--duration", "0.2", "--keyframe", "0", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "no inerter.device in the model" in done.stdout
    assert (tmp_path / "simulation.html").exists()


STIFF = oscillator(device(stiffness=1e9, name="strut"), 'integrator="RK4"', extra=PULL)
WRONG = {
    "missing": ("{f}/none.xml", [], "no such file"),
    "folder": ("{f}", [], "is a folder"),
    "table": (
        "{f}/table.csv",
        [],
        "table.csv: by its ending this is no model; give a model, .xml or .mjb",
    ),
    "no ending": ("{f}/table", [], "give a model, .xml or .mjb"),
    "not XML": ("{f}/text.xml", [], "text.xml: XML parse error"),
    "schema": ("{f}/schema.xml", [], "invalid keyword: 'slid'"),
    "device": ("{f}/device.xml", [], 'inertance is "-3"'),
    "binary": ("{f}/broken.mjb", [], "failed to load"),
    "unread": ("{f}/unread.mjb", [], "no sensor reads device 'strut'"),
    "keyframe": ("{f}/good.xml", ["--keyframe", "pushed"], "no keyframe 'pushed'"),
    "index": ("{f}/good.xml", ["--keyframe", "1"], "it has pulled"),
    "integrator": ("{f}/good.xml", ["--integrator", "leapfrog"], "choose one of Euler, RK4"),
    "timestep": ("{f}/good.xml", ["--timestep", "0"], "give seconds above 0"),
    "duration": ("{f}/good.xml", ["--duration", "-1"], "give seconds above 0"),
    "short": ("{f}/good.xml", ["--duration", "1e-5"], "shorter than a time step"),
    "long": ("{f}/good.xml", ["--duration", "1e7"], "at most 1e+09 are made"),
    "many": ("{f}/good.xml", ["--duration", "9e5"], "too many to keep"),
    "control": ("{f}/good.xml", ["--control", "{f}/none.csv"], "none.csv: no such file"),
    "video": ("{f}/good.xml", ["--video", "{f}/a.avi"], "ends in .gif or .mp4"),
    "diverged": ("{f}/stiff.xml", ["--keyframe", "0"], "diverged at t = 0.0"),
}


@pytest.mark.parametrize("case", WRONG)
def test_mistakes_get_one_line_status_2_and_no_files(tmp_path: Path, case: str) -> None:
    good = oscillator(device(inertance=1), extra=PULL)
    written(tmp_path, good, "good.xml")
    written(tmp_path, "text", "text.xml")
    written(tmp_path, "time,displacement", "table.csv")
    written(tmp_path, "time,displacement", "table")
    written(tmp_path, good.replace('"slide"', '"slid"'), "schema.xml")
    written(tmp_path, oscillator(device(inertance=-3)), "device.xml")
    written(tmp_path, STIFF, "stiff.xml")
    (tmp_path / "broken.mjb").write_bytes(b"\0" * 100)
    if case == "unread":
        mujoco.mj_saveModel(mujoco.MjModel.from_xml_string(good), str(tmp_path / "unread.mjb"))
    path, options, words = WRONG[case]
    filled = [text.format(f=tmp_path) for text in (path, *options)]
    before = set(tmp_path.iterdir())
    done = subprocess.run(
        [sys.executable, "-m", "inerter", "simulate", *filled, "--out", "out"],
        capture_output=True, text=True, timeout=100, check=False, cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert words in done.stderr
    # neither results nor the engine's MUJOCO_LOG.TXT
    assert set(tmp_path.iterdir()) == before


def test_divergence_says_when_and_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(SimulationError) as caught:
        run_model(written(tmp_path, STIFF), 1.0, keyframe="pulled")
    assert "joint 'x' is the first" in str(caught.value)
    assert "--timestep 0.00025" in str(caught.value)
    assert "--integrator implicitfast" in str(caught.value)


def test_an_unwritable_folder_costs_no_run(tmp_path: Path) -> None:
    path = written(tmp_path, oscillator(device(inertance=1)))
    done = inerter("simulate", path, "--duration", "1e6", "--rate", "1", "--out", path)
    assert done.returncode == 2
    assert "not a folder" in done.stderr


def test_files_appear_together_or_not_at_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = run_model(written(tmp_path, oscillator(device(inertance=1))), 0.1)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "strut.csv").write_text("old")
    output = importlib.import_module("inerter.simulate.output")

    def fail(run: SimulatedRun) -> str:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(output, "render_page", fail)
    with pytest.raises(OSError, match="No space left"):
        write_run(run, tmp_path / "out")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["strut.csv"]
    assert (tmp_path / "out" / "strut.csv").read_text() == "old"


def test_without_the_lab_the_extra_is_named() -> None:
    script = (
        "import sys; sys.modules['typer'] = None; sys.argv[1:] = ['simulate', 'model.xml']\n"
        "from inerter.__main__ import main; main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )  # fmt: skip
    assert done.returncode == 2
    assert "this needs the extra `lab`" in done.stderr


def test_what_the_documentation_shows_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = DOCUMENTATION.read_text(encoding="utf-8")
    command, table, code = (
        block for _, block in re.findall(r"```(sh|python|)\n(.*?)```", text, re.DOTALL)
    )
    names: dict[str, np.ndarray] = {}
    exec(code, names)
    assert names["friction"] == pytest.approx([-5, -10, -20], rel=1e-6)

    # the command, with the table for its road
    shutil.copytree(model_path("quarter_car").parent, tmp_path / "mjcf_models" / "quarter_car")
    (tmp_path / "road.csv").write_text(table)
    monkeypatch.chdir(tmp_path)
    program, *arguments = command.split()
    done = inerter(*arguments, "--control", "road.csv")
    assert program == "inerter"
    assert done.returncode == 0, done.stderr
    (record,) = read_records("out/kerb/vehicle", "vehicle")
    assert record.road.max() == pytest.approx(0.02)


# ------------------------------ page and video ------------------------------


def two_devices(folder: Path) -> SimulatedRun:
    series = device(
        states=2, inertance=50, series_stiffness=2e5, series_damping=100, name="</script><b>"
    ).replace("</script>", "&lt;/script&gt;").replace("<b>", "&lt;b&gt;")  # fmt: skip
    plain = device(inertance=5, friction="coulomb", coulomb_force=3, name="plain")
    path = written(folder, oscillator(series + plain, extra=PULL), "two.xml")
    return run_model(path, 0.5, keyframe="pulled")


def test_the_page_holds_everything_and_loads_nothing(tmp_path: Path) -> None:
    reader = Reader(render_page(two_devices(tmp_path)))
    plots = reader.data["plots"]
    assert all(np.isfinite(values).all() for values in numbers(plots))
    places = {a["data-plot"] for _, a in reader.tags if "data-plot" in a}
    assert all(places == set(made) | set(plots["single"]) for made in plots["runs"])
    assert reader.text.count("</script><b>") == 3
    for tag, attributes in reader.tags:
        assert "src" not in attributes, tag
        assert (attributes.get("href") or "#").startswith("#")


@needs_browser
@pytest.mark.parametrize("width", [375, 1200])
def test_a_browser_draws_every_plot_within_the_page(tmp_path: Path, width: int) -> None:
    found = browse(tmp_path, render_page(two_devices(tmp_path)), width)
    assert found["plots"] == found["drawn"] == 7
    assert found["overflow"] <= 0
    assert found["wide"] == 0


def test_a_video_shows_the_motion(tmp_path: Path) -> None:
    from PIL import Image, ImageChops

    try:
        refuse_video(tmp_path / "a.gif")
    except SimulationError as error:
        pytest.skip(str(error))
    done = inerter(
        "simulate", written(tmp_path, oscillator(device(inertance=1), extra=PULL)), "--keyframe",
        "0", "--duration", "0.4", "--video", tmp_path / "a.gif", "--out", tmp_path / "out",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    with Image.open(tmp_path / "a.gif") as video:
        assert video.n_frames == 11  # type: ignore[attr-defined]
        first = video.convert("RGB")
        video.seek(5)
        assert ImageChops.difference(first, video.convert("RGB")).getbbox() is not None


@pytest.mark.skipif(shutil.which("ffmpeg") is not None, reason="ffmpeg is here")
def test_without_ffmpeg_a_gif_is_advised(tmp_path: Path) -> None:
    with pytest.raises(SimulationError, match=r"ffmpeg is not installed.*write a \.gif"):
        refuse_video(tmp_path / "a.mp4")


@pytest.mark.skipif(sys.platform != "linux", reason="names a Linux back end")
def test_without_opengl_it_says_so(tmp_path: Path) -> None:
    path = written(tmp_path, oscillator(device(inertance=1)))
    environment = {**os.environ, "MUJOCO_GL": "off"}
    done = subprocess.run(
        [sys.executable, "-m", "inerter", "simulate", str(path), "--video", "a.gif"],
        capture_output=True, text=True, check=False, cwd=tmp_path, env=environment,
    )  # fmt: skip
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1
    assert "--video needs OpenGL" in done.stderr


def test_a_relative_path_to_a_model_with_a_model_in_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The engine alone looks for the inner one in the wrong place."""
    shutil.copytree(model_path("fluid_inerter").parent, tmp_path / "models" / "fluid")
    monkeypatch.chdir(tmp_path)
    assert load_model(Path("models/fluid/scene.xml")).nq > 0
