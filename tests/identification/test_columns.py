"""The derivatives that a fit works with are those of its residual, to rounding."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from inerter.catalogue.along_stroke import QUANTITIES, Quantity
from inerter.catalogue.coordinates import COORDINATES
from inerter.identify import in_proportion
from inerter.identify.channel import clips
from inerter.identify.columns import Columns
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
SHAFT = {"series_frequency": 15.0, "series_loss": 0.3}
# what may stand beside a linear term, with what it needs, at values that do something
BESIDE = {
    "asymmetric damping": ("none", {"damping_asymmetry": 0.4}),
    "bent damping": ("none", {"damping_knee": 0.05, "damping_beyond": 0.3}),
    "damping that bends in each direction by itself": (
        "none",
        {"damping_knee": 0.05, "damping_beyond": 0.3, "damping_knee_back": 0.1,
         "damping_beyond_back": 0.6, "damping_sharpness": 4.0},
    ),
    "damping that goes with a power of the speed": (
        "none",
        {"damping_power_knee": 0.01, "damping_beyond": 0.0, "damping_exponent": 0.35},
    ),
    "dampers behind a spring": ("none", {"damping_asymmetry": 0.4, "damper_stiffness": 5e3}),
    "a leak": ("none", {"leak_corner": 3.0}),
    "a leak that bends": ("none", {"leak_quadratic_damping": 3e3}),
    "a clutch": (
        "none", {"clutch_force": 40.0, "series_frequency": 12.0, "series_loss": 0.3},
    ),
    "a spring about another place": ("none", {"rest_length": 0.004}),
    "asymmetric friction": ("coulomb", {"friction_asymmetry": 0.3}),
    "friction along x": ("dahl", {"friction_gradient": 10.0, "friction_curvature": 300.0}),
    "inertance along x": ("none", {"inertance_gradient": 5.0, "inertance_curvature": 100.0}),
    "inertance along v": ("none", {"inertance_speed_gradient": 1.0}),
    "friction play": ("dahl", {"friction_backlash": 1e-3, "friction_place": 0.3}),
    "rate and state": ("rate_state", {"rate_effect": 0.1, "age_effect": 0.2, "age_distance": 1e-4}),
    "load friction": ("none", {"load_friction": 0.2, "transition_velocity": 1e-3}),
    "Bouc-Wen": (
        "bouc_wen",
        {"bw_stiffness": 3e3, "bw_beta": 80.0, "bw_gamma": 40.0, "bw_exponent": 1.0,
         "bw_ratio": 0.1},
    ),
    "shaft": ("none", {**SHAFT, "series_hardening": 20.0, "flywheel_viscous": 30.0}),
    "backlash": ("none", {**SHAFT, "backlash": 1e-3}),
    "a damper in series": ("none", {"series_damping": 900.0}),
    "branches": (
        "none",
        {"branch_stiffness_1": 2e3, "branch_time_1": 0.1, "branch_stiffness_2": 2e3,
         "branch_time_2": 1.0},
    ),
    "stops of rubber": (
        "none",
        {"stop_upper": 0.01, "stop_stiffness": 1e4, "stop_stiffness_cubic": 1e8},
    ),
    "stops": (
        "none",
        {"stop_lower": -0.01, "stop_upper": 0.01, "stop_stiffness": 1e4, "stop_damping": 1.0},
    ),
    "gas": ("none", {"gas_push": 50.0, "gas_reach": 0.1, "gas_exponent": 1.3}),
    "gas above": ("none", {"gas_push": 50.0, "gas_reach_above": 0.1, "gas_exponent": 1.3}),
    "periods": (
        "coulomb",
        {f"{q.name}_{word}_1": value for q in QUANTITIES
         for word, value in (("period", 0.015), ("cosine", 0.1), ("sine", 0.05))},
    ),
    "delay": ("none", {"delay": 1.3 * H}),
    "a force that is not held": ("none", {"force_coupling": 0.4}),
    "a zero that settles": ("none", {"settling_time": 0.3}),
    "force filter": ("none", LOW_PASS),
    "displacement filter": (
        "none", {f"displacement{name.removeprefix('force')}": v for name, v in LOW_PASS.items()},
    ),
    "limits": ("none", {"force_maximum": 60.0, "force_minimum": -60.0}),
    "tone": ("none", {"disturbance_amplitude": 5.0, "disturbance_frequency": 7.0}),
    "viscous drift": ("none", {"viscous_drift": 0.3}),
    "friction drift": ("dahl", {"friction_drift": 0.3}),
    "a mass before the shaft": ("none", {**SHAFT, "grip_mass": 6.0}),
}  # fmt: skip
OF_CHANNEL = [
    name for name, (_, values) in BESIDE.items()
    if any(COORDINATES[each].belongs_to == "channel" for each in values if each in COORDINATES)
]  # fmt: skip


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


def test_a_mass_before_a_play_has_its_column() -> None:
    """It takes its share of the first force, by which the flywheel begins."""
    values = {**LINEAR, **SHAFT, "backlash": 1e-3, "grip_mass": 6.0}
    model = Model("none", values, ("grip_mass", "inertance"))
    assert errors_of_columns(problem(), model).max() < 1e-4


def test_every_coordinate_stands_beside_the_linear_ones() -> None:
    """Of curves along the stroke and of periods, one of a kind; nodes have tests of their own."""
    tried = {*LINEAR, *(name for law in LAWS.values() for name in law)}
    tried |= {name for _, values in BESIDE.values() for name in values}
    nodes = {name for q in QUANTITIES for name in (*q.nodes, *q.back_nodes)}
    missing = {re.sub(r"_[23]$", "_1", name) for name in COORDINATES} - tried - nodes
    assert not missing, f"BESIDE has none of {sorted(missing)}"


@pytest.mark.parametrize("band", [np.inf, 60.0])
@pytest.mark.parametrize("beside", BESIDE)
def test_columns_are_right_beside_every_coordinate(beside: str, band: float) -> None:
    law, values = BESIDE[beside]
    stated = LAWS[law] if "bw_stiffness" not in values else {}
    model = Model(law, LINEAR | stated | values, tuple(LINEAR))
    errors = rms_errors_of_columns(problem_in(band), model)
    # samples that come to the limit or leave it tell another slope
    assert errors.max() < (0.1 if clips(values) else 1e-4), dict(zip(LINEAR, errors, strict=True))


@pytest.mark.parametrize("band", [np.inf, 60.0])
@pytest.mark.parametrize("beside", OF_CHANNEL)
def test_nodes_of_friction_are_right_beside_every_channel(beside: str, band: float) -> None:
    data = problem_in(band)
    nodes = {name: 0.05 * i for i, name in enumerate(QUANTITIES[2].nodes[:7])}
    ends = dict(zip(("curve_lower", "curve_upper"), data.scales.travel, strict=True))
    values = LINEAR | LAWS["coulomb"] | BESIDE[beside][1] | ends | nodes
    assert rms_errors_of_columns(data, Model("coulomb", values, tuple(nodes))).max() < 1e-3


@pytest.mark.parametrize("low_pass", [{}, LOW_PASS], ids=["", "low-pass"])
@pytest.mark.parametrize("band", [np.inf, 60.0])
@pytest.mark.parametrize("law", ["none", "dahl", "bouc_wen", "lugre"])
# at 0.17 m/s the inertance is that at rest, twice, half and the floor of it
@pytest.mark.parametrize("by_speed", [0.0, 6.0, -3.0, -7.0], ids=["", "more", "less", "floored"])
@pytest.mark.parametrize(
    ("quantity", "flanks"),
    [(QUANTITIES[0], False), (QUANTITIES[1], False), (QUANTITIES[1], True)],
    ids=["force", "inertance", "flanks"],
)
def test_nodes_of_a_curve_are_differences_of_the_residual(
    quantity: Quantity,
    flanks: bool,
    by_speed: float,
    law: str,
    band: float,
    low_pass: dict[str, float],
    effects_seed: int,
) -> None:
    data = problem_in(band)
    low, high = data.scales.travel
    draw = np.random.default_rng(effects_seed)
    size = 0.05 if quantity.name == "inertance" else 5.0
    names = (*quantity.nodes[:7], *(quantity.back_nodes[:7] if flanks else ()))
    nodes = {name: float(draw.uniform(-size, size)) for name in names}
    also = {"inertance": 40.0, "viscous": 90.0, "inertance_gradient": 1.5, "delay": 1.3 * H}
    ends = {"curve_lower": low, "curve_upper": high, "inertance_speed_gradient": by_speed}
    # with another exponent a step over z = 0 is smooth to 1e-3 alone
    smooth = law == "bouc_wen" and by_speed
    stated = LAWS[law] | ({"bw_exponent": 1.0} if smooth else {})
    model = Model(law, also | stated | low_pass | ends | nodes, (*nodes, "viscous"))
    assert errors_of_columns(data, model).max() < 1e-4


@pytest.mark.parametrize("band", [np.inf, 60.0])
@pytest.mark.parametrize("quantity", QUANTITIES[:2], ids=["force", "inertance"])
@pytest.mark.parametrize("beside", ["limits", "displacement filter", "backlash"])
def test_nodes_are_no_differences_beside_what_was_one_of_each(
    beside: str, quantity: Quantity, band: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = problem_in(band)
    size = 0.01 if quantity.name == "inertance" else 1.0
    nodes = {name: size * (i % 3) for i, name in enumerate(quantity.nodes[:7])}
    ends = dict(zip(("curve_lower", "curve_upper"), data.scales.travel, strict=True))
    law, values = BESIDE[beside]
    # what is behind a shaft has no column of its own
    behind = beside == "backlash" and quantity.name == "inertance"
    also = ("viscous",) if behind else (*nodes, "viscous")
    # beside a play a delay is one of the motion, where forces are compared as measured
    delay = {} if beside == "backlash" and np.isinf(band) else {"delay": 1.3 * H}
    stated = LINEAR | LAWS[law] | values | ends | delay | nodes
    model = Model(law, stated, also)
    assert rms_errors_of_columns(data, model).max() < (0.1 if clips(values) else 1e-4)
    monkeypatch.setattr(Columns, "_difference", None)
    assert data.jacobian(model).shape[1] == len(also)


@pytest.mark.parametrize("band", [np.inf, 60.0])
def test_columns_a_few_at_a_time_are_the_same(band: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of long records not all are worked out at once."""
    nodes = {name: 0.1 * i for i, name in enumerate(QUANTITIES[0].nodes[:7])}
    ends = dict(zip(("curve_lower", "curve_upper"), problem().scales.travel, strict=True))
    model = Model("none", LINEAR | ends | nodes | {"delay": 1.3 * H}, (*LINEAR, *nodes))
    at_once = problem_in(band).jacobian(model)
    monkeypatch.setattr(in_proportion, "_AT_ONCE", 3 * N)
    np.testing.assert_array_equal(problem_in(band).jacobian(model), at_once)


@pytest.mark.parametrize("force", [np.inf, 1e300])
@pytest.mark.parametrize(("beyond", "slope"), [(np.inf, 2.0), (1e-9, 2.0), (-1.0, 0.0)])
def test_a_difference_keeps_to_where_there_is_a_force(
    force: float, beyond: float, slope: float
) -> None:
    """On the other side of a point whose force runs away; none where it does on both."""
    data = problem()
    model = Model("none", LINEAR, tuple(LINEAR))
    here = data.variables(model).encode(model.values)
    at = model.free.index("viscous")

    def residual(point: np.ndarray, pressed: float = 0.0) -> list[np.ndarray]:
        moved = pressed + point[at] - here[at]
        runs_away = moved > beyond if beyond > 0 else moved != 0
        return [np.full(N, force if runs_away else 2.0 * moved)]

    found = Columns(data)._difference("viscous", model, here, residual(here), residual)
    assert found == pytest.approx(np.full(N, slope))


def test_what_is_left_out_changes_no_fit() -> None:
    data = problem()
    model = Model("dahl", LINEAR | LAWS["dahl"], ("inertance", "viscous", "coulomb_force"))
    alone = Problem(data.runs[:1], data.masks[:1], data.scales).fit(model)
    part = data.with_masks([data.masks[0], np.zeros(N, bool)])
    beside = part.fit(model)
    assert dict(beside.model.values) == dict(alone.model.values)
    # what it misses of the run left out is told all the same
    there = part.residual(beside.model)[1]
    np.testing.assert_array_equal(beside.residual[1], there)


def problem_in(band: float) -> Problem:
    """The same in a band [Hz], where it is finite."""
    data = problem()
    if np.isinf(band):
        return data
    runs = [
        replace(run, cutoff=band, measured=(run.displacement, run.velocity, run.acceleration))
        for run in data.runs
    ]
    return Problem(runs, data.masks)


def errors_of_columns(data: Problem, model: Model) -> np.ndarray:
    """How far each column is from the difference of the residual, per its largest value."""
    # short, for a bristle has a kink where the first force comes to what it can hold
    there = differences(data, model, 1e-4)
    return np.abs(data.jacobian(model) - there).max(axis=0) / np.abs(there).max(axis=0)


def rms_errors_of_columns(data: Problem, model: Model) -> np.ndarray:
    """The same, rms: where the force jumps, single samples say nothing."""
    there = differences(data, model, 1e-4)
    return np.linalg.norm(data.jacobian(model) - there, axis=0) / np.linalg.norm(there, axis=0)


def differences(data: Problem, model: Model, size: float) -> np.ndarray:
    """Central differences of the residual by the search variables."""
    columns = []
    for step in size * np.eye(len(model.free)):
        ahead, behind = (data.masked(data.residual(data.moved(model, s))) for s in (step, -step))
        columns.append((ahead - behind) / (2 * size))
    return np.column_stack(columns)
