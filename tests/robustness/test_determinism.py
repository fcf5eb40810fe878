"""The same input gives the same bits: any thread, any batch, any run, any number of workers."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import mujoco
import mujoco.batch
import numpy as np
import pytest
from inerter.commands import app
from inerter.models import data_path, model_path
from mujoco import rollout
from typer.testing import CliRunner

STEPS = 60
MODELS = [
    ("pairs", ""),
    ("quarter_car", "model_siblings.xml"),
    ("full_car", "model_s2.xml"),
    ("fluid_inerter", "model.xml"),
]
FIELDS = ("qpos", "qvel", "act", "sensordata")

# what makes every part of the plugin work: bristles, series element with play, stops
DEVICE = {
    "friction": "lugre", "coulomb_force": "30", "static_force": "45", "bristle_stiffness": "1e5",
    "bristle_damping": "100", "series_stiffness": "2e5", "series_damping": "300",
    "backlash": "1e-4", "stop_upper": "0.01", "stop_stiffness": "1e5", "load_friction": "0.1",
}  # fmt: skip


PAIRS = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <worldbody>
    <geom type="plane" size="1 1 .1"/>
    <body name="a" pos="0 0 .09"><freejoint/><geom size=".1"/><site name="a"/></body>
    <body name="b" pos=".1 0 .4">
      <joint type="slide" axis="0 0 1"/><geom size=".1"/><site name="b"/>
      <body name="c" pos="0 .1 .3">
        <joint type="slide" axis="0 0 1" range="-.02 .02" limited="true"/>
        <geom size=".1"/><site name="c"/>
      </body>
    </body>
  </worldbody>
  <tendon>
    <spatial name="ab"><site site="a"/><site site="b"/></spatial>
    <spatial name="bc"><site site="b"/><site site="c"/></spatial>
    <spatial name="ac"><site site="a"/><site site="c"/></spatial>
  </tendon>
  <actuator>
    <plugin plugin="inerter.device" tendon="ab"><config key="inertance" value="3"/></plugin>
    <plugin plugin="inerter.device" tendon="bc" actdim="1">{bristle}</plugin>
    <plugin plugin="inerter.device" tendon="ac" actdim="4">{all}</plugin>
  </actuator>
</mujoco>"""


def loaded(folder: str, file: str, integrator: str) -> mujoco.MjModel:
    """A shipped model, or bodies in contact whose three devices have every part."""
    if folder == "pairs":
        texts = [f'<config key="{key}" value="{value}"/>' for key, value in DEVICE.items()]
        mass = '<config key="inertance" value="5"/>'
        xml = PAIRS.format(bristle=mass + "".join(texts[:5]), all=mass + "".join(texts))
        model = mujoco.MjModel.from_xml_string(xml)
    else:
        model = mujoco.MjModel.from_xml_path(str(model_path(folder, file)))
    model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator}")
    return model


def starts(model: mujoco.MjModel, count: int) -> np.ndarray:
    return np.random.default_rng(5).normal(0, 0.3, (count, model.nv))


def alone(model: mujoco.MjModel, velocities: np.ndarray) -> list[dict[str, bytes]]:
    """One after another, each with data of its own."""
    ends = []
    for velocity in velocities:
        data = mujoco.MjData(model)
        data.qvel[:] = velocity
        for _ in range(STEPS):
            mujoco.mj_step(model, data)
        assert np.isfinite(data.qpos).all()
        ends.append({name: getattr(data, name).tobytes() for name in FIELDS})
    return ends


@pytest.mark.parametrize("integrator", ["RK4", "IMPLICITFAST", "DISCRETE"])
@pytest.mark.parametrize(("folder", "file"), MODELS, ids=[f"{a}/{b}" for a, b in MODELS])
def test_a_simulation_does_not_know_its_batch(folder: str, file: str, integrator: str) -> None:
    model = loaded(folder, file, integrator)
    velocities = starts(model, 12)
    expected = alone(model, velocities)
    assert len({end["qpos"] for end in expected}) == 12
    for threads, count in ((1, 12), (2, 12), (4, 12), (4, 5), (2, 1)):
        for persistent in (False, True):
            worlds = mujoco.batch.Batch(model, count, threads, persistent)
            # what is bound before a step is kept by it
            ends = {name: worlds.bind(name) for name in FIELDS}
            ends["qvel"][:] = velocities[-count:]
            worlds.step(nstep=STEPS - 1)
            worlds.step(nstep=1)
            for name in FIELDS:
                found = [values.tobytes() for values in ends[name]]
                assert found == [end[name] for end in expected[-count:]], (threads, count, name)


@pytest.mark.parametrize(("folder", "file"), MODELS[:2], ids=[f"{a}/{b}" for a, b in MODELS[:2]])
def test_a_rollout_does_not_know_its_threads(folder: str, file: str) -> None:
    model = loaded(folder, file, "IMPLICITFAST")
    size = mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    initial = []
    for velocity in starts(model, 9):
        data = mujoco.MjData(model)
        data.qvel[:] = velocity
        state = np.empty(size)
        mujoco.mj_getState(model, data, state, mujoco.mjtState.mjSTATE_FULLPHYSICS)
        initial.append(state)
    found = set()
    for threads in (1, 2, 4):
        for chunk in (1, 4, None):
            workers = [mujoco.MjData(model) for _ in range(threads)]
            made = rollout.rollout(model, workers, np.array(initial), nstep=STEPS, chunk_size=chunk)
            found.add(b"".join(part.tobytes() for part in made))
    assert len(found) == 1


# --- commands ----------------------------------------------------------------------------------

RECORD = str(data_path("bench_record.csv"))
TABLE = str(data_path("ball_screw_table.csv"))
TIMES = {"seconds", "processor_seconds", "wall"}


def timeless(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: timeless(each) for key, each in value.items() if key not in TIMES}
    return [timeless(each) for each in value] if isinstance(value, list) else value


def results(out: Path, *arguments: str) -> dict[str, Any]:
    """What a command writes, without times."""
    done = CliRunner().invoke(app, [*arguments, "--out", str(out)])
    assert done.exit_code == 0, done.output
    return {
        str(path.relative_to(out)): timeless(json.loads(path.read_bytes()))
        if path.suffix == ".json"
        else path.read_bytes()
        for path in out.rglob("*")
        if path.is_file() and "cases" not in path.parts
    }


TWICE = {
    "simulate": ["simulate", str(model_path("half_car", "scene.xml")), "--duration", "0.3"],
    "identify": ["identify", RECORD, "--law", "coulomb,lugre", "--intervals", "normal",
                 "--starts", "3"],
    "prepare": ["prepare", RECORD, "--denoise", "emd", "--derivatives"],
    "table": ["diagnose", TABLE],
}  # fmt: skip


@pytest.mark.parametrize("command", TWICE)
def test_a_command_run_twice_writes_the_same(command: str, tmp_path: Path) -> None:
    first = results(tmp_path / "a", *TWICE[command])
    again = results(tmp_path / "b", *TWICE[command])
    assert len(first) > 2
    assert first == again


WORKERS = {
    "optimize": ["suspension", "optimize", "--layout", "S1,S3", "--index", "J3", "--stiffness",
                 "60e3:90e3:3"],
    "evaluate": ["suspension", "evaluate", "--layout", "S3", "--index", "J1", "--case",
                 "ideal,friction", "--seeds", "4", "--settle", "1"],
}  # fmt: skip


@pytest.mark.parametrize("command", WORKERS)
def test_workers_change_nothing(command: str, tmp_path: Path) -> None:
    one = results(tmp_path / "one", *WORKERS[command], "--jobs", "1")
    three = results(tmp_path / "three", *WORKERS[command], "--jobs", "3")
    for found in (one, three):
        # plotly names the parts of a page at random
        found.pop("optimum.html", None)
    assert one == three


def test_processors_change_no_diagnosis(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Coulomb friction, noise and a seed: the whole of the JSON, on one thread and on five."""
    random = np.random.default_rng(3)
    t = np.arange(0, 4, 4e-3)
    x, v, a = np.zeros((3, t.size))
    for f in (0.6, 1.9, 4.7):
        x += 0.01 / (1 + f) * np.sin(2 * np.pi * f * t + f)
        v += 0.01 / (1 + f) * 2 * np.pi * f * np.cos(2 * np.pi * f * t + f)
        a -= 0.01 / (1 + f) * (2 * np.pi * f) ** 2 * np.sin(2 * np.pi * f * t + f)
    force = 100 * a + 12 * np.sign(v) + random.normal(0, 0.5, t.size)
    rows = np.column_stack([t, x + random.normal(0, 1e-6, t.size), force])
    path = tmp_path / "record.csv"
    np.savetxt(path, rows, delimiter=",", header="time,displacement,force", comments="")
    found = []
    for processors in (1, 5):
        monkeypatch.setattr(os, "cpu_count", lambda count=processors: count)
        found.append(results(tmp_path / str(processors), "diagnose", str(path)))
    assert found[0]["diagnosis.json"]["findings"]
    assert found[0] == found[1]
