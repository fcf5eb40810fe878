"""A damper that is no straight line in the engine: in the plugin, whatever the engine holds."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from inerter.reference import ReferenceDevice
from scipy.integrate import solve_ivp

SHAPE = {"damping_asymmetry": 0.4, "damping_knee": 0.2, "damping_beyond": 0.3}
BACK = {"damping_knee_back": 0.05, "damping_beyond_back": 1.5, "damping_sharpness": 8}
DEVICE = {"inertance": 3.0, "viscous": 40.0, "stiffness": 800.0}


def mass(
    integrator: str, step: float, keys: dict[str, float], numerics: dict[str, float] | None = None
) -> mujoco.MjModel:
    """2 kg on a slide with a device to the world."""
    config = "".join(f'<config key="{name}" value="{value}"/>' for name, value in keys.items())
    custom = "".join(
        f'<numeric name="d.{name}" data="{value}"/>' for name, value in (numerics or {}).items()
    )
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="{step}" integrator="{integrator}" gravity="0 0 0"/>
  <custom>{custom}</custom>
  <worldbody><body><joint name="j" type="slide" axis="1 0 0"/>
    <geom size="0.1" mass="2"/></body></worldbody>
  <actuator><plugin name="d" plugin="inerter.device" joint="j">{config}</plugin></actuator>
</mujoco>""")


def end(model: mujoco.MjModel, time: float = 0.5) -> float:
    data = mujoco.MjData(model)
    data.qvel[0] = 2.0
    mujoco.mj_step(model, data, round(time / model.opt.timestep))
    return float(data.qpos[0])


def exact(shape: dict[str, float] = SHAPE, time: float = 0.5) -> float:
    device = ReferenceDevice(**(DEVICE | shape | {"inertance": 0.0}))  # pyright: ignore[reportArgumentType]

    def rate(_: float, y: np.ndarray) -> list[float]:
        return [y[1], -float(device.force(y[0], y[1], 0.0)) / 5.0]

    return float(solve_ivp(rate, (0, time), [0.0, 2.0], rtol=1e-11, atol=1e-13).y[0, -1])


@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "discrete"])
def test_first_order_towards_the_solution(integrator: str) -> None:
    errors = [
        end(mass(integrator, step, DEVICE | SHAPE)) - exact() for step in (1e-3, 5e-4, 2.5e-4)
    ]
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.05)
    assert errors[1] / errors[2] == pytest.approx(2, rel=0.05)


def test_rk4() -> None:
    assert end(mass("RK4", 1e-3, DEVICE | SHAPE)) == pytest.approx(exact(), abs=1e-6)


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "discrete", "RK4"])
def test_each_direction_bends_by_itself(integrator: str) -> None:
    step, tolerance = (1e-3, 1e-6) if integrator == "RK4" else (5e-5, 2e-4)
    for shape in (SHAPE | BACK, BACK):
        found = end(mass(integrator, step, DEVICE | shape))
        assert found == pytest.approx(exact(shape), abs=tolerance)
        assert abs(found - exact()) > 2e-3


def test_the_engine_holds_none_of_it() -> None:
    model = mass("implicitfast", 1e-3, DEVICE | SHAPE)
    assert model.actuator_damping[0] == 0
    assert model.actuator_armature[0] == 3


@pytest.mark.parametrize("integrator", ["implicitfast", "RK4"])
def test_a_shape_that_comes_while_it_runs(integrator: str) -> None:
    # compiled straight, with its damping in the engine: bent by numbers of the model
    straight = {"damping_asymmetry": 0.0, "damping_knee": 0.0, "damping_beyond": 1.0}
    live = mass(integrator, 2e-4, DEVICE, straight)
    assert live.actuator_damping[0] == 40
    live.numeric_data[:] = list(SHAPE.values())
    stated = mass(integrator, 2e-4, DEVICE | SHAPE)
    tolerance = {"implicitfast": 2e-4, "RK4": 1e-9}[integrator]
    assert end(live) == pytest.approx(end(stated), rel=tolerance)


def test_stable_at_any_step() -> None:
    # h c / m = 500
    keys = {"viscous": 1e5, "inertance": 0.0} | SHAPE
    for integrator in ("Euler", "implicit", "implicitfast", "discrete"):
        model = mass(integrator, 1e-2, keys)
        data = mujoco.MjData(model)
        data.qvel[0] = 2.0
        speeds = []
        for _ in range(200):
            mujoco.mj_step(model, data)
            speeds.append(data.qvel[0])
        assert np.all(np.diff(np.abs([2.0, *speeds])) <= 1e-12), integrator


BRAKE = {"damping_knee": 0.2, "damping_beyond": 0.0, "damping_exponent": -1.0}


@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "discrete"])
def test_a_force_that_falls_with_the_speed(integrator: str) -> None:
    # passes its knee on the way down from 2 m/s
    errors = [
        end(mass(integrator, step, DEVICE | BRAKE)) - exact(BRAKE) for step in (1e-3, 5e-4, 2.5e-4)
    ]
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.05)
    assert errors[1] / errors[2] == pytest.approx(2, rel=0.05)
    # far beyond the step in which it could be followed it still only brakes
    model = mass(integrator, 1e-2, {"viscous": 1e5, "inertance": 0.0} | BRAKE)
    data = mujoco.MjData(model)
    data.qvel[0] = 2.0
    speeds = [2.0]
    for _ in range(200):
        mujoco.mj_step(model, data)
        speeds.append(float(data.qvel[0]))
    assert np.all(np.diff(speeds) <= 1e-12)
    assert 0.0 <= speeds[-1] < 1e-6


def test_a_force_that_falls_under_rk4() -> None:
    assert end(mass("RK4", 1e-3, DEVICE | BRAKE)) == pytest.approx(exact(BRAKE), abs=1e-6)


def test_dampers_that_are_disabled_damp_no_more() -> None:
    model = mass("implicitfast", 1e-3, DEVICE | SHAPE)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_DAMPER
    plain = mass("implicitfast", 1e-3, {"inertance": 3.0, "stiffness": 800.0})
    assert end(model) == pytest.approx(end(plain), rel=1e-12)
