"""A law that contains a simpler one explains the data it is fitted to no worse."""

from __future__ import annotations

import numpy as np
import pytest
from inerter import Device
from inerter.identify.estimate import identify
from inerter.identify.turns import turned
from inerter.models import data_path
from inerter.records import Record, read_records


@pytest.fixture(scope="module")
def shipped() -> list[Record]:
    """Coulomb friction, with slow turns in which the velocity is within its noise."""
    return read_records([str(data_path("bench_record.csv"))], "bench")


def test_the_bias_of_noise_is_taken_out_only_where_it_is_known(shipped: list[Record]) -> None:
    """The shape of a hysteresis that is all but a jump hangs on nothing but noise."""
    result = identify(shipped, ["ideal", "bouc_wen"], intervals="normal", starts=16)
    errors = {each.law: each.fit_rmse for each in result.results}
    assert errors["bouc_wen"] < 0.2 * errors["ideal"]
    assert result.best.law == "bouc_wen"
    assert np.isclose(result.best.device.inertance, 113, rtol=0.01)


def made(friction: Device, rate: float = 250.0, duration: float = 12.0) -> Record:
    """Three sines along a device that rests nowhere; 0.3 N of noise on its force alone."""
    t = np.arange(0, duration, 1 / rate)
    x, v, a = np.zeros((3, t.size))
    for size, w in ((0.01, 4.0), (0.004, 11.0), (0.001, 29.0)):
        x += size * np.sin(w * t)
        v += size * w * np.cos(w * t)
        a -= size * w**2 * np.sin(w * t)
    noise = 0.3 * np.random.default_rng(1).standard_normal(t.size)
    force = friction.along(1 / rate, x, v, a)["total"] + noise
    return Record(name="bench", time=t, displacement=x, force=force)


def test_a_short_bristle_is_as_good_as_none() -> None:
    """Between two samples it turns with the motion, as Coulomb friction does with the velocity."""
    true = Device(inertance=113, viscous=40, friction="coulomb", coulomb_force=10)
    result = identify([made(true)], ["viscous", "coulomb", "dahl", "lugre"], intervals="normal")
    errors = {each.law: each.fit_rmse for each in result.results}
    # the shortest bristle searched for yields over 1e-5 of the motion, not over nothing
    assert errors["dahl"] < 3 * errors["coulomb"]
    assert errors["lugre"] < 1.5 * errors["coulomb"]
    assert errors["lugre"] < 1.02 * errors["dahl"]
    dahl = next(each for each in result.results if each.law == "dahl")
    assert abs(dahl.device.coulomb_force / 10 - 1) < 0.005
    assert abs(dahl.device.inertance / 113 - 1) < 0.002


def test_the_path_turns_where_the_motion_does() -> None:
    """Against sines at a phase that no sample meets; elsewhere nothing is moved."""
    h, w = 4e-3, 11.0
    t = h * np.arange(2000) + 0.37e-3
    x, v = np.sin(w * t), w * np.cos(w * t)
    path = turned(x, v, h)
    moved = np.flatnonzero(path != x)
    before = np.flatnonzero(np.diff(np.sign(v)))
    assert np.array_equal(moved, before)
    assert np.allclose(np.abs(path[moved]), 1.0, atol=(w * h) ** 4)
    # from there to the next sample the path has the new velocity's direction
    assert np.all(np.sign(path[moved + 1] - path[moved]) == np.sign(v[moved + 1]))
