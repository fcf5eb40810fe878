"""Are forces that depend on the acceleration solved with the acceleration that they cause?

Load friction mu |N| sign(v) and a varying inertance, N = b(x) a + b'(x) v^2 / 2.
"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import instance_actuator

WIDTH = 1e-2


def arm(devices: dict[str, tuple[float, float, float]]) -> str:
    """Two hinges and a slide in space, with devices (b, mu, gradient) by actuator target."""
    texts = [
        instance_actuator(
            {
                "inertance": b, "load_friction": mu, "transition_velocity": WIDTH,
                "inertance_gradient": gradient,
            },
            target,
            f"d{i}",
        )
        for i, (target, (b, mu, gradient)) in enumerate(devices.items())
    ]  # fmt: skip
    return f"""
<mujoco>
  <extension><plugin plugin="inerter.device">{"".join(t[0] for t in texts)}</plugin></extension>
  <option timestep="1e-3" integrator="RK4"/>
  <worldbody>
    <site name="fixed" pos="0.3 0.4 1.2"/>
    <body name="upper" pos="0 0 0.8" gravcomp="0.5">
      <joint name="shoulder" axis="0 1 0" damping="0.1" actuatorgravcomp="true"/>
      <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.03" mass="1.5"/>
      <body name="lower" pos="0.4 0 0">
        <joint name="elbow" axis="1 0 1"/>
        <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.03" mass="1"/>
        <site name="hand" pos="0.4 0 0"/>
        <body name="slider" pos="0.4 0 0">
          <joint name="slide" type="slide" axis="1 0 0" stiffness="50"/>
          <geom size="0.08" mass="0.7"/>
        </body>
      </body>
    </body>
  </worldbody>
  <tendon><spatial name="cable"><site site="fixed"/><site site="hand"/></spatial></tendon>
  <actuator>
    {"".join(t[1] for t in texts)}
    <motor name="motor" joint="elbow" forcerange="-1 1"/>
  </actuator>
  <sensor>{"".join(t[2] for t in texts)}</sensor>
</mujoco>"""


CABLE, ELBOW, SLIDE = 'tendon="cable"', 'joint="elbow"', 'joint="slide" gear="2"'
DEVICES = {
    "load, tendon": {CABLE: (2.0, 0.4, 0.0)},
    "load, joint with gear": {SLIDE: (1.0, 0.9, 0.0)},
    "load, three": {CABLE: (2.0, 0.4, 0.0), ELBOW: (0.5, 0.7, 0.0), SLIDE: (1.0, 1.0, 0.0)},
    "load, one of two": {ELBOW: (0.5, 0.0, 0.0), CABLE: (2.0, 0.4, 0.0)},
    "varying, tendon": {CABLE: (2.0, 0.0, -0.7)},
    "varying, three": {CABLE: (2.0, 0.0, 1.5), ELBOW: (0.5, 0.0, -0.8), SLIDE: (1.0, 0.0, 2.0)},
    "both, three": {CABLE: (2.0, 0.5, 1.5), ELBOW: (0.5, 0.9, -0.8), SLIDE: (1.0, 0.7, 2.0)},
}


@pytest.mark.parametrize("devices", DEVICES.values(), ids=DEVICES)
@pytest.mark.parametrize("seed", range(4))
def test_the_force_belongs_to_the_acceleration_that_results(devices: dict, seed: int) -> None:
    model = mujoco.MjModel.from_xml_string(arm(devices))
    data = mujoco.MjData(model)
    rng = np.random.default_rng(seed)
    data.qpos[:] = rng.normal(0, 0.3, model.nq)
    data.qvel[:] = rng.normal(0, 2, model.nv)
    data.qfrc_applied[:] = rng.normal(0, 3, model.nv)
    data.xfrc_applied[2] = rng.normal(0, 5, 6)
    data.ctrl[-1] = 7  # limited to 1 N m
    mujoco.mj_forward(model, data)
    largest = 0.0
    for i, (b, mu, gradient) in enumerate(devices.values()):
        total, inertance, friction, *_ = data.sensor(f"d{i}").data
        x, v = data.actuator(f"d{i}").length[0], data.actuator(f"d{i}").velocity[0]
        expected = mu * abs(inertance) * np.tanh(v / WIDTH)
        assert friction == pytest.approx(expected, rel=1e-9, abs=1e-9)
        assert total == pytest.approx(inertance + friction, rel=1e-12)
        # the actuator applies what the inertia matrix does not hold: all but b a
        factor = max(0.01, 1 + gradient * x)
        rest = 0.5 * b * gradient * v**2 * (factor > 0.01)
        a = (inertance - rest) / (b * factor)
        assert data.actuator(f"d{i}").force[0] == pytest.approx(b * a - total, rel=1e-8, abs=1e-8)
        largest = max(largest, abs(b * a - total))
    assert largest > 0.05


def test_one_mass_by_hand() -> None:
    # m = 1 kg, b = 1 kg, mu = 0.5, f = 5 N, v >> v_t: (1 + 1 + 0.5) a = 5 while accelerating,
    # (1 + 1 - 0.5) a = -3 while braking
    extension, actuator, sensor = instance_actuator(
        {"inertance": 1, "load_friction": 0.5}, 'joint="slide"'
    )
    model = mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device">{extension}</plugin></extension>
  <option gravity="0 0 0"/>
  <worldbody><body><joint name="slide" type="slide"/><geom size="0.1" mass="1"/></body></worldbody>
  <actuator>{actuator}</actuator>
  <sensor>{sensor}</sensor>
</mujoco>""")
    data = mujoco.MjData(model)
    for force, acceleration in ((5, 2.0), (-3, -2.0)):
        data.qvel[0], data.qfrc_applied[0] = 1, force
        mujoco.mj_forward(model, data)
        assert data.qacc[0] == pytest.approx(acceleration, rel=1e-12)
        assert data.sensordata[2] == pytest.approx(1.0, rel=1e-12)
