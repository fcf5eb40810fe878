"""Effects, their sizes, vehicles and roads are drawn; the diagnosis has to name them."""

from __future__ import annotations

import numpy as np
import pytest
from drawn_vehicles import OF_DEVICE, OF_VEHICLE, draw

# share of the true value within which a parameter has to be found
CLOSE = {"series_damping": 0.15, "bristle_stiffness": 0.15, "stop_stiffness": 0.1}
USUAL = 0.04


@pytest.mark.long
@pytest.mark.parametrize("effect", [*OF_VEHICLE, *OF_DEVICE])
def test_a_drawn_effect_is_named(effect: str, effects_seed: int) -> None:
    case = draw(effects_seed, effect)
    found = case.diagnose()
    named = [finding.effect for finding in found.findings]
    assert named[:1] == [effect], f"seed {case.seed}: {found.verdict}"
    parameters = found.findings[0].parameters
    assert case.parameters.keys() <= parameters.keys(), f"seed {case.seed}"
    for name, true in case.parameters.items():
        share = abs(parameters[name].value / true - 1)
        assert share < CLOSE.get(name, USUAL), f"seed {case.seed}: {name}"
    assert found.extended.rmse < 0.7 * found.baseline.rmse, f"seed {case.seed}"
    # on road that it was not fitted to, and with the model as it is written
    assert found.engines["mujoco"] == pytest.approx(found.extended.rmse, rel=0.01)
    if effect in OF_VEHICLE:
        assert found.extended.rmse < 1.1 * found.noise_floor, f"seed {case.seed}"
        assert not found.unexplained.significant, f"seed {case.seed}"
    if effect == "spring_hardening":
        # between the same two bodies: the records cannot know whose stiffness it is
        rivals = {rival.effect for rival in found.findings[0].rivals}
        assert "hardening_stiffness" in rivals, f"seed {case.seed}"


@pytest.mark.long
def test_nothing_is_named_in_a_drawn_vehicle_with_nothing_hidden(effects_seed: int) -> None:
    case = draw(effects_seed, "none")
    found = case.diagnose()
    assert found.findings == [], f"seed {case.seed}: {found.verdict}"
    assert np.isfinite(found.extended.rmse)
