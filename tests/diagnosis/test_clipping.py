"""A channel that clips nearly all of a force is none: what it shows is a constant."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.diagnose.clipping import begun_clipped, hides_nearly_all
from inerter.identify.model import Model
from inerter.identify.runs import thin
from inerter.records import Record
from inerter.records.preparation import prepare


def pressed(seed: int = 0) -> Record:
    """A rod with friction that a pressure pushes out by 200 N."""
    time = np.arange(0, 12, 1 / 200)
    random, turn = np.random.default_rng(seed), 2 * np.pi * np.array([[0.4], [0.9]])
    x = np.array([0.02, 0.008]) @ np.sin(turn * time)
    v = (np.array([0.02, 0.008]) * turn[:, 0]) @ np.cos(turn * time)
    return Record(
        name="rod", time=time, displacement=x + random.normal(0, 2e-6, time.size),
        force=200.0 + 10.0 * np.tanh(v / 1e-3) + 30.0 * v + random.normal(0, 0.1, time.size),
    )  # fmt: skip


def swung(peak: float, limit: float = np.inf) -> Record:
    """20 kg along a sine, the force cut off at a limit."""
    time = np.arange(0, 6, 1 / 250)
    omega = 2 * np.pi * 2.0
    force = -peak * np.sin(omega * time) + np.random.default_rng(2).normal(0, 0.3, time.size)
    return Record(
        name=f"{peak:g} N", time=time,
        displacement=peak / (20.0 * omega**2) * np.sin(omega * time),
        force=np.clip(np.round(force / 0.1) * 0.1, -limit, limit),
    )  # fmt: skip


def test_a_search_begins_at_limits_that_records_show() -> None:
    ideal = Model("none", {"inertance": 20.0}, ("inertance",))
    assert begun_clipped([swung(100.0), swung(50.0)], ideal) is None
    begun = begun_clipped([swung(50.0), swung(100.0, 80.0)], ideal)
    assert begun is not None
    assert begun.free == ("inertance", "force_maximum", "force_minimum")
    assert begun.values["force_maximum"] == pytest.approx(80.0, abs=1.0)
    assert begun.values["force_minimum"] == pytest.approx(-80.0, abs=1.0)
    # one that goes beyond has another range, and there is no limit of both
    assert begun_clipped([swung(100.0), swung(100.0, 80.0)], ideal) is None


@pytest.mark.parametrize(("lower", "expected"), [(150.0, False), (200.0, False), (215.0, True)])
def test_some_of_the_force_has_to_be_seen(lower: float, expected: bool) -> None:
    runs = [thin(motion) for motion in prepare([pressed()]).motions]
    known = {"inertance": 1e-6, "force_offset": 200.0, "viscous": 30.0, "coulomb_force": 10.0}
    model = Model("coulomb", {**known, "transition_velocity": 1e-3, "force_minimum": lower}, ())
    assert hides_nearly_all(model, runs) is expected
    assert not hides_nearly_all(model.without(("force_minimum",)), runs)


def test_a_large_constant_is_no_limit_of_the_channel(effects_seed: int) -> None:
    found = diagnose_bench([pressed(effects_seed)])
    named = {each.effect for each in found.findings}
    assert named == {"force_offset", "coulomb_friction", "viscous_friction"}
    assert found.parameters["force_offset"].value == pytest.approx(200.0, rel=0.005)
