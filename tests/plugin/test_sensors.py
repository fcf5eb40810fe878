"""Do the sensors tell the truth: Newton's law, energy balance, the state?"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import (
    DAMPER,
    FRICTION,
    INERTANCE,
    INTEGRATORS,
    SPRUNG,
    STRUT,
    TYRE,
    UNSPRUNG,
    instance_actuator,
    quarter_car_xml,
)


def car(law: str, option: str, **keys: float) -> mujoco.MjModel:
    """A quarter-car whose whole strut is the device."""
    device = {
        "inertance": INERTANCE, "viscous": DAMPER, "stiffness": STRUT, "friction": law,
        **FRICTION[law], **keys,
    }  # fmt: skip
    instance, actuator, sensor = instance_actuator(device)
    return mujoco.MjModel.from_xml_string(
        quarter_car_xml(
            actuator, instance=instance, sensor=sensor, option=option, stiffness=0, damping=0
        )
    )


def energies(model: mujoco.MjModel, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Mechanical energy with what the device stores, and heat, at every step."""
    data = mujoco.MjData(model)
    data.qvel[:] = 0.3, -0.3
    mechanical, heat = [], []
    for _ in range(round(duration / model.opt.timestep)):
        mujoco.mj_forward(model, data)
        zu, _ = data.qpos
        vu, v = data.qvel
        outside = UNSPRUNG * vu**2 / 2 + SPRUNG * (vu + v) ** 2 / 2 + TYRE * zu**2 / 2
        mechanical.append(outside + data.sensordata[-2])
        heat.append(data.sensordata[-1])
        mujoco.mj_step(model, data)
    return np.array(mechanical), np.array(heat)


@pytest.mark.parametrize("law", FRICTION)
@pytest.mark.parametrize("load", [0.0, 0.1])
def test_energy_is_conserved_under_rk4(law: str, load: float) -> None:
    model = car(
        law,
        'timestep="2.5e-4" integrator="RK4"',
        load_friction=load,
        transition_velocity=0.02,
        inertance_gradient=30 if load else 0,
        inertance_curvature=2000 if load else 0,
    )
    mechanical, heat = energies(model, 0.5)
    start = mechanical[0]
    # laws with memory have a corner at v = 0, where RK4 is of second order only
    assert np.abs(mechanical + heat - start).max() < 2e-6 * start
    assert np.diff(heat).min() > -1e-9 * start, "heat never flows back"
    assert heat[-1] > 0.5 * start


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
def test_the_energy_defect_of_other_integrators_falls_with_the_step(integrator: str) -> None:
    defects = []
    for h in (1e-3, 5e-4, 2.5e-4):
        mechanical, heat = energies(car("lugre", f'timestep="{h}" integrator="{integrator}"'), 0.3)
        defects.append(np.abs(mechanical + heat - mechanical[0]).max() / mechanical[0])
    assert np.log2(np.divide(defects[:-1], defects[1:])).min() > 0.8, defects


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("law", ["none", "stribeck", "lugre"])
def test_the_total_force_is_what_moves_the_body(law: str, integrator: str) -> None:
    model = car(law, f'timestep="1e-3" integrator="{integrator}"')
    data = mujoco.MjData(model)
    data.qvel[:] = 0.3, -0.3
    for _ in range(50):
        mujoco.mj_step(model, data)
        before = data.qvel.copy()
        mujoco.mj_forward(model, data)
        total, inertance, friction, *_ = data.sensordata
        x, v = data.qpos[1], data.qvel[1]
        acceleration = data.qacc.sum()
        # `discrete` reports the acceleration of the step, at the damper's speed at its end
        speed = v + 1e-3 * data.qacc[1] if integrator == "discrete" else v
        assert total == pytest.approx(inertance + DAMPER * v + STRUT * x + friction, abs=1e-9)
        assert SPRUNG * acceleration == pytest.approx(
            -(total + DAMPER * (speed - v)), rel=1e-9, abs=1e-7
        )
        assert inertance == pytest.approx(INERTANCE * data.qacc[1], rel=1e-12)
        assert np.array_equal(before, data.qvel)


def test_the_state_and_its_place() -> None:
    model = car("lugre", 'timestep="1e-3" integrator="implicitfast"')
    assert model.nsensordata == 6
    data = mujoco.MjData(model)
    data.act[0] = 1e-3
    mujoco.mj_forward(model, data)
    assert data.sensordata[3] == 1e-3
    # sigma0 z + sigma1 z' at rest
    assert data.sensordata[2] == pytest.approx(50.0)
    assert data.sensordata[4] == pytest.approx(5e4 * 1e-6 / 2)


def test_displacement_counts_from_the_rest_length() -> None:
    keys = {"inertance": 1, "stiffness": 100, "rest_length": 0.3}
    instance, actuator, sensor = instance_actuator(keys, 'tendon="cable"')
    model = mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device">{instance}</plugin></extension>
  <option gravity="0 0 0"/>
  <worldbody>
    <site name="a"/>
    <body pos="0.5 0 0"><joint type="slide" axis="1 0 0"/><geom size="0.1"/><site name="b"/></body>
  </worldbody>
  <tendon><spatial name="cable"><site site="a"/><site site="b"/></spatial></tendon>
  <actuator>{actuator}</actuator>
  <sensor>{sensor}</sensor>
</mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.sensordata[0] - data.sensordata[1] == pytest.approx(100 * 0.2)
    # tension pulls the body towards the site
    assert data.qacc[0] < 0


def test_a_disabled_actuator_leaves_inertance_and_damping() -> None:
    model = car("lugre", 'timestep="1e-3" integrator="implicitfast"')
    data = mujoco.MjData(model)
    data.qvel[:], data.act[0] = (0.3, -0.3), 1e-3
    model.opt.disableactuator = 1
    for _ in range(3):
        mujoco.mj_step(model, data)
    assert data.act[0] == 1e-3
    assert data.actuator_force[0] == 0
    assert data.sensordata[2] == 0
    mujoco.mj_forward(model, data)
    expected = data.sensordata[1] + DAMPER * data.qvel[1]
    assert data.sensordata[0] == pytest.approx(expected)
    assert SPRUNG * data.qacc.sum() == pytest.approx(-expected, rel=1e-9)


def test_the_control_is_a_force_beside_the_device() -> None:
    model = car("none", 'timestep="1e-3"')
    model.actuator_ctrllimited[0], model.actuator_ctrlrange[0] = True, (-5, 5)
    data = mujoco.MjData(model)
    for ctrl, force in ((3.0, 3.0), (-8.0, -5.0), (np.nan, 0.0)):
        data.ctrl[0] = ctrl
        data.qvel[:] = data.qpos[:] = 0
        with np.errstate(invalid="ignore"):
            mujoco.mj_forward(model, data)
        # positive lengthens: it pushes the body up, the wheel down
        assert data.actuator_force[0] == pytest.approx(force)
        assert SPRUNG * data.qacc.sum() + INERTANCE * data.qacc[1] == pytest.approx(force)
