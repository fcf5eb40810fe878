"""A force of the place that lies beyond the stops alone: it is what these do, not a second cause.

A bumper of two materials, or of foam, rises neither straight nor with the cube of its depth.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from inerter.catalogue.along_stroke import curves_of_nodes
from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.result import Finding, Rival
from inerter.identify.model import Model

# share of its largest force that a curve may have between the stops, and places that are asked
_NOTHING, _PLACES = 0.05, 200


def as_shape_of_stop(finding: Finding, model: Model) -> Finding:
    """A finding; one of a force of the place that is nothing between the stops says what it is."""
    curve = model.device().force_curve
    if finding.effect != "position_force" or not curve or "stop_stiffness" not in model.values:
        return finding
    low, high = (model.values[name] for name in ("curve_lower", "curve_upper"))
    place = np.linspace(low, high, _PLACES)
    force = np.abs(curves_of_nodes(low, high, len(curve))(place) @ np.array(curve))
    first, last = (
        model.values.get(name, end) for name, end in (("stop_lower", low), ("stop_upper", high))
    )
    # a smooth curve begins to bend before the stop
    bend = (high - low) / (len(curve) - 1)
    free = (place > first + bend) & (place < last - bend)
    if not free.any() or force[free].max() > _NOTHING * force.max():
        return finding
    share = finding.confidence / 2
    others = [rival for rival in finding.rivals if rival.effect != "end_stop"]
    stop = EFFECTS["end_stop"].plain
    evidence = (
        f"{finding.evidence} It acts beyond the stops alone: rather {stop} whose force rises in "
        "another way, as of two materials or foam."
    )
    return replace(
        finding, confidence=share, rivals=[Rival("end_stop", share), *others], evidence=evidence
    )
