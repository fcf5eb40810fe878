"""Causes that these data cannot tell apart: told as one finding, with the error that this leaves.

A delay of the force adds b tau times the jerk, which along one sine is a damper, and nearly so in a
narrow band. Along one sine of amplitude A a stiffness k3 x^3 is an inertance b (1 + c x^2) with
c = -k3 / (2 b w^2), and another b: what c adds to the force is b c w^2 (A^2 x - 2 x^3). Beside a
stated inertance a stiffness k along one sine is an inertance that is wrong by -k / w^2. Friction
that differs between the directions is a level and a constant force, but at rest.

Each finding with such a counterpart is fitted once more with the counterpart beside it. Where its
own parameter may then be none, the two are one finding with two members; where the parameter only
moves, its error is at least as large as that.

A low-pass is first of all late. One of another order with a delay beside it is as late as the one
found, and where it takes as little of what the motion has, the finding has both members.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inerter.catalogue.friction import FRICTION
from inerter.diagnose import wording
from inerter.diagnose.branch_or_coupling import with_coupling
from inerter.diagnose.composition import stripped
from inerter.diagnose.decision import CRITERIA, visible_delay
from inerter.diagnose.leak_or_filter import with_leak
from inerter.diagnose.low_passes import as_delay, filters, with_low_pass
from inerter.diagnose.rate_of_level import with_rate_of_level
from inerter.diagnose.result import Finding, ParameterValue, Rival
from inerter.diagnose.search import Search
from inerter.diagnose.statistics import advantage, block_squares
from inerter.diagnose.values import parameter_units
from inerter.identify.channel_filter import CHANNELS, Filter, filter_of
from inerter.identify.fit import Fit, parameter_errors
from inerter.identify.in_proportion import BY_SPEED
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.parallel_steps import parallel

# the effects that make up for each other, each by one coordinate
_PAIRS = (
    ("viscous_friction", "sensor_delay"),
    ("hardening_stiffness", "variable_inertance"),
    ("parallel_stiffness", "inertance_error"),
    ("asymmetric_friction", "force_offset"),
)
COUNTERPARTS = {one: other for pair in _PAIRS for one, other in (pair, pair[::-1])}
# those that do along one sine alone: where the inertance is free, and where it is stated
_OF_ONE_SINE, _OF_STATED, _OF_FRICTION = _PAIRS[1:]
# share of the longest stroke from which on another is as long
_SAME_STROKE = 0.95
# share of rests that tell nothing
_RARE = 0.02
_COORDINATE = {
    "viscous_friction": "viscous",
    "sensor_delay": "delay",
    "hardening_stiffness": "stiffness_cubic",
    "variable_inertance": "inertance_curvature",
    "parallel_stiffness": "stiffness",
    "inertance_error": "inertance",
    "asymmetric_friction": "friction_asymmetry",
    "force_offset": "force_offset",
}


@dataclass(frozen=True)
class Exchange:
    """What becomes of an effect's parameter with its counterpart beside it.

    Attributes
    ----------
    counterpart : str
        The other effect.
    value, error : float
        The parameter and its standard error then, in SI units.
    other : float
        The counterpart's parameter then.
    instead : tuple of float
        The counterpart's parameter without the effect, and its standard error; where the two are
        not told apart.
    same : bool
        Whether the two are the same force along the motion.
    none, other_none : float
        The parameter, and the counterpart's, where there is no such effect.
    alone : bool
        Whether there is nothing of the counterpart without the effect.
    """

    counterpart: str
    value: float
    error: float
    other: float
    same: bool = False
    instead: tuple[float, float] = (0.0, 0.0)
    none: float = 0.0
    other_none: float = 0.0
    alone: bool = False

    @property
    def is_told_apart(self) -> bool:
        """Whether the effect is needed beside its counterpart."""
        return not self.same and abs(self.value - self.none) > CRITERIA.distinction * self.error


def exchanges(
    search: Search,
    fit: Fit,
    effects: Sequence[str],
    covered: Callable[[Fit], Fit] = lambda found: found,
) -> dict[str, Exchange]:
    """The effects of a fitted model that have a counterpart which the model has not.

    covered: a fit with errors that allow for what its residuals do not show.
    """
    baseline, one_tone = search.baseline, search.problem.scales.one_tone
    free, stated = fit.model.free, "inertance" not in baseline.free
    none = {"inertance": baseline.values.get("inertance", 0.0)}
    # friction without memory that never rests is a level and a constant force, whatever its sides
    is_even = not FRICTION[fit.model.friction].memory and rests(search.runs) < _RARE

    def may_be_exchanged(effect: str) -> bool:
        other = COUNTERPARTS.get(effect)
        if other is None or _COORDINATE[effect] not in free:
            return False
        if effect in _OF_STATED:
            return one_tone and stated and _COORDINATE[other] not in free
        if _COORDINATE[other] in fit.model.values:
            return False
        if effect in _OF_FRICTION:
            # a constant force beside a level with memory has been compared with this already
            return effect == _OF_FRICTION[0] or (is_even and "coulomb_force" in free)
        return effect not in _OF_ONE_SINE or (one_tone and "inertance" in free)

    asked = [effect for effect in effects if may_be_exchanged(effect)]
    spacing = max(run.spacing for run in search.runs)
    models = [_beside(fit.model, COUNTERPARTS[effect], spacing) for effect in asked]
    fits = parallel(search.problem.fit, models) if models else []
    # friction jumps where the motion turns, and tells a delay along one sine, too; without it what
    # tells them apart there is noise of the motion
    quiet = one_tone and fit.model.friction == "none"
    found = {}
    for effect, both in zip(asked, fits, strict=True):
        known, other = parameter_errors(covered(both)), COUNTERPARTS[effect]
        if _COORDINATE[effect] in known and _COORDINATE[other] in known:
            value, error = known[_COORDINATE[effect]]
            same = quiet or effect in (*_OF_ONE_SINE, *_OF_STATED)
            same = is_even if effect in _OF_FRICTION else same
            zero, other_zero = (none.get(_COORDINATE[each], 0.0) for each in (effect, other))
            amount = known[_COORDINATE[other]][0]
            exchange = Exchange(other, value, error, amount, same, none=zero, other_none=other_zero)
            if not exchange.is_told_apart:
                bare = _beside(_bare(fit.model, effect, baseline), other, spacing)
                instead = search.problem.fit(bare)
                amount, error = parameter_errors(covered(instead))[_COORDINATE[other]]
                absent = abs(amount - exchange.other_none) <= CRITERIA.distinction * error
                if absent and _is_worse(search, instead, fit):
                    # a damper is never early, say
                    continue
                exchange = replace(exchange, instead=(amount, error), alone=absent)
            found[effect] = exchange
    return found


def _is_worse(search: Search, instead: Fit, fit: Fit) -> bool:
    """Whether what stands in for an effect surely leaves more, and much more."""
    masks = search.problem.masks
    if instead.rmse(masks) <= (1 + CRITERIA.too_much) * fit.rmse(masks):
        return False
    squares = [block_squares(each.residual, search.blocks) for each in (instead, fit)]
    return advantage(*squares) > CRITERIA.advantage


def rests(runs: Sequence[BenchRun]) -> float:
    """Share of the samples that count at which nothing moves."""
    found = []
    for run in runs:
        speed = run.velocity
        if run.measured is not None:
            speed = run.measured[1][:: run.thinned * run.instants][: speed.size]
        found.append(speed[run.inner] == 0.0)
    return float(np.mean(np.concatenate(found)))


def _bare(model: Model, effect: str, baseline: Model) -> Model:
    """A model without what its counterpart stands for."""
    if effect in _OF_FRICTION:
        return model.without((_COORDINATE[effect],))
    return stripped(model, effect, baseline)


def _beside(model: Model, effect: str, spacing: float) -> Model:
    name = _COORDINATE[effect]
    begin = 0.1 * spacing if effect == "sensor_delay" else model.values.get(name, 0.0)
    return model.adding(None, **{name: begin})


def with_members(
    finding: Finding,
    exchange: Exchange | None,
    search: Search,
    fit: Fit,
    covered: Callable[[Fit], Fit] = lambda found: found,
) -> Finding:
    """A finding with whatever else the data cannot tell from it."""
    finding = with_branch(with_exchange(finding, exchange), search, fit)
    finding = with_coupling(with_force_of_place(finding, search, fit), search, fit)
    finding = with_leak(with_delay(finding, search, fit, covered), search, fit)
    return with_rate_of_level(with_low_pass(finding, search, fit), search, fit, covered)


def with_exchange(finding: Finding, exchange: Exchange | None) -> Finding:
    """A finding with what its counterpart leaves of it."""
    if exchange is None:
        return finding
    name = _COORDINATE[finding.effect]
    found = finding.parameters.get(name)
    if found is None:
        return finding
    moved = abs(exchange.value - found.value)
    error = float(max(found.stderr, np.hypot(exchange.error, moved)))
    if exchange.is_told_apart:
        if moved < CRITERIA.distinction * found.stderr:
            return finding
        amount = wording.amount_in_words(exchange.counterpart, exchange.other, finding.motion)
        beside = f"with {amount} beside it {name} would be {exchange.value:.3g}"
        return replace(
            finding,
            parameters=_with_error(finding.parameters, name, error),
            evidence=f"{finding.evidence} {beside[0].upper()}{beside[1:]} {found.unit}.",
        )
    # it may be none, and so may be what stands in for it
    size = abs(found.value - exchange.none)
    error = float(np.clip(error, size / CRITERIA.distinction, max(size, found.stderr)))
    # and whatever was shared out between the two
    its = (each.confidence for each in finding.rivals if each.effect == exchange.counterpart)
    share = min(sum(its, finding.confidence), 1.0) / 2
    known = _with_error(finding.parameters, name, error)
    if exchange.alone:
        told = replace(finding, confidence=share, parameters=known)
        return replace(told, evidence=wording.evidence(told))
    value, spread = exchange.instead
    spread = max(spread, error / size * abs(value - exchange.other_none)) if size else spread
    other = _COORDINATE[exchange.counterpart]
    unit = parameter_units(finding.motion)[other]
    rivals = [rival for rival in finding.rivals if rival.effect != exchange.counterpart]
    told = replace(
        finding,
        confidence=share,
        members=(finding.effect, exchange.counterpart),
        parameters={**known, other: ParameterValue(value, spread, unit)},
        rivals=[Rival(exchange.counterpart, share), *rivals],
    )
    told = _with_low_pass(told) if exchange.same else told
    return replace(told, evidence=wording.evidence(told))


def _with_low_pass(finding: Finding) -> Finding:
    """A delay along one sine may be a low-pass that is as late, too."""
    late = finding.parameters.get("delay")
    if late is None or not late.value:
        return finding
    channel = "force" if late.value > 0 else "displacement"
    cutoff = Filter.as_late_as(abs(late.value)).cutoff
    known = ParameterValue(cutoff, cutoff * late.stderr / abs(late.value), "Hz")
    return replace(
        finding,
        members=(*finding.members, "sensor_filter"),
        parameters={**finding.parameters, f"{channel}_filter": known},
    )


def with_branch(finding: Finding, search: Search, fit: Fit) -> Finding:
    """A damper along one sine that is no delay: it may be a spring that relaxes.

    With w the speed of the sine [rad/s] a branch k, c is a damper c / (1 + (w c / k)^2) and an
    inertance of another size. The softest with a damper c has k = 2 w c and 2 c of its own.
    """
    sizes, model = search.problem.scales, fit.model
    alone = not finding.members and model.friction == "none" and model.shaft is None
    if finding.effect != "viscous_friction" or not (sizes.one_tone and alone):
        return finding
    branches = any(name.startswith("branch_") for name in model.values)
    found = finding.parameters.get("viscous")
    if found is None or branches or "delay" in model.values or "inertance" not in model.free:
        return finding
    share, size = finding.confidence / 2, abs(found.value)
    units = parameter_units(finding.motion)
    either = {
        name: ParameterValue(value, value / CRITERIA.distinction, units[name])
        for name, value in (
            ("branch_stiffness_1", 4 * np.pi * sizes.frequency * size),
            ("branch_damping_1", 2 * size),
        )
    }
    error = max(found.stderr, size / CRITERIA.distinction)
    told = replace(
        finding,
        confidence=share,
        members=(finding.effect, "viscoelasticity"),
        parameters={**_with_error(finding.parameters, "viscous", error), **either},
        rivals=[Rival("viscoelasticity", share), *_others(finding.rivals, ("viscoelasticity",))],
    )
    return replace(told, evidence=wording.evidence(told))


def with_force_of_place(finding: Finding, search: Search, fit: Fit) -> Finding:
    """An inertance that varies along the stroke of one sine: it is a force of the place.

    With a = -w^2 x and v^2 = w^2 (A^2 - x^2) what it adds is a function of x, whatever its form.
    """
    free, one_tone = fit.model.free, search.problem.scales.one_tone
    strokes = [float(np.ptp(run.displacement[run.inner])) for run in search.runs if run.inner.any()]
    alike = min(strokes, default=0.0) > _SAME_STROKE * max(strokes, default=0.0)
    asked = finding.effect == "variable_inertance" and not finding.members
    # what differs between the directions, or goes with the speed, is none
    more = BY_SPEED in free or any("_back_" in name for name in free)
    if more or not (asked and one_tone and alike and "inertance" in free):
        return finding
    share, others = finding.confidence / 2, ("position_force", "gas_spring", "hardening_stiffness")
    rivals = [Rival(others[0], share), *_others(finding.rivals, others)]
    members = (finding.effect, *others)
    told = replace(finding, confidence=share, members=members, rivals=rivals)
    return replace(told, evidence=wording.evidence(told))


def _with_error(
    parameters: Mapping[str, ParameterValue], name: str, error: float
) -> dict[str, ParameterValue]:
    return {**parameters, name: replace(parameters[name], stderr=error)}


def with_delay(
    finding: Finding,
    search: Search,
    fit: Fit,
    covered: Callable[[Fit], Fit] = lambda found: found,
) -> Finding:
    """A low-pass that is found, and what a delay beside another one would leave of it."""
    found = [each for each in CHANNELS if f"{each}_filter" in finding.parameters]
    if finding.effect != "sensor_filter" or not found or "delay" in fit.model.values:
        return finding
    masks, cutoff = search.problem.masks, f"{found[0]}_filter"
    fits = parallel(search.problem.fit, list(_others_with_delay(fit.model, found[0])))

    def is_as_good(other: Fit) -> bool:
        squares = [block_squares(each.residual, search.blocks) for each in (other, here)]
        return advantage(*squares) < CRITERIA.tolerated_advantage

    here = replace(fit, residual=search.problem.residual(fit.model))
    damper = _with_damper(search, fit.model)
    if damper and is_as_good(other := search.problem.fit(damper)):
        return _or_damper(finding, covered(other), as_delay(fit.model).delay)
    near = [each for each in fits if is_as_good(each)]
    spacing = max(run.sample_spacing for run in search.runs)
    late, told = as_delay(fit.model).delay, []
    for each in sorted(near, key=lambda other: other.rmse(masks)):
        value, error = parameter_errors(covered(each)).get("delay", (0.0, 0.0))
        if abs(value) > CRITERIA.distinction * error and visible_delay(value, spacing):
            told.append((value, each.model.values[cutoff]))
    # a clock that is off the same way as the filter is the likelier one
    told.sort(key=lambda pair: pair[0] * late < 0)
    if not told:
        return finding
    known, (delay, other) = finding.parameters[cutoff], told[0]
    # a value without the delay, and none of it with the filter alone
    apart = abs(other - known.value) / CRITERIA.distinction
    parameters = _with_error(finding.parameters, cutoff, max(known.stderr, apart))
    found_with = replace(
        finding,
        members=(finding.effect, "sensor_delay"),
        parameters={**parameters, "delay": ParameterValue(delay, abs(delay), "s")},
    )
    return replace(found_with, evidence=wording.evidence(found_with))


def _with_damper(search: Search, model: Model) -> Model | None:
    """The model with a damper in the place of its low-pass, where both are late the same way."""
    sizes = search.problem.scales
    if not sizes.one_tone or model.friction != "none" or "viscous" in model.values:
        return None
    bare = stripped(model, "sensor_filter", search.baseline)
    return bare.adding(None, viscous=0.01 * sizes.force / sizes.velocity)


def _or_damper(finding: Finding, damped: Fit, delay: float) -> Finding:
    """A low-pass along one sine that may as well be a damper, or a delay [s]."""
    value, error = parameter_errors(damped)["viscous"]
    share = finding.confidence / 2
    members = (finding.effect, "viscous_friction", "sensor_delay")
    unit = parameter_units(finding.motion)["viscous"]
    either = {
        "viscous": ParameterValue(value, max(error, abs(value) / CRITERIA.distinction), unit),
        "delay": ParameterValue(delay, abs(delay) / CRITERIA.distinction, "s"),
    }
    parameters = {
        name: replace(known, stderr=max(known.stderr, abs(known.value) / CRITERIA.distinction))
        for name, known in finding.parameters.items()
    }
    told = replace(
        finding, members=members, confidence=share, parameters={**parameters, **either},
        rivals=[Rival("viscous_friction", share), *_others(finding.rivals, members)],
    )  # fmt: skip
    return replace(told, evidence=wording.evidence(told))


def _others(rivals: Sequence[Rival], members: Sequence[str]) -> list[Rival]:
    return [rival for rival in rivals if rival.effect not in members]


def _others_with_delay(model: Model, channel: str) -> Iterator[Model]:
    """The model with low-passes of every other shape, and a delay that makes them as late."""
    here, late = filter_of(model.values, channel), as_delay(model).delay
    sign = 1.0 if channel == "force" else -1.0
    for candidate in filters(model):
        (start,) = candidate.starts
        other = filter_of(start.values, channel)
        if here is None or other is None or (other.kind, other.order) == (here.kind, here.order):
            continue
        # as steep where the motion is: the cut-off found, and the delay what that lacks
        begin = start.holding(**{f"{channel}_filter": here.cutoff})
        lateness = replace(other, cutoff=here.cutoff).lateness
        yield begin.adding(None, delay=late - sign * lateness)
