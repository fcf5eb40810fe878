"""Each part of a device alone in the engine: order of convergence, and energy over a long run.

Wheel and car side by side, a spring and a device between them, nothing outside: slow (below
12 rad/s), so that what RK4 itself loses does not hide what a part does. Truth: the reference's
equations. `python tests/plugin/test_parts_in_engine.py` prints the table of docs/accuracy.md.
"""

from __future__ import annotations

import functools
import math
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter import add_device
from inerter.core import Device
from inerter.reference import ReferenceDevice
from inerter.reference.structure import Structure
from inerter.reference.strut import Strut
from plugin_models import INTEGRATORS

MASSES, TYRE, SPRING, B, SPEED = (25.0, 180.0), 2500.0, 800.0, 113.0, 0.3
END = 1.0
SHAFT = {"series_stiffness": 1200.0, "series_damping": 30.0}
SLIP = {
    "friction": "maxwell_slip", "slip_stiffness_1": 600.0, "slip_force_1": 1.0,
    "slip_stiffness_2": 400.0, "slip_force_2": 2.0,
}  # fmt: skip
RISE = (0.1, -0.1, 0.2, 0.0, 0.15, -0.05)
RANGE = {"curve_lower": -0.06, "curve_upper": 0.06}
SMOOTH = {
    "friction": "brown_mcphee", "coulomb_force": 2.0, "static_force": 3.0, "stribeck_velocity": 0.2,
}  # fmt: skip
COIL = {
    "piston_area": 1.649e-3, "channel_area": 2.827e-5, "channel_length": 1.18,
    "fluid_density": 998.0, "fluid_viscosity": 1e-3, "coil_diameter": 0.2,
}  # fmt: skip
DAHL = {"friction": "dahl", "coulomb_force": 3.0, "bristle_stiffness": 1000.0}

# a part, whether its force is smooth along a motion, and how well RK4 at 1 ms keeps its energy
PARTS: dict[str, tuple[dict[str, Any], bool, float]] = {
    "friction at the flywheel": ({**SMOOTH, **SHAFT, "friction_side": "flywheel"}, True, 1e-8),
    "Dahl at the flywheel": ({**DAHL, **SHAFT, "friction_side": "flywheel"}, False, 1e-5),
    "inertance, period": ({"inertance_periods": (0.08, 0.05, 1.0)}, True, 1e-8),
    # its third derivative jumps at every value
    "inertance, curve": ({"inertance_curve": RISE, **RANGE}, False, 1e-4),
    "inertance of two flanks": ({"inertance_back_periods": (0.08, 0.05, 0.0)}, False, 1e-4),
    "friction level, period": ({**SMOOTH, "friction_periods": (0.08, 0.4, 0.0)}, True, 1e-8),
    "spring force, period": ({"force_periods": (0.08, 8.0, 0.5)}, True, 1e-8),
    "viscous damping, period": (
        {"viscous": 15.0, "viscous_periods": (0.08, 10.0, 0.0)}, True, 1e-8,
    ),
    "load friction by direction": (
        {"mu_forward": 0.2, "mu_backward": 0.1, "transition_velocity": 0.1}, False, 1e-5,
    ),
    "load on Dahl": ({**DAHL, "mu_forward": 0.2, "mu_backward": 0.1}, False, 1e-5),
    "maxwell_slip": (SLIP, False, 1e-4),
    "rate_state": (
        {"friction": "rate_state", "coulomb_force": 2.0, "rate_effect": 0.03, "age_effect": 0.05,
         "rate_velocity": 0.05, "age_distance": 2e-2, "transition_velocity": 0.1}, False, 1e-6,
    ),
    "viscoelastic branches": (
        {"branch_stiffness_1": 300.0, "branch_damping_1": 60.0, "branch_stiffness_2": 200.0,
         "branch_damping_2": 300.0}, True, 1e-8,
    ),
    "dampers behind a spring": (
        {"viscous": 60.0, "damping_knee": 0.5, "damping_beyond": 0.4, "damper_stiffness": 900.0},
        True, 1e-8,
    ),
    # slips all the time, or now and then
    "leak": ({"leak_damping": 20.0, "leak_quadratic_damping": 40.0}, True, 1e-7),
    "leak behind a spring": ({**SHAFT, "leak_damping": 20.0}, True, 1e-7),
    "clutch": ({**SHAFT, "clutch_force": 4.0, "clutch_asymmetry": 0.3}, False, 1e-4),
    "control of the damping, lag": (
        {"viscous": 10.0, "control": "viscous", "control_lower": 5.0, "control_upper": 60.0,
         "control_lag": 0.2}, True, 1e-8,
    ),
    "coiled channel": (COIL, False, 1e-6),
    "coiled channel behind a spring": ({**COIL, **SHAFT}, False, 1e-6),
}  # fmt: skip
COMMAND = 40.0


def keys(name: str) -> dict[str, Any]:
    given = PARTS[name][0]
    return given if "channel_area" in given else {"inertance": B, **given}


def build(
    name: str, integrator: str, step: float, given: dict[str, Any] | None = None
) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """The model with a part, or with another device."""
    spec = mujoco.MjSpec()
    spec.option.timestep, spec.option.gravity = step, [0, 0, 0]
    spec.option.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{integrator.upper()}")
    for place, (body, mass) in enumerate(zip(("wheel", "car"), MASSES, strict=True)):
        made = spec.worldbody.add_body(name=body, pos=[0, 0, place])
        made.add_joint(
            name=body, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, 1],
            stiffness=0 if place else TYRE,
        )  # fmt: skip
        made.add_geom(size=[0.05, 0, 0], mass=mass, contype=0, conaffinity=0)
    tendon = spec.add_tendon(name="strut", stiffness=SPRING)
    tendon.wrap_joint("wheel", -1)
    tendon.wrap_joint("car", 1)
    add_device(spec, "d", tendon="strut", **(given or keys(name)))
    model = spec.compile()
    data = mujoco.MjData(model)
    data.qvel[0] = SPEED
    if model.nu:
        data.ctrl[0] = COMMAND
    return model, data


@functools.cache
def truth(name: str) -> np.ndarray:
    """Displacements and velocities at the end."""
    given = keys(name)
    told: dict[str, Any] = {"command": COMMAND} if "control" in given else {}
    made = Structure(
        mass=np.diag(MASSES),
        damping=np.zeros((2, 2)),
        stiffness=np.diag([TYRE, 0.0]),
        directions=np.array([[-1.0], [1.0]]),
        struts=(Strut(layout="S2", device=ReferenceDevice(**given, **told), stiffness=SPRING),),
    )
    state = np.zeros(made.nstate)
    state[2] = SPEED
    run = made.simulate(
        lambda t: np.zeros(2), [0.0, END], initial=state, method="DOP853", rtol=1e-11, atol=1e-14,
        max_step=5e-3,
    )  # fmt: skip
    return np.concatenate([run.position[-1], run.velocity[-1]])


def error(name: str, integrator: str, step: float) -> float:
    """Largest error of displacements and velocities at the end, relative to the largest."""
    model, data = build(name, integrator, step)
    mujoco.mj_step(model, data, round(END / step))
    true = truth(name)
    return max(
        np.abs(found - true[part]).max() / np.abs(true[part]).max()
        for found, part in ((data.qpos, slice(2)), (data.qvel, slice(2, 4)))
    )


def errors_and_order(name: str, integrator: str) -> tuple[float, float]:
    """The error at 1 ms; the order from there on, of RK4 between steps that it shows in."""
    coarse, fine = (8e-3, 2e-3) if integrator == "RK4" else (2e-3, 5e-4)
    order = math.log(error(name, integrator, coarse) / error(name, integrator, fine), 4.0)
    return error(name, integrator, 1e-3), order


def energy_defect(name: str, seconds: float) -> float:
    """Largest change of all energy, heat and stored energy included, relative to that given."""
    model, data = build(name, "RK4", 1e-3)
    values = []
    for _ in range(20):
        mujoco.mj_forward(model, data)
        bodies = 0.5 * (np.array(MASSES) @ data.qvel**2)
        springs = 0.5 * (TYRE * data.qpos[0] ** 2 + SPRING * (data.qpos[1] - data.qpos[0]) ** 2)
        values.append(bodies + springs + data.sensordata[-2:].sum())
        mujoco.mj_step(model, data, round(seconds / 20 / 1e-3))
    return float(np.ptp(values) / values[0])


@pytest.mark.parametrize(
    "integrator",
    [
        each if each in ("Euler", "RK4") else pytest.param(each, marks=pytest.mark.long)
        for each in INTEGRATORS
    ],
)
@pytest.mark.parametrize("name", PARTS)
def test_the_motion_converges_to_the_equations(name: str, integrator: str) -> None:
    at_1_ms, order = errors_and_order(name, integrator)
    if integrator != "RK4":
        assert order > 0.85
        assert at_1_ms < (0.1 if integrator == "discrete" else 0.05)
        return
    smooth = PARTS[name][1]
    assert order > (3.7 if smooth else 0.9)
    assert at_1_ms < (2e-8 if smooth else 2e-4)


@pytest.mark.parametrize("name", PARTS)
def test_energy_over_ten_seconds(name: str) -> None:
    assert energy_defect(name, 10.0) < PARTS[name][2]


@pytest.mark.long
@pytest.mark.parametrize("name", PARTS)
def test_energy_over_a_hundred_seconds(name: str) -> None:
    assert energy_defect(name, 100.0) < PARTS[name][2]


def table() -> str:
    """As in docs/accuracy.md."""
    lines = [f"| part | {' | '.join(INTEGRATORS)} | energy, 100 s |"]
    lines.append("| --- " * (len(INTEGRATORS) + 2) + "|")
    for name in PARTS:
        cells = [f"{e:.0e}, {order:.1f}" for e, order in (
            errors_and_order(name, integrator) for integrator in INTEGRATORS)]  # fmt: skip
        lines.append(f"| {name} | {' | '.join(cells)} | {energy_defect(name, 100.0):.0e} |")
    return "\n".join(lines)


@pytest.mark.parametrize("name", PARTS)
def test_each_part_acts(name: str) -> None:
    """A part that did nothing would pass all above."""
    bare = Device(inertance=Device(**keys(name)).inertance).given
    model, data = build(name, "RK4", 1e-3, bare)
    mujoco.mj_step(model, data, round(END / 1e-3))
    true = truth(name)[:2]
    assert np.abs(data.qpos - true).max() > 2e-3 * np.abs(true).max()


if __name__ == "__main__":
    print(table())
