"""A design under variations of payload, tyres, speed and its own parts: the worst, the mean.

The design stays as it is on the planned car and road; each variation is simulated on roads of the
same seeds. The interval of the mean is the mean of the intervals: deviations of one road may all
point the same way, so it can be too wide but not too narrow.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from inerter.suspension.time_domain.design import Design, both
from inerter.suspension.time_domain.linear import spectrum
from inerter.suspension.time_domain.piece import Piece
from inerter.suspension.time_domain.road import road_named
from inerter.suspension.variations import Scene, scenes_of


@dataclass(frozen=True)
class Varied:
    """An index under a variation, "as planned" or as in "body_mass x 1.3"; SI units.

    `value` with its 95 % interval; `linear`, exact without friction and play, None where there is
    none.
    """

    name: str
    value: float
    low: float
    high: float
    linear: float | None


def varied_pieces(piece: Piece, design: Design) -> list[tuple[str, Piece]]:
    """A piece for each variation of its plan, with its name; the design stays as it is.

    Raises
    ------
    ValueError
        Too many combinations.
    """
    plan = piece.plan
    found = []
    for scene in scenes_of(plan.car, spectrum(plan.road), dict(plan.vary)):
        road = plan.road
        if scene.road.velocity != road.speed:
            road = road_named(road.name, scene.road.velocity)
        # the design is chosen, nothing is given or sought
        changed = replace(plan, car=scene.car, road=road, vary=(), reoptimise=False)
        own = replace(piece, plan=changed, design=_off(design, scene))
        found.append((scene.name, own))
    return found


def _off(design: Design, scene: Scene) -> Design:
    """A design whose parts are off by the factors of a scene."""
    factors = dict(scene.factors)
    struts = []
    for strut in design.struts:
        values: dict[str, Any] = {
            name: getattr(strut, name) * factor
            for name, factor in factors.items()
            if getattr(strut, name) is not None
        }
        struts.append(replace(strut, rear=None, **values))
    return both(struts)


def summary(nominal: float, varied: Sequence[Varied]) -> Mapping[str, Any]:
    """`nominal`, `mean` with its interval, root mean square, and the best and worst variation."""
    best, worst = (pick(varied, key=lambda each: each.value) for pick in (min, max))
    values = [each.value for each in varied]
    return {
        "nominal": nominal,
        "mean": float(np.mean(values)),
        "mean_low": float(np.mean([each.low for each in varied])),
        "mean_high": float(np.mean([each.high for each in varied])),
        "root_mean_square": float(np.sqrt(np.mean(np.square(values)))),
        "best": best.value,
        "best_when": best.name,
        "worst": worst.value,
        "worst_low": worst.low,
        "worst_high": worst.high,
        "worst_when": worst.name,
    }
