"""Tyres that pull on the road: position actuators `road`, `road_...` on the slides of wheels.

Such a tyre is a spring that holds both ways. At rest the weight W of the car presses it; in a model
without gravity, whose forces count from rest, it may pull by W and no more. W is the wheel's own
weight and its share of the rest: that of the least squares that balances force and moments about
the centre of mass, which is the exact one for two axles and for a car that is alike on both sides.
"""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GRAVITY = 9.81
"""[m/s^2], for models that have none."""


def static_loads(model: mujoco.MjModel) -> dict[str, float]:
    """Weight [N] on the tyre of each road actuator; empty where there are none."""
    wheels = _wheels(model)
    if not wheels:
        return {}
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    bodies = list(wheels.values())
    # a sprung body may hang on its wheel: what is not a wheel is the rest
    own = np.array([model.body_mass[body] for body in bodies])
    rest = [i for i in range(1, model.nbody) if i not in bodies]
    masses = model.body_mass[rest]
    total = float(masses.sum())
    centre = masses @ data.xipos[rest, :2] / total if total else np.zeros(2)
    arms = data.xipos[bodies, :2] - centre
    balance = np.vstack([np.ones(len(bodies)), arms.T])
    share = np.linalg.lstsq(balance, np.array([total, 0.0, 0.0]), rcond=None)[0]
    loads = GRAVITY * (own + share)
    return dict(zip(wheels, loads.tolist(), strict=True))


def pulling(model: mujoco.MjModel, columns: dict[str, Array]) -> list[str]:
    """A sentence on each tyre that pulled by more than its static load.

    `columns` of a vehicle record, in a model without gravity.
    """
    if np.any(model.opt.gravity):
        return []
    found = []
    for road, load in static_loads(model).items():
        name = road.replace("road", "tyre_force", 1)
        lowest = float(columns[name].min()) if name in columns else 0.0
        if load > 0.0 and lowest < -load * (1.0 + 1e-9):
            share = float(np.mean(columns[name] < -load))
            found.append(
                f"{name} falls to {lowest:.0f} N, but {load:.0f} N press that tyre at rest: for "
                f"{100.0 * share:.2g} % of the time the tyre pulls on the road, which none does; "
                f'give actuator {road!r} forcelimited="true" forcerange="-{load:.6g} 1e9" for a '
                "tyre that leaves the road"
            )
    return found


def _wheels(model: mujoco.MjModel) -> dict[str, int]:
    """Wheel body of each road actuator that acts on a slide."""
    found = {}
    for i in range(model.nactuator):
        name, joint = model.actuator(i).name, int(model.actuator_trnid[i, 0])
        affine = model.actuator_biastype[i] == mujoco.mjtBias.mjBIAS_AFFINE
        of_joint = model.actuator_trntype[i] == mujoco.mjtTrn.mjTRN_JOINT
        if not (affine and of_joint and (name == "road" or name.startswith("road_"))):
            continue
        if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_SLIDE:
            found[name] = int(model.jnt_bodyid[joint])
    return found
