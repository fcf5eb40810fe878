"""On which side of a shaft friction acts: at the terminals, or on the flywheel behind it.

There it holds the flywheel and sets it swinging. A whole device that stands on a base or in a frame
that gives is the same: all its friction is behind that spring.
"""

from __future__ import annotations

from dataclasses import replace

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.result import Finding
from inerter.identify.model import Model

SIDE = "friction_side"
"""What a device states of it."""


def on_the_other_side(model: Model, baseline: Model) -> list[Model]:
    """The model with its friction on the other side of its shaft, if it has both.

    Where the user states the side it stays. A level that drifts is known at the terminals alone:
    what its change does to the flywheel is not the change of its force.
    """
    drifts, stated = "friction_drift" in model.values, SIDE in baseline.texts
    if stated or drifts or model.friction == "none" or not model.has_series:
        return []
    side = "terminals" if model.rubs_behind else "flywheel"
    return [replace(model, texts={**model.texts, SIDE: side})]


def with_side(finding: Finding, model: Model) -> Finding:
    """A finding of friction, or of a shaft, that says where the friction acts behind the shaft."""
    if not model.rubs_behind:
        return finding
    if EFFECTS[finding.effect].kind in ("law", "level"):
        text = "It acts behind the elasticity, on the flywheel."
    elif EFFECTS[finding.effect].kind == "shaft":
        text = (
            "The friction acts behind it: a shaft with friction in the bearings of its flywheel, "
            "or a base or a frame that gives under the whole device."
        )
    else:
        return finding
    return finding.remarked(text)
