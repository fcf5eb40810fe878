"""Effects inside the device, hidden by the reference quarter-car, are named with their values."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from hidden_vehicles import S2, diagnose, reference_records
from inerter.reference import QuarterCar, ReferenceDevice

HIDDEN: dict[str, tuple[dict[str, Any], dict[str, tuple[float, float]]]] = {
    "coulomb_friction": (
        {"friction": "coulomb", "coulomb_force": 60.0},
        {"coulomb_force": (60.0, 0.01)},
    ),
    "hysteretic_friction": (
        {"friction": "dahl", "coulomb_force": 100.0, "bristle_stiffness": 1e5},
        {"coulomb_force": (100.0, 0.01), "bristle_stiffness": (1e5, 0.05)},
    ),
    "inertance_error": ({"inertance": 120.0}, {"inertance": (120.0, 0.005)}),
    "end_stop": (
        {"stop_upper": 0.003, "stop_stiffness": 5e5},
        {"stop_upper": (0.003, 0.01), "stop_stiffness": (5e5, 0.03)},
    ),
    "series_elasticity": (
        {"series_stiffness": 3e5, "series_damping": 500.0},
        {"series_stiffness": (3e5, 0.02), "series_damping": (500.0, 0.05)},
    ),
}


@pytest.mark.long
@pytest.mark.parametrize("effect", HIDDEN)
def test_effect_of_the_device_is_named(effect: str) -> None:
    values, parameters = HIDDEN[effect]
    device = ReferenceDevice(**{"inertance": S2.inertance, **values})
    found = diagnose(reference_records(QuarterCar(device=device)))
    assert found.findings[0].effect == effect
    for name, (true, share) in parameters.items():
        assert found.findings[0].parameters[name].value == pytest.approx(true, rel=share)
    assert found.extended.rmse < 1.2 * found.noise_floor < 0.014
    assert found.extended.rmse < 0.5 * found.baseline.rmse
    assert found.devices["strut"].given == found.extended.device


@pytest.mark.long
def test_a_first_drive_that_hardly_moves_hides_nothing() -> None:
    """Starting points come from the motion of all drives: from the first's none leads to a stop."""
    values, parameters = HIDDEN["end_stop"]
    car = QuarterCar(device=ReferenceDevice(inertance=S2.inertance, **values))
    idle = replace(reference_records(car, runs=1, seed=99, amplitude=1e-4)[0], name="idle")
    found = diagnose([idle, *reference_records(car)])
    assert [finding.effect for finding in found.findings] == ["end_stop"]
    for name, (true, share) in parameters.items():
        assert found.findings[0].parameters[name].value == pytest.approx(true, rel=share)
