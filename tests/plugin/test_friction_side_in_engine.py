"""Friction behind the shaft, by load, of several elements: one motion by every integrator."""

from typing import Any

import mujoco
import numpy as np
import pytest

MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="{step}" integrator="{integrator}" gravity="0 0 0"/>
  <worldbody>
    <body>
      <joint name="slide" type="slide" axis="1 0 0" stiffness="2000"/>
      <geom size="0.1" mass="10"/>
    </body>
  </worldbody>
  <actuator>
    <plugin name="strut" plugin="inerter.device" joint="slide" actdim="{states}">{keys}</plugin>
  </actuator>
</mujoco>
"""
STRUT = {"inertance": 30, "series_stiffness": 5e4, "series_damping": 100}
LAWS: dict[str, dict[str, Any]] = {
    "coulomb": {"coulomb_force": 10, "transition_velocity": 1e-2},
    "lugre": {"coulomb_force": 10, "static_force": 14, "bristle_damping": 100},
}


def run(law: str, integrator: str, step: float, side: str = "flywheel") -> np.ndarray:
    values = {**STRUT, "friction": law, "friction_side": side, **LAWS[law]}
    return run_with(values, 3 if law == "lugre" else 2, integrator, step)


def run_with(values: dict[str, Any], states: int, integrator: str, step: float) -> np.ndarray:
    keys = "".join(f'<config key="{key}" value="{value}"/>' for key, value in values.items())
    model = mujoco.MjModel.from_xml_string(
        MODEL.format(step=step, integrator=integrator, states=states, keys=keys)
    )
    data = mujoco.MjData(model)
    data.qpos[0] = 0.02
    found = []
    for _ in range(100):
        for _ in range(round(4e-3 / step)):
            mujoco.mj_step(model, data)
        found.append(data.qpos[0])
    return np.array(found)


@pytest.mark.parametrize("law", LAWS)
def test_implicit_steps_converge_to_the_stages_of_runge_kutta(law: str) -> None:
    true = run(law, "RK4", 5e-5)
    coarse, fine = (np.max(abs(run(law, "implicitfast", h) - true)) for h in (4e-4, 1e-4))
    assert coarse < 4e-5
    assert fine == pytest.approx(coarse / 4.0, rel=0.1)
    assert np.max(abs(run(law, "Euler", 1e-4) - true)) == pytest.approx(fine, rel=1e-6)
    # and it is another motion than that of friction at the terminals
    assert np.max(abs(run(law, "RK4", 1e-4, "terminals") - true)) > 1e-5


@pytest.mark.parametrize("shaft", [False, True], ids=["rigid", "shaft"])
def test_load_friction_by_the_direction_of_power(shaft: bool) -> None:
    values: dict[str, Any] = {"inertance": 30, "mu_forward": 0.4, "mu_backward": 0.2}
    values["transition_velocity"] = 1e-2
    values |= {key: value for key, value in STRUT.items() if shaft and key != "inertance"}
    states = 2 if shaft else 0
    true = run_with(values, states, "RK4", 5e-5)
    coarse, fine = (
        np.max(abs(run_with(values, states, "implicitfast", h) - true)) for h in (4e-4, 1e-4)
    )
    assert coarse < 2e-4
    assert fine == pytest.approx(coarse / 4.0, rel=0.2)
    # between one mu and the other
    for mu in (0.4, 0.2):
        plain = {**values, "mu_forward": mu, "mu_backward": mu}
        assert np.max(abs(run_with(plain, states, "RK4", 2e-4) - true)) > 1e-4


def test_maxwell_slip_in_the_engine() -> None:
    values: dict[str, Any] = {"inertance": 5, "friction": "maxwell_slip"}
    for i, (stiffness, force) in enumerate(((1e4, 4), (2e3, 3), (600, 3)), 1):
        values |= {f"slip_stiffness_{i}": stiffness, f"slip_force_{i}": force}
    true = run_with(values, 3, "RK4", 5e-5)
    coarse, fine = (
        np.max(abs(run_with(values, 3, "implicitfast", h) - true)) for h in (4e-4, 1e-4)
    )
    assert coarse < 2e-4
    assert fine == pytest.approx(coarse / 4.0, rel=0.2)


def test_viscoelastic_branches_in_the_engine() -> None:
    values: dict[str, Any] = {"inertance": 5, "branch_stiffness_1": 4e3, "branch_damping_1": 200}
    values |= {"branch_stiffness_2": 1e3, "branch_damping_2": 500}
    true = run_with(values, 2, "RK4", 5e-5)
    coarse, fine = (
        np.max(abs(run_with(values, 2, "implicitfast", h) - true)) for h in (4e-4, 1e-4)
    )
    assert coarse < 2e-4
    assert fine == pytest.approx(coarse / 4.0, rel=0.2)
    # stiffer than a step resolves: the dashpot alone, and no oscillation that grows
    stiff = {"inertance": 5, "branch_stiffness_1": 1e9, "branch_damping_1": 200}
    damper = {"inertance": 5, "viscous": 200}
    apart = run_with(stiff, 1, "implicitfast", 4e-3) - run_with(damper, 0, "RK4", 1e-4)
    assert np.max(abs(apart)) < 2e-3
