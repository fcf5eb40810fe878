"""What shows in few places of a vehicle's records, and where a model with dry friction rests."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from inerter.blind_test.vehicle import diagnose_vehicle
from inerter.blind_test.vehicle_model import vehicle_mjcf
from inerter.diagnose.vehicle.build import model_of_text
from inerter.diagnose.vehicle.inputs import undriven
from inerter.diagnose.vehicle.simulate import _equilibrium
from inerter.plugin import load_plugin
from inerter.reference import hide_in_vehicle
from inerter.reference.hidden_vehicle import draw_vehicle


@pytest.mark.long
@pytest.mark.parametrize(("seed", "reached"), [(2328789260, True), (14, False)])
def test_a_wheel_that_seldom_leaves_the_road_is_named(seed: int, reached: bool) -> None:
    # one burst tells it, on the second vehicle in no run that is held out
    case = hide_in_vehicle(seed, ("tyre_liftoff",))
    diagnosis = diagnose_vehicle(case)
    (finding,) = diagnosis.findings
    assert finding.effect == "tyre_liftoff"
    assert finding.seen_in_blocks is not reached
    assert finding.rmse_after < 0.1 * finding.rmse_before
    load = finding.parameters["tyre_static_load"].value
    assert load == pytest.approx(case.parameters["tyre_static_load"], rel=1e-3)
    told = "does not reach" in diagnosis.verdict and "does not reach" in finding.evidence
    assert told is not reached


def test_a_model_rests_where_friction_holds_nothing() -> None:
    load_plugin()
    text = vehicle_mjcf(draw_vehicle(np.random.default_rng(5), "arm"))
    # put together above its road: hard friction holds the body where the strut misses little
    text = re.sub(r'name="ground" pos="[^"]*"', 'name="ground"', text)
    hard = 'name="heave" frictionloss="90" solimpfriction="0.9999 0.9999 0.001"'
    smooth, dry = (
        model_of_text(each, Path("car.xml")).model
        for each in (text, text.replace('name="heave"', hard))
    )
    rest = _equilibrium(smooth, undriven(smooth))
    assert abs(rest[0]) > 0.1
    assert _equilibrium(dry, undriven(dry)) == pytest.approx(rest, abs=1e-6)
    # the model itself keeps its friction
    assert not dry.opt.disableflags
