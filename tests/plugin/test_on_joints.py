"""Devices on the joints of an arm: solved for in its dofs, and in another way where they must be.

A second body in the model, a device on it and a limit that it presses on, makes the plugin solve
for every device by the matrix of their mobilities. The arm, which does not feel that body, has to
move the same.
"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from inerter import solve_counts

PRESSED = """<body pos="0 50 0"><joint name="pressed" type="slide" axis="0 0 1" limited="true"
range="0 1"/><geom size="0.1" contype="0" conaffinity="0"/></body>"""
INTEGRATORS = ["Euler", "implicit", "implicitfast", "RK4"]


def _law(rng: np.random.Generator) -> dict[str, float | str]:
    level = float(rng.choice([1e-3, 0.1, 1.0, 20.0]) * rng.uniform(0.5, 1.5))
    inertance = rng.choice([0.0, 0.01, 1.0])
    keys: dict[str, float | str] = {"inertance": inertance}
    if rng.random() < 0.4:
        keys |= {"viscous": rng.uniform(0, 2)}
    if inertance and rng.random() < 0.3:
        keys |= {"load_friction": rng.uniform(0, 0.3)}
    kind = rng.choice(["coulomb", "stribeck", "brown_mcphee", "none"])
    if kind != "none":
        keys |= {"friction": kind, "coulomb_force": level}
    if kind in ("stribeck", "brown_mcphee"):
        keys |= {"static_force": level * rng.uniform(1, 2), "stribeck_velocity": 0.05}
    if rng.random() < 0.3:
        keys |= {"transition_velocity": 10 ** rng.uniform(-5, -1)}
    return keys


def _arm(seed: int, integrator: str, more: bool) -> mujoco.MjModel:
    """A chain of hinges and slides, a device on most of them, two on one; in two trees."""
    rng = np.random.default_rng(seed)
    bodies = devices = ""
    number = 0
    for tree in range(int(rng.integers(1, 3))):
        links = int(rng.integers(1, 6))
        for link in range(links):
            axis = " ".join(f"{value:.3f}" for value in rng.normal(size=3))
            kind = "slide" if rng.random() < 0.2 else "hinge"
            place = f'pos="{10 * tree if not link else 0.3} 0 {0.1 * link}"'
            damping = rng.choice([0.0, 0.0, 3.0])
            bodies += (
                f'<body {place}><joint name="j{number}" type="{kind}" axis="{axis}" '
                f'damping="{damping}" armature="{rng.choice([0, 0.05])}"/>'
                f'<geom size="0.05" mass="{10 ** rng.uniform(-1, 1)}" pos="0.1 0 0" '
                f'contype="0" conaffinity="0"/>'
            )
            for _ in range(int(rng.integers(0, 3)) if link else 1):
                keys = "".join(f'<config key="{k}" value="{v}"/>' for k, v in _law(rng).items())
                devices += (
                    f'<plugin plugin="inerter.device" joint="j{number}" '
                    f'gear="{rng.choice([1, 1, -2, 0.3])}">{keys}</plugin>'
                )
            number += 1
        bodies += "</body>" * links
    if more:
        bodies += PRESSED
        devices += (
            '<plugin plugin="inerter.device" joint="pressed"><config key="inertance" value="1"/>'
            '<config key="friction" value="coulomb"/><config key="coulomb_force" value="2"/>'
            "</plugin>"
        )
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><option integrator="{integrator}" timestep="{rng.choice([0.001, 0.004])}"/>'
        '<extension><plugin plugin="inerter.device"/></extension>'
        f"<worldbody>{bodies}</worldbody><actuator>{devices}</actuator></mujoco>"
    )


def _difference(seed: int, integrator: str) -> float:
    """Largest difference of acceleration over 40 steps, each from the same state, over the largest
    acceleration.
    """
    model, other = (_arm(seed, integrator, more) for more in (False, True))
    data, beside = mujoco.MjData(model), mujoco.MjData(other)
    rng = np.random.default_rng(seed + 1)
    nv = model.nv
    data.qvel[:] = rng.normal(size=nv) * rng.choice([0, 1e-4, 1.0], size=nv)
    worst = 0.0
    for _ in range(40):
        beside.qpos[:nv], beside.qvel[:nv] = data.qpos, data.qvel
        beside.act[:] = data.act
        beside.qacc_warmstart[:nv] = data.qacc_warmstart
        mujoco.mj_step(model, data)
        mujoco.mj_step(other, beside)
        assert np.isfinite(data.qvel).all()
        change = np.abs(data.qvel - beside.qvel[:nv]).max()
        # at rest it is what gravity would do that is held
        scale = max(np.abs(data.qacc).max(), 9.81) * model.opt.timestep
        worst = max(worst, change / scale)
    counts = solve_counts(model, data)
    assert all(count.stops == 0 for count in counts.values())
    return worst


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.filterwarnings("ignore")
def test_an_arm_moves_the_same_beside_a_body_that_is_pressed(integrator: str) -> None:
    found = [_difference(seed, integrator) for seed in range(40)]
    assert max(found) < 1e-9, f"seed {int(np.argmax(found))}: {max(found):g}"
    assert np.median(found) < 1e-12
