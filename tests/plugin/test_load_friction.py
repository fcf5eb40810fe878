"""Is load friction mu |b a| sign(v) solved with the acceleration that it causes?"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import instance_actuator

WIDTH = 1e-2


def arm(devices: dict[str, tuple[float, float]]) -> str:
    """Two hinges and a slide in space, with devices (b, mu) by actuator target."""
    texts = [
        instance_actuator(
            {"inertance": b, "load_friction": mu, "transition_velocity": WIDTH}, target, f"d{i}"
        )
        for i, (target, (b, mu)) in enumerate(devices.items())
    ]
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


DEVICES = {
    "one on a tendon": {'tendon="cable"': (2.0, 0.4)},
    "one on a joint with gear": {'joint="slide" gear="2"': (1.0, 0.9)},
    "three together": {
        'tendon="cable"': (2.0, 0.4), 'joint="elbow"': (0.5, 0.7), 'joint="slide"': (1.0, 1.0),
    },
    "with and without": {'joint="elbow"': (0.5, 0.0), 'tendon="cable"': (2.0, 0.4)},
}  # fmt: skip


@pytest.mark.parametrize("devices", DEVICES.values(), ids=DEVICES)
@pytest.mark.parametrize("seed", range(4))
def test_friction_belongs_to_the_acceleration_that_results(devices: dict, seed: int) -> None:
    model = mujoco.MjModel.from_xml_string(arm(devices))
    data = mujoco.MjData(model)
    rng = np.random.default_rng(seed)
    data.qpos[:] = rng.normal(0, 0.3, model.nq)
    data.qvel[:] = rng.normal(0, 2, model.nv)
    data.qfrc_applied[:] = rng.normal(0, 3, model.nv)
    data.xfrc_applied[2] = rng.normal(0, 5, 6)
    data.ctrl[-1] = 7  # limited to 1 N m
    mujoco.mj_forward(model, data)
    friction = 0.0
    for i, (_, mu) in enumerate(devices.values()):
        total, inertance, shown, *_ = data.sensor(f"d{i}").data
        v = data.actuator(f"d{i}").velocity[0]
        expected = mu * abs(inertance) * np.tanh(v / WIDTH)
        assert shown == pytest.approx(expected, rel=1e-9, abs=1e-9)
        assert total == pytest.approx(inertance + shown, rel=1e-12)
        # what the actuator applies is the friction that the sensor shows
        assert data.actuator(f"d{i}").force[0] == pytest.approx(-expected, rel=1e-9, abs=1e-9)
        friction = max(friction, abs(expected))
    assert friction > 0.05


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
