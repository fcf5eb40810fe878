"""Is a run determined by the state: copies, resets, keyframes, files, batches, threads?"""

from __future__ import annotations

import copy
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import mujoco
import numpy as np
import pytest
from inerter.device_in_model import device_of
from plugin_models import FRICTION, INERTANCE, INTEGRATORS, instance_actuator, quarter_car_xml


def car(integrator: str = "implicitfast", law: str = "lugre", extra: str = "") -> mujoco.MjModel:
    keys = {"inertance": INERTANCE, "friction": law, "load_friction": 0.05, **FRICTION[law]}
    instance, actuator, sensor = instance_actuator(keys)
    option = f'timestep="1e-3" integrator="{integrator}"'
    return mujoco.MjModel.from_xml_string(
        quarter_car_xml(actuator, instance=instance, sensor=sensor, option=option, extra=extra)
    )


def run(model: mujoco.MjModel, data: mujoco.MjData, steps: int) -> np.ndarray:
    rows = []
    for _ in range(steps):
        mujoco.mj_step(model, data)
        rows.append(np.concatenate([data.qpos, data.qvel, data.act, data.sensordata]))
    return np.array(rows)


def started(model: mujoco.MjModel) -> mujoco.MjData:
    data = mujoco.MjData(model)
    data.qvel[:] = 0.3, -0.3
    return data


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_runs_repeat_and_copies_continue(integrator: str) -> None:
    model = car(integrator)
    data = started(model)
    whole = run(model, data, 200)
    assert np.array_equal(whole, run(model, started(model), 200))

    # a copy of the data half-way, a copy of the state alone, a copy of the model
    half = started(model)
    run(model, half, 100)
    duplicate = copy.copy(half)
    spec = mujoco.mjtState.mjSTATE_INTEGRATION
    state = np.zeros(mujoco.mj_stateSize(model, spec))
    mujoco.mj_getState(model, half, state, spec)
    fresh = mujoco.MjData(model)
    mujoco.mj_setState(model, fresh, state, spec)
    assert np.array_equal(run(model, half, 100), whole[100:])
    assert np.array_equal(run(model, duplicate, 100), whole[100:])
    assert np.array_equal(run(model, fresh, 100), whole[100:])
    assert np.array_equal(run(copy.copy(model), started(model), 200), whole)


def test_a_copy_between_step1_and_step2_continues() -> None:
    model = car("Euler")
    whole = run(model, started(model), 20)
    data = started(model)
    for row in whole:
        mujoco.mj_step1(model, data)
        data = copy.copy(data)
        mujoco.mj_step2(model, data)
        np.testing.assert_array_equal(np.concatenate([data.qpos, data.qvel, data.act]), row[:5])


def test_reset_and_keyframe() -> None:
    model = car(extra='<keyframe><key qvel="0.3 -0.3" act="1e-4"/></keyframe>')
    data = started(model)
    first = run(model, data, 50)
    mujoco.mj_resetData(model, data)
    assert data.act[0] == 0
    mujoco.mj_forward(model, data)
    assert data.sensordata[-1] == 0, "heat starts again"
    data.qvel[:] = 0.3, -0.3
    assert np.array_equal(run(model, data, 50), first)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    assert data.act[0] == 1e-4
    other = run(model, data, 50)
    assert not np.array_equal(other, first)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    assert np.array_equal(run(model, data, 50), other)


def test_files_keep_the_device(tmp_path: Path) -> None:
    model = car("RK4")
    whole = run(model, started(model), 50)
    mujoco.mj_saveModel(model, str(tmp_path / "car.mjb"))
    binary = mujoco.MjModel.from_binary_path(str(tmp_path / "car.mjb"))
    assert np.array_equal(run(binary, started(binary), 50), whole)
    mujoco.mj_saveLastXML(str(tmp_path / "car.xml"), model)
    text = mujoco.MjModel.from_xml_path(str(tmp_path / "car.xml"))
    assert np.array_equal(run(text, started(text), 50), whole)


def test_edits_of_a_compiled_model_count() -> None:
    # the inertance is written once, in the compiler; later edits of the model stay
    for inertance in (50.0, 0.0):
        model = car("RK4")
        model.actuator_armature[0] = inertance
        data = started(model)
        run(model, data, 20)
        mujoco.mj_forward(model, data)
        assert model.actuator_armature[0] == inertance
        assert data.sensordata[1] == pytest.approx(inertance * data.qacc[1])
        assert device_of(model, "strut").now(model).inertance == inertance


def test_gains_may_be_scaled_as_a_whole() -> None:
    model = car()
    whole = run(model, started(model), 20)
    model.actuator_gainprm *= 1.1
    assert np.array_equal(run(model, started(model), 20), whole)


def test_a_batch_is_a_loop() -> None:
    many = pytest.importorskip("mujoco.batch", reason="MuJoCo 3.16 has none")
    # 256 cars of different inertance, damping and start, on two threads
    model, count, steps = car(), 256, 40
    rng = np.random.default_rng(0)
    inertances = rng.uniform(20, 300, count)
    dampings = rng.uniform(0, 2000, count)
    speeds = rng.normal(0, 0.3, (count, 2))
    bristles = rng.normal(0, 1e-4, count)
    batch = many.Batch(model, count, 2)
    batch.expand("actuator_armature")[:, 0] = inertances
    batch.expand("actuator_damping")[:, 0] = dampings
    batch.set_const()
    qpos, qvel, act = (batch.bind(name) for name in ("qpos", "qvel", "act"))
    sensors = batch.bind("sensordata")
    qvel[:], act[:, 0] = speeds, bristles
    batch.step(nstep=steps)
    for i in range(count):
        single = copy.copy(model)
        single.actuator_armature[0], single.actuator_damping[0] = inertances[i], dampings[i]
        data = mujoco.MjData(single)
        mujoco.mj_setConst(single, data)
        mujoco.mj_resetData(single, data)
        data.qvel[:], data.act[0] = speeds[i], bristles[i]
        last = run(single, data, steps)[-1]
        assert np.array_equal(np.concatenate([qpos[i], qvel[i], act[i], sensors[i]]), last), i


def test_threads_do_not_meet() -> None:
    model = car("RK4")
    expected = run(model, started(model), 200)
    with ThreadPoolExecutor(4) as pool:
        runs = pool.map(lambda _: run(model, started(model), 200), range(8))
        assert all(np.array_equal(found, expected) for found in runs)


def test_derivatives_see_the_friction_state() -> None:
    model = car("implicitfast")
    data = started(model)
    run(model, data, 20)
    a = np.zeros((2 * model.nv + model.na, 2 * model.nv + model.na))
    mujoco.mjd_transitionFD(model, data, 1e-7, True, a, None, None, None)
    # the bristle of the next step depends on the bristle and, through it, the velocities do
    assert 0 < a[-1, -1] < 1.1
    assert np.abs(a[2:4, -1]).min() > 1e-3
