"""What is added to a model is searched for alone, all that it had following linearly."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.catalogue.along_stroke import QUANTITIES
from inerter.core import Device
from inerter.diagnose.promise import MOST_NEW, Known
from inerter.identify.fit import Problem, rms
from inerter.identify.model import Model
from three_sines import H, motion, run_of

NODES = QUANTITIES[0].nodes


def curved(effects_seed: int, **more: float | str) -> tuple[Problem, Model]:
    """A force along the stroke and what is `more`; the model without that, as it is fitted."""
    x, v, a = motion()
    draw = np.random.default_rng(effects_seed)
    ends = {"curve_lower": float(x.min()), "curve_upper": float(x.max())}
    values = dict(zip(NODES[:9], draw.uniform(-5, 5, 9).tolist(), strict=True))
    device = Device(inertance=50.0, force_curve=list(values.values()), **ends, **more)
    run = run_of(device.along(H, x, v, a)["total"] + 0.1 * draw.standard_normal(x.size), (x, v, a))
    problem = Problem([run], [np.ones(x.size, bool)])
    begin = {"inertance": 60.0, **values}
    model = Model("none", {**ends, **begin, "transition_velocity": 1e-4}, tuple(begin))
    return problem, problem.fit(model, evaluations=100).model


def test_a_linear_part_is_found_as_by_a_fit_of_everything(effects_seed: int) -> None:
    problem, model = curved(effects_seed, viscous=20.0)
    start = model.adding(None, viscous=0.0)
    found = Known(problem, model).beside(problem, start, 10, 1e-6)
    assert found
    whole = problem.fit(start, evaluations=100).model
    for name in start.free:
        assert found.values[name] == pytest.approx(whole.values[name], rel=1e-4, abs=1e-4), name


def test_what_bends_is_found_on_part_of_the_data(effects_seed: int) -> None:
    """Dahl friction on the first third, from a bristle twice as stiff."""
    problem, model = curved(
        effects_seed, friction="dahl", coulomb_force=12.0, bristle_stiffness=3e4
    )
    part = problem.head(0.4)
    start = model.adding("dahl", coulomb_force=8.0, presliding=8e-4)
    found = Known(problem, model).beside(part, start, 20, 1e-6)
    assert found
    # what the rest of the data know of the curve does not hold there
    limit = 1.1 * part.fit(start, evaluations=100).rmse(part.masks)
    assert rms(part.residual(found), part.masks) < limit
    assert found.values["coulomb_force"] == pytest.approx(12.0, rel=0.1)
    assert found.values["presliding"] == pytest.approx(4e-4, rel=0.2)


def test_what_it_cannot_tell_it_leaves_alone(effects_seed: int) -> None:
    problem, model = curved(effects_seed)
    known = Known(problem, model)
    moved = model.holding(inertance=61.0).adding(None, viscous=0.0)
    assert known.beside(problem, moved, 10, 1e-6) is None
    many = dict.fromkeys(QUANTITIES[1].nodes[: MOST_NEW + 1], 0.0)
    assert known.beside(problem, model.adding(None, **many), 10, 1e-6) is None


def test_derivatives_are_begun_with_loosely(effects_seed: int) -> None:
    """Those by what a model had are known, of a start that is some way from it."""
    problem, model = curved(effects_seed)
    known = Known(problem, model)
    start = model.holding(inertance=50.5).adding("coulomb", coulomb_force=3.0)
    assert known.near(problem, start) is None
    near = known.near(problem, start, loosely=True)
    assert near
    assert near.bending == ("coulomb_force",)
    at = [start.free.index(name) for name in model.free]
    np.testing.assert_array_equal(near.columns[:, at], known.columns)
    exact = problem.derivatives(start, ("coulomb_force",), counted=True)
    np.testing.assert_array_equal(near.columns[:, [start.free.index("coulomb_force")]], exact)
