"""Parameters that a numeric holds: the device is the one that they state, whatever they become."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from inerter.core import DeviceError
from inerter.device_in_model import device_of
from plugin_models import INTEGRATORS, instance_actuator

CHANNEL = {"piston_area": 1e-3, "channel_area": 1e-5, "channel_length": 0.04}
MASS, FORCE = 2.0, 12.0


def slide(keys: dict, numerics: dict, integrator: str = "Euler") -> mujoco.MjModel:
    """A mass on a slide that is pulled, the device between it and the world."""
    instance, actuator, sensor = instance_actuator(keys, 'joint="x"')
    numeric = "".join(f'<numeric name="strut.{k}" data="{v}"/>' for k, v in numerics.items())
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device">{instance}</plugin></extension>
        <option integrator="{integrator}" gravity="0 0 0"/>
        <worldbody><body><joint name="x" type="slide"/><geom size="0.1" mass="{MASS}"/></body>
        </worldbody>
        <actuator>{actuator}</actuator><sensor>{sensor}</sensor><custom>{numeric}</custom>
        </mujoco>"""
    )


def pulled(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
    """Inertance that answers the force, and that which the sensor shows."""
    data.qfrc_applied[0] = FORCE
    mujoco.mj_forward(model, data)
    return FORCE / data.qacc[0] - MASS, data.sensordata[1] / data.qacc[0]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_an_inertance_may_be_none(integrator: str) -> None:
    model = slide({"inertance": 4}, {"inertance": 0}, integrator)
    assert model.actuator_armature[0] == 4, "the engine holds it"
    data = mujoco.MjData(model)
    for inertance in (0.0, 3.0, 0.0, 9.0):
        model.numeric_data[0] = inertance
        assert pulled(model, data) == pytest.approx((inertance, inertance), abs=1e-12)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("key", [*CHANNEL, "fluid_density"])
def test_a_channel_changes_its_inertance(key: str, integrator: str) -> None:
    start = (CHANNEL | {"fluid_density": 1000})[key]
    model = slide(CHANNEL, {key: start}, integrator)
    data, power = mujoco.MjData(model), {"piston_area": 2, "channel_area": -1}.get(key, 1)
    for factor in (1, 2, 0.5):
        model.numeric_data[0] = factor * start
        expected = 4 * float(factor) ** power
        assert pulled(model, data) == pytest.approx((expected, expected), rel=1e-12)
        assert device_of(model, "strut").now(model).inertance == pytest.approx(expected, rel=1e-12)


def test_an_edited_armature_is_no_channel() -> None:
    model = slide(CHANNEL, {})
    place = device_of(model, "strut")
    assert place.now(model).inertance == pytest.approx(4, rel=1e-12)
    model.actuator_armature[0] = 5
    with pytest.raises(DeviceError, match="inertance is 5 kg, but the channel gives 4 kg"):
        place.now(model)
    data = mujoco.MjData(model)
    mujoco.mj_setConst(model, data)
    assert pulled(model, data) == pytest.approx((5, 5), rel=1e-12)


def test_names_with_dots_do_not_meet() -> None:
    devices = "".join(
        f'<plugin name="{name}" plugin="inerter.device" joint="{name}">'
        '<config key="inertance" value="1"/></plugin>'
        for name in ("car", "car.front")
    )
    bodies = "".join(
        f'<body><joint name="{name}" type="slide"/><geom size="0.1" mass="{MASS}"/></body>'
        for name in ("car", "car.front")
    )
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>
        <option gravity="0 0 0"><flag contact="disable"/></option>
        <worldbody>{bodies}</worldbody><actuator>{devices}</actuator>
        <custom><numeric name="car.inertance" data="2"/>
        <numeric name="car.front.inertance" data="4"/></custom></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qfrc_applied[:] = FORCE
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(FORCE / data.qacc - MASS, [2, 4], rtol=1e-12)
