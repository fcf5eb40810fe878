"""What a motion hides is not looked for, and the report says so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.catalogue.scales import Scales
from inerter.core import Device
from inerter.diagnose import diagnose_bench
from inerter.diagnose.cannot_tell import FEW, FEW_STROKES, is_hidden, strokes_of
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.motion_units import ROTATION
from inerter.records import Record

SIZES = Scales(
    force=100.0, displacement=0.01, velocity=0.1, acceleration=1.0, cutoff=20.0,
    travel=(-0.02, 0.02),
)  # fmt: skip
BARE = Model("none", {"inertance": 80.0}, ("inertance",))


def run(velocity: np.ndarray) -> BenchRun:
    zero = np.zeros(velocity.size)
    return BenchRun(
        name="a", start=0.0, spacing=0.01, displacement=zero, velocity=velocity, acceleration=zero,
        force=zero, inner=np.ones(velocity.size, bool), first_force=0.0, cutoff=np.inf,
    )  # fmt: skip


def test_strokes_are_counted() -> None:
    t = np.linspace(0.0, 1.0, 500)
    once, thrice = run(np.sin(np.pi * t)), run(np.sin(3.0 * np.pi * t))
    assert strokes_of([once]) == 1
    assert strokes_of([thrice]) == 3
    assert strokes_of([once, thrice]) == 4
    # what trembles about a rest is no stroke, and a rest of all is one
    assert strokes_of([run(np.r_[np.sin(np.pi * t), 0.01 * np.sin(90.0 * t)])]) == 1
    assert strokes_of([run(0.0 * t)]) == 1


def test_a_turn_comes_back_to_where_it_was() -> None:
    t = np.linspace(0.0, 1.0, 500)
    spun = replace(run(np.ones(500)), displacement=40.0 * t)
    assert strokes_of([spun]) == 1
    assert strokes_of([replace(spun, motion=ROTATION)]) == 7


@pytest.mark.parametrize("effect", FEW.effects)
def test_along_few_strokes_no_drift_is_told(effect: str) -> None:
    assert is_hidden({effect, "viscous_friction"}, BARE, SIZES, FEW_STROKES - 1)
    assert not is_hidden({effect}, BARE, SIZES, FEW_STROKES)
    assert not is_hidden({"viscous_friction"}, BARE, SIZES, 1)


def test_two_stops_need_room_between_them() -> None:
    def stopped(lower: float, upper: float) -> Model:
        return BARE.adding(
            None, stop_lower=lower, stop_upper=upper, stop_stiffness=1e4, stop_damping=0.0
        )

    assert is_hidden({"end_stop"}, stopped(0.001, 0.002), SIZES, 99)
    assert is_hidden({"end_stop"}, stopped(0.002, 0.001), SIZES, 99)
    assert not is_hidden({"end_stop"}, stopped(-0.01, 0.01), SIZES, 99)


def test_along_one_sine_a_low_pass_that_turns_it_is_none() -> None:
    sine = replace(SIZES, one_tone=True)

    def filtered(cutoff: float) -> Model:
        return BARE.adding(None, force_filter=cutoff).holding(
            force_filter_order=4.0, force_filter_bessel=0.0
        )

    for cutoff, hidden in ((0.5, True), (2.0, True), (20.0, False)):
        model = filtered(cutoff * sine.frequency)
        assert is_hidden({"sensor_filter"}, model, sine, 99) == hidden
        assert not is_hidden({"sensor_filter"}, model, SIZES, 99)


def test_a_report_of_one_stroke_says_what_it_cannot_tell() -> None:
    random = np.random.default_rng(1)
    t = np.arange(0.0, 4.0, 0.002)
    speed = 0.3 * np.sin(np.pi * t / 4.0) + 0.02 * np.sin(40.0 * t) * np.sin(np.pi * t / 4.0)
    device = Device(inertance=60.0, viscous=150.0)
    x = np.cumsum(speed) * 0.002
    force = device.evaluate(x, speed, np.gradient(speed, t), 0.0)["total"]
    record = Record(
        name="once", time=t, displacement=x, force=force + random.normal(0.0, 0.3, t.size)
    )
    found = diagnose_bench([record], Device(inertance=60.0))
    assert "viscous_drift" not in [finding.effect for finding in found.findings]
    assert FEW in found.cannot_tell
    assert "several strokes there and back would tell" in found.verdict
