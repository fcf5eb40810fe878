"""Curves along the stroke in the engine: both placements, contacts, live lists, energy."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from inerter import add_device
from inerter.core import Device
from inerter.reference import ReferenceDevice
from scipy.integrate import solve_ivp
from topology_models import mjcf, slide

WHEEL, CAR, TYRE, STRUT, B = 25.0, 180.0, 2500.0, 800.0, 113.0
LAYOUTS = ("nested", "siblings")
RANGE: dict[str, Any] = {"curve_lower": -0.04, "curve_upper": 0.05}
RISE = (0.1, -0.1, 0.2, 0.0, 0.15, -0.05)
DEVICES: dict[str, dict[str, Any]] = {
    "curve": {"inertance_curve": RISE, **RANGE},
    "periods": {"inertance_periods": (0.03, 0.05, 1.0, 0.01, 0.01, 0.0)},
    "directions": {"inertance_curve": RISE, **RANGE, "inertance_back_periods": (0.03, 0.05, 0.0)},
    "force": {"force_curve": tuple(30.0 * y for y in RISE), **RANGE, "force_periods": (0.02, 3, 0)},
    "map": {
        "force_map": tuple(8.0 * y for y in (*RISE, *RISE[::-1], 0, 2, 1, -1, -2, 3)),
        "force_map_columns": 6, "force_map_lower": -0.2, "force_map_upper": 0.2,
        "force_map_speed": 0.6, "force_map_scale": 0.3,
    },
    "all": {
        "inertance_curve": RISE, **RANGE, "inertance_periods": (0.03, 0.05, 1.0),
        "force_periods": (0.02, 5.0, 0.0), "viscous": 20.0, "viscous_curve": (5, 30, -5, 10),
        "friction": "brown_mcphee", "coulomb_force": 6.0, "static_force": 6.0,
        "stribeck_velocity": 0.05, "friction_periods": (0.02, 0.5, 0.0),
    },
}  # fmt: skip


def texts(keys: dict[str, Any]) -> dict[str, Any]:
    return Device(inertance=B, **keys).given


def build(
    layout: str, keys: dict[str, Any], option: str, stops: str = "", tyre: float = TYRE,
    strut: float = STRUT,
) -> mujoco.MjModel:  # fmt: skip
    if layout == "nested":
        inner = slide("car", CAR, 1, stops)
        world = slide("wheel", WHEEL, 0, f'stiffness="{tyre}"', inner)
        joints = '<joint joint="car" coef="1"/>'
    else:
        world = slide("wheel", WHEEL, 0, f'stiffness="{tyre}"') + slide("car", CAR, 1, stops)
        joints = '<joint joint="wheel" coef="-1"/><joint joint="car" coef="1"/>'
    tendon = f'<fixed name="strut" stiffness="{strut}">{joints}</fixed>'
    xml = mjcf(world, tendon, [(texts(keys), 'tendon="strut"')])
    return mujoco.MjModel.from_xml_string(xml.replace("{option}", option))


def travel(layout: str, data: mujoco.MjData) -> tuple[float, float, float]:
    pairs = (data.qpos, data.qvel, data.qacc)
    x, v, a = (q[1] if layout == "nested" else q[1] - q[0] for q in pairs)
    return float(x), float(v), float(a)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", DEVICES)
def test_the_motion_is_that_of_the_equations(name: str, layout: str) -> None:
    """Wheel and car with the reference device, by SciPy; RK4 in the engine."""
    device = ReferenceDevice(inertance=B, **DEVICES[name])

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        zu, zs, vu, vs = y
        x, v = zs - zu, vs - vu
        rest = float(device.force(x, v, 0.0))
        mass = float(device.force(x, v, 1.0)) - rest
        pull = STRUT * x + rest
        # M a = f, the device between both
        matrix = np.array([[WHEEL + mass, -mass], [-mass, CAR + mass]])
        return np.array([vu, vs, *np.linalg.solve(matrix, [pull - TYRE * zu, -pull])])

    model = build(layout, DEVICES[name], 'integrator="RK4" timestep="5e-4"')
    data = mujoco.MjData(model)
    data.qvel[:] = (0.3, -0.3) if layout == "nested" else (0.3, 0.0)
    mujoco.mj_step(model, data, 1000)
    truth = solve_ivp(rate, (0.0, 0.5), [0, 0, 0.3, 0.0], method="DOP853", rtol=1e-9, atol=1e-11)
    zu, zs, vu, vs = truth.y[:, -1]
    x, v, _ = travel(layout, data)
    assert x == pytest.approx(zs - zu, abs=2e-6)
    assert v == pytest.approx(vs - vu, abs=5e-5)


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "discrete", "RK4"])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_force_and_acceleration_fit_each_other_in_contact(layout: str, integrator: str) -> None:
    """The car runs onto stops: momentum of both bodies, the constraint's force included."""
    stops = 'limited="true" range="-0.02 0.02"'
    keys: dict[str, Any] = {"inertance_periods": (0.03, 0.2, 1.0)}
    keys |= {"inertance_back_periods": (0.02, 0.2, 0.0)}
    model = build(layout, keys, f'integrator="{integrator}" timestep="5e-4"', stops, 0.0, 0.0)
    data = mujoco.MjData(model)
    data.qvel[:] = (0.3, -0.8) if layout == "nested" else (0.3, -0.5)
    device, met = ReferenceDevice(inertance=B, **keys), 0
    for _ in range(1500):
        mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        x, v, a = travel(layout, data)
        pull = float(device.force(x, v, a))
        aw = data.qacc[0]
        ac = aw + a if layout == "nested" else data.qacc[1]
        held = data.qfrc_constraint
        met += data.nefc > 0
        push = held[1]
        wheel = pull + (held[0] - push if layout == "nested" else held[0])
        size = abs(pull) + abs(push) + WHEEL * abs(aw) + 1.0
        assert abs(CAR * ac + pull - push) < 1e-7 * (size + CAR * abs(ac))
        assert abs(WHEEL * aw - wheel) < 1e-7 * size
    assert met > 5


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", ["curve", "periods", "directions", "force"])
def test_energy_is_kept_to_1e_10(name: str, layout: str, request: pytest.FixtureRequest) -> None:
    """2 s at 0.1 ms (with --long 100 s) of wheel, car, tyre, strut and device.

    The curve reaches over the whole stroke: at its ends its second derivative jumps.
    """
    keys = DEVICES[name]
    wide = {"curve_lower": -0.15, "curve_upper": 0.15} if "curve_lower" in keys else {}
    model = build(layout, keys | wide, 'integrator="RK4" timestep="1e-4"')
    data = mujoco.MjData(model)
    data.qvel[:] = (0.3, -0.3) if layout == "nested" else (0.3, 0.0)

    def energy() -> float:
        mujoco.mj_forward(model, data)
        zu, zs = data.qpos
        vu, vs = data.qvel
        if layout == "nested":
            zs, vs = zu + zs, vu + vs
        springs = TYRE * zu**2 / 2 + STRUT * (zs - zu) ** 2 / 2
        return (WHEEL * vu**2 + CAR * vs**2) / 2 + springs + data.sensordata[-2:].sum()

    first, worst = energy(), 0.0
    for _ in range(100 if request.config.getoption("--long") else 2):
        mujoco.mj_step(model, data, 10_000)
        worst = max(worst, abs(energy() - first) / first)
    # a turn within a step jumps between the inertances of the directions: first order there
    assert worst < (1e-5 if name == "directions" else 1e-10)


def test_lists_can_be_live() -> None:
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="car")
    body.add_joint(name="travel", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
    body.add_geom(size=[0.1, 0, 0], mass=1.0)
    added = add_device(
        spec, joint="travel", inertance=2.0, force_periods=[[0.02, 3.0, 0.0]],
        force_curve=(0.0, 1.0, 0.0), **RANGE, live=("force_periods", "curve_upper"),
    )  # fmt: skip
    model = spec.compile()
    place = added.of(model)
    data = mujoco.MjData(model)
    data.qpos[0] = 0.005
    mujoco.mj_forward(model, data)
    total = place.sensor["total"]
    assert place.device.given == added.device.given

    def expected(amplitude: float) -> float:
        device = Device(
            inertance=2.0, force_periods=(0.02, amplitude, 0.0), force_curve=(0, 1, 0), **RANGE
        )
        return float(device.evaluate(0.005, 0.0, data.qacc[0], 0.0)["total"][0])

    assert data.sensordata[total] == pytest.approx(expected(3.0))
    model.numeric_data[place.live["force_periods"] + 1] = -7.0
    mujoco.mj_forward(model, data)
    assert data.sensordata[total] == pytest.approx(expected(-7.0))
    # a list that cannot be is an error that names it
    model.numeric_data[place.live["force_periods"]] = -1.0
    with pytest.raises(mujoco.FatalError, match="force_periods: number 1 is -1"):
        mujoco.mj_forward(model, data)


@pytest.mark.parametrize("integrator", ["Euler", "implicitfast", "discrete", "RK4"])
def test_a_passive_map_brings_a_mass_to_rest_whatever_its_numbers(integrator: str) -> None:
    """Steep over velocity: more than an explicit step could take; sensors tell what it does."""
    steep = np.linspace(-400.0, 400.0, 6) + np.array([[0.0, 60.0, -90.0, 30.0, 80.0, 0.0]] * 3)
    step = 1e-4 if integrator == "RK4" else 2e-3
    spec = mujoco.MjSpec()
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    spec.option.timestep, spec.option.gravity = step, (0, 0, 0)
    body = spec.worldbody.add_body(name="car")
    body.add_joint(name="travel", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
    body.add_geom(size=[0.1, 0, 0], mass=1.0)
    added = add_device(
        spec, joint="travel", force_map=steep.tolist(), force_map_columns=6, force_map_passive=1,
        force_map_lower=-0.1, force_map_upper=0.1, force_map_speed=0.5, stiffness=100.0,
        live=("force_map",),
    )  # fmt: skip
    model = spec.compile()
    place, data = added.of(model), mujoco.MjData(model)
    data.qvel[0] = 0.4
    mujoco.mj_forward(model, data)
    expected = place.device.evaluate(0.0, 0.4, data.qacc[0], 0.0)
    if integrator == "RK4":
        for name in ("total", "stored_energy", "dissipated_power"):
            told = {"stored_energy": "stored", "dissipated_power": "power"}.get(name, name)
            if told in place.sensor:
                assert data.sensordata[place.sensor[told]] == pytest.approx(expected[name][0])
    first = 0.5 * data.qvel[0] ** 2
    mujoco.mj_step(model, data, int(1.0 / step))
    assert 0.5 * data.qvel[0] ** 2 < 0.05 * first
    # the numbers are live: none of them, no force but the spring's
    model.numeric_data[place.live["force_map"] : place.live["force_map"] + 18] = 0.0
    data.qpos[0], data.qvel[0] = 0.02, 0.1
    mujoco.mj_forward(model, data)
    assert data.sensordata[place.sensor["total"]] == pytest.approx(2.0)


def test_viscous_damping_along_the_stroke_goes_with_the_damper_flag() -> None:
    keys: dict[str, Any] = {"viscous_periods": (0.02, -3.0, 1.0), "viscous": 5.0}
    model = build("nested", keys, 'timestep="1e-3" integrator="implicitfast"')
    data = mujoco.MjData(model)
    data.qpos[1], data.qvel[1] = 0.004, 0.5
    mujoco.mj_forward(model, data)
    before = data.qacc.copy()
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_DAMPER
    mujoco.mj_forward(model, data)
    off = data.qacc.copy()
    model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.qacc, before)
    assert abs(off - before).max() > 1e-3
