"""A leak past the inertance, or a low-pass of the force: where nothing stands beside, they are one.

Of a device that is an inertance alone a laminar leak shows b a behind a low-pass of the first order
with the leak's corner, and with a spring before it (oil that is compressed) one of the second:

    F = b a / (1 + s b / c_l + s^2 b / k)

What else acts between the terminals passes a low-pass of the channel and no leak, and tells them
apart. A low-pass is asked for such a twin where its cut-off is within what the motion tells: others
are chosen so that they leave the motion alone.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose import wording
from inerter.diagnose.decision import CRITERIA, loss
from inerter.diagnose.low_passes import as_delay, filters
from inerter.diagnose.result import Finding, ParameterValue
from inerter.diagnose.statistics import advantage, block_squares
from inerter.diagnose.values import parameter_units
from inerter.identify.fit import Fit, parameter_errors
from inerter.identify.model import Model
from inerter.parallel_steps import parallel

if TYPE_CHECKING:
    from inerter.diagnose.search import Scored, Search

_LEAK = EFFECTS["leak"].coordinates
_FILTER = tuple(n for n in EFFECTS["sensor_filter"].coordinates if n.startswith("force"))
# damping ratio of the usual low-passes of the second order, loss of a spring of oil
_RATIO, _LOSS = 0.75, 0.01


def with_leak(finding: Finding, search: Search, fit: Fit) -> Finding:
    """A leak, or a low-pass of the force, with the other one where the data cannot tell them."""
    if search.problem.scales.one_tone:
        return finding
    twins, name = [], ""
    if finding.effect == "leak" and not finding.members:
        twins, name = _low_passes(fit.model), "force_filter"
    elif finding.effect == "sensor_filter" and "force_filter" in finding.parameters:
        twins, name = _leaks(fit.model, search), "leak_damping"
    twins = [model for model in twins if search.may_be(model)]
    twin = as_good_as(parallel(search.problem.fit, twins), search, fit) if twins else None
    if twin is None:
        return finding
    value, error = parameter_errors(twin)[name]
    known = ParameterValue(value, error, parameter_units(finding.motion)[name])
    other = "sensor_filter" if finding.effect == "leak" else "leak"
    told = replace(
        finding,
        members=(*(finding.members or (finding.effect,)), other),
        parameters={**finding.parameters, name: known},
        rivals=[rival for rival in finding.rivals if rival.effect != other],
    )
    return replace(told, evidence=wording.evidence(told))


def leak_for_low_pass(search: Search, current: Scored) -> Scored | None:
    """A leak, and a spring before it, in the place of a low-pass and a delay, if they do as well.

    A low-pass within what the motion tells that needs a delay beside it is none that is usual.
    """
    model = current.model
    if search.problem.scales.one_tone or not {"force_filter", "delay"} <= set(model.free):
        return None
    fits = parallel(search.problem.fit, list(filter(search.may_be, _leaks(model, search))))
    masks, limit = search.problem.masks, current.fit.rmse(search.problem.masks)
    near = [f for f in fits if f.rmse(masks) < (1 + CRITERIA.tolerated_loss) * limit]
    scored = search.scores([("exchange", None, fit) for fit in near])
    best = min(scored, key=lambda s: s.squares.sum(), default=None)
    return best if best and loss(best, current) < CRITERIA.exchange_loss else None


def _low_passes(model: Model) -> list[Model]:
    """Low-passes of the force in the place of a laminar leak."""
    if "leak_corner" not in model.free or "leak_quadratic_damping" in model.values:
        return []
    late = 0.5 / math.pi / model.values["leak_corner"]
    found = [c.starts[0] for c in filters(model.without(_LEAK), late)]
    if "delay" in model.free:
        # another channel may be late as well
        alone = [c.starts[0] for c in filters(model.without((*_LEAK, "delay")), late)]
        found += [each.adding(None, delay=model.delay) for each in alone]
    return found


def _leaks(model: Model, search: Search) -> list[Model]:
    """A leak, one behind a spring, and one beside a delay, in the place of a low-pass."""
    cutoff = model.values.get("force_filter", math.inf)
    within = cutoff < search.problem.scales.highest_frequency
    if not within or model.has_series or not model.values.get("inertance"):
        return []
    late = as_delay(model).delay
    dropped = (*_FILTER, "delay") if "delay" in model.free else _FILTER
    bare = model.without(dropped)
    leak = bare.adding(None, leak_corner=0.5 / math.pi / late) if late > 0 else None
    oil = bare.adding(
        None, leak_corner=0.5 * cutoff / _RATIO, series_frequency=cutoff, series_loss=_LOSS
    )
    found = [oil] if leak is None else [leak, oil]
    own = late - model.values.get("delay", 0.0)
    if "delay" in model.free and own > 0:
        found.append(model.without(_FILTER).adding(None, leak_corner=0.5 / math.pi / own))
    return found


def as_good_as(fits: Sequence[Fit], search: Search, fit: Fit) -> Fit | None:
    """The nearest of some fits that do as well as one, if any does."""
    masks, problem = search.problem.masks, search.problem
    here = replace(fit, residual=problem.residual(fit.model))
    best = min(fits, key=lambda each: each.rmse(masks))
    if best.rmse(masks) > (1 + CRITERIA.tolerated_loss) * here.rmse(masks):
        return None
    squares = [block_squares(each.residual, search.blocks) for each in (best, here)]
    return best if advantage(*squares) < CRITERIA.tolerated_advantage else None
