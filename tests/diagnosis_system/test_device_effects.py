"""A drawn end stop of the device in drives of which one hardly moves."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hidden_vehicles import S2, diagnose, reference_records
from inerter.reference import QuarterCar, ReferenceDevice


@pytest.mark.long
def test_a_first_drive_that_hardly_moves_hides_nothing(effects_seed: int) -> None:
    """Starting points come from the motion of all drives: from the first's none leads to a stop."""
    draw = np.random.default_rng([effects_seed, 3])
    bare = QuarterCar(device=ReferenceDevice(inertance=S2.inertance))
    road = int(draw.integers(1, 10_000))
    travel = reference_records(bare, runs=1, seed=road)[0].channels()["suspension_travel"]
    true: dict[str, Any] = {
        "stop_upper": float(draw.uniform(0.3, 0.6) * np.max(travel)),
        "stop_stiffness": float(draw.uniform(3e5, 8e5)),
    }
    car = QuarterCar(device=ReferenceDevice(inertance=S2.inertance, **true))
    idle = replace(reference_records(car, runs=1, seed=road + 50, amplitude=1e-4)[0], name="idle")
    found = diagnose([idle, *reference_records(car, seed=road)])
    assert [(f.effect, f.law) for f in found.findings] == [("end_stop", "rebound")], effects_seed
    for name, value in true.items():
        measured = found.findings[0].parameters[name]
        share = 0.01 if name == "stop_upper" else 0.03
        assert abs(measured.value - value) < max(share * value, 4 * measured.stderr), effects_seed
    assert found.devices["strut"].given == found.extended.device
