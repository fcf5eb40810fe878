"""A load on a bristle in the engine: converges to the reference under every integrator."""

import functools
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.reference import ReferenceDevice
from inerter.reference.structure import Structure
from inerter.reference.strut import Strut

END, MASSES, GROUND, SPRING, SPEED = 0.1, (25.0, 180.0), (1.2e5, 6e3), 6e4, 0.3
LAWS: dict[str, dict[str, Any]] = {
    "dahl": {"coulomb_force": 100.0, "bristle_stiffness": 1e5, "mu_forward": 0.3,
             "mu_backward": 0.2},
    "lugre": {"coulomb_force": 100.0, "bristle_stiffness": 1e5, "bristle_damping": 300.0,
              "load_friction": 0.1},
}  # fmt: skip
INTEGRATORS = ("Euler", "implicit", "implicitfast", "discrete", "RK4")


@functools.cache
def truth(law: str) -> tuple[float, float]:
    device = ReferenceDevice(inertance=113.0, friction=law, **LAWS[law])
    made = Structure(
        mass=np.diag(MASSES),
        damping=np.zeros((2, 2)),
        stiffness=np.diag(GROUND),
        directions=np.array([[-1.0], [1.0]]),
        struts=(Strut(layout="S2", device=device, stiffness=SPRING),),
    )
    state = np.zeros(made.nstate)
    state[2] = SPEED
    run = made.simulate(
        lambda t: np.zeros(2), [0.0, END], initial=state, rtol=1e-7, atol=1e-11, max_step=2e-3
    )
    return tuple(run.position[-1])


def model(law: str, integrator: str, step: float, nested: bool) -> mujoco.MjModel:
    """Between two bodies of the world, or of one branch, whose matrix holds the inertance."""
    keys = {"inertance": 113.0, "friction": law, "stiffness": SPRING, "rest_length": 1.0}
    config = "".join(f'<config key="{k}" value="{v}"/>' for k, v in {**keys, **LAWS[law]}.items())

    def body(i: int, place: float, inner: str = "") -> str:
        joint = "" if nested and i else f'stiffness="{GROUND[i]}"'
        return (
            f'<body pos="0 0 {place}"><joint type="slide" axis="0 0 1" {joint}/>'
            f'<inertial pos="0 0 0" mass="{MASSES[i]}" diaginertia="1 1 1"/>'
            f'<site name="s{i}"/>{inner}</body>'
        )

    tree = body(0, 0.0, body(1, 1.0)) if nested else body(0, 0.0) + body(1, 1.0)
    # nested, the sprung mass hangs on a spring to the ground of its own
    ground = '<site name="g" pos="0 0 2"/>' if nested else ""
    spring = (
        f'<spatial stiffness="{GROUND[1]}" springlength="1"><site site="g"/><site site="s1"/>'
        "</spatial>"
        if nested
        else ""
    )
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>
        <option gravity="0 0 0" integrator="{integrator}" timestep="{step}"/>
        <worldbody>{ground}{tree}</worldbody>
        <tendon><spatial name="t"><site site="s0"/><site site="s1"/></spatial>{spring}</tendon>
        <actuator><plugin plugin="inerter.device" tendon="t" actdim="1">{config}</plugin></actuator>
        </mujoco>"""
    )


def run(law: str, integrator: str, step: float, nested: bool) -> tuple[float, float]:
    made = model(law, integrator, step, nested)
    data = mujoco.MjData(made)
    data.qvel[:] = [SPEED, -SPEED] if nested else [SPEED, 0.0]
    for _ in range(round(END / step)):
        mujoco.mj_step(made, data)
    first = float(data.qpos[0])
    return first, float(data.qpos[1]) + (first if nested else 0.0)


@pytest.mark.parametrize("nested", [False, True], ids=["siblings", "nested"])
@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("law", LAWS)
def test_it_converges_to_the_reference(law: str, integrator: str, nested: bool) -> None:
    true = np.array(truth(law))
    errors = [
        np.abs(np.array(run(law, integrator, step, nested)) - true).max() / np.abs(true).max()
        for step in (1e-3, 2.5e-4)
    ]
    most = {"discrete": 0.1, "RK4": 2e-5}.get(integrator, 0.006)
    assert errors[0] < most
    assert errors[1] < errors[0] / 2.5 or errors[1] < 2e-6


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("shaft", [False, True])
def test_energy_balance_under_rk4(law: str, shaft: bool) -> None:
    """What the masses lose is stored or heat, behind a shaft too, and nothing is slowed."""
    keys = {"inertance": 113.0, "friction": law, "rest_length": 1.0, **LAWS[law]}
    if shaft:
        keys |= {"series_stiffness": 1e6, "series_damping": 3200.0, "friction_side": "flywheel"}
    config = "".join(f'<config key="{k}" value="{v}"/>' for k, v in keys.items())
    bodies = "".join(
        f'<body pos="0 0 {i}"><joint type="slide" axis="0 0 1" stiffness="{GROUND[i]}"/>'
        f'<inertial pos="0 0 0" mass="{MASSES[i]}" diaginertia="1 1 1"/><site name="s{i}"/></body>'
        for i in (0, 1)
    )
    made = mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device"><instance name="d">{config}
        </instance></plugin></extension>
        <option gravity="0 0 0" integrator="RK4" timestep="2e-4"/><worldbody>{bodies}</worldbody>
        <tendon><spatial name="t"><site site="s0"/><site site="s1"/></spatial></tendon>
        <actuator><plugin instance="d" plugin="inerter.device" tendon="t"
        actdim="{3 if shaft else 1}"/></actuator>
        <sensor><plugin plugin="inerter.device" instance="d"/></sensor></mujoco>"""
    )
    data = mujoco.MjData(made)
    data.qvel[0] = SPEED

    def energy() -> float:
        mujoco.mj_forward(made, data)
        own = np.array(MASSES) @ data.qvel**2 + np.array(GROUND) @ data.qpos**2
        # stored energy and heat are the last of the sensor
        return 0.5 * own + data.sensordata[-2] + data.sensordata[-1]

    before = energy()
    for _ in range(500):
        mujoco.mj_step(made, data)
    assert energy() == pytest.approx(before, rel=1e-6)
