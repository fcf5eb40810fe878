"""The same devices as a user writes them in Python, for comparison.

Nested cars: MuJoCo has the inertance (tendon armature), the friction is a passive force in
`mjcb_passive`, its state stepped there. Branches: no callback can add an inertance there, since the
force hangs on the acceleration that it causes; the loop over `mj_step1` and `mj_step2` solves for
it, a = a0 - W b a, W = J M^-1 J', with NumPy.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from inerter.benchmark.laws import INERTANCE, LAWS


def lugre(v: float, z: float, h: float) -> tuple[float, float]:
    """Force of the LuGre law and its state a step later."""
    p = LAWS["lugre"]
    fall = math.exp(-((v / p["stribeck_velocity"]) ** 2))
    level = p["coulomb_force"] + (p["static_force"] - p["coulomb_force"]) * fall
    rate = v - p["bristle_stiffness"] * abs(v) * z / level
    return p["bristle_stiffness"] * z + p["bristle_damping"] * rate, z + h * rate


def passive_callback(model: Any) -> Callable[[Any, Any], None]:
    """For `mujoco.set_mjcb_passive`: LuGre friction in every strut of a nested car."""
    struts = [i for i in range(model.ntendon) if model.tendon(i).name.startswith("strut")]
    dofs = [model.joint(f"wheel{n}").dofadr[0] for n in range(len(struts))]
    states, h = [0.0] * len(struts), model.opt.timestep

    def passive(_: Any, data: Any) -> None:
        for n, (strut, dof) in enumerate(zip(struts, dofs, strict=True)):
            force, states[n] = lugre(data.ten_velocity[strut], states[n], h)
            # a wheel that goes up shortens its strut
            data.qfrc_passive[dof] += force

    return passive


def coupled_steps(model: Any, data: Any, steps: int) -> None:
    """Step a car of branches, an ideal inerter in every strut."""
    n, nv = model.ntendon, model.nv
    moment, answer = np.zeros((n, nv)), np.empty((n, nv))
    rows, counts = model.ten_J_rowadr, model.ten_J_rownnz
    entries = [np.arange(rows[i], rows[i] + counts[i]) for i in range(n)]
    columns = [model.ten_J_colind[entry] for entry in entries]
    inverse = np.eye(n) / INERTANCE
    for _ in range(steps):
        mujoco.mj_step1(model, data)
        for i in range(n):
            moment[i, columns[i]] = data.ten_J[entries[i]]
        mujoco.mj_solveM(model, data, answer, moment)
        free = answer @ (data.qfrc_passive - data.qfrc_bias)
        force = np.linalg.solve(inverse + moment @ answer.T, free)
        data.qfrc_applied[:] = -force @ moment
        mujoco.mj_step2(model, data)
