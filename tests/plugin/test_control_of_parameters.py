"""A control that sets a parameter of its device, in the engine: closed forms, energy, controls."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import inerter
import mujoco
import numpy as np
import pytest
from inerter import Device, add_device
from inerter.controls import device_controls
from inerter.reference import ReferenceDevice
from scipy.integrate import solve_ivp

INTEGRATORS = ("EULER", "IMPLICIT", "IMPLICITFAST", "DISCRETE", "RK4")
DAMPER: dict[str, Any] = {
    "inertance": 5.0, "viscous": 10.0, "control": "viscous", "control_lower": 10.0,
    "control_upper": 500.0, "control_lag": 0.05,
}  # fmt: skip
FLYWHEEL: dict[str, Any] = {
    "inertance": 5.0, "control": "inertance", "control_lower": 2.0, "control_upper": 50.0,
    "control_lag": 0.05,
}  # fmt: skip


def built(
    integrator: str,
    device: dict[str, Any],
    *,
    between: bool = False,
    step: float = 1e-3,
    **how: Any,
) -> tuple[Any, mujoco.MjModel, mujoco.MjData, Any]:
    """A mass of 10 kg, or two of 20 kg side by side, and the device."""
    spec: Any = mujoco.MjSpec()
    spec.option.timestep, spec.option.gravity = step, [0, 0, 0]
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator}")
    for i in range(1 + between):
        body = spec.worldbody.add_body(name=f"body{i}", pos=[2.0 * i, 0, 0])
        body.add_joint(name=f"joint{i}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[1, 0, 0])
        body.add_geom(size=[0.1] * 3, mass=20 if between else 10, contype=0, conaffinity=0)
    ends = (("body0", [0, 0, 0]), ("body1", [0, 0, 0]))
    where: dict[str, Any] = {"joint": "joint0"}
    if between:
        where = {"between": ends, "rest_length": "initial"}
    added = add_device(spec, "d", Device(**device), **where, **how)
    model = spec.compile()
    return spec, model, mujoco.MjData(model), added


def started(data: mujoco.MjData, speed: float = 1.0) -> None:
    # side by side: the second at this speed against the first
    data.qvel[:] = [speed] if data.qvel.size == 1 else [-speed / 2, speed / 2]


def run(model: mujoco.MjModel, data: mujoco.MjData, time: float) -> None:
    for _ in range(round(time / model.opt.timestep)):
        mujoco.mj_step(model, data)


def speed(data: mujoco.MjData) -> float:
    return float(data.qvel[-1] - data.qvel[0]) if data.qvel.size > 1 else float(data.qvel[0])


def damped(time: float) -> float:
    """V / v0 of 15 kg behind the damper whose control goes to 200."""
    spent = 200.0 * time - 190.0 * 0.05 * (1.0 - np.exp(-time / 0.05))
    return float(np.exp(-spent / 15.0))


@pytest.mark.parametrize("between", [False, True])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_damper_that_rises_in_closed_form_and_its_order(integrator: str, between: bool) -> None:
    errors = []
    for step in (2e-3, 1e-3):
        _, model, data, added = built(integrator, DAMPER, between=between, step=step)
        started(data)
        data.ctrl[0] = 200.0
        run(model, data, 0.1)
        errors.append(abs(speed(data) - damped(0.1)))
        assert added.of(model).act == {"control_change": 0}
        assert data.act[0] == pytest.approx(190.0 * (1.0 - np.exp(-2.0)), rel=1e-6)
    order = np.log2(errors[0] / errors[1])
    assert order > (3.7 if integrator == "RK4" else 0.9), (errors, order)
    assert errors[1] < (1e-6 if integrator == "RK4" else 2e-2)


@pytest.mark.parametrize("between", [False, True])
@pytest.mark.parametrize("lag", [0.0, 0.05])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_an_inertance_that_rises_in_closed_form(integrator: str, lag: float, between: bool) -> None:
    # a push of 30 N on m + b(t); side by side: on either end
    _, model, data, _ = built(integrator, {**FLYWHEEL, "control_lag": lag}, between=between)
    data.qfrc_applied[:] = [30.0] if not between else [-30.0, 30.0]
    data.ctrl[0] = 45.0
    run(model, data, 0.2)
    t = np.linspace(0.0, 0.2, 20001)
    inertance = 45.0 - 40.0 * np.exp(-t / lag) if lag else np.full_like(t, 45.0)
    expected = np.trapezoid(30.0 / (10.0 + inertance), dx=1e-5)
    bound = 1e-6 if integrator == "RK4" else 2e-2
    assert speed(data) == pytest.approx(expected, rel=bound)


@pytest.mark.parametrize("between", [False, True])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_the_actuator_pays_for_an_inertance_that_rises(integrator: str, between: bool) -> None:
    # steady speed: no force, no heat; b v^2 / 2 grows all the same
    _, model, data, added = built(integrator, FLYWHEEL, between=between)
    started(data, 2.0)
    device = added.of(model)
    mujoco.mj_forward(model, data)
    before = device.read(data.sensordata)
    data.ctrl[0] = 45.0
    run(model, data, 0.3)
    mujoco.mj_forward(model, data)
    after = device.read(data.sensordata)
    assert speed(data) == pytest.approx(2.0, rel=1e-12)
    assert after["dissipated_energy"] == pytest.approx(0.0, abs=1e-9)
    change = data.act[0]
    assert change == pytest.approx(40.0 * (1.0 - np.exp(-6.0)), rel=1e-6)
    gained = after["stored_energy"] - before["stored_energy"]
    assert gained == pytest.approx(0.5 * change * 4.0, rel=1e-12)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_work_heat_and_the_actuators_energy_add_up(integrator: str) -> None:
    # energy at the start + the actuator's = energy at the end + heat, to the order of the step
    left = []
    for step in (1e-3, 5e-4):
        p = FLYWHEEL | {"viscous": 20.0, "stiffness": 2e3}
        _, model, data, added = built(integrator, p, step=step)
        started(data)
        device, reader = Device(**p), added.of(model)
        data.ctrl[0], given, flow = 40.0, 0.0, []
        mujoco.mj_forward(model, data)
        start = 5.0 * data.qvel[0] ** 2 + reader.read(data.sensordata)["stored_energy"]
        for _ in range(round(0.2 / step)):
            x, v, z = data.qpos[0], data.qvel[0], data.act.copy()
            flow.append(device.evaluate(x, v, 0.0, z, command=40.0)["control_power"][0])
            mujoco.mj_step(model, data)
        x, v, z = data.qpos[0], data.qvel[0], data.act.copy()
        flow.append(device.evaluate(x, v, 0.0, z, command=40.0)["control_power"][0])
        given = float(np.trapezoid(flow, dx=step))
        mujoco.mj_forward(model, data)
        said = reader.read(data.sensordata)
        end = 5.0 * data.qvel[0] ** 2 + said["stored_energy"] + said["dissipated_energy"]
        left.append(abs(start + given - end))
        # no small part
        assert given > 1.0
    assert left[1] < (1e-4 if integrator == "RK4" else 0.02) * start
    assert left[0] / left[1] > 1.7


@pytest.mark.long
@pytest.mark.parametrize("name", ["inertance", "stiffness"])
def test_energy_over_a_hundred_seconds(name: str) -> None:
    # a command every half second; nothing is lost but what the integrator of fourth order loses
    p = {"inertance": 5.0, "stiffness": 400.0, "control": name, "control_lag": 0.05}
    p |= {"control_lower": 0.5 * p[name], "control_upper": 3.0 * p[name]}
    _, model, data, added = built("RK4", p)
    device, reader, rng = Device(**p), added.of(model), np.random.default_rng(2)
    started(data)
    mujoco.mj_forward(model, data)
    start = 5.0 * data.qvel[0] ** 2 + reader.read(data.sensordata)["stored_energy"]
    given = largest = 0.0
    for _ in range(200):
        command = rng.uniform(device.control_lower, device.control_upper)
        data.ctrl[0], rows = command, []
        for _ in range(500):
            rows.append([data.qpos[0], data.qvel[0], data.act[0]])
            mujoco.mj_step(model, data)
        rows.append([data.qpos[0], data.qvel[0], data.act[0]])
        x, v, z = np.array(rows).T
        flow = device.evaluate(x, v, 0.0, z[:, np.newaxis], command=command)["control_power"]
        # Simpson's rule
        given += 1e-3 / 3.0 * (flow[0] + 4 * flow[1::2].sum() + 2 * flow[2:-1:2].sum() + flow[-1])
        mujoco.mj_forward(model, data)
        now = 5.0 * data.qvel[0] ** 2 + reader.read(data.sensordata)["stored_energy"]
        largest = max(largest, abs(now - start - given) / now)
    assert largest < 1e-5
    assert abs(given) > 0.1 * start


def test_every_control_in_the_engine_is_the_reference() -> None:
    cases: dict[str, dict[str, Any]] = {
        "viscous": {}, "quadratic_damping": {"quadratic_damping": 40.0}, "stiffness": {},
        "flywheel_viscous": {"flywheel_viscous": 30.0}, "inertance": {},
        "coulomb_force": {"friction": "coulomb", "coulomb_force": 5.0, "transition_velocity": 0.1},
        "static_force": {"friction": "stribeck", "coulomb_force": 3.0, "static_force": 5.0,
                         "transition_velocity": 0.1, "stribeck_velocity": 0.3},
        "bw_stiffness": {"friction": "bouc_wen", "bw_stiffness": 900.0, "bw_beta": 40.0,
                         "bw_gamma": 20.0, "bw_ratio": 0.2},
        "minor_loss": {"piston_area": 1e-2, "channel_area": 2e-3, "channel_length": 0.1,
                       "minor_loss": 20.0},
    }  # fmt: skip
    for name, special in cases.items():
        for series in ({}, {"series_stiffness": 3e3, "series_damping": 40.0}):
            p: dict[str, Any] = {"inertance": 5.0, "viscous": 15.0, "stiffness": 900.0} | special
            if name == "minor_loss":
                del p["inertance"]
            least = 3.0 if name == "static_force" else p[name] / 2
            p |= series | {"control": name, "control_lower": least, "control_upper": 3 * p[name],
                           "control_lag": 0.08}  # fmt: skip
            command = 2.2 * p[name]
            _, model, data, _ = built("RK4", p)
            started(data)
            if series:
                data.act[Device(**p).state_names.index("flywheel_velocity")] = 1.0
            data.ctrl[0] = command
            run(model, data, 0.3)
            told = ReferenceDevice(**p, command=command)
            z0 = np.zeros(told.nstate)
            if series:
                z0[told.state_names.index("flywheel_velocity")] = 1.0

            def rates(t: float, y: np.ndarray, told: Any = told) -> np.ndarray:
                x, v, z = y[0], y[1], told.state_argument(y[2:])
                mass, rest = told.branch(x, v, z)
                a = -(rest + told.rest_force(x, v, z)) / (10.0 + mass)
                return np.concatenate([[v, a], np.atleast_1d(told.state_rate(x, v, z))])

            end = solve_ivp(rates, (0, 0.3), [0.0, 1.0, *z0], rtol=1e-10, atol=1e-12).y[:, -1]
            found = [data.qpos[0], data.qvel[0], *data.act]
            np.testing.assert_allclose(found, end, rtol=3e-5, atol=3e-6, err_msg=f"{name} {series}")


# --- the control ----------------------------------------------------------------------------------


def test_nu_and_ctrlrange_follow() -> None:
    _, model, _, _ = built("EULER", DAMPER)
    assert model.nu == 1
    np.testing.assert_array_equal(model.actuator_ctrlrange, [[10.0, 500.0]])
    assert model.actuator_ctrllimited[0]
    plain = {key: value for key, value in DAMPER.items() if not key.startswith("control")}
    assert built("EULER", plain)[1].nu == 0
    _, model, _, _ = built("EULER", plain, control=True)
    assert model.nu == 1
    assert not model.actuator_ctrllimited[0]


def test_a_name_as_the_control_of_add_device() -> None:
    plain = {key: value for key, value in DAMPER.items() if key in ("inertance", "viscous")}
    _, model, data, _ = built("EULER", plain, control="viscous", control_lower=5, control_upper=90)
    assert model.nu == 1
    started(data)
    data.ctrl[0] = 1e4
    mujoco.mj_forward(model, data)
    assert data.qacc[0] == pytest.approx(-90.0 / 15.0, rel=1e-2)
    with pytest.raises(ValueError, match="control is False"):
        built("EULER", DAMPER, control=False)


def test_without_controls_leaves_it() -> None:
    spec, model, _, _ = built("EULER", DAMPER)
    assert inerter.without_controls(spec) == []
    assert spec.compile().nu == 1
    assert device_controls(model) == []


@pytest.mark.parametrize(("stated", "says"), [((0, 400), "ctrlrange"), ((20, 600), "ctrlrange")])
def test_a_ctrlrange_beyond_the_bounds_is_refused(stated: tuple[float, float], says: str) -> None:
    spec, _, _, _ = built("EULER", DAMPER)
    spec.actuator("d").ctrlrange, spec.actuator("d").ctrllimited = stated, True
    with pytest.raises(ValueError, match=says):
        spec.compile()


def test_all_states_that_there_can_be_are_named() -> None:
    device: dict[str, Any] = {"friction": "maxwell_slip", "backlash": 1e-4, **DAMPER}
    device |= {"series_stiffness": 1e4, "series_damping": 10.0}
    device |= {f"slip_stiffness_{i}": 1e4 for i in range(1, 9)}
    device |= {f"slip_force_{i}": 2.0 for i in range(1, 9)}
    device |= {f"branch_stiffness_{i}": 1e3 for i in range(1, 4)}
    device |= {f"branch_damping_{i}": 10.0 for i in range(1, 4)}
    spec, model, data, _ = built("IMPLICITFAST", device)
    assert model.na == len(Device(**device).state_names) == 15
    started(data)
    run(model, data, 0.05)
    assert np.isfinite(data.act).all()
    spec.actuator("d").actdim = 0
    with pytest.raises(ValueError, match=r'friction_state_1, .*control_change; write actdim="15"'):
        spec.compile()


def test_a_narrower_ctrlrange_counts() -> None:
    spec, _, _, _ = built("EULER", {**DAMPER, "control_lag": 0.0})
    spec.actuator("d").ctrlrange, spec.actuator("d").ctrllimited = (20, 60), True
    model = spec.compile()
    data = mujoco.MjData(model)
    started(data)
    data.ctrl[0] = 300.0
    mujoco.mj_forward(model, data)
    assert data.sensordata[0] + 10 * data.qacc[0] == pytest.approx(0.0, abs=1e-9)
    damping = -(15.0 * data.qacc[0]) / (data.qvel[0] + model.opt.timestep * data.qacc[0])
    assert damping == pytest.approx(60.0, rel=1e-9)


def test_the_state_of_a_reset_is_the_stated_value_and_files_keep_it(tmp_path: Path) -> None:
    spec, model, data, _ = built("IMPLICITFAST", {**DAMPER, "viscous": 100.0})
    started(data)
    data.ctrl[0] = 400.0
    run(model, data, 0.1)
    ends = [data.qvel[0]]
    text, binary = tmp_path / "model.xml", tmp_path / "model.mjb"
    text.write_text(spec.to_xml())
    mujoco.mj_saveModel(model, str(binary), None)
    for again in (
        mujoco.MjModel.from_xml_path(str(text)),
        mujoco.MjModel.from_binary_path(str(binary)),
        model,
    ):
        other = mujoco.MjData(again)
        started(other)
        other.ctrl[0] = 400.0
        run(again, other, 0.1)
        ends.append(other.qvel[0])
        mujoco.mj_resetData(again, other)
        started(other)
        mujoco.mj_forward(again, other)
        assert other.sensordata[0] == pytest.approx(-10 * other.qacc[0])
        first = -15.0 * other.qacc[0] / (1.0 + again.opt.timestep * other.qacc[0])
        assert first == pytest.approx(100.0, rel=1e-9)
    assert len(set(ends)) == 1


def test_a_disabled_actuator_keeps_the_value_that_it_had() -> None:
    _, model, data, _ = built("EULER", FLYWHEEL)
    started(data)
    data.ctrl[0] = 45.0
    run(model, data, 0.1)
    change = data.act[0]
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    data.qfrc_applied[0] = 7.0
    run(model, data, 0.01)
    assert data.act[0] == change
    mujoco.mj_forward(model, data)
    assert data.qacc[0] == pytest.approx(7.0 / (10.0 + 5.0 + change), rel=1e-9)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("device", [DAMPER, FLYWHEEL])
def test_inverse_dynamics_hold_the_commanded_device(integrator: str, device: dict) -> None:
    _, model, data, added = built(integrator, device)
    started(data)
    data.ctrl[0] = 44.0
    run(model, data, 0.05)
    data.qfrc_applied[0] = 12.0
    mujoco.mj_forward(model, data)
    found = inerter.device_force(model, data, data.qacc).force["d"]
    said = added.of(model).read(data.sensordata)["total"]
    assert found == pytest.approx(float(said), rel=1e-9)


def test_bad_controls_and_states_stay_within_the_bounds() -> None:
    for lag in (0.0, 0.02):
        _, model, data, _ = built("IMPLICITFAST", {**FLYWHEEL, "control_lag": lag})
        model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_CLAMPCTRL)
        for ctrl in (np.nan, np.inf, -1e300, 1e300, -5.0):
            data.ctrl[0] = ctrl
            if lag:
                data.act[0] = -1e6
            data.qfrc_applied[0] = 1.0
            mujoco.mj_forward(model, data)
            assert 1.0 / 60.0 <= data.qacc[0] <= 1.0 / 12.0 + 1e-9
        mujoco.mj_resetData(model, data)


def test_bounds_can_be_live() -> None:
    _, model, data, added = built(
        "EULER", {**DAMPER, "control_lag": 0.0}, live=("control_upper", "viscous")
    )
    started(data)
    data.ctrl[0] = 400.0
    where = added.of(model).live
    for upper in (300.0, 120.0):
        model.numeric_data[where["control_upper"]] = upper
        mujoco.mj_forward(model, data)
        damping = -(15.0 * data.qacc[0]) / (1.0 + model.opt.timestep * data.qacc[0])
        assert damping == pytest.approx(upper, rel=1e-9)


def test_threads_and_copies_are_bit_identical() -> None:
    rollout = pytest.importorskip("mujoco.rollout")
    _, model, data, _ = built("IMPLICITFAST", DAMPER, between=True)
    started(data)
    size = mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    start = np.zeros(size)
    mujoco.mj_getState(model, data, start, mujoco.mjtState.mjSTATE_FULLPHYSICS)
    rng = np.random.default_rng(1)
    control = rng.uniform(0, 600, (8, 100, 1))
    states, _ = rollout.rollout([model] * 8, [mujoco.MjData(model) for _ in range(3)],
                                np.tile(start, (8, 1)), control)  # fmt: skip
    for k in range(8):
        alone = mujoco.MjData(model)
        started(alone)
        for i in range(100):
            alone.ctrl[0] = control[k, i, 0]
            mujoco.mj_step(model, alone)
        end = np.zeros(size)
        mujoco.mj_getState(model, alone, end, mujoco.mjtState.mjSTATE_FULLPHYSICS)
        np.testing.assert_array_equal(states[k, -1], end)
