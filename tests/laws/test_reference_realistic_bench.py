"""A bench as it is: each thing that it does to a record, alone and against a closed form."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from inerter.reference import NoiseLevels, hide_effect, hide_unknown
from inerter.reference.bench_channel import Channel, shown
from inerter.reference.bench_motions import Drive
from inerter.reference.bench_realistic import FINE, RATES, Chain, draw_bench_drives, quantised
from inerter.reference.motion import Response, sine_motion
from inerter.reference.sizes import rms
from scipy.signal import bessel, butter

QUIET = NoiseLevels(force=0.0, displacement=0.0)
TIME = np.arange(round(6 * FINE)) / FINE
SINE = Drive("one_sine", sine_motion(0.01, 3.0), FINE, TIME)


def truth(force: np.ndarray | None = None) -> Response:
    zero = np.zeros(TIME.size)
    return Response(
        time=TIME, displacement=SINE.displacement, velocity=zero, acceleration=SINE.acceleration,
        state=zero, force=zero if force is None else force, states=np.zeros((TIME.size, 0)),
    )  # fmt: skip


def wave(values: np.ndarray, frequency: float) -> complex:
    """Amplitude and phase of a sine, without the first second."""
    t = TIME[TIME >= 1.0]
    columns = np.column_stack(
        [np.sin(2 * np.pi * frequency * t), np.cos(2 * np.pi * frequency * t)]
    )
    inside, quadrature = np.linalg.lstsq(columns, values[TIME >= 1.0], rcond=None)[0]
    return complex(inside, quadrature)


def test_a_chain_that_does_nothing_leaves_everything_as_it_is() -> None:
    force = np.sin(TIME)
    np.testing.assert_array_equal(Chain().force(truth(force)), force)
    np.testing.assert_array_equal(Chain().displacement(SINE), SINE.displacement)
    assert Chain().brings == ()
    shake = np.random.default_rng(0)
    np.testing.assert_array_equal(Chain(rate=250.0).sampled(force, TIME, shake), force[::8])


def test_mass_hum_and_drift_are_what_they_are_called() -> None:
    found = Chain(grip_mass=2.0).force(truth())
    np.testing.assert_allclose(found, 2.0 * SINE.acceleration, atol=1e-12)
    assert abs(wave(Chain(hum=0.7, hum_frequency=60.0, phase=1.0).force(truth()), 60.0)) == (
        pytest.approx(0.7, rel=1e-9)
    )
    assert np.ptp(Chain(drift=0.5).force(truth())) == pytest.approx(0.5 * TIME[-1])


@pytest.mark.parametrize("is_bessel", [False, True])
def test_filters_are_those_of_their_transfer_function(is_bessel: bool) -> None:
    chain = Chain(force_filter=30.0, displacement_filter=30.0, order=3, is_bessel=is_bessel)
    cutoff = 2 * np.pi * 30.0
    transfer: Any = butter(3, cutoff, analog=True)
    if is_bessel:
        transfer = bessel(3, cutoff, analog=True, norm="mag")
    above, below = (np.polyval(each, 2j * np.pi * 3.0) for each in transfer)
    expected = complex(above / below)
    passed = wave(chain.force(truth(np.sin(2 * np.pi * 3.0 * TIME))), 3.0)
    assert passed == pytest.approx(expected, abs=1e-3)
    assert wave(chain.displacement(SINE), 3.0) == pytest.approx(0.01 * expected, abs=1e-5)
    # alike on both there is nothing to name; on one there is
    assert chain.brings == ()
    assert "sensor_filter" in replace(chain, force_filter=0.0).brings


def test_a_grip_is_felt_behind_what_the_channel_hides() -> None:
    hidden = Channel(delay=4e-3, force_filter=20.0, force_filter_order=2.0)
    felt = shown(hidden, SINE, SINE.motion.acceleration)
    turn = 2j * np.pi * 3.0
    transfer: Any = butter(2, 2 * np.pi * 20.0, analog=True)
    above, below = (np.polyval(each, turn) for each in transfer)
    there = wave(SINE.acceleration, 3.0) * complex(above / below) * np.exp(-turn * 4e-3)
    assert wave(Chain(grip_mass=2.0).force(truth(), felt), 3.0) == pytest.approx(
        2 * there, rel=2e-3
    )


def test_converters_and_clocks() -> None:
    values = quantised(np.array([0.24, 0.26, -0.9]), 0.5)
    np.testing.assert_allclose(values, [0.0, 0.5, -1.0])
    chain = Chain(rate=500.0, jitter=1e-4)
    found = chain.sampled(np.sin(2 * np.pi * TIME), TIME, np.random.default_rng(1))
    error = found - np.sin(2 * np.pi * TIME)[::4]
    # to first order the velocity times the jitter
    assert rms(error) == pytest.approx(2 * np.pi * 1e-4 / np.sqrt(2), rel=0.1)


def test_benches_differ_and_their_motions_are_what_they_say() -> None:
    kinds, counts = set(), set()
    for seed in range(40):
        drives = draw_bench_drives(np.random.default_rng(seed), 100.0)
        kinds |= {drive.kind for drive in drives}
        counts.add(len(drives))
        for drive in drives:
            assert 4.9 <= drive.time[-1] <= 20.0
            middle = drive.time[200:-200:97]
            step = 1e-6
            rise = drive.motion.displacement(middle + step)
            rise = (rise - drive.motion.displacement(middle - step)) / (2 * step)
            np.testing.assert_allclose(drive.motion.velocity(middle), rise, atol=1e-6)
    assert {1, 2, 3} <= counts <= {1, 2, 3, 4}
    assert "one_sine" in kinds
    assert len(kinds) == 6


def test_a_case_follows_from_its_seed_and_holds_what_was_hidden() -> None:
    first, again = (
        hide_effect(7, "viscous_friction", noise=QUIET, realistic=True) for _ in range(2)
    )
    assert first.chain is not None
    assert first.chain == again.chain
    for one, other in zip(first.runs, again.runs, strict=True):
        np.testing.assert_array_equal(one.force, other.force)
        assert one.time.size == one.force.size == one.displacement.size == one.truth.force.size
        assert one.sample_rate == first.chain.rate
        assert np.diff(one.time).mean() == pytest.approx(1.0 / first.chain.rate)
    assert first.effects == ("viscous_friction",)
    rates = {hide_effect(s, "none", realistic=True).runs[0].sample_rate for s in range(8)}
    assert len(rates) > 2
    assert rates <= set(RATES)
    assert hide_effect(7, "viscous_friction").chain is None
    assert hide_unknown(7, "beating", realistic=True).chain is not None
