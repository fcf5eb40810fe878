"""What a residual is linear in is solved for at every point; the fit ends where it did."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.catalogue.along_stroke import QUANTITIES
from inerter.core import Device
from inerter.identify.apart import Apart, Basis
from inerter.identify.columns import Columns
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from three_sines import H, motion, run_of

FORCE, INERTANCE = QUANTITIES[0], QUANTITIES[1]


def curved(effects_seed: int) -> tuple[Problem, Model, dict[str, float]]:
    """Dahl friction and curves of force and inertance, where to begin, and the true nodes."""
    x, v, a = motion()
    low, high = float(x.min()), float(x.max())
    draw = np.random.default_rng(effects_seed)
    force, inertance = draw.uniform(-5, 5, 7), draw.uniform(-0.05, 0.05, 7)
    inertance[3] = 0.0
    device = Device(
        friction="dahl", inertance=50.0, coulomb_force=12.0, bristle_stiffness=12.0 / 4e-4,
        force_curve=force.tolist(), inertance_curve=inertance.tolist(),
        curve_lower=low, curve_upper=high,
    )  # fmt: skip
    total = device.along(H, x, v, a)["total"]
    run = run_of(total + 0.1 * draw.standard_normal(x.size), (x, v, a))
    true = dict(zip(FORCE.nodes, force.tolist(), strict=False))
    true |= dict(zip(INERTANCE.nodes, inertance.tolist(), strict=False))
    free = {name: 0.0 for name in true if name != INERTANCE.nodes[3]}
    begin = {"inertance": 60.0, "coulomb_force": 8.0, "presliding": 1e-3}
    ends = {"curve_lower": low, "curve_upper": high, INERTANCE.nodes[3]: 0.0}
    model = Model("dahl", {**begin, **ends, **free}, (*begin, *free))
    return Problem([run], [np.ones(x.size, bool)]), model, true


def test_a_fit_with_and_without_it(effects_seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    data, model, true = curved(effects_seed)
    found = data.fit(model, evaluations=100)
    errors = np.sqrt(np.diag(found.covariance))
    for name, error in zip(found.model.free, errors, strict=True):
        expected = {"inertance": 50.0, "coulomb_force": 12.0, "presliding": 4e-4, **true}[name]
        assert abs(found.model.values[name] - expected) < 6 * error, name
    monkeypatch.setattr(Columns, "apart", lambda self, model: None)
    plain = data.fit(model, evaluations=100)
    assert found.cost == pytest.approx(plain.cost, rel=1e-6)
    spread = np.sqrt(np.diag(plain.covariance))
    np.testing.assert_allclose(errors, spread, rtol=0.02)
    for name, error in zip(model.free, spread, strict=True):
        assert abs(found.model.values[name] - plain.model.values[name]) < 0.02 * error


def test_few_coordinates_or_columns_that_move_are_not_taken_apart(effects_seed: int) -> None:
    data, model, _ = curved(effects_seed)
    columns = Columns(data)
    apart = columns.apart(model)
    assert apart
    nodes = {name for name in model.free if "node" in name}
    assert set(apart.names) == nodes
    assert columns.apart(model.adding(None, delay=1e-3)) is None
    plain = model.without([name for name in model.free if "node" in name])
    assert columns.apart(plain) is None


def test_beyond_bounds_nothing_is_solved(effects_seed: int) -> None:
    data, model, _ = curved(effects_seed)
    columns = np.random.default_rng(effects_seed).standard_normal((50, 2))
    apart = Apart(FORCE.nodes[:2], Basis.of(columns), [False, False])
    sizes = data.scales
    amounts = np.array([0.5, -0.25]) * sizes.force
    solved = apart.solved(model, -columns @ amounts, sizes)
    assert solved
    before = [model.values[name] for name in FORCE.nodes[:2]]
    after = [solved.values[name] for name in FORCE.nodes[:2]]
    np.testing.assert_allclose(np.subtract(after, before), amounts)
    assert apart.solved(model, -columns @ (100 * amounts), sizes) is None
    # what is left has nothing of the columns
    rest = apart.rest(np.random.default_rng(effects_seed + 1).standard_normal(50))
    np.testing.assert_allclose(columns.T @ rest, 0, atol=1e-12)
