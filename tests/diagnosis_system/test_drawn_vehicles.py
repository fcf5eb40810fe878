"""Effects, their sizes, vehicles and roads are drawn; the diagnosis has to name them."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.blind_test.vehicle import diagnose_vehicle, name_in_vehicle, vehicle_parameters
from inerter.reference import VEHICLE_EFFECTS, hide_in_vehicle

# what a gap changes is seen at a few contacts, what it is named as hangs on the drawn road
WEAK = ("backlash",)
# share of the true value within which a parameter has to be found, 6 standard errors apart
CLOSE = {"series_damping": 0.15, "bristle_stiffness": 0.15, "stop_stiffness": 0.1}
USUAL = 0.04


@pytest.mark.long
@pytest.mark.parametrize("effect", [e for e in VEHICLE_EFFECTS if e not in WEAK])
def test_a_drawn_effect_is_named(effect: str, effects_seed: int) -> None:
    law = "dahl" if effect == "hysteretic_friction" else None
    case = hide_in_vehicle(effects_seed, (effect,), law=law)
    found = diagnose_vehicle(case)
    where = f"seed {case.seed}, {case.stated.kind}"
    named = {name_in_vehicle(case, f): f for f in found.findings}
    said = {name for f in found.findings for name in (f.effect, *f.members)}
    assert effect in said, f"{where}: {found.verdict}"
    assert len(found.findings) == 1, f"{where}: {found.verdict}"
    if effect in named:
        for _, name, true, value, error in vehicle_parameters(case, found.findings):
            assert value is not None, f"{where}: {name}"
            near = max(CLOSE.get(name, USUAL) * abs(true), 6 * (error or 0.0))
            assert abs(value - true) < near, f"{where}: {name} {value} for {true}"
    assert found.extended.rmse < 1.3 * found.noise_floor, where
    # on road that it was not fitted to, and with the model as it is written
    assert found.engines["mujoco"] == pytest.approx(found.extended.rmse, rel=0.01), where
    if effect == "spring_hardening":
        # between the same two bodies: the records cannot know whose stiffness it is
        rivals = {rival.effect for rival in found.findings[0].rivals}
        assert "hardening_stiffness" in rivals, where


@pytest.mark.long
def test_nothing_is_named_in_a_drawn_vehicle_with_nothing_hidden(effects_seed: int) -> None:
    case = hide_in_vehicle(effects_seed)
    found = diagnose_vehicle(case)
    assert found.findings == [], f"seed {case.seed}: {found.verdict}"
    assert np.isfinite(found.extended.rmse)


def test_a_drawn_effect_of_a_quarter_car_is_named_quickly(effects_seed: int) -> None:
    case = hide_in_vehicle(effects_seed, ("tyre_damping",), vehicle="quarter")
    found = diagnose_vehicle(case)
    assert [f.effect for f in found.findings] == ["tyre_damping"], f"seed {case.seed}"
