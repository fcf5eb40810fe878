"""The force that a sensor tells is the one in the balance of `mj_forward`, in every placement.

A mass on a damped slide, held by a device alone: m qacc = -F - D v. The inertance force in it is b
times qacc where the engine holds the inertance, and b (v_next - v) / h where it was solved for.
"""

from __future__ import annotations

import mujoco
import pytest
from plugin_models import INTEGRATORS

MASS, DAMPING, STEP = 2.0, 900.0, 5e-3
# h D / m = 2.2: the acceleration of mj_forward is three times that of the step
MODEL = """
<mujoco>
  <extension>
    <plugin plugin="inerter.device"><instance name="strut">{keys}</instance></plugin>
  </extension>
  <option gravity="0 0 0" integrator="{integrator}" timestep="{step}"/>
  <worldbody>
    <body><joint name="slide" type="slide" damping="{damping}"/>
      <geom size="0.1" mass="{mass}"/></body>
    <body pos="1 0 0"><joint name="away" type="slide"/><geom size="0.1" mass="1e9"/></body>
  </worldbody>
  <tendon>
    <fixed name="native"><joint joint="slide" coef="1"/></fixed>
    <fixed name="coupled"><joint joint="slide" coef="1"/><joint joint="away" coef="-1"/></fixed>
  </tendon>
  <actuator>
    <plugin name="strut" plugin="inerter.device" instance="strut" {target} {actdim}/>
  </actuator>
  <sensor><plugin plugin="inerter.device" instance="strut"/></sensor>
</mujoco>"""
DEVICES = {
    "inertance": ({"inertance": 5}, 0),
    "damped": ({"inertance": 5, "viscous": 300}, 0),
    "coulomb": ({"inertance": 5, "friction": "coulomb", "coulomb_force": 20}, 0),
    "dahl": ({"inertance": 5, "friction": "dahl", "coulomb_force": 20}, 1),
    "elastic": ({"inertance": 5, "series_stiffness": 1e4}, 2),
}


def model_of(name: str, target: str, integrator: str, damping: float) -> mujoco.MjModel:
    keys, states = DEVICES[name]
    text = "".join(f'<config key="{key}" value="{value}"/>' for key, value in keys.items())
    return mujoco.MjModel.from_xml_string(
        MODEL.format(
            keys=text, integrator=integrator, step=STEP, damping=damping, mass=MASS,
            target=target, actdim=f'actdim="{states}"' if states else "",
        )
    )  # fmt: skip


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("target", ['joint="slide"', 'tendon="native"', 'tendon="coupled"'])
@pytest.mark.parametrize("name", DEVICES)
def test_the_force_moves_the_mass(name: str, target: str, integrator: str) -> None:
    for damping in (0.0, DAMPING):
        model = model_of(name, target, integrator, damping)
        if integrator == "RK4":
            model.opt.timestep = 5e-4
        h, data = model.opt.timestep, mujoco.MjData(model)
        data.qvel[0] = 1.0
        for _ in range(5):
            mujoco.mj_forward(model, data)
            v, qacc = data.qvel[0], data.qacc[0]
            total, inertance = data.sensordata[:2].copy()
            # the discrete integrator reports the step's acceleration, with dampers at its end
            at_end = h * qacc if integrator == "discrete" else 0.0
            damper = damping * (v + at_end) + model.actuator_damping[0] * at_end
            assert MASS * qacc == pytest.approx(-total - damper, rel=1e-7, abs=1e-9)
            mujoco.mj_step(model, data)
            if name == "elastic":
                continue
            native = model.actuator_armature[0] > 0
            a = qacc if native or integrator == "RK4" else (data.qvel[0] - v) / h
            assert inertance == pytest.approx(5 * a, rel=1e-6)
