"""A low-pass of a channel: closed forms, the differential equation, what is put back."""

from __future__ import annotations

import math

import numpy as np
import pytest
from inerter.identify.channel_filter import (
    KINDS,
    ORDERS,
    Filter,
    filter_of,
    filtered,
    named,
    read_filter,
    without_start,
)
from inerter.reference.bench_channel import Channel, low_passed

RATE = 1000.0
TIME = np.arange(4000) / RATE
SHAPES = [(kind, order) for kind in KINDS for order in ORDERS]


@pytest.mark.parametrize(("kind", "order"), SHAPES)
def test_half_of_the_power_passes_at_the_cutoff(kind: str, order: int) -> None:
    each = Filter(kind, order, 30.0)
    low, at, high = abs(each.response(np.array([0.0, 30.0, 3e5])))
    assert low == pytest.approx(1.0)
    assert at == pytest.approx(1 / math.sqrt(2))
    # far above, a factor of ten is one of ten to the order
    assert abs(each.response(np.array([3e6])))[0] == pytest.approx(high * 10.0**-order, rel=1e-3)


def test_butterworth_is_flat_and_bessel_evenly_late() -> None:
    """Closed forms: |H|^2 = 1 / (1 + (f / f_c)^2n); the lateness of a Bessel filter stays."""
    f = np.linspace(0.1, 60, 50)
    for order in ORDERS:
        power = np.abs(Filter("butterworth", order, 20.0).response(f)) ** 2
        np.testing.assert_allclose(power, 1 / (1 + (f / 20) ** (2 * order)), rtol=1e-12)
    each = Filter("bessel", 4, 20.0)
    slow = np.linspace(0.1, 12, 50)
    phase = np.unwrap(np.angle(each.response(slow)))
    np.testing.assert_allclose(-phase / (2 * np.pi * slow), each.lateness, rtol=5e-3)


@pytest.mark.parametrize(("kind", "order"), SHAPES)
def test_as_late_as_a_delay(kind: str, order: int) -> None:
    each = Filter.as_late_as(4e-3, kind, order)
    assert (each.kind, each.order) == (kind, order)
    assert each.lateness == pytest.approx(4e-3, rel=1e-12)


@pytest.mark.parametrize(("kind", "order"), SHAPES)
def test_a_sine_is_smaller_and_later(kind: str, order: int) -> None:
    each = Filter(kind, order, 15.0)
    gain = complex(each.response(np.array([9.0]))[0])
    found = filtered(np.sin(2 * np.pi * 9 * TIME + 0.4), 1 / RATE, each)
    expected = abs(gain) * np.sin(2 * np.pi * 9 * TIME + 0.4 + np.angle(gain))
    inner = slice(600, -600)
    np.testing.assert_allclose(found[inner], expected[inner], atol=2e-3)


def test_a_ramp_is_only_late() -> None:
    each = Filter("bessel", 3, 10.0)
    found = filtered(2.0 + 3.0 * TIME, 1 / RATE, each)
    np.testing.assert_allclose(found, 2.0 + 3.0 * (TIME - each.lateness), atol=1e-10)


@pytest.mark.parametrize(("kind", "order"), SHAPES)
def test_it_is_the_differential_equation_of_the_reference(kind: str, order: int) -> None:
    random = np.random.default_rng(2)
    tones = [a * np.sin(2 * np.pi * f * TIME + p) for f, a, p in random.uniform(0.3, 9, (5, 3))]
    force = np.sum(tones, axis=0)
    channel = Channel(
        force_filter=12.0, force_filter_order=order, force_filter_bessel=float(kind == "bessel")
    )
    found = filtered(force, 1 / RATE, Filter(kind, order, 12.0))
    inner = slice(800, -400)
    expected = low_passed(channel, TIME, force)
    np.testing.assert_allclose(found[inner], expected[inner], atol=5e-3 * np.ptp(force))


def test_what_was_taken_is_put_back_as_far_as_it_is_known() -> None:
    each = Filter("butterworth", 2, 20.0)
    wave = np.sin(2 * np.pi * 5 * TIME) + 0.3 * np.sin(2 * np.pi * 17 * TIME)
    back = filtered(filtered(wave, 1 / RATE, each), 1 / RATE, each, inverse=True)
    inner = slice(300, -300)
    np.testing.assert_allclose(back[inner], wave[inner], atol=2e-3)
    # of what has passed as good as nothing, no more than ten times is made
    fast = np.sin(2 * np.pi * 400 * TIME)
    made = filtered(fast, 1 / RATE, each, inverse=True)
    assert np.abs(made[inner]).max() < 10.5


@pytest.mark.parametrize(
    ("text", "kind", "order", "cutoff"),
    [
        ("bessel:50", "bessel", 4, 50.0),
        ("Bessel:50 Hz:2", "bessel", 2, 50.0),
        ("butter:1e2:3", "butterworth", 3, 100.0),
    ],
)
def test_filters_are_stated(text: str, kind: str, order: int, cutoff: float) -> None:
    found = read_filter(text, "--filter force")
    assert (found.kind, found.order, found.cutoff) == (kind, order, cutoff)
    assert read_filter(found.text, "again") == found
    assert filter_of(named("force", found), "force") == found
    assert filter_of(named("force", found), "displacement") is None


@pytest.mark.parametrize(
    "text", ["", "bessel", "bessel:0", "b:50", "sinc:50", "bessel:50:9", "bessel:x", "bessel:nan"]
)
def test_what_is_no_filter_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"--filter force is .* such as bessel:50"):
        read_filter(text, "--filter force")


@pytest.mark.parametrize(("kind", "order"), SHAPES)
def test_what_a_filter_held_before_a_run_is_read_off_it(kind: str, order: int) -> None:
    """Two pasts of one force differ by free responses alone, which leave nothing."""
    random = np.random.default_rng(4)
    each = Filter(kind, order, 12.0)
    channel = Channel(
        force_filter=12.0, force_filter_order=order, force_filter_bessel=float(kind == "bessel")
    )
    first = 700
    wave = np.sin(2 * np.pi * 2.3 * TIME) + random.normal()
    other = np.where(TIME[first] > TIME, 3.0, wave)
    apart = low_passed(channel, TIME, other) - low_passed(channel, TIME, wave)
    mask = np.arange(TIME.size) >= first
    left = without_start(apart, 1 / RATE, mask, each, first)
    assert np.abs(apart[mask]).max() > 0.5
    assert np.abs(left[mask]).max() < 0.02 * np.abs(apart[mask]).max()
    # and nothing else is taken
    np.testing.assert_array_equal(left[first + 1500 :], apart[first + 1500 :])
    # where its beginning is left out, the whole beginning tells it
    late = mask & (np.arange(TIME.size) >= first + 1000)
    told = without_start(apart, 1 / RATE, late, each, first)
    assert np.abs(told[mask]).max() < 0.02 * np.abs(apart[mask]).max()


@pytest.mark.parametrize(("kind", "order"), SHAPES)
@pytest.mark.parametrize("share", [0.3, 0.5, 0.9])
def test_a_fold_without_the_beginning_is_not_carried_away(
    kind: str, order: int, share: float
) -> None:
    """What noise leaves of the end of a free response says nothing of how it began."""
    each, first, random = Filter(kind, order, 12.0), 700, np.random.default_rng(4)
    noise = random.normal(size=TIME.size)
    memory = round(8.0 * each.lateness * RATE)
    mask = np.arange(TIME.size) >= first + round(share * memory)
    left = without_start(noise, 1 / RATE, mask, each, first)
    assert np.std(left[first:]) < 1.05 * np.std(noise[first:])
    assert np.abs(left[first:]).max() < 1.5 * np.abs(noise[first:]).max()
