"""A channel that clips nearly all of a force is none: what it shows is a constant."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.diagnose.clipping import hides_nearly_all
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
