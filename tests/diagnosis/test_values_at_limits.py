"""Values that a fit leaves at the end of their range are no measurement, and are told so."""

from __future__ import annotations

import json

import pytest
from inerter.catalogue.scales import Scales
from inerter.diagnose.result import ParameterValue, StatedValue
from inerter.diagnose.values import at_limits
from inerter.identify.model import Model

SIZES = Scales(force=50.0, displacement=0.02, velocity=0.2, acceleration=3.0, cutoff=40.0)


@pytest.mark.parametrize(
    ("sharpness", "ends"), [(64.0 - 1e-8, {"damping_sharpness"}), (63.0, set()), (2.0, set())]
)
def test_the_end_of_a_range_is_told(sharpness: float, ends: set[str]) -> None:
    values = {
        "inertance": 40.0, "viscous": 90.0, "damping_knee": 0.1, "damping_beyond": 0.2,
        "damping_sharpness": sharpness,
    }  # fmt: skip
    assert at_limits(Model("none", values, tuple(values)), SIZES) == ends
    # what is stated is where it is
    assert not at_limits(Model("none", values, ("inertance",)), SIZES)


def test_json_says_it_where_it_is() -> None:
    plain, ended = (ParameterValue(1.0, 0.1, "1", at_limit=end) for end in (False, True))
    assert plain.json() == {"value": 1.0, "stderr": 0.1, "unit": "1"}
    assert ended.json() == plain.json() | {"at_limit": True}
    assert json.dumps(StatedValue(1.0, 0.1, "1", 2.0).json())
