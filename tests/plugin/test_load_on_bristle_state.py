"""A load on a law with memory: MjSpec, live parameters, copies, threads, rollouts and batches.

Every way gives the same numbers, bit for bit.
"""

from __future__ import annotations

import copy
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import inerter
import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS

LAWS: dict[str, dict[str, Any]] = {
    "dahl": {"coulomb_force": 40.0, "bristle_stiffness": 5e4},
    "lugre": {
        "coulomb_force": 40.0, "static_force": 60.0, "bristle_stiffness": 5e4,
        "bristle_damping": 100.0,
    },
    "bouc_wen": {"bw_stiffness": 5e4, "bw_beta": 800.0, "bw_gamma": 400.0},
    "maxwell_slip": {
        "slip_stiffness_1": 3e4, "slip_force_1": 15.0, "slip_stiffness_2": 2e4,
        "slip_force_2": 25.0,
    },
}  # fmt: skip
SHAFTS: dict[str, dict[str, Any]] = {
    "rigid": {},
    "flywheel": {"series_stiffness": 2e5, "series_damping": 300.0, "friction_side": "flywheel"},
}
CASES = [(law, shaft) for law in LAWS for shaft in SHAFTS]
STEPS = 150


def spec(
    law: str, shaft: str, integrator: str, mu: float = 0.2, *, live: bool = False,
    more: dict[str, float] | None = None,
) -> mujoco.MjSpec:  # fmt: skip
    """A wheel and a car side by side; with `live` the load friction is a numeric."""
    made = mujoco.MjSpec()
    made.option.timestep = 5e-4
    made.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    for name, mass, spring in (("wheel", 25.0, 1.2e5), ("car", 180.0, 6e3)):
        body = made.worldbody.add_body(name=name, pos=[0, 0, 0.5 * (name == "car")])
        body.add_joint(
            name=name, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, 1], stiffness=spring
        )
        body.add_geom(size=[0.05, 0, 0], mass=mass, contype=0, conaffinity=0)
    inerter.add_device(
        made, "strut", between=(("wheel", [0, 0, 0]), ("car", [0, 0, 0])), rest_length="initial",
        inertance=113.0, friction=law, mu_forward=mu, mu_backward=0.1,
        live=("mu_forward",) if live else (), **{**LAWS[law], **SHAFTS[shaft], **(more or {})},
    )  # fmt: skip
    return made


def start(model: mujoco.MjModel) -> mujoco.MjData:
    data = mujoco.MjData(model)
    data.qvel[:] = [0.4, 0.0]
    return data


def run(model: mujoco.MjModel, data: mujoco.MjData, steps: int = STEPS) -> np.ndarray:
    """qpos, qvel, act and sensors after each step."""
    rows = []
    for _ in range(steps):
        mujoco.mj_step(model, data)
        rows.append(np.concatenate([data.qpos, data.qvel, data.act, data.sensordata]))
    return np.array(rows)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize(("law", "shaft"), CASES)
def test_the_same_in_copies_threads_and_from_its_xml(law: str, shaft: str, integrator: str) -> None:
    made = spec(law, shaft, integrator)
    model = made.compile()
    expected = run(model, start(model))
    assert np.ptp(expected[:, 4]) > 1e-5, "the friction moves"
    none = spec(law, shaft, integrator, mu=0.1).compile()
    assert np.abs(run(none, start(none)) - expected).max() > 1e-3, "the load counts"

    # as text, and as the parts of a run
    again = mujoco.MjModel.from_xml_string(made.to_xml())
    np.testing.assert_array_equal(run(again, start(again)), expected)
    half = start(model)
    run(model, half, STEPS // 2)
    twin = copy.copy(half)
    np.testing.assert_array_equal(run(model, twin, STEPS - STEPS // 2), expected[STEPS // 2 :])

    # threads share the model
    with ThreadPoolExecutor(4) as pool:
        for found in pool.map(lambda _: run(model, start(model)), range(6)):
            np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("integrator", ["implicitfast", "RK4"])
@pytest.mark.parametrize(("law", "shaft"), CASES)
def test_a_rollout_and_a_batch_are_a_loop(law: str, shaft: str, integrator: str) -> None:
    rollout = pytest.importorskip("mujoco.rollout")
    model = spec(law, shaft, integrator).compile()
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS
    first = np.zeros(mujoco.mj_stateSize(model, full))
    mujoco.mj_getState(model, start(model), first, full)
    speeds = np.linspace(-0.5, 0.5, 6)
    starts = np.tile(first, (6, 1))
    starts[:, 1 + model.nq] = speeds
    states, _ = rollout.rollout(
        [model] * 6, [mujoco.MjData(model) for _ in range(3)], starts, nstep=STEPS
    )
    ends = []
    for k, speed in enumerate(speeds):
        data = start(model)
        data.qvel[0] = speed
        ends.append(run(model, data)[-1])
        end = np.zeros_like(first)
        mujoco.mj_getState(model, data, end, full)
        np.testing.assert_array_equal(states[k, -1], end)

    many = pytest.importorskip("mujoco.batch", reason="MuJoCo 3.16 has none")
    batch = many.Batch(model, 6, 2)
    qpos, qvel, act, sensors = (batch.bind(name) for name in ("qpos", "qvel", "act", "sensordata"))
    qvel[:] = np.stack([speeds, np.zeros(6)], axis=1)
    batch.step(nstep=STEPS)
    found = np.concatenate([qpos, qvel, act, sensors], axis=1)
    np.testing.assert_array_equal(found, np.array(ends))


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize(("law", "shaft"), CASES)
def test_a_live_load_is_the_compiled_one(law: str, shaft: str, integrator: str) -> None:
    stated = spec(law, shaft, integrator, mu=0.35).compile()
    model = spec(law, shaft, integrator, mu=0.2, live=True).compile()
    assert model.numeric(0).name == "strut.mu_forward"
    model.numeric_data[0] = 0.35
    np.testing.assert_array_equal(run(model, start(model)), run(stated, start(stated)))
    # and on the way: the part before is that of the value before
    model.numeric_data[0] = 0.2
    data, before = start(model), spec(law, shaft, integrator).compile()
    np.testing.assert_array_equal(run(model, data, 40), run(before, start(before), 40))
    model.numeric_data[0] = 0.35
    other = mujoco.MjData(stated)
    size = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.zeros(mujoco.mj_stateSize(model, size))
    mujoco.mj_getState(model, data, state, size)
    mujoco.mj_setState(stated, other, state, size)
    other.qacc_warmstart[:] = data.qacc_warmstart
    np.testing.assert_array_equal(run(model, data, 40), run(stated, other, 40))


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "RK4"])
@pytest.mark.parametrize("shaft", SHAFTS)
def test_where_several_accelerations_fit_the_bodies_gain_nothing(
    shaft: str, integrator: str
) -> None:
    """Mu sigma1 |v| is 450 times the level, see load_friction.c."""
    steep = {"bristle_damping": 1e4, "static_force": 40.0}
    made = spec("lugre", shaft, integrator, mu=0.9, more=steep)
    made.option.timestep, made.option.gravity = 1.25e-4, [0, 0, 0]
    model = made.compile()
    data = start(model)
    data.qvel[0] = 2.0
    kept = []
    for _ in range(1600):
        mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        bodies = 0.5 * (
            25.0 * data.qvel[0] ** 2 + 180.0 * data.qvel[1] ** 2
            + 1.2e5 * data.qpos[0] ** 2 + 6e3 * data.qpos[1] ** 2
        )  # fmt: skip
        kept.append(bodies + data.sensordata[-2])
    # 2 m/s of 25 kg and of 113 kg beside, or behind the shaft at rest
    first = 0.5 * 25.0 * 4.0 + (0.5 * 113.0 * 4.0 if shaft == "rigid" else 0.0)
    assert max(kept) <= first * (1.0 + 1e-3)
    balance = (kept[-1] + data.sensordata[-1]) / first
    assert balance == pytest.approx(1.0, abs=1e-4 if integrator == "RK4" else 1e-2)
