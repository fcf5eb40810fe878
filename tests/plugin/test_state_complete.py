"""Is a run determined by the state, for devices across branches and with series elements?

Live parameters, copies, states, resets, keyframes, files, attached models, batches.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS
from topology_mechanisms import Array
from topology_models import mjcf, slide

LIVE = """
  <custom>
    <numeric name="d0.inertance" data="113"/>
    <numeric name="d0.viscous" data="900"/>
    <numeric name="d1.series_stiffness" data="8e4"/>
  </custom>"""
KEYFRAME = """
  <keyframe>
    <key qpos="0.001 0.002 0 0" qvel="0.3 0 0.1 -0.2" act="1e-4 5e-5 0.05 1e-4"/>
  </keyframe>"""


def text(live: bool = True, option: str = "") -> str:
    """A car with seat on a wheel, and a box: devices across branches, one with a series element."""
    seat = slide("seat", 20, 0.3, 'stiffness="4e3"')
    world = '<geom type="plane" size="3 3 0.1" pos="0 0 -0.106"/>'
    wheel = slide("wheel", 25, 0, 'stiffness="120e3"').replace('contype="0" conaffinity="0"', "")
    world += wheel + slide("car", 180, 1, "", seat) + slide("box", 30, 2, 'stiffness="3e3"')
    tendons = "".join(
        f'<fixed name="{a}_{b}" stiffness="9e3"><joint joint="{a}" coef="-1"/>'
        f'<joint joint="{b}" coef="1"/></fixed>'
        for a, b in (("wheel", "car"), ("car", "box"), ("seat", "box"))
    )
    bristle = {
        "inertance": 113,
        "viscous": 900,
        "friction": "lugre",
        "coulomb_force": 40,
        "bristle_stiffness": 5e4,
        "bristle_damping": 100,
        "load_friction": 0.05,
    }
    series = {
        "inertance": 60, "series_stiffness": 8e4, "series_damping": 200, "backlash": 1e-4,
    }  # fmt: skip
    devices = [
        (bristle, 'tendon="wheel_car"'),
        (series, 'tendon="car_box"'),
        ({"inertance": 5.0}, 'tendon="seat_box"'),
    ]
    rest = (LIVE if live else "") + KEYFRAME
    return mjcf(world, tendons, devices, rest=rest, gravity=(0, 0, -3), option=option)


def model_of(integrator: str, live: bool = True) -> mujoco.MjModel:
    """The compiled model."""
    option = f'timestep="1e-3" integrator="{integrator}"'
    return mujoco.MjModel.from_xml_string(text(live).replace("{option}", option))


def run(model: mujoco.MjModel, data: mujoco.MjData, steps: int) -> Array:
    """Rows of everything that a step leaves."""
    rows = []
    for _ in range(steps):
        mujoco.mj_step(model, data)
        rows.append(np.concatenate([data.qpos, data.qvel, data.act, data.sensordata, data.qacc]))
    return np.array(rows)


def started(model: mujoco.MjModel) -> mujoco.MjData:
    """The first state."""
    data = mujoco.MjData(model)
    data.qvel[:] = 0.3, 0.0, -0.2, 0.1
    return data


def whole_state(model: mujoco.MjModel, data: mujoco.MjData) -> mujoco.MjData:
    """A new MjData that knows nothing but the integration state of another one."""
    spec = mujoco.mjtState.mjSTATE_INTEGRATION
    state = np.zeros(mujoco.mj_stateSize(model, spec))
    mujoco.mj_getState(model, data, state, spec)
    fresh = mujoco.MjData(model)
    mujoco.mj_setState(model, fresh, state, spec)
    return fresh


def copied_over(model: mujoco.MjModel, data: mujoco.MjData) -> mujoco.MjData:
    """A copy into an MjData that has run elsewhere."""
    other = mujoco.MjData(model)
    other.qvel[:] = 1.0
    run(model, other, 7)
    mujoco.mj_copyData(other, model, data)
    return other


CONTINUATIONS: dict[str, Callable[[mujoco.MjModel, mujoco.MjData], mujoco.MjData]] = {
    "copy": lambda model, data: copy.copy(data),
    "mj_copyData": copied_over,
    "state": whole_state,
}


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("way", CONTINUATIONS)
def test_a_run_continues_bit_for_bit(way: str, integrator: str) -> None:
    model = model_of(integrator)
    whole = run(model, started(model), 120)
    assert whole[:, 8:12].any(axis=0).all(), "every state of the devices moves"
    half = started(model)
    run(model, half, 60)
    assert np.array_equal(run(model, CONTINUATIONS[way](model, half), 60), whole[60:])


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
def test_a_copy_between_the_halves_of_a_step_continues(integrator: str) -> None:
    model = model_of(integrator)
    whole = run(model, started(model), 40)
    data = started(model)
    for row in whole:
        mujoco.mj_step1(model, data)
        data = copy.copy(data)
        mujoco.mj_step2(model, data)
        assert np.array_equal(np.concatenate([data.qpos, data.qvel, data.act]), row[:12])


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_resets_and_keyframes_start_again(integrator: str) -> None:
    model = model_of(integrator)
    data = started(model)
    first = run(model, data, 60)
    mujoco.mj_resetData(model, data)
    data.qvel[:] = 0.3, 0.0, -0.2, 0.1
    assert np.array_equal(run(model, data, 60), first)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    assert data.act.tolist() == [1e-4, 5e-5, 0.05, 1e-4]
    second = run(model, data, 60)
    assert not np.array_equal(second, first)
    fresh = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, fresh, 0)
    assert np.array_equal(run(model, fresh, 60), second)


@pytest.mark.parametrize("integrator", ["implicitfast", "RK4"])
def test_files_keep_the_devices(integrator: str, tmp_path: Path) -> None:
    model = model_of(integrator)
    whole = run(model, started(model), 60)
    mujoco.mj_saveLastXML(str(tmp_path / "car.xml"), model)
    again = mujoco.MjModel.from_xml_path(str(tmp_path / "car.xml"))
    assert np.array_equal(run(again, started(again), 60), whole)
    mujoco.mj_saveModel(model, str(tmp_path / "car.mjb"))
    binary = mujoco.MjModel.from_binary_path(str(tmp_path / "car.mjb"))
    assert np.array_equal(run(binary, started(binary), 60), whole)


def test_an_attached_model_is_the_same_device() -> None:
    # live numerics are named after the actuator: the prefix goes to both
    option = 'timestep="1e-3" integrator="implicitfast"'
    child = mujoco.MjSpec.from_string(text().replace("{option}", option))
    parent = mujoco.MjSpec()
    parent.option.timestep = 1e-3
    parent.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    parent.option.gravity = [0, 0, -3]
    parent.attach(child, prefix="front_", frame=parent.worldbody.add_frame())
    model = parent.compile()
    plain = model_of("implicitfast")
    assert np.array_equal(run(model, started(model), 60), run(plain, started(plain), 60))
    model.numeric("front_d0.inertance").data[:] = 40
    plain.numeric("d0.inertance").data[:] = 40
    changed = run(plain, started(plain), 60)
    assert np.array_equal(run(model, started(model), 60), changed)
    whole = model_of("implicitfast")
    assert not np.array_equal(changed, run(whole, started(whole), 60))


# --------------------------- live parameters ------------------------------------------------------


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_change_between_steps_is_the_model_with_that_value(integrator: str) -> None:
    live = model_of(integrator)
    data = started(live)
    run(live, data, 40)
    live.numeric("d0.inertance").data[:] = 20
    live.numeric("d0.viscous").data[:] = 2000
    live.numeric("d1.series_stiffness").data[:] = 3e4
    after = run(live, data, 40)

    # the same with values that were there from the start, continued from the same state
    other = model_of(integrator)
    half = started(other)
    run(other, half, 40)
    stated = text(live=False).replace("{option}", f'timestep="1e-3" integrator="{integrator}"')
    for key, old, new in (
        ("inertance", 113, 20), ("viscous", 900, 2000), ("series_stiffness", 80000.0, 3e4),
    ):  # fmt: skip
        before = f'"{key}" value="{old}"'
        assert stated.count(before) == 1
        stated = stated.replace(before, f'"{key}" value="{new}"')
    fixed = mujoco.MjModel.from_xml_string(stated)
    np.testing.assert_allclose(
        after, run(fixed, whole_state_of(other, half, fixed), 40), rtol=1e-9, atol=1e-12
    )


def whole_state_of(
    model: mujoco.MjModel, data: mujoco.MjData, other: mujoco.MjModel
) -> mujoco.MjData:
    """The state of one model's run as that of another of the same sizes."""
    spec = mujoco.mjtState.mjSTATE_INTEGRATION
    state = np.zeros(mujoco.mj_stateSize(model, spec))
    mujoco.mj_getState(model, data, state, spec)
    fresh = mujoco.MjData(other)
    mujoco.mj_setState(other, fresh, state, spec)
    return fresh


def test_a_value_that_cannot_be_is_an_error() -> None:
    model = model_of("implicitfast")
    data = started(model)
    model.numeric("d0.inertance").data[:] = -1
    with pytest.raises(mujoco.FatalError, match="inertance"):
        mujoco.mj_step(model, data)


# --------------------------- batches --------------------------------------------------------------

CARS, STEPS = 4096, 20


def quarter_car() -> mujoco.MjModel:
    """Wheel and car as siblings with a device whose parameters are live."""
    world = slide("wheel", 25, 0, 'stiffness="120e3"') + slide("car", 180, 1)
    tendon = """<fixed name="t" stiffness="60e3"><joint joint="wheel" coef="-1"/>
      <joint joint="car" coef="1"/></fixed>"""
    keys = {
        "inertance": 113, "viscous": 900, "friction": "lugre", "coulomb_force": 40,
        "series_stiffness": 8e4,
    }  # fmt: skip
    names = ("inertance", "viscous", "coulomb_force", "series_stiffness")
    numerics = "".join(f'<numeric name="d0.{n}" data="{keys[n]}"/>' for n in names)
    xml = mjcf(world, tendon, [(keys, 'tendon="t"')], rest=f"<custom>{numerics}</custom>")
    option = 'timestep="1e-3" integrator="implicitfast"'
    return mujoco.MjModel.from_xml_string(xml.replace("{option}", option))


@pytest.fixture(scope="module")
def loop() -> tuple[Array, Array, Array]:
    """Parameters, first velocities and last states of cars that run one after the other."""
    model = quarter_car()
    rng = np.random.default_rng(0)
    values = rng.uniform([20, 100, 5, 1e4], [300, 2000, 80, 1e6], (CARS, 4))
    speeds = rng.normal(0, 0.3, (CARS, 2))
    rows = []
    data = mujoco.MjData(model)
    for value, speed in zip(values, speeds, strict=True):
        model.numeric_data[:] = value
        mujoco.mj_resetData(model, data)
        data.qvel[:] = speed
        mujoco.mj_step(model, data, STEPS)
        rows.append(np.concatenate([data.qpos, data.qvel, data.act, data.sensordata]))
    return values, speeds, np.array(rows)


@pytest.mark.parametrize("persistent", [False, True])
@pytest.mark.parametrize("threads", [1, 2])
def test_a_batch_is_the_loop(
    threads: int, persistent: bool, loop: tuple[Array, Array, Array]
) -> None:
    many = pytest.importorskip("mujoco.batch", reason="MuJoCo 3.16 has none")
    values, speeds, rows = loop
    batch = many.Batch(quarter_car(), CARS, threads, persistent)
    batch.expand("numeric_data")[:] = values
    qpos, qvel, act = (batch.bind(name) for name in ("qpos", "qvel", "act"))
    sensors = batch.bind("sensordata")
    qvel[:] = speeds
    batch.step(nstep=7)
    batch.step(nstep=STEPS - 7)
    assert np.array_equal(np.hstack([qpos, qvel, act, sensors]), rows)
    assert len(np.unique(rows[:, 0])) == CARS


@pytest.mark.parametrize("integrator", ["implicit", "implicitfast"])
def test_a_motor_at_its_limit_continues_bit_for_bit(integrator: str) -> None:
    """The engine's derivatives look at the motors' force, which must be that of the same pass."""
    device = (
        {"inertance": 3.0, "load_friction": 0.02},
        'joint="arm"',
    )
    world = """<body><joint name="arm" axis="0 1 0" damping="0.3" actuatorfrcrange="-30 30"/>
      <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.04" mass="2"/></body>"""
    servo = '<position name="servo" joint="arm" kp="60" kv="5"/>'
    xml = mjcf(world, "", [device], actuators=servo, gravity=(0, 0, -9.81))
    option = f'timestep="2e-3" integrator="{integrator}"'
    model = mujoco.MjModel.from_xml_string(xml.replace("{option}", option))
    data = mujoco.MjData(model)
    data.qvel[:], data.ctrl[:1] = 2.0, 1.0
    run(model, data, 3)
    fresh = whole_state(model, data)
    assert np.array_equal(run(model, fresh, 20), run(model, data, 20))
