"""The derivatives that a fit works with are those of its residual, to rounding."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from three_sines import H, N, motion, run_of

LINEAR = {
    "inertance": 40.0, "viscous": 90.0, "stiffness": 500.0, "stiffness_cubic": 1e5,
    "force_offset": 3.0, "quadratic_damping": 40.0, "force_drift": 1.5,
}  # fmt: skip
LAWS = {
    "none": {},
    "coulomb": {"coulomb_force": 12.0, "transition_velocity": 1e-3},
    "dahl": {"coulomb_force": 12.0, "presliding": 2e-3},
    "lugre": {
        "coulomb_force": 12.0, "presliding": 1e-3, "static_excess": 5.0,
        "stribeck_velocity": 0.02, "bristle_damping": 50.0,
    },
    "bouc_wen": {"bw_level": 12.0, "presliding": 2e-3, "bw_shape": 0.6, "bw_exponent": 1.3},
    "rate_state": {"coulomb_force": 12.0, "transition_velocity": 1e-3},
}  # fmt: skip
BRANCH = {"branch_stiffness_1": 2e3, "branch_damping_1": 200.0}


def problem() -> Problem:
    """Two runs whose first force is not 0, and that leave out some of their samples."""
    runs = []
    for scale, offset in ((1.0, 9.0), (0.5, -4.0)):
        x, v, a = motion(scale)
        force = 50 * a + 70 * v + 10 * np.sign(v) + offset
        runs.append(run_of(force, (x, v, a)))
    masks = [np.arange(N) % 7 > 0, np.arange(N) > N // 5]
    return Problem(runs, masks)


@pytest.mark.parametrize("branch", [{}, BRANCH], ids=["", "branch"])
@pytest.mark.parametrize("delay", [0.0, 1.3 * H])
@pytest.mark.parametrize("law", LAWS)
def test_columns_are_differences_of_the_residual(
    law: str, delay: float, branch: dict[str, float]
) -> None:
    data = problem()
    values = LINEAR | LAWS[law] | branch | ({"delay": delay} if delay else {})
    model = Model(law, values, tuple(LINEAR))
    found = data.jacobian(model)
    for i, name in enumerate(LINEAR):
        step = np.zeros(len(LINEAR))
        step[i] = 1e-3
        ahead, behind = (data.masked(data.residual(data.moved(model, s))) for s in (step, -step))
        there = (ahead - behind) / 2e-3
        error = np.abs(found[:, i] - there).max() / np.abs(there).max()
        assert error < 1e-4, (name, error)
