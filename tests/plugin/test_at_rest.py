"""No energy out of rest: devices and contacts are solved for together, however sharp the laws are.

The bodies here begin at rest. Gravity may do its work, nothing else: mechanical energy, that of the
devices included, must not rise above where it began.
"""

from __future__ import annotations

import inerter
import mujoco
import numpy as np
import pytest
from plugin_models import plugin_actuator

ONE_STAGE = ["Euler", "implicit", "implicitfast", "discrete"]
COULOMB = {"friction": "coulomb", "coulomb_force": 1.56}
STRIBECK = {"friction": "stribeck", "coulomb_force": 1.0, "static_force": 1.56}
LAWS: dict[str, tuple[dict[str, float | str], int]] = {
    "coulomb": (COULOMB, 0),
    "stribeck": (STRIBECK, 0),
    "brown_mcphee": (STRIBECK | {"friction": "brown_mcphee"}, 0),
    "load": ({"load_friction": 0.4}, 0),
    "soft shaft, coulomb": (COULOMB | {"series_stiffness": 1e3}, 2),
    "stiff shaft, coulomb": (COULOMB | {"series_stiffness": 6.6e4}, 2),
    "dahl": (COULOMB | {"friction": "dahl"}, 1),
    "lugre": (STRIBECK | {"friction": "lugre", "bristle_damping": 300}, 1),
}

Strut = tuple[dict[str, float | str], int, str, str]  # keys, states, site in the world, on the box


def box(
    mass: float, struts: list[Strut], step: float, integrator: str, cone: str = "pyramidal"
) -> mujoco.MjModel:
    """A box at rest on the floor, struts to the world."""
    world = "".join(f'<site name="w{i}" pos="{s[2]}"/>' for i, s in enumerate(struts))
    own = "".join(f'<site name="b{i}" pos="{s[3]}"/>' for i, s in enumerate(struts))
    tendons = "".join(
        f'<spatial name="t{i}"><site site="w{i}"/><site site="b{i}"/></spatial>'
        for i in range(len(struts))
    )
    devices = "".join(
        plugin_actuator(
            keys, f'tendon="t{i}"', attributes=f'actdim="{states}"' if states else ""
        ).replace('name="strut"', f'name="d{i}"')
        for i, (keys, states, *_) in enumerate(struts)
    )
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="{step}" integrator="{integrator}" cone="{cone}"/>
  <worldbody>
    <geom type="plane" size="3 3 0.1"/>{world}
    <body pos="0 0 0.05"><freejoint/>
      <geom type="box" size="0.05 0.05 0.05" mass="{mass}"/>{own}</body>
  </worldbody>
  <tendon>{tendons}</tendon>
  <actuator>{devices}</actuator>
</mujoco>""")


def fastest(model: mujoco.MjModel, steps: int) -> tuple[float, float]:
    """Largest speed of a run from rest, and how far the energy rises above its start [J]."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    start, speed, rise = inerter.energy(model, data).total, 0.0, 0.0
    for k in range(steps):
        mujoco.mj_step(model, data)
        speed = max(speed, np.abs(data.qvel[:3]).max())
        if k % 10 == 0:
            mujoco.mj_forward(model, data)
            rise = max(rise, inerter.energy(model, data).total - start)
    assert data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number == 0
    for counts in inerter.solve_counts(model, data).values():
        assert counts.stops == 0
    return speed, rise


@pytest.mark.parametrize("integrator", ONE_STAGE)
@pytest.mark.parametrize("name", LAWS)
def test_a_light_box_with_two_devices_stays(name: str, integrator: str) -> None:
    keys, states = LAWS[name]
    struts: list[Strut] = [
        (keys | {"inertance": b}, states, where, "0 0 0")
        for b, where in ((1.63, "0.3 0 0.5"), (0.053, "-0.3 0.1 0.5"))
    ]
    model = box(0.1, struts, 2.5e-3, integrator)
    speed, rise = fastest(model, 300)
    # settling into the soft floor: some millimetres per second
    assert speed < 0.02
    assert rise < 1e-4


@pytest.mark.parametrize("integrator", ONE_STAGE)
@pytest.mark.parametrize("mass", [10.0, 1.0])
def test_four_struts_hold_a_box(mass: float, integrator: str) -> None:
    struts: list[Strut] = [
        (
            {"inertance": 2, "friction": "coulomb", "coulomb_force": 20}, 0,
            f"{0.3 * x} {0.3 * y} 0.5", f"{0.05 * x} {0.05 * y} 0.05",
        )
        for x in (1, -1) for y in (1, -1)
    ]  # fmt: skip
    speed, rise = fastest(box(mass, struts, 2.5e-3, integrator), 300)
    assert speed < 0.02
    assert rise < 1e-3 * mass


@pytest.mark.parametrize("seed", range(12))
def test_drawn_boxes_gain_no_energy(seed: int) -> None:
    """Masses, levels, steps, places, laws, cones and integrators drawn."""
    rng = np.random.default_rng([20261124, seed])
    mass, step = 10.0 ** rng.uniform(-1, 1.5), 10.0 ** rng.uniform(-3.3, -2)
    struts: list[Strut] = []
    for _ in range(rng.integers(1, 6)):
        keys, states = LAWS[str(rng.choice(list(LAWS)))]
        level = 10.0 ** rng.uniform(-1, 2)
        keys = dict(keys)
        for name in ("coulomb_force", "static_force"):
            if name in keys:
                keys[name] = float(keys[name]) * level
        keys["inertance"] = 10.0 ** rng.uniform(-2, 2)
        places = (rng.uniform([-1, -1, 0.2], [1, 1, 2.2]), rng.uniform(-0.05, 0.05, 3))
        outside, inside = (" ".join(f"{c:.4f}" for c in place) for place in places)
        struts.append((keys, states, outside, inside))
    integrator, cone = str(rng.choice(ONE_STAGE)), str(rng.choice(["elliptic", "pyramidal"]))
    model = box(mass, struts, step, integrator, cone)
    speed, rise = fastest(model, 200)
    weight = mass * 9.81
    assert speed < 0.3, (mass, step, struts)
    assert rise < 1e-3 * weight, (mass, step, struts)


@pytest.mark.parametrize("integrator", ONE_STAGE)
@pytest.mark.parametrize("damping", [0.0, 1.0, 60.0, 1e4])
@pytest.mark.parametrize("step", [5e-3, 2e-2])
def test_a_bristle_rests_at_every_damping_and_step(
    step: float, damping: float, integrator: str
) -> None:
    # 0.1 kg m^2 under 0.49 N m: h sigma1 / I up to 2000
    keys = {"friction": "lugre", "coulomb_force": 3, "static_force": 4, "bristle_stiffness": 1e4,
            "bristle_damping": damping}  # fmt: skip
    device = plugin_actuator(keys, 'joint="hinge"', attributes='actdim="1"')
    model = mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="{step}" integrator="{integrator}"/>
  <worldbody>
    <body><joint name="hinge" axis="0 1 0"/>
      <inertial pos="0.05 0 0" mass="1" diaginertia="0.0975 0.0975 0.0975"/></body>
  </worldbody>
  <actuator>{device}</actuator>
</mujoco>""")
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, round(10 / step))
    # at rest, or settling as slowly as so strong a damper lets: sigma1 / sigma0 = 1 s
    assert abs(data.qvel[0]) < (1e-6 if damping == 1e4 else 1e-12)
    assert data.actuator_force[0] == pytest.approx(-0.05 * 9.81, rel=1e-5)


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "discrete"])
def test_friction_that_holds_beside_a_spring_is_soon_found(integrator: str) -> None:
    # spring and friction of newtons cancel to nothing: less than their rounding tells no more
    model = mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option integrator="{integrator}" timestep="1e-3" gravity="0 0 0"/>
  <worldbody>
    <body><joint type="slide" axis="1 0 0"/><geom size="0.1" mass="3"/><site name="a"/></body>
    <body pos="1 0 0"><joint type="slide" axis="1 0 0"/><geom size="0.1" mass="2"/><site name="b"/>
    </body>
  </worldbody>
  <tendon><spatial name="t"><site site="a"/><site site="b"/></spatial></tendon>
  <actuator>
    <plugin name="one" plugin="inerter.device" tendon="t" actdim="2">
      <config key="inertance" value="94.9"/>
      <config key="series_stiffness" value="125"/>
      <config key="rest_length" value="1"/>
      <config key="friction" value="coulomb"/>
      <config key="coulomb_force" value="4.24"/>
    </plugin>
  </actuator>
</mujoco>""")
    data = mujoco.MjData(model)
    data.qvel[:] = 1.0, 0.5
    mujoco.mj_step(model, data, 3000)
    assert abs(data.qvel[0] - data.qvel[1]) < 1e-3
    counts = inerter.solve_counts(model, data)["one"]
    assert counts.solves == 3000
    assert counts.stops < 0.1 * counts.solves
