"""Effects that act in few places, which the run held out may not reach."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.catalogue.scales import Scales
from inerter.core import Device
from inerter.diagnose import Diagnosis, diagnose_bench
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import without_effect
from inerter.identify.model import Model
from inerter.records import Record

RATE = 500.0
DEVICE = Device(inertance=80.0, viscous=60.0, stop_upper=0.016, stop_stiffness=4e5,
                stop_damping=0.2)  # fmt: skip


RUBBER = DEVICE.replace(stop_lower=-0.017, stop_stiffness=3e4, stop_stiffness_cubic=3e9)


def record(name: str, amplitude: float, seed: int, device: Device = DEVICE) -> Record:
    random = np.random.default_rng(seed)
    t = np.arange(0, 10, 1 / RATE)
    x, v, a = np.zeros((3, t.size))
    for rate in random.uniform(3, 15, 5):
        phase, size = random.uniform(0, 2 * np.pi), amplitude / 5
        x += size * np.cos(rate * t + phase)
        v -= size * rate * np.sin(rate * t + phase)
        a -= size * rate**2 * np.cos(rate * t + phase)
    force = device.evaluate(x, v, a, 0.0)["total"] + 0.3 * random.standard_normal(t.size)
    return Record(name=name, time=t, displacement=x + 1e-6 * random.standard_normal(t.size),
                  force=force)  # fmt: skip


@pytest.fixture(scope="module")
def diagnosis() -> Diagnosis:
    sizes = {"small": 0.010, "large": 0.026, "middle": 0.012}
    runs = [record(name, size, seed) for seed, (name, size) in enumerate(sizes.items())]
    return diagnose_bench(runs, Device(inertance=80.0, viscous=60.0), holdout=["middle"])


@pytest.mark.long
def test_a_stop_that_one_run_alone_reaches_is_found(diagnosis: Diagnosis) -> None:
    assert [finding.effect for finding in diagnosis.findings] == ["end_stop"], diagnosis.verdict
    stop = diagnosis.findings[0].parameters
    assert stop["stop_upper"].value == pytest.approx(0.016, abs=1e-4)
    assert stop["stop_stiffness"].value == pytest.approx(4e5, rel=0.1)


@pytest.mark.long
def test_its_gain_is_that_on_blocks_left_out(diagnosis: Diagnosis) -> None:
    """As the run held out says nothing of it, which the finding tells."""
    stop = diagnosis.findings[0]
    assert stop.seen_in_blocks
    assert stop.rmse_after < 0.3 * stop.rmse_before
    assert "what is held out does not reach it" in stop.evidence
    # on the run held out both models say the same
    assert diagnosis.extended.rmse == pytest.approx(diagnosis.baseline.rmse, rel=1e-3)


@pytest.mark.long
def test_stops_of_rubber_are_measured() -> None:
    sizes = {"first": 0.032, "second": 0.036, "third": 0.034}
    runs = [record(name, size, seed, RUBBER) for seed, (name, size) in enumerate(sizes.items())]
    found = diagnose_bench(runs, Device(inertance=80.0, viscous=60.0))
    assert [finding.effect for finding in found.findings] == ["end_stop"], found.verdict
    stop = found.findings[0].parameters
    for name, value in stop.items():
        assert value.value == pytest.approx(getattr(RUBBER, name), rel=0.02), name


BARE = Model("none", {"inertance": 80.0, "transition_velocity": 1e-3}, ("inertance",))


def begun(**stops: float) -> dict[str | None, set[str]]:
    """What the forms of a stop that are tried beside some stops set free."""
    model = BARE.adding(None, **stops)
    sizes = Scales(
        force=100.0, displacement=0.01, velocity=0.1, acceleration=1.0, travel=(-0.02, 0.02)
    )
    tried = [each for each in candidates(model, sizes) if each.effect == "end_stop"]
    return {each.law: set(each.starts[0].free) - set(model.free) for each in tried}


def test_beside_a_stop_the_other_end_and_rubber_are_tried() -> None:
    assert set(begun()) == {"upper", "lower", "both"}
    upper = {"stop_upper": 0.015, "stop_stiffness": 1e4, "stop_damping": 0.0}
    assert begun(**upper) == {
        "stop_lower": {"stop_lower"}, "rubber": {"stop_stiffness_cubic"}
    }  # fmt: skip
    assert set(begun(**upper, stop_lower=-0.015)) == {"rubber"}
    assert not begun(**upper, stop_lower=-0.015, stop_stiffness_cubic=1e7)
    # that nothing reaches says nothing of its rubber
    assert set(begun(**upper | {"stop_upper": 0.02})) == {"stop_lower"}


def test_of_two_stops_one_may_be_needless_and_the_rubber_too() -> None:
    stops = {"stop_upper": 0.01, "stop_stiffness": 1e4, "stop_damping": 0.0}
    both = BARE.adding(None, **stops, stop_lower=-0.01, stop_stiffness_cubic=1e7)
    less = [set(each.free) for each in without_effect(both, "end_stop", BARE)]
    for name in ("stop_upper", "stop_lower", "stop_stiffness_cubic"):
        assert set(both.free) - {name} in less
    assert set(BARE.free) in less
    one = BARE.adding(None, **stops)
    assert [set(each.free) for each in without_effect(one, "end_stop", BARE)] == [set(BARE.free)]
