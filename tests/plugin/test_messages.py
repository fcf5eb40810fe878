"""What the compiler says of a device, beside refusing wrong values."""

from __future__ import annotations

import re

import mujoco
import pytest
from plugin_models import plugin_actuator

MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <worldbody>
    <body><joint name="hinge"/><geom size="0.1" mass="1" pos="0.3 0 0"/></body>
    <body pos="1 0 0"><joint name="slide" type="slide"/><geom size="0.1" mass="2"/></body>
  </worldbody>
  <tendon>
    <fixed name="belt"><joint joint="hinge" coef="2"/></fixed>
    <fixed name="both"><joint joint="hinge" coef="0.02"/><joint joint="slide" coef="1"/></fixed>
  </tendon>
  <actuator>{actuator}</actuator>
  <sensor>{sensor}</sensor>
</mujoco>"""


def compiled(actuator: str, sensor: str = "") -> mujoco.MjModel:
    return mujoco.MjSpec.from_string(MODEL.format(actuator=actuator, sensor=sensor)).compile()


def refusal(actuator: str, sensor: str = "") -> str:
    with pytest.raises(ValueError, match=r"inerter\.device") as caught:
        compiled(actuator, sensor)
    return str(caught.value)


@pytest.mark.parametrize(
    ("target", "keys", "unit"),
    [
        ('joint="hinge"', {"inertance": -2}, "kg*m^2"),
        ('tendon="belt"', {"viscous": -2}, "N*m*s/rad"),
        ('joint="hinge"', {"stop_damping": -2}, "s/rad"),
        ('joint="slide"', {"inertance": -2}, "kg"),
        ('tendon="both"', {"viscous": -2}, "N*s/m"),
    ],
)
def test_a_hinge_is_spoken_of_in_its_units(target: str, keys: dict, unit: str) -> None:
    text = refusal(plugin_actuator(keys, target))
    assert f"give a finite number >= 0 {unit} (" in text


def test_a_name_in_quotes_is_no_unit() -> None:
    text = refusal(plugin_actuator({"inertance": 1, "friction": "m N kg"}, 'joint="hinge"'))
    assert 'friction is "m N kg"' in text


def test_a_sensor_without_an_instance() -> None:
    text = refusal(
        plugin_actuator({"inertance": 1}, 'joint="slide"'),
        '<plugin name="force" plugin="inerter.device"/>',
    )
    assert 'sensor "force": it names no instance' in text
    assert 'instance="NAME" in its actuator and in this sensor' in text


def test_an_empty_device() -> None:
    assert "nothing is configured" in refusal(plugin_actuator({}, 'joint="slide"'))
    # stated, a 0 is meant
    assert compiled(plugin_actuator({"inertance": 0}, 'joint="slide"')).nu == 1


def test_a_gear_of_several_numbers() -> None:
    text = refusal(plugin_actuator({"inertance": 1}, 'joint="slide"', attributes='gear="2 1"'))
    assert 'gear is "2 1 0 0 0 0"' in text
    assert 'gear="2"' in text


FRICTION = {"friction": "coulomb", "coulomb_force": 1}


def test_friction_without_an_inertance_is_said() -> None:
    with pytest.warns(UserWarning, match="inertance is not given: it runs as friction without one"):
        compiled(plugin_actuator(FRICTION, 'joint="slide"'))
    # warnings are errors in these tests
    compiled(plugin_actuator({"inertance": 0, **FRICTION}, 'joint="slide"'))
    compiled(plugin_actuator(FRICTION, 'joint="slide"', attributes='armature="1"'))
    compiled(plugin_actuator({"viscous": 3}, 'joint="slide"'))


def servo(target: str, attributes: str) -> str:
    return f'<position name="servo" {target} kp="40" {attributes}/>'


@pytest.mark.parametrize("ratio", [0.7, 1, 0.05])
@pytest.mark.parametrize("target", ['joint="slide"', 'tendon="both" gear="3"'])
def test_a_damping_ratio_that_lacks_the_inertance_is_told(target: str, ratio: float) -> None:
    device = plugin_actuator({"inertance": 48}, 'joint="slide"')
    asked = servo(target, f'dampratio="{ratio}"')
    with pytest.warns(UserWarning, match=f"dampratio {ratio:g}") as caught:
        compiled(device + asked)
    (kv,) = re.findall('kv="([^"]*)"', str(caught[0].message))

    # the engine's own, with the inertance where it sees it in time
    stated = plugin_actuator({"inertance": 48}, 'joint="slide"', attributes='armature="48"')
    right = compiled(stated + asked).actuator_biasprm[1, 2]
    assert -float(kv) == pytest.approx(right, rel=1e-5)
    assert compiled(asked).actuator_biasprm[0, 2] > 1.5 * right, "it matters"

    # what is written in place of it is taken as it is
    assert compiled(device + servo(target, f'kv="{kv}"')).actuator_biasprm[1, 2] == -float(kv)


def test_servos_of_other_masses_are_left_alone() -> None:
    device = plugin_actuator({"inertance": 48}, 'joint="slide"')
    compiled(device + servo('joint="hinge"', 'dampratio="0.7"'))
