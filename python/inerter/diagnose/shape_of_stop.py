"""What changes along the stroke beyond the stops alone: it is what these do, not a second cause.

A bumper of two materials, or of foam, rises neither straight nor with the cube of its depth, and
one that is damped as oil is damps otherwise than a stop does.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from inerter.catalogue.along_stroke import QUANTITIES, curves_of_nodes
from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.result import Finding, Rival
from inerter.identify.model import Model

# share of its largest value that a curve may have between the stops, and places that are asked
_NOTHING, _PLACES = 0.05, 200


def as_shape_of_stop(finding: Finding, model: Model) -> Finding:
    """A finding; one of curves that are nothing between the stops says what it is."""
    if "stop_stiffness" not in model.values or not _is_beyond_the_stops(finding.effect, model):
        return finding
    share = finding.confidence / 2
    others = [rival for rival in finding.rivals if rival.effect != "end_stop"]
    stop = EFFECTS["end_stop"].plain
    told = replace(finding, confidence=share, rivals=[Rival("end_stop", share), *others])
    return told.remarked(
        f"It acts beyond the stops alone: rather {stop} whose force rises in another way, as of "
        "two materials or foam."
    )


def _is_beyond_the_stops(effect: str, model: Model) -> bool:
    """Whether all curves by which a model has an effect are nothing where no stop is touched."""
    quantity = next((each for each in QUANTITIES if each.effect == effect), None)
    if quantity is None or quantity.form(set(model.free)) not in ("curve", "flanks"):
        return False
    low, high = (model.values[name] for name in ("curve_lower", "curve_upper"))
    place = np.linspace(low, high, _PLACES)
    first, last = (
        model.values.get(name, end) for name, end in (("stop_lower", low), ("stop_upper", high))
    )
    free, beyond = [0.0], [0.0]
    for names in (quantity.nodes, quantity.back_nodes):
        nodes = [model.values[name] for name in names if name in model.values]
        if not nodes:
            continue
        curve = np.abs(curves_of_nodes(low, high, len(nodes))(place) @ np.array(nodes))
        # a smooth curve begins to bend before the stop
        bend = (high - low) / (len(nodes) - 1)
        between = (place > first + bend) & (place < last - bend)
        if not between.any():
            return False
        free.append(float(curve[between].max()))
        beyond.append(float(curve.max()))
    return max(free) <= _NOTHING * max(beyond)
