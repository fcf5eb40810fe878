"""A curve of the place that is nothing between two stops is what the stops do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose.result import Finding, Rival
from inerter.diagnose.shape_of_stop import as_shape_of_stop
from inerter.identify.model import Model

NODES = 17
PLACES = np.linspace(-0.02, 0.02, NODES)
FINDING = Finding(
    effect="position_force", law="curve", confidence=0.98, parameters={}, rmse_before=5.0,
    rmse_after=1.0, evidence="It takes 80 %.", rivals=[Rival("gas_spring", 0.01)],
)  # fmt: skip


def model(force: np.ndarray, **stops: float) -> Model:
    nodes = {f"force_node_{i + 1}": float(each) for i, each in enumerate(force)}
    bare = Model("none", {"inertance": 80.0}, ("inertance",))
    drawn = bare.holding(curve_lower=-0.02, curve_upper=0.02).adding(None, **nodes)
    return drawn.adding(None, **stops) if stops else drawn


BEYOND = 400.0 * np.sign(PLACES) * (np.abs(PLACES) > 0.013)
BOTH = {"stop_lower": -0.013, "stop_upper": 0.013, "stop_stiffness": 1e5, "stop_damping": 0.0}


def test_it_is_told_as_the_shape_of_the_stops() -> None:
    told = as_shape_of_stop(FINDING, model(BEYOND, **BOTH))
    assert told.confidence == pytest.approx(0.49)
    assert [rival.effect for rival in told.rivals] == ["end_stop", "gas_spring"]
    assert told.evidence.startswith("It takes 80 %. It acts beyond the stops alone")


@pytest.mark.parametrize(
    ("force", "stops"),
    [
        # without stops it is all there is
        (BEYOND, {}),
        # cogging between the stops, or a force before the only one
        (BEYOND + 40.0 * np.sin(600.0 * PLACES), BOTH),
        (BEYOND, {name: value for name, value in BOTH.items() if name != "stop_lower"}),
    ],
)
def test_another_force_of_the_place_stays(force: np.ndarray, stops: dict[str, float]) -> None:
    assert as_shape_of_stop(FINDING, model(force, **stops)) == FINDING


@pytest.mark.parametrize("between", [0.0, 0.02])
def test_a_ratio_that_changes_beyond_a_stop_alone_is_the_stop(between: float) -> None:
    """In both directions, as of a bumper that damps as oil does."""
    ratio = {
        f"inertance{back}_node_{i + 1}": size * float(place > 0.013) + between * np.sin(900 * place)
        for back, size in (("", 0.15), ("_back", -0.2))
        for i, place in enumerate(PLACES)
    }
    bare = Model("none", {"inertance": 80.0}, ("inertance",))
    drawn = bare.holding(curve_lower=-0.02, curve_upper=0.02).adding(None, **ratio)
    upper = {name: value for name, value in BOTH.items() if name != "stop_lower"}
    finding = replace(FINDING, effect="variable_inertance", law="flanks")
    told = as_shape_of_stop(finding, drawn.adding(None, **upper))
    assert (told.rivals[0].effect == "end_stop") is (between == 0.0)
    assert (told == finding) is (between > 0.0)


def test_other_findings_stay() -> None:
    other = replace(FINDING, effect="coulomb_friction", law=None)
    assert as_shape_of_stop(other, model(BEYOND, **BOTH)) == other


def test_a_member_is_no_rival_besides() -> None:
    rivals = [Rival("end_stop", 0.4), Rival("gas_spring", 0.1)]
    both = replace(FINDING, members=("position_force", "end_stop"), rivals=rivals)
    assert [rival.effect for rival in both.other_rivals] == ["gas_spring"]
    assert replace(both, members=()).other_rivals == rivals
