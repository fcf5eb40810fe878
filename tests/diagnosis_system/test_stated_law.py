"""A friction law that a vehicle's device states is contradicted as a whole, defaults included."""

from __future__ import annotations

from typing import Any

import pytest
from inerter.diagnose.vehicle.build import model_of_text
from inerter.diagnose.vehicle.candidate import Scale
from inerter.diagnose.vehicle.effects import Effects
from inerter.diagnose.vehicle.model import VehicleModel
from inerter.models import model_path

STATED: dict[str, tuple[dict[str, Any], set[str]]] = {
    "dahl": ({"coulomb_force": 50.0}, {"coulomb_force", "presliding"}),
    "lugre": (
        {"coulomb_force": 50.0, "bristle_stiffness": 2e4},
        {
            "coulomb_force", "static_excess", "stribeck_velocity", "presliding", "bristle_damping",
        },
    ),
    "brown_mcphee": (
        {"coulomb_force": 50.0}, {"coulomb_force", "static_excess", "stribeck_velocity"},
    ),
    "bouc_wen": (
        {"bw_stiffness": 2e4}, {"bw_stiffness", "bw_beta", "bw_gamma", "bw_exponent", "bw_ratio"},
    ),
}  # fmt: skip
SCALE = Scale(
    force=500.0, x=5e-3, v=0.1, a=5.0, largest=0.02, smallest=-0.02, step=1e-3, explicit=True
)


@pytest.mark.parametrize("law", STATED)
def test_every_parameter_of_a_stated_law_is_set_free(law: str) -> None:
    keys, wanted = STATED[law]
    config = "".join(f'<config key="{k}" value="{v!r}"/>' for k, v in keys.items())
    path = model_path("quarter_car", "model.xml")
    rest = '<config key="rest_length"'
    text = path.read_text(encoding="utf-8")
    text = text.replace(rest, f'<config key="friction" value="{law}"/>{config}{rest}')
    if law != "brown_mcphee":
        text = text.replace('tendon="strut"/>', 'tendon="strut" actdim="1"/>')
    user = model_of_text(text, path)
    user.with_roads([user.model.actuator("road").id])
    effects = Effects(user, {"strut": SCALE})
    found = [
        candidate
        for candidate in effects.candidates(VehicleModel())
        if candidate.friction == law and candidate.added.element == "strut"
    ]
    (candidate,) = found
    free = {name.removeprefix("strut.") for name in candidate.added.coordinates}
    assert free == wanted
    # each of its starts is a model that the engine takes
    for start in candidate.starts:
        user.compile(candidate.model(VehicleModel(), start))
