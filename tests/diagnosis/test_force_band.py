"""Forces are compared above the band of the motion where most of what is missed lies there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose.band import force_band
from inerter.diagnose.composition import effects_of
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.stages.searching import search_in
from inerter.diagnose.stages.settling import run_beyond_motion
from inerter.diagnose.start import Given, Prepared, prepared
from inerter.records import Record
from inerter.records.motion import motion_noise

STEP, SECONDS = 1e-3, 6.0
TIME = np.arange(0, SECONDS, STEP)


def records(draw: np.random.Generator, ripple: float) -> list[Record]:
    """Fast strokes of an inerter of 40 kg over teeth of 6.4 mm [N]; noise of 0.5 N and 3 um."""
    found = []
    for name, frequency in (("a", 1.7), ("b", 2.3), ("c", 1.3)):
        omega, phase = 2 * np.pi * frequency, draw.uniform(0, 6)
        x = 0.04 * np.sin(omega * TIME + phase)
        force = -40 * omega**2 * x + ripple * np.sin(2 * np.pi * x / 6.4e-3)
        found.append(
            Record(
                name=name,
                time=TIME,
                displacement=x + 3e-6 * draw.standard_normal(TIME.size),
                force=force + 0.5 * draw.standard_normal(TIME.size),
            )
        )
    return found


def start(draw: np.random.Generator, ripple: float) -> Prepared:
    return prepared(Given(records=records(draw, ripple), holdout=["c"]))


@pytest.mark.parametrize(("ripple", "more"), [(0.0, False), (0.5, False), (8.0, True)])
def test_it_takes_more_than_noise_above_the_motion(
    ripple: float, more: bool, effects_seed: int
) -> None:
    begun = start(np.random.default_rng(effects_seed), ripple)
    preparation = begun.weighed
    band = force_band(begun.data.learnt, begun.baseline, preparation)
    # where the stroke is fastest, teeth pass at 2 pi 0.04 m 2.3 Hz / 6.4 mm = 90 per second
    if more:
        assert 1.5 * preparation.cutoff < band < 120.0
    else:
        assert band == 0.0


def test_a_tone_needs_no_wider_band(effects_seed: int) -> None:
    made = [
        replace(record, force=record.force + 8.0 * np.sin(2 * np.pi * 61.3 * TIME))
        for record in records(np.random.default_rng(effects_seed), 0.0)
    ]
    begun = prepared(Given(records=made, holdout=["c"]))
    assert force_band(begun.data.learnt, begun.baseline, begun.weighed) == 0.0


@pytest.mark.parametrize(
    ("cubic", "hum", "more"), [(0.0, 0.0, False), (2e7, 0.0, True), (0.0, 3.0, False)]
)
def test_harmonics_of_one_sine_are_no_tones(
    cubic: float, hum: float, more: bool, effects_seed: int
) -> None:
    """A coarse displacement asks for much smoothing, and 2e7 N/m^3 (10 mm)^3 shows at 9 Hz."""
    draw, omega = np.random.default_rng(effects_seed), 2 * np.pi * 3.0
    x = 0.01 * np.sin(omega * TIME + draw.uniform(0, 6))
    force = -40 * omega**2 * x + cubic * x**3 + hum * np.sin(2 * np.pi * 50.0 * TIME)
    (record,) = (
        Record(
            name="sine", time=TIME, displacement=x + 3e-5 * draw.standard_normal(TIME.size),
            force=force + 0.3 * draw.standard_normal(TIME.size),
        ),
    )  # fmt: skip
    begun = prepared(Given(records=[record]))
    assert begun.weighed.cutoff < 9.0
    band = force_band(begun.data.learnt, begun.baseline, begun.weighed)
    assert (band > begun.weighed.cutoff) == more


def test_above_the_motions_cut_off_its_noise_is_none() -> None:
    frequency = np.array([2.0, 5.0, 20.0, 60.0])
    everywhere = motion_noise(frequency, 4.0)
    quiet = motion_noise(frequency, 4.0, quiet=8.0)
    np.testing.assert_allclose(quiet[:1], everywhere[:1], rtol=1e-3)
    assert quiet[-1] == pytest.approx(1.0 + 15.0**4 / (1.0 + 7.5**6) ** 2)


def test_above_the_motions_band_what_was_found_stays(effects_seed: int) -> None:
    """Teeth are found beside a damper that these data do not need, and nothing linear is added."""
    begun = start(np.random.default_rng(effects_seed), 8.0)
    wide = force_band(begun.data.learnt, begun.baseline, begun.weighed)
    search = search_in(begun, replace(begun.weighed, force_band=wide))
    final = run_beyond_motion(search, begun.baseline.adding(None, viscous=3.0), most=2)
    named = dict(effects_of(final.model, begun.baseline))
    assert named.keys() == {"viscous_friction", "position_force"}
    assert final.model.values["force_period_1"] == pytest.approx(6.4e-3, rel=0.01)
    # afterwards rivals of every kind are asked again
    assert not search.excluded
    assert search.least == CRITERIA.gain
