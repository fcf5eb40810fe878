"""The ball-screw paper's table and trends: what holds, and under which reading."""

import math

import numpy as np
import pytest
from inerter.design import design_ball_screw
from inerter.design.ball_screw.inputs import INPUTS
from inerter.design.ball_screw.losses import Losses
from inerter.design.ball_screw.measured import Points, compare
from inerter.design.ball_screw.trends import PAPER_TRENDS, over_frequency, trend
from inerter.design.inputs import read_inputs

# Table 3, as printed
PRINTED = np.array([37.6, 38.1, 39.6, 39.4, 40.3, 40.8, 41.2, 39.7, 40.9, 39.9, 39.8, 40.1])


@pytest.mark.parametrize("method", ["corrected", "printed"])
def test_measured_table_within_the_paper_s_errors(method: str) -> None:
    design = design_ball_screw(measured="paper", method=method)
    rows = design.tables["measured"]
    error = np.array([row["calculated"] for row in rows]) / PRINTED - 1
    # 5 % at all frequencies, 2 % above 3 Hz but for one point
    assert np.max(np.abs(error)) < 0.05
    assert sorted(np.abs(error[3:]))[-2] < 0.02
    assert np.max(np.abs(error[3:])) < 0.023
    # a constant has no part in this: it misses 1 Hz by more than 5 %
    assert design.value("largest_error_of_constant") > 0.05
    assert design.value("largest_error_left_out") < 0.03


def test_parameters_come_back_from_points_made_with_them() -> None:
    values = read_inputs(INPUTS, {"preload": 1.5})
    losses = Losses(values)
    force = np.geomspace(8.0, 400.0, 9)
    acceleration = force / (losses.inertance * losses.efficiency(force))
    points = Points("made", np.arange(1.0, 10.0), force, acceleration)
    found = compare(points, Losses(read_inputs(INPUTS, {})))
    assert found.inertance == pytest.approx(losses.inertance, rel=1e-5)
    assert found.preload == pytest.approx(1.5, rel=1e-3)


def test_another_friction_gives_another_inertance_and_the_same_curve() -> None:
    one, other = (design_ball_screw(measured="paper", sliding_friction=mu) for mu in (0.07, 0.12))
    assert other.value("inertance") / one.value("inertance") > 1.03
    curves = [[row["calculated"] for row in d.tables["measured"]] for d in (one, other)]
    assert curves[0] == pytest.approx(curves[1], rel=1e-3)


def agreements(preload: float, method: str) -> dict[str, bool]:
    values = read_inputs(INPUTS, {"preload": preload, "method": method})
    frequency = np.linspace(1.0, 12.0, 23)
    return {name: trend(values, name, frequency).row()["agrees"] for name in PAPER_TRENDS}


def test_trends_hold_for_printed_equations_with_a_preload() -> None:
    assert all(agreements(15.0, "printed").values())


def test_trends_do_not_follow_from_the_printed_ball_load_alone() -> None:
    # eq. (26) without preload: more balls lose less, and inertance falls with frequency
    assert not agreements(0.0, "printed")["ball_number"]
    curve = over_frequency(
        Losses(read_inputs(INPUTS, {"preload": 0, "method": "printed"})), [1.0, 12.0]
    )
    assert curve[1] < curve[0]


def test_consistent_kinematics_reverse_three_of_five_trends() -> None:
    found = agreements(0.59, "corrected")
    assert {name for name, agrees in found.items() if agrees} == {"lead", "ball_number"}


def test_printed_chain_cannot_lose_a_tenth() -> None:
    # the paper's gap of 10 % to the ideal inertance, at its loads, with mu_f = 1 and no preload
    losses = Losses(read_inputs(INPUTS, {"preload": 0, "method": "printed", "sliding_friction": 1}))
    assert losses.sliding_loss(308.17) < 0.02


def test_inertance_rises_with_frequency_to_a_limit() -> None:
    values = read_inputs(INPUTS, {})
    curve = over_frequency(Losses(values), np.linspace(1.0, 12.0, 50))
    assert np.all(np.diff(curve) > 0)
    assert curve[-1] / curve[len(curve) // 2] < 1.01
    assert math.isnan(over_frequency(Losses(values.replace(preload=30.0)), [1.0])[0])


@pytest.mark.parametrize(("frequency", "acceleration"), [(1.0, 0.18), (2.0, 0.26), (12.0, 7.69)])
def test_friction_never_lowers_force_per_acceleration(
    frequency: float, acceleration: float
) -> None:
    # what a bench reads: peak and fundamental of the device's force in a sinusoid
    device = design_ball_screw(measured="paper").device
    phase = np.linspace(0.0, 2 * math.pi, 4001)[:-1]
    rate = 2 * math.pi * frequency
    x = acceleration / rate**2
    force = device.evaluate(
        -x * np.cos(phase), x * rate * np.sin(phase), acceleration * np.cos(phase), 0.0
    )["total"]
    fundamental = 2 * abs(np.mean(force * np.exp(-1j * phase)))
    assert fundamental / acceleration > device.inertance
    assert np.max(force) / acceleration > device.inertance
