"""Derivatives by the nodes of a friction curve are those of the residual."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.catalogue.along_stroke import QUANTITIES, curves_of_nodes
from inerter.core import Device
from inerter.identify.along_friction import nodes_of
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from three_sines import H, motion, run_of

FRICTION = next(quantity for quantity in QUANTITIES if quantity.name == "friction")
LAWS = {
    "coulomb": {"coulomb_force": 12.0, "transition_velocity": 1e-2},
    "dahl": {"coulomb_force": 12.0, "presliding": 2e-4},
    "lugre": {
        "coulomb_force": 12.0, "presliding": 2e-4, "static_excess": 0.3,
        "stribeck_velocity": 0.02, "bristle_damping": 20.0,
    },
    "play": {
        "coulomb_force": 12.0, "presliding": 2e-4,
        "friction_backlash": 3e-4, "friction_place": 0.0,
    },
}  # fmt: skip


@pytest.mark.parametrize("band", [np.inf, 60.0])
@pytest.mark.parametrize("law", LAWS)
def test_columns_of_a_friction_curve(law: str, band: float, effects_seed: int) -> None:
    """To second order in what the law remembers over the distance of nodes."""
    x, v, a = motion()
    run = run_of(50 * a + 10 * np.sign(v), (x, v, a))
    if np.isfinite(band):
        run = replace(run, cutoff=band, measured=(x, v, a))
    data = Problem([run], [np.ones(x.size, bool)])
    low, high = data.scales.travel
    draw = np.random.default_rng(effects_seed)
    nodes = {name: float(draw.uniform(-0.3, 0.3)) for name in FRICTION.nodes[:9]}
    values = {"inertance": 50.0, "delay": 1.3 * H, "curve_lower": low, "curve_upper": high}
    friction = "dahl" if law == "play" else law
    model = Model(friction, values | LAWS[law] | nodes, (*nodes, "inertance"))
    assert nodes_of(model.free, model) == list(nodes)
    found = data.jacobian(model)
    for column, step in zip(found[:, :9].T, 1e-3 * np.eye(10), strict=False):
        ahead, behind = (data.masked(data.residual(data.moved(model, s))) for s in (step, -step))
        there = (ahead - behind) / 2e-3
        assert np.linalg.norm(column - there) < 0.02 * np.linalg.norm(there)


def test_a_friction_of_the_flywheel_behind_a_shaft_is_differenced() -> None:
    names = FRICTION.nodes[:7]
    ends = {"curve_lower": -0.1, "curve_upper": 0.1}
    values = {"inertance": 50.0, "coulomb_force": 12.0, "presliding": 1e-4, **ends}
    values |= dict.fromkeys(names, 0.1)
    assert nodes_of(names, Model("dahl", values, names)) == list(names)
    for also in ({"series_stiffness": 1e5}, {"friction_drift": 0.1}, {"force_maximum": 30.0}):
        assert nodes_of(names, Model("dahl", values | also, names)) == []


def test_the_curves_of_nodes_are_those_of_a_device(effects_seed: int) -> None:
    draw = np.random.default_rng(effects_seed)
    values = draw.uniform(-5, 5, 8)
    x = np.linspace(-0.2, 0.2, 401)
    device = Device(
        friction="none", force_curve=values.tolist(), curve_lower=-0.12, curve_upper=0.1
    )
    there = device.along(1e-3, x, 0 * x, 0 * x)["total"]
    expected = curves_of_nodes(-0.12, 0.1, 8)(x.clip(-0.12, 0.1)) @ values
    np.testing.assert_allclose(there, expected, rtol=0, atol=1e-9)
