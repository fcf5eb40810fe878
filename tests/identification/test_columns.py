"""The derivatives that a fit works with are those of its residual, to rounding."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.catalogue.along_stroke import QUANTITIES, Quantity
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
LOW_PASS = {"force_filter": 40.0, "force_filter_order": 3.0, "force_filter_bessel": 1.0}
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
    errors = errors_of_columns(data, model)
    assert errors.max() < 1e-4, dict(zip(LINEAR, errors, strict=True))


@pytest.mark.parametrize("low_pass", [{}, LOW_PASS], ids=["", "low-pass"])
@pytest.mark.parametrize("band", [np.inf, 60.0])
@pytest.mark.parametrize("law", ["none", "dahl", "bouc_wen", "lugre"])
@pytest.mark.parametrize(
    ("quantity", "flanks"),
    [(QUANTITIES[0], False), (QUANTITIES[1], False), (QUANTITIES[1], True)],
    ids=["force", "inertance", "flanks"],
)
def test_nodes_of_a_curve_are_differences_of_the_residual(
    quantity: Quantity,
    flanks: bool,
    law: str,
    band: float,
    low_pass: dict[str, float],
    effects_seed: int,
) -> None:
    data = problem()
    if np.isfinite(band):
        runs = [
            replace(run, cutoff=band, measured=(run.displacement, run.velocity, run.acceleration))
            for run in data.runs
        ]
        data = Problem(runs, data.masks)
    low, high = data.scales.travel
    draw = np.random.default_rng(effects_seed)
    size = 0.05 if quantity.name == "inertance" else 5.0
    names = (*quantity.nodes[:7], *(quantity.back_nodes[:7] if flanks else ()))
    nodes = {name: float(draw.uniform(-size, size)) for name in names}
    also = {"inertance": 40.0, "viscous": 90.0, "inertance_gradient": 1.5, "delay": 1.3 * H}
    ends = {"curve_lower": low, "curve_upper": high}
    model = Model(law, also | LAWS[law] | low_pass | ends | nodes, (*nodes, "viscous"))
    assert errors_of_columns(data, model).max() < 1e-4


def test_what_is_left_out_changes_no_fit() -> None:
    data = problem()
    model = Model("dahl", LINEAR | LAWS["dahl"], ("inertance", "viscous", "coulomb_force"))
    alone = Problem(data.runs[:1], data.masks[:1], data.scales).fit(model)
    beside = data.with_masks([data.masks[0], np.zeros(N, bool)]).fit(model)
    assert dict(beside.model.values) == dict(alone.model.values)
    # what it misses of the run left out is told all the same
    there = data.residual(beside.model)[1]
    np.testing.assert_array_equal(beside.residual[1], there)


def errors_of_columns(data: Problem, model: Model) -> np.ndarray:
    """How far each column is from the difference of the residual, per its largest value."""
    found = data.jacobian(model)
    errors = []
    for column, step in zip(found.T, 1e-3 * np.eye(len(model.free)), strict=True):
        ahead, behind = (data.masked(data.residual(data.moved(model, s))) for s in (step, -step))
        there = (ahead - behind) / 2e-3
        errors.append(np.abs(column - there).max() / np.abs(there).max())
    return np.array(errors)
