"""Where a search begins with end stops."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from inerter.catalogue.effect import Effect
from inerter.catalogue.scales import Scales
from inerter.diagnose.candidate import Candidate
from inerter.identify.model import Model


def end_stops(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Stops at one end or both; where there is one that at the other end, and rubber that stiffens.

    Both ends have one stiffness.
    """
    if not np.isfinite(sizes.travel).all():
        return
    low, high = sizes.travel
    share = 0.5 * (high - low)
    deep = (0.03, 0.12, 0.3, 0.6)
    lower = [{"stop_lower": low + depth * share} for depth in deep]
    upper = [{"stop_upper": high - depth * share} for depth in deep]
    if "stop_stiffness" in model.values:
        for name, places in (("stop_lower", lower), ("stop_upper", upper)):
            if name not in model.values:
                starts = tuple(model.adding(None, **place) for place in places)
                yield Candidate(effect.name, name, starts)
        yield from _rubber(effect, model, low, high)
        return
    contact = {
        "stop_stiffness": 5 * sizes.force / sizes.displacement,
        "stop_damping": 0.1 / sizes.velocity,
    }
    both = [one | other for one, other in zip(lower, upper, strict=True)]
    for form, places in (("upper", upper), ("lower", lower), ("both", both)):
        starts = tuple(model.adding(None, **place, **contact) for place in places)
        yield Candidate(effect.name, form, starts)


def _rubber(effect: Effect, model: Model, low: float, high: float) -> Iterator[Candidate]:
    """From a stop that does not stiffen, and from one that mostly does."""
    deepest = max(
        model.values.get("stop_lower", low) - low, high - model.values.get("stop_upper", high)
    )
    if "stop_stiffness_cubic" in model.values or deepest <= 0.0:
        return
    stiffness = model.values["stop_stiffness"]
    softer = {"stop_stiffness": 0.2 * stiffness, "stop_stiffness_cubic": stiffness / deepest**2}
    starts = (model.adding(None, stop_stiffness_cubic=0.0), model.adding(None, **softer))
    yield Candidate(effect.name, "rubber", starts)
