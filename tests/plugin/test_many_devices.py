"""Many devices in one model: each moves as it does alone, and what is tied is solved together."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS
from topology_mechanisms import Array

CARS = 9
STEPS = 60
TIGHT = 'tolerance="1e-15" ls_tolerance="1e-10" iterations="300" ls_iterations="100"'
# pairs of cars held together: by a device, by a damped spring, by an equality
TIES = {"device": (7, 2), "spring": (1, 6), "equality": (0, 8)}
CONSTRAINED = ("discrete", "implicitfast", "RK4")


def model_of(
    cars: Sequence[int], option: str, ties: Sequence[str] = (), constrained: bool = False
) -> mujoco.MjModel:
    """Cars whose wheel and body are siblings, with a strut each; on a road with stops if asked."""
    world, tendons, devices, equalities = "", "", "", ""
    road = '<geom type="plane" size="9 9 0.1"/>' if constrained else ""
    stop = 'limited="true" range="-0.004 0.004"' if constrained else ""
    for i in cars:
        contact = 'contype="2" conaffinity="1"' if constrained else 'contype="0" conaffinity="0"'
        world += f"""
          <body name="wheel{i}" pos="{i} 0 0.099">
            <joint name="wheel{i}" type="slide" axis="0 0 1" stiffness="{9e3 + 500 * i}"
              damping="20"/>
            <geom size="0.1" mass="{25 + i}" {contact}/>
          </body>
          <body name="car{i}" pos="{i} 0 0.8">
            <joint name="car{i}" type="slide" axis="0 0 1" {stop}/>
            <geom size="0.1" mass="{150 + 7 * i}" contype="0" conaffinity="0"/>
          </body>"""
        tendons += fixed(f"strut{i}", f"wheel{i}", f"car{i}", 'stiffness="6e3" damping="300"')
        devices += device(f"strut{i}", 30.0 + 11 * i, "lugre" if i % 3 == 0 else "none")
    if "device" in ties:
        a, b = TIES["device"]
        tendons += fixed("link", f"car{a}", f"car{b}", "")
        devices = device("link", 55.0, "coulomb") + devices
    if "spring" in ties:
        a, b = TIES["spring"]
        spring = 'stiffness="4e4" damping="2e3"'
        tendons += fixed("rod", f"car{a}", f"car{b}", spring)
    if "equality" in ties:
        a, b = TIES["equality"]
        equalities = f'<equality><joint joint1="car{a}" joint2="car{b}"/></equality>'
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>
        <option timestep="1e-3" {option} {TIGHT}/><worldbody>{road}{world}</worldbody>
        <tendon>{tendons}</tendon><actuator>{devices}</actuator>{equalities}</mujoco>"""
    )


def fixed(name: str, a: str, b: str, attributes: str) -> str:
    """A tendon from one joint to another."""
    ends = f'<joint joint="{a}" coef="-1"/><joint joint="{b}" coef="1"/>'
    return f'<fixed name="{name}" {attributes}>{ends}</fixed>'


def device(tendon: str, inertance: float, friction: str) -> str:
    """A device along a tendon."""
    keys = {"inertance": inertance, "viscous": 40.0, "friction": friction}
    if friction != "none":
        keys["coulomb_force"] = 30.0
    if friction == "lugre":
        keys |= {"static_force": 40.0, "bristle_stiffness": 2e4, "bristle_damping": 100.0}
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in keys.items())
    states = int(friction == "lugre")
    return (
        f'<plugin plugin="inerter.device" name="{tendon}" tendon="{tendon}" actdim="{states}">'
        f"{config}</plugin>"
    )


def paths(model: mujoco.MjModel, cars: Sequence[int]) -> dict[int, Array]:
    """Wheel and body of every car over time, each car started in its own way."""
    data = mujoco.MjData(model)
    joints = {i: (model.joint(f"wheel{i}").dofadr[0], model.joint(f"car{i}").dofadr[0])
              for i in cars}  # fmt: skip
    for i, (wheel, car) in joints.items():
        data.qvel[wheel], data.qvel[car] = 0.3 - 0.05 * i, 0.02 * i - 0.1
    rows = []
    for _ in range(STEPS):
        mujoco.mj_step(model, data)
        rows.append(data.qpos.copy())
    path = np.array(rows)
    return {i: path[:, list(pair)] for i, pair in joints.items()}


def agree(found: dict[int, Array], alone: dict[int, Array], tolerance: float) -> None:
    for i, path in alone.items():
        size = np.max(np.abs(path))
        assert np.max(np.abs(found[i] - path)) < tolerance * size, i


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_every_car_moves_as_it_does_alone(integrator: str) -> None:
    option = f'integrator="{integrator}"'
    found = paths(model_of(range(CARS), option), range(CARS))
    for i in range(CARS):
        agree(found, paths(model_of([i], option), [i]), 1e-11)


@pytest.mark.parametrize("jacobian", ["sparse", "dense"])
@pytest.mark.parametrize("integrator", CONSTRAINED)
def test_constrained_cars_move_as_alone(integrator: str, jacobian: str) -> None:
    option = f'integrator="{integrator}" jacobian="{jacobian}"'
    found = paths(model_of(range(CARS), option, constrained=True), range(CARS))
    for i in range(CARS):
        agree(found, paths(model_of([i], option, constrained=True), [i]), 1e-7)


@pytest.mark.parametrize("constrained", [False, True])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_tied_cars_move_as_the_pair_alone(integrator: str, constrained: bool) -> None:
    option = f'integrator="{integrator}" jacobian="sparse"'
    model = model_of(range(CARS), option, list(TIES), constrained)
    found = paths(model, range(CARS))
    for tie, pair in TIES.items():
        agree(found, paths(model_of(sorted(pair), option, [tie], constrained), pair), 1e-7)
        # the tie is felt
        untied = paths(model_of(sorted(pair), option, [], constrained), pair)
        assert max(np.max(np.abs(found[i] - untied[i])) for i in pair) > 1e-5


def test_inverse_weights_are_those_of_native_inertances() -> None:
    """Derived once, when every device of the model is placed."""
    bodies = "".join(
        f"""<body pos="{i} 0 1"><joint type="slide" axis="0 0 1"/><geom size="0.1" mass="{5 + i}"/>
        <body pos="0 0 1"><joint name="j{i}" type="slide" axis="0 0 1" damping="{1 + i}"/>
        <geom size="0.1" mass="9"/></body></body>"""
        for i in range(5)
    )
    tendons = "".join(
        f'<fixed name="t{i}"><joint joint="j{i}" coef="1"/></fixed>' for i in range(5)
    )
    head = '<mujoco><extension><plugin plugin="inerter.device"/></extension><worldbody>'
    models = [
        mujoco.MjModel.from_xml_string(
            f"{head}{bodies}</worldbody><tendon>{tendons}</tendon>"
            f"<actuator>{''.join(one(i) for i in range(5))}</actuator></mujoco>"
        )
        for one in (
            lambda i: device(f"t{i}", 20.0 + i, "none"),
            lambda i: f'<general tendon="t{i}" armature="{20 + i}" damping="40" gainprm="0"/>',
        )
    ]
    for name in ("dof_invweight0", "body_invweight0", "tendon_invweight0", "dof_M0"):
        ours, native = (getattr(model, name) for model in models)
        assert np.array_equal(ours, native), name
