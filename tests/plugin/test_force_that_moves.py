"""Is the force that a sensor shows the one that moves the masses, however sharp the laws are?

Two free masses, a load that changes its direction: momentum alone tells the force of a step, and
nothing of the plugin's is asked for it.
"""

from __future__ import annotations

import itertools

import inerter
import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS

COULOMB = {"friction": "coulomb", "coulomb_force": 20.0}
ONE_WAY = {"series_damping": 10.0, "clutch_force": 2.5, "clutch_asymmetry": 1.0}
DEVICES: dict[str, tuple[dict[str, float | str], int]] = {
    "shaft": ({**COULOMB, "series_stiffness": 100.0}, 2),
    "stiff shaft": ({**COULOMB, "series_stiffness": 1000.0}, 2),
    "play": ({**COULOMB, "series_stiffness": 100.0, "backlash": 1e-3}, 3),
    "leak": ({**COULOMB, "series_stiffness": 100.0, "leak_damping": 50.0}, 3),
    "one-way clutch": ({**COULOMB, "series_stiffness": 70.0, **ONE_WAY}, 3),
    "dahl": ({**COULOMB, "friction": "dahl", "bristle_stiffness": 1e5}, 1),
    "lugre and a shaft": (
        {**COULOMB, "friction": "lugre", "bristle_stiffness": 1e5, "series_stiffness": 100.0}, 3
    ),
}  # fmt: skip


def two_masses(
    device: dict[str, float | str], states: int, masses: tuple[float, float], options: str
) -> mujoco.MjModel:
    keys = "".join(f'<config key="{name}" value="{value}"/>' for name, value in device.items())
    bodies = "".join(
        f'<body><joint name="{name}" type="slide" axis="1 0 0"/>'
        f'<geom size="0.1" mass="{mass}" contype="0"/></body>'
        for name, mass in zip("ab", masses, strict=True)
    )
    actdim = f'actdim="{states}"' if states else ""
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension>
    <plugin plugin="inerter.device"><instance name="d">{keys}</instance></plugin>
  </extension>
  <option gravity="0 0 0" {options}/>
  <worldbody>{bodies}</worldbody>
  <tendon><fixed name="t"><joint joint="b" coef="1"/><joint joint="a" coef="-1"/></fixed></tendon>
  <actuator>
    <plugin name="d" plugin="inerter.device" instance="d" tendon="t" {actdim}/>
  </actuator>
  <sensor><plugin plugin="inerter.device" instance="d"/></sensor>
</mujoco>""")


def worst_step(model: mujoco.MjModel, load: float, frequency: float, steps: int = 300) -> float:
    """Largest difference of the force that moved a mass and the one of the sensor [N]."""
    data, mass, worst = mujoco.MjData(model), float(model.body_mass[2]), 0.0
    for _ in range(steps):
        push = load * np.sign(np.sin(2 * np.pi * frequency * data.time + 0.1))
        data.qfrc_applied[:] = push, -push
        before = float(data.qvel[1])
        mujoco.mj_step(model, data)
        felt = -(mass * (data.qvel[1] - before) / model.opt.timestep + push)
        worst = max(worst, abs(felt - data.sensordata[0]))
    counts = inerter.solve_counts(model, data)["d"]
    assert counts.misfits == 0
    return worst


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
@pytest.mark.parametrize("name", DEVICES)
def test_the_force_of_a_step_is_the_one_that_moves(name: str, integrator: str) -> None:
    device, states = DEVICES[name]
    for inertance, light, load, frequency, step in itertools.product(
        (1.0, 5.0), (0.2, 3.0), (30.0, 100.0), (3.0, 10.0), (1e-3, 5e-3)
    ):
        model = two_masses(
            {"inertance": inertance, **device}, states, (1.0, light),
            f'integrator="{integrator}" timestep="{step}" tolerance="1e-14" iterations="200"',
        )  # fmt: skip
        assert worst_step(model, load, frequency) < 1e-4 * load, (inertance, light, load, step)


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
def test_friction_sticks_however_the_step_begins(integrator: str) -> None:
    """A load of 49.7 N against friction of 50 N beside a one-way clutch: it creeps, no more."""
    device = {
        "inertance": 3.0, "friction": "coulomb", "coulomb_force": 50.0, "series_stiffness": 70.0,
        **ONE_WAY,
    }  # fmt: skip
    for step in (1e-3, 5e-3):
        options = f'integrator="{integrator}" timestep="{step}"'
        model = two_masses(device, 3, (0.25, 0.25), options)
        data = mujoco.MjData(model)
        data.qvel[:] = 0.5, 0.65
        data.qfrc_applied[:] = 49.7, -49.7
        mujoco.mj_step(model, data, round(0.3 / step))
        assert -3e-4 < data.qpos[1] - data.qpos[0] < 0.0


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
def test_the_solution_does_not_depend_on_the_warm_start(integrator: str) -> None:
    device, states = DEVICES["shaft"]
    options = f'integrator="{integrator}" timestep="5e-3"'
    model = two_masses({"inertance": 5.0, **device}, states, (1.0, 0.2), options)
    data, rng, found = mujoco.MjData(model), np.random.default_rng(1), []
    for _ in range(200):
        mujoco.mj_resetData(model, data)
        data.qvel[:], data.act[:] = (0.5, 0.52), (0.01, 0.3)
        data.qfrc_applied[:] = 30.0, -30.0
        data.qacc_warmstart[:] = rng.normal(size=2) * 10.0 ** rng.uniform(-1, 3)
        mujoco.mj_step(model, data)
        found.append(data.qvel.copy())
    assert np.ptp(found, axis=0).max() < 1e-9


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast"])
def test_what_rests_is_no_misfit(integrator: str) -> None:
    """An ideal device between two wheels of a cart that stands still: all forces are rounding."""
    wheels = "".join(
        f'<body pos="{x} 0 -.05"><joint name="{name}" axis="0 1 0"/>'
        '<geom type="cylinder" zaxis="0 1 0" size=".05 .02" mass=".2"/></body>'
        for name, x in (("a", -0.1), ("b", 0.1))
    )
    model = mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option integrator="{integrator}"/>
  <worldbody>
    <geom type="plane" size="5 5 .1"/>
    <body pos="0 0 .1"><freejoint/><geom type="box" size=".15 .05 .02"/>{wheels}</body>
  </worldbody>
  <tendon><fixed name="t"><joint joint="a" coef="1"/><joint joint="b" coef="-1"/></fixed></tendon>
  <actuator><plugin name="d" plugin="inerter.device" tendon="t">
    <config key="inertance" value="1"/>
  </plugin></actuator>
</mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 1500)
    assert inerter.solve_counts(model, data)["d"].misfits == 0
