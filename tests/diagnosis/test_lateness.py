"""A force that is late, known from the first step on, and what stands in for it else."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.blind_test.case import hide, records_of
from inerter.blind_test.plan import Task
from inerter.diagnose import diagnose_bench
from inerter.diagnose.remainder.words import summary
from inerter.records import Record
from inerter.reference import HiddenCase, ReferenceDevice, response, sum_of_sines
from scipy.signal import butter, sosfilt

RATE, FINE = 200, 20
DAMPER = ReferenceDevice(inertance=170.0, branch_stiffness_1=15e3, branch_damping_1=700.0)
FREQUENCIES = np.array([0.5, 0.9, 1.3, 1.9, 2.6, 3.3, 4.1, 4.9])


def late_record(ringing: float = 0.0) -> Record:
    """A damper with elasticity behind a low-pass that the displacement has not; 38.5 Hz [m/s^2]."""
    tones = [*FREQUENCIES, 38.5]
    sizes = [*(0.004 / (1 + FREQUENCIES)), ringing / (2 * np.pi * 38.5) ** 2]
    motion = sum_of_sines(sizes, tones, 1.7 * np.arange(len(tones)) ** 2)
    time = np.arange(0, 10, 1 / (RATE * FINE))
    truth = response(DAMPER, motion, time)
    low_pass = butter(4, 49.5, fs=RATE * FINE, output="sos")
    force = np.asarray(sosfilt(low_pass, truth.force))
    random, kept = np.random.default_rng(4), slice(100 * FINE, None, FINE)
    x, f = truth.displacement[kept], force[kept]
    return Record(
        name="run",
        time=time[kept] - time[kept][0],
        displacement=x + random.normal(0, 1e-6, x.size),
        force=f + random.normal(0, 0.3, f.size),
    )


def test_a_late_damper_with_elasticity_is_no_damper_beside_a_shaft() -> None:
    found = diagnose_bench([late_record(ringing=0.02)])
    names = {finding.effect for finding in found.findings}
    assert "viscoelasticity" in names
    assert names & {"sensor_delay", "sensor_filter"}
    assert not names & {"series_elasticity", "viscous_friction", "backlash"}
    values = next(f for f in found.findings if f.effect == "viscoelasticity").parameters
    for name, truth in (("branch_stiffness_1", 15e3), ("branch_damping_1", 700.0)):
        value = values[name]
        assert abs(value.value - truth) < max(4 * value.stderr, 0.02 * truth), name
    # what rings in the drive above the band of the motion is told
    assert "tone of 38.5 Hz, above the" in found.verdict


def test_a_tone_above_the_band_is_told_before_what_is_not_there() -> None:
    text = summary([], {}, {}, 1.4, 0.4, 0.0, False, None, above=(38.5, 1.35, 15.0))
    assert "is more than this noise: 1.35 N rms of it is a tone of 38.5 Hz, above the 15 Hz" in text
    assert "Else it shows no dependence" in text


def test_what_lies_above_the_band_is_told_from_what_is_left_below() -> None:
    text = summary([], {}, {}, 14.5, 2.9, 0.0, False, None, beyond=(3.0, 40.0))
    assert "most of it lies above the 40 Hz up to which the motion is told from noise" in text
    assert "Below, 3 N rms are left, and that shows no dependence" in text
    # of noise nothing is said
    quiet = summary([], {}, {}, 1.0, 0.9, 0.0, False, None, beyond=(0.5, 40.0))
    assert "above" not in quiet


@pytest.mark.long
@pytest.mark.parametrize(
    ("effect", "seed"), [("viscoelasticity", 2844657545), ("friction_drift", 89049161)]
)
def test_a_late_force_is_no_shaft_and_no_play(effect: str, seed: int) -> None:
    """Cases in which it was: from the delay on, and with jumps followed between samples, not."""
    task = Task(group="single", seed=seed, noise=0.01, effects=(effect,), bench="realistic")
    hidden = hide(task)
    assert isinstance(hidden, HiddenCase)
    found = diagnose_bench(records_of(hidden))
    names = {finding.effect for finding in found.findings}
    assert effect in names
    assert not names & {"series_elasticity", "backlash", "viscous_friction"}, found.verdict
