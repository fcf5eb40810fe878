"""The panel without a window: both sides of it talk over the viewer's own channels."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import mujoco
import numpy as np
import pytest
from inerter.commands import app as commands
from inerter.models import model_path
from typer.testing import CliRunner

pytest.importorskip("mujoco.studio.app", reason="this MuJoCo comes without its studio")

from inerter.view.control import (
    DeviceControl,
    PanelSnapshot,
    SetLaw,
    SetParameter,
    SetShake,
    Watch,
)
from inerter.view.panel import POINTS, copied, thinned
from inerter.view.session import Session
from inerter.view.shake import Shake
from mujoco.studio import app, endpoints, launch_thread, messages, viewer_handle
from mujoco.studio.sim import PauseState  # pyright: ignore[reportMissingImports]
from served import served

SCENE = model_path("half_car", "scene.xml")


class Run:
    """The simulation's side as in a viewer, and the end of the channel that the viewer has."""

    def __init__(self, path: Path = SCENE) -> None:
        self.viewer: endpoints.ViewerEndpoint
        self.viewer, sim = launch_thread.make_thread_endpoints()
        session = Session(path)
        self.control = DeviceControl(session, next(iter(session.devices)))
        self.handle = viewer_handle.ViewerHandle(sim, sim_plugins=[*app.SIM_PLUGINS, self.control])
        self.handle.dispatch(messages.LoadModelEvent(path=str(path)))

    def until(self, seconds: float) -> PanelSnapshot:
        """Go on to a time of the run; the panel's last picture."""
        shown, patience = None, time.monotonic() + 60
        while self.time < seconds or shown is None:
            assert time.monotonic() < patience
            self.handle.sync()
            for snapshot in self.viewer.get_sim_snapshots():
                shown = snapshot if isinstance(snapshot, PanelSnapshot) else shown
        return shown

    @property
    def time(self) -> float:
        assert self.handle.data is not None
        return self.handle.data.time


@pytest.fixture
def run() -> Run:
    return Run()


def test_the_panel_is_shown_the_loop_of_the_run(run: Run) -> None:
    """As the same steps give it, every step, shaken by the road."""
    shown = run.until(0.3)
    time_, x, v, force = shown.loop
    assert shown.devices == ["strut_front", "strut_rear"]
    assert shown.shake == Shake("road_front", 0.01, 1.5)
    np.testing.assert_allclose(np.diff(time_), 1e-3, rtol=1e-6)

    session = Session(SCENE)
    row = session.devices["strut_front"]
    assert shown.shake
    again = []
    while session.data.time < time_[-1] - 1e-6:
        shown.shake.apply(session.model, session.data)
        mujoco.mj_step(session.model, session.data)
        again.append(session.data.sensordata[row.sensor["total"]])
    np.testing.assert_array_equal(force, again)
    assert np.abs(x).max() > 1e-5
    # what belongs together: the rate of x is v
    np.testing.assert_allclose(np.gradient(x, time_)[5:-5], v[5:-5], atol=0.02 * np.abs(v).max())


def test_a_slider_changes_the_run_and_not_the_model(run: Run) -> None:
    run.until(0.1)
    model, before = run.handle.model, run.time
    for value in (500.0, 1000.0, 3000.0):
        run.viewer.send_to_sim(SetParameter("strut_front", "viscous", value))
    shown = run.until(before + 0.1)
    assert run.handle.model is model
    assert run.time > before
    assert next(each.value for each in shown.sliders if each.key == "viscous") == 3000
    assert not shown.refusal


def test_what_cannot_be_is_told_and_the_run_goes_on(run: Run) -> None:
    run.until(0.05)
    run.viewer.send_to_sim(SetParameter("strut_front", "inertance", -1.0))
    shown = run.until(run.time + 0.1)
    assert "inertance" in shown.refusal
    assert next(each.value for each in shown.sliders if each.key == "inertance") == 30
    run.viewer.send_to_sim(SetParameter("strut_front", "inertance", 31.0))
    assert not run.until(run.time + 0.1).refusal


def test_another_law_is_another_model_in_the_same_run(run: Run) -> None:
    run.until(0.2)
    model, before = run.handle.model, run.time
    assert run.handle.data is not None
    qpos = run.handle.data.qpos.copy()
    run.viewer.get_sim_events()
    run.viewer.send_to_sim(SetLaw("strut_front", "dahl"))
    shown = run.until(before + 0.05)
    assert shown.law == "dahl"
    assert run.handle.model is not model
    assert run.handle.model is run.control.session.model
    assert run.handle.data is run.control.session.data
    sent = [
        event for event in run.viewer.get_sim_events() if isinstance(event, messages.ModelEvent)
    ]
    assert len(sent) == 1
    assert np.abs(run.handle.data.qpos - qpos).max() < 0.05
    assert any(each.key == "bristle_stiffness" for each in shown.sliders)


def test_another_device_and_another_shake(run: Run) -> None:
    run.until(0.05)
    run.viewer.send_to_sim(Watch("strut_rear", 0.05))
    run.viewer.send_to_sim(SetShake(Shake("road_rear", 0.005, 2.0)))
    shown = run.until(run.time + 0.2)
    assert shown.device == "strut_rear"
    assert shown.loop[0, -1] - shown.loop[0, 0] == pytest.approx(0.05, abs=2e-3)
    assert run.handle.data is not None
    assert run.handle.data.ctrl[0] == 0
    assert run.handle.data.ctrl[1] != 0


def test_a_pause_is_kept(run: Run) -> None:
    run.until(0.05)
    event = messages.StepControlSnapshot(
        pause_state=PauseState.NORMAL_PAUSED, speed=100.0, noise_scale=0.0, noise_rate=0.0
    )
    run.viewer.send_to_sim(event)
    run.handle.sync()
    before = run.time
    for _ in range(30):
        run.handle.sync()
    assert run.time == before


def test_reload_begins_anew(run: Run) -> None:
    run.until(0.2)
    run.handle.reload()
    assert run.time < 0.1
    assert len(run.control.loop) == 0


def test_a_curve_is_thinned_to_what_can_be_seen() -> None:
    loop = np.tile(np.arange(5000.0), (4, 1))
    x, _, _ = thinned(loop)
    assert POINTS / 2 < x.size <= POINTS
    assert x[-1] == 4999
    assert thinned(np.empty((4, 0)))[0].size == 0


def test_the_picture_of_a_device_outlives_its_scene() -> None:
    session = Session(SCENE)
    scene = mujoco.MjvScene(session.model, maxgeom=500)
    decor = int(mujoco.mjtCatBit.mjCAT_DECOR)
    options = mujoco.MjvOption(), mujoco.MjvPerturb(), mujoco.MjvCamera()
    mujoco.mjv_updateScene(session.model, session.data, *options, decor, scene)
    kind = int(mujoco.mjtObj.mjOBJ_ACTUATOR)
    drawn = [scene.geoms[i] for i in range(scene.ngeom) if scene.geoms[i].objtype == kind]
    assert len(drawn) >= 3 * len(session.devices)
    for geom in drawn:
        new = copied(geom)
        assert new.type == geom.type
        for name in ("size", "pos", "mat", "rgba"):
            np.testing.assert_allclose(getattr(new, name), getattr(geom, name), rtol=1e-6)


# --- the command ----------------------------------------------------------------------------------


def refusal(*arguments: object) -> str:
    """What is said on stderr where a view cannot be."""
    done = CliRunner().invoke(commands, ["view", *map(str, arguments)])
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1
    return done.stderr


def test_the_page_is_served_to_this_machine_alone(tmp_path: Path) -> None:
    with served(tmp_path) as viewer:
        with urllib.request.urlopen(viewer.address, timeout=20) as answer:
            assert b"<html" in answer.read().lower()
        with socket.socket() as outside:
            outside.settimeout(2)
            address = own_address()
            if address:
                assert outside.connect_ex((address, viewer.port)) != 0
        assert viewer.end(signal.SIGINT) == 0, viewer.log.read_text()
    text = viewer.log.read_text()
    assert "No display here" in text
    assert f"ssh -L {viewer.port}:localhost:{viewer.port}" in text
    assert "No authentication" not in text
    assert "Traceback" not in text


def own_address() -> str | None:
    """An address of this machine on a network, if it has one."""
    try:
        found = socket.gethostbyname(socket.gethostname())
    except OSError:
        return None
    return None if found.startswith("127.") else found


def test_a_picture_without_any_graphics(tmp_path: Path) -> None:
    """The loops, and why the scene is missing."""
    target = tmp_path / "view.png"
    command = [sys.executable, "-m", "inerter", "view", str(SCENE), "--picture", str(target)]
    done = subprocess.run(
        [*command, "--duration", "0.2"],
        capture_output=True, text=True, check=False, env={**os.environ, "MUJOCO_GL": "disable"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "the loops alone" in done.stdout
    assert target.read_bytes().startswith(b"\x89PNG")
    assert [path.name for path in tmp_path.iterdir()] == ["view.png"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["none.xml"], "give a model file"),
        ([SCENE, "--device", "x"], "strut_front, strut_rear"),
        ([SCENE, "--keyframe", "x"], "kerb"),
        ([SCENE, "--shake", "x=1@1"], "no control 'x'"),
        ([SCENE, "--picture", "x.jpg"], ".png"),
        ([SCENE, "--picture", "x.png", "--shake", "road_front=1e9@1"], "diverged"),
    ],
)
def test_what_cannot_be_seen_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], said: str
) -> None:
    monkeypatch.chdir(tmp_path)
    assert said in refusal(*arguments)
    assert list(tmp_path.iterdir()) == []


def test_a_port_that_is_taken_is_refused() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        assert "is taken" in refusal(SCENE, "--port", taken.getsockname()[1])
