"""A law that contains a simpler one explains the data it is fitted to no worse."""

from __future__ import annotations

import io

import numpy as np
import pytest
from inerter import Device
from inerter.identify.estimate import identify, prepared
from inerter.identify.fit import rms
from inerter.identify.laws import law_named
from inerter.identify.multistart import search
from inerter.identify.nested import contains, embedded
from inerter.identify.output import left_open, print_identification
from inerter.identify.result import Estimate, Identification
from inerter.identify.turns import turned
from inerter.models import data_path
from inerter.records import Record, read_records
from inerter.records.preparation import prepare
from rich.console import Console


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


@pytest.mark.parametrize(
    ("law", "other", "strictly", "nearly"),
    [
        ("viscous", "ideal", True, True),
        ("stribeck", "coulomb", True, True),
        ("lugre", "dahl", True, True),
        ("bouc_wen", "dahl", True, True),
        ("bouc_wen_any+stiffness", "dahl", True, True),
        ("dahl+play+offset", "dahl", True, True),
        ("dahl", "coulomb", False, True),
        ("lugre+offset", "coulomb+offset", False, True),
        ("coulomb", "dahl", False, False),
        ("bouc_wen", "lugre", False, False),
        ("dahl", "dahl+offset", False, False),
        ("dahl+series", "dahl", False, False),
        ("bouc_wen_any", "bouc_wen", False, False),
        ("dahl", "dahl", False, False),
    ],
)
def test_which_law_is_within_which(law: str, other: str, strictly: bool, nearly: bool) -> None:
    pair = law_named(law), law_named(other)
    assert contains(*pair) == strictly
    assert contains(*pair, limits=True) == nearly


@pytest.mark.parametrize(
    ("law", "other"),
    [
        ("viscous", "ideal"), ("coulomb", "viscous"), ("stribeck", "coulomb"), ("lugre", "dahl"),
        ("bouc_wen", "dahl"), ("bouc_wen_any", "dahl"), ("dahl+offset", "dahl"),
        ("lugre", "viscous"), ("bouc_wen", "viscous"), ("dahl+play", "dahl"),
    ],
)  # fmt: skip
def test_a_law_says_what_one_within_it_says(law: str, other: str) -> None:
    true = Device(inertance=113, viscous=40, friction="dahl", coulomb_force=10,
                  bristle_stiffness=1e4)  # fmt: skip
    data = prepared([made(true)], prepare([made(true)]), (), {})._problem()
    inner = search(data, law_named(other), {}, starts=4).best
    outer = search(data, law_named(law), {}, starts=2).best.model
    (found, *_) = embedded(outer, [inner.model], data.scales)
    assert found.free == outer.free
    error = rms(data.residual(found), data.masks)
    # a bound is near 0, not 0
    assert error == pytest.approx(inner.rmse(data.masks), rel=2e-3)


@pytest.mark.parametrize(("law", "simple"), [("bouc_wen", "dahl"), ("lugre", "dahl")])
def test_bad_starts_do_not_leave_a_law_behind_a_simpler_one(
    law: str, simple: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A search that stops at once leaves the law far off, unless a simpler law shows the way."""
    true = Device(inertance=113, friction=simple, coulomb_force=10, bristle_stiffness=1e5)
    data = prepared([made(true)], prepare([made(true)]), (), {})._problem()
    inner = search(data, law_named(simple), {}).best
    for name in ("_ROUGH", "_THOROUGH"):
        monkeypatch.setattr(f"inerter.identify.multistart.{name}", 2)
    left = search(data, law_named(law), {}, starts=1).best
    shown = search(data, law_named(law), {}, starts=1, simpler=[inner.model]).best
    assert left.rmse(data.masks) > 1.2 * inner.rmse(data.masks)
    assert shown.rmse(data.masks) < 1.0001 * inner.rmse(data.masks)


def test_a_fit_that_has_not_converged_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    true = Device(inertance=113, friction="dahl", coulomb_force=10, bristle_stiffness=1e4)
    for name in ("_ROUGH", "_THOROUGH"):
        monkeypatch.setattr(f"inerter.identify.multistart.{name}", 1)
    monkeypatch.setattr("inerter.identify.law_fit._EVALUATIONS", 1)
    result = identify([made(true)], ["bouc_wen"], intervals="normal", starts=2)
    assert not result.best.converged
    assert result.json()["results"][0]["converged"] is False
    text = printed(result)
    assert "bouc_wen (not converged)" in text
    assert "the fit of bouc_wen has not converged" in text


def test_a_law_behind_a_simpler_one_says_so(shipped: list[Record]) -> None:
    """In the slow turns Coulomb friction goes with the speed, a bristle does not."""
    result = identify(shipped, ["coulomb", "dahl"], intervals="normal")
    dahl = next(each for each in result.results if each.law == "dahl")
    assert dahl.worse_than == ("coulomb",)
    assert dahl.converged
    assert result.json()["results"][1]["worse_than"] == ["coulomb"]
    assert "dahl explains the fitted data less well than coulomb" in printed(result)


def test_a_parameter_as_good_as_nothing_has_an_upper_end(shipped: list[Record]) -> None:
    """The device has no viscous damping: one name is not told apart from any other."""
    result = identify(shipped, ["coulomb"])
    viscous = result.best.parameters["viscous"]
    assert result.best.undetermined == (("viscous",),)
    assert viscous.low is None
    assert viscous.high is not None
    assert viscous.stderr < viscous.high < 6 * viscous.stderr
    text = printed(result)
    assert f"These data do not determine viscous, only that it is below {viscous.high:.3g}" in text
    assert "cannot tell apart" not in text


def test_one_parameter_is_not_determined_and_several_are_not_told_apart() -> None:
    known = Estimate(3.0, 2.0, None, None, "N")
    above = Estimate(3.0, 2.0, 1.25, None, "1")
    assert left_open(("a", "b"), {"a": known}) == "These data cannot tell apart: a, b."
    assert left_open(("a",), {"a": known}) == "These data do not determine a."
    assert left_open(("a",), {}) == "These data do not determine a."
    assert left_open(("a",), {"a": above}).endswith("determine a, only that it is above 1.25.")


def printed(result: Identification) -> str:
    """What the terminal shows, in one line."""
    out = Console(file=io.StringIO(), width=200)
    print_identification(result, out)
    assert isinstance(out.file, io.StringIO)
    return " ".join(out.file.getvalue().split())
