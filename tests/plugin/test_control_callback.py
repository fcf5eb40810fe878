"""Callbacks for the control, which the plugin makes the engine call once more under `discrete`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS, instance_actuator

INERTANCE = 3.0


def siblings(integrator: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Two masses of 1 kg in two trees, the device between them, a motor on each."""
    instance, actuator, sensor = instance_actuator({"inertance": INERTANCE})
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device">{instance}</plugin></extension>
        <option integrator="{integrator}" gravity="0 0 0"><flag contact="disable"/></option>
        <worldbody>
          <body><joint name="x" type="slide"/><geom size="0.1" mass="1"/></body>
          <body><joint name="y" type="slide"/><geom size="0.1" mass="1"/></body>
        </worldbody>
        <tendon><fixed name="strut"><joint joint="x" coef="-1"/><joint joint="y" coef="1"/></fixed>
        </tendon>
        <actuator><motor joint="x"/><motor joint="y"/>{actuator}</actuator>
        <sensor>{sensor}</sensor></mujoco>"""
    )
    return model, mujoco.MjData(model)


@contextmanager
def controlled(callback: Callable[[mujoco.MjModel, mujoco.MjData], None]) -> Iterator[None]:
    mujoco.set_mjcb_control(callback)
    try:
        yield
    finally:
        mujoco.set_mjcb_control(None)


def answers(model: mujoco.MjModel, data: mujoco.MjData) -> bool:
    """Whether the device pulls with b times the acceleration that the step found."""
    force = data.sensordata[0]
    assert data.actuator_force[2] == pytest.approx(-force, abs=1e-12)
    return force == pytest.approx(INERTANCE * (data.qacc[1] - data.qacc[0]), abs=1e-9)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_callback_that_counts_does_not_break_the_force(integrator: str) -> None:
    model, data = siblings(integrator)
    rng = np.random.default_rng(0)

    def push(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.ctrl[:2] = rng.normal(size=2)
        data.qfrc_applied[:] = rng.normal(size=2)
        data.xfrc_applied[1, 0] = rng.normal()

    with controlled(push):
        for _ in range(20):
            mujoco.mj_forward(model, data)
            assert answers(model, data)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_control_between_step1_and_step2_counts(integrator: str) -> None:
    model, data = siblings(integrator)

    def rest(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.ctrl[:] = 0

    with controlled(rest):
        mujoco.mj_step1(model, data)
        data.ctrl[1] = 7
        mujoco.mj_step2(model, data)
    # half of the mass in relative motion: (1/2 + 3) a = 7/2
    np.testing.assert_allclose(data.qacc, [3, 4], rtol=1e-9)
    assert data.ctrl[1] == 7


def test_an_interrupted_callback_leaves_nothing_behind() -> None:
    model, data = siblings("discrete")
    calls = []

    def interrupted(_: mujoco.MjModel, data: mujoco.MjData) -> None:
        data.ctrl[1] = 7
        calls.append(data.time)
        if len(calls) == 2:
            raise KeyboardInterrupt

    with controlled(interrupted):
        with pytest.raises(KeyboardInterrupt):
            mujoco.mj_forward(model, data)
        mujoco.mj_resetData(model, data)
        mujoco.mj_forward(model, data)
        assert answers(model, data)
        np.testing.assert_allclose(data.qacc, [3, 4], rtol=1e-9)
