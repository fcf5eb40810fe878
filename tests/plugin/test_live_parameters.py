"""Parameters that a numeric holds: the device is the one that they state, whatever they become."""

from __future__ import annotations

import inerter
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


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize(
    ("law", "states", "more"),
    [
        ("coulomb", 0, {}),
        ("stribeck", 0, {"static_force": 5.0}),
        ("brown_mcphee", 0, {"static_force": 5.0}),
        ("dahl", 1, {"bristle_stiffness": 1e5}),
        ("lugre", 1, {"bristle_stiffness": 1e5}),
        ("rate_state", 1, {}),
    ],
)
def test_a_level_of_friction_may_be_none(
    law: str, states: int, more: dict[str, float], integrator: str
) -> None:
    level = {"coulomb_force": 5.0, **({"static_force": 5.0} if "static_force" in more else {})}
    keys = {"friction": law, "inertance": 4, **more, **level}
    model = slide(keys, dict.fromkeys(level, 0.0), integrator)
    data = mujoco.MjData(model)
    assert data.act.size == states
    for size in (0.0, 5.0, 0.0):
        mujoco.mj_resetData(model, data)
        model.numeric_data[:] = size
        data.qvel[0], data.qfrc_applied[0] = 0.5, FORCE
        for _ in range(100):
            mujoco.mj_step(model, data)
        gained = (data.qvel[0] - 0.5) * (MASS + 4) / (100 * model.opt.timestep)
        if size:
            assert FORCE - 6 < gained < FORCE - 3
        else:
            assert gained == pytest.approx(FORCE, rel=1e-9)
        assert np.isfinite(data.sensordata).all()
        now = device_of(model, "strut").now(model)
        assert now.coulomb_force == pytest.approx(size, abs=1e-20)


@pytest.mark.parametrize("slips", [{"leak_damping": 1000.0}, {"leak_quadratic_damping": 50.0}])
def test_a_flywheel_behind_a_leak_is_as_stated(slips: dict[str, float]) -> None:
    """There it is a state: the engine's armature is not its inertance."""
    device = inerter.Device(inertance=50, **slips)
    config = "".join(f'<config key="{k}" value="{v}"/>' for k, v in device.given.items())
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>
        <worldbody><body><joint name="x" type="slide"/><geom size="0.1" mass="{MASS}"/></body>
        </worldbody><actuator><plugin name="strut" plugin="inerter.device" joint="x"
        actdim="{device.nstate}">{config}</plugin></actuator></mujoco>"""
    )
    now = device_of(model, "strut").now(model)
    assert now.inertance == 50
    assert now.given.items() >= slips.items()


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


def test_a_value_that_cannot_be_is_an_error_of_every_step() -> None:
    model = slide({"inertance": 4, "viscous": 1}, {"viscous": 1})
    data = mujoco.MjData(model)
    model.numeric_data[0] = -1
    for _ in range(3):
        with pytest.raises(mujoco.FatalError, match="live parameters: viscous is -1"):
            mujoco.mj_step(model, data)
    model.numeric_data[0] = np.nan
    with pytest.raises(mujoco.FatalError, match="live parameters: viscous is"):
        mujoco.mj_step(model, data)
    # mended: also to the value that stood before
    for viscous in (1.0, 5.0):
        model.numeric_data[0] = viscous
        mujoco.mj_resetData(model, data)
        data.qvel[0] = 2
        mujoco.mj_forward(model, data)
        assert data.qacc[0] == pytest.approx(-viscous * 2 / (MASS + 4), rel=1e-12)


def knee(**numerics: float) -> mujoco.MjSpec:
    """A leg with a device on its knee, live parameters of it."""
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="shank")
    body.add_joint(name="knee", type=mujoco.mjtJoint.mjJNT_SLIDE)
    body.add_geom(size=[0.1, 0, 0], mass=MASS)
    device = inerter.Device(inertance=1, **numerics)
    inerter.add_device(spec, "knee_dev", joint="knee", device=device, live=list(numerics))
    return spec


@pytest.mark.parametrize(
    ("prefix", "suffix"), [("left/", ""), ("/", "_a"), ("b/", ".right"), ("a.b/", "_viscous")]
)
def test_an_attached_model_keeps_its_live_parameters(prefix: str, suffix: str) -> None:
    spec = mujoco.MjSpec()
    spec.option.gravity[:] = 0
    spec.attach(knee(viscous=3.0), prefix=prefix, suffix=suffix, frame=spec.worldbody.add_frame())
    model = spec.compile()
    (device,) = inerter.devices_of(model)
    assert device.name == f"{prefix}knee_dev{suffix}"
    assert device.live == {"viscous": 0}
    data = mujoco.MjData(model)
    model.numeric_data[0] = 8
    data.qvel[0] = 1
    mujoco.mj_forward(model, data)
    assert data.qacc[0] == pytest.approx(-8 / (MASS + 1), rel=1e-12)


def test_two_attached_models_have_each_its_own() -> None:
    spec = mujoco.MjSpec()
    for suffix, viscous in (("_a", 3.0), ("_b", 4.0), ("", 5.0)):
        frame = spec.worldbody.add_frame()
        leg = knee(viscous=viscous, stiffness=viscous)
        spec.attach(leg, prefix="l/", suffix=suffix, frame=frame)
    model = spec.compile()
    values = {
        each.name: [float(model.numeric_data[place]) for place in each.live.values()]
        for each in inerter.devices_of(model)
    }
    assert values == {"l/knee_dev_a": [3, 3], "l/knee_dev_b": [4, 4], "l/knee_dev": [5, 5]}


def test_a_renamed_actuator_keeps_its_live_parameters() -> None:
    spec = knee(viscous=3.0)
    spec.actuator("knee_dev").name = "strut"
    (device,) = inerter.devices_of(spec.compile())
    assert (device.name, dict(device.live)) == ("strut", {"viscous": 0})
    # two statements of one parameter
    spec.add_numeric(name="strut.viscous", data=[1], size=1)
    with pytest.raises(ValueError, match="is the second one that holds its viscous"):
        spec.compile()


@pytest.mark.parametrize(
    ("numeric", "words"),
    [
        ("hip.viscous", 'no device is named "hip"'),
        ("left/strut.viscous", 'no device is named "left/strut"'),
        ("strut.viscus", '"viscus" is not a parameter that can be live'),
    ],
)
def test_a_numeric_that_would_hold_nothing_is_refused(numeric: str, words: str) -> None:
    instance, actuator, sensor = instance_actuator({"inertance": 1}, 'joint="x"')
    xml = f"""<mujoco><extension><plugin plugin="inerter.device">{instance}</plugin></extension>
        <worldbody><body><joint name="x" type="slide"/><geom size="0.1"/></body></worldbody>
        <actuator>{actuator}</actuator><sensor>{sensor}</sensor>
        <custom><numeric name="{numeric}" data="1"/><numeric name="gains.left" data="1 2"/></custom>
        </mujoco>"""
    with pytest.raises(ValueError, match=words):
        mujoco.MjModel.from_xml_string(xml)
    mujoco.MjModel.from_xml_string(xml.replace(numeric, "camera.height"))


@pytest.mark.parametrize("change", [1.0, 1e-9])
def test_every_number_of_a_long_list_is_seen(change: float) -> None:
    """None is lost beside the many after it."""
    rows, columns = 24, 16
    random = np.random.default_rng(0)
    numbers = 3.0 * random.standard_normal(rows * columns)
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body()
    body.add_joint(name="travel", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
    body.add_geom(size=[0.1, 0, 0], mass=1.0)
    added = inerter.add_device(
        spec, "strut", joint="travel", force_map=numbers.tolist(), force_map_columns=columns,
        force_map_lower=-0.1, force_map_upper=0.1, force_map_speed=1.0, live=("force_map",),
    )  # fmt: skip
    model = spec.compile()
    place, data = added.of(model), mujoco.MjData(model)
    first = place.live["force_map"]
    for row in range(rows):
        data.qpos[0] = -0.1 + 0.2 * row / (rows - 1)
        mujoco.mj_forward(model, data)
        before = data.sensordata[place.sensor["total"]]
        model.numeric_data[first + row * columns : first + (row + 1) * columns] += change
        mujoco.mj_forward(model, data)
        told = data.sensordata[place.sensor["total"]] - before
        # a smooth map does not pass through its numbers
        assert told == pytest.approx(change, rel=0.2)
