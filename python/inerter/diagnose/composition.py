"""How effects are read off a model and taken out of it.

`effects_of` looks at a model alone, so that a name does not depend on the way the search took.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from inerter.catalogue.along_stroke import PERIODS, QUANTITIES, node_of
from inerter.catalogue.coordinates import search_range
from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.friction import (
    BRISTLES,
    FRICTION,
    LAW_COORDINATES,
    LEVEL_COORDINATES,
    PLAY_COORDINATES,
)
from inerter.catalogue.scales import Scales
from inerter.diagnose.bent_damping import bends_less
from inerter.diagnose.decision import CRITERIA
from inerter.identify.fit import Fit, parameter_errors
from inerter.identify.model import Model

DRIVE = tuple(name for name, effect in EFFECTS.items() if effect.kind in ("play", "shaft"))
"""Effects that take away the rigid drive of the flywheel."""
PLAYS = frozenset(e.coordinates[0] for e in EFFECTS.values() if e.kind == "play")
"""Coordinates with which a shaft is that of a play or of a clutch."""
SMOOTH = frozenset(name for name, effect in EFFECTS.items() if effect.smooth)
"""Effects that are linear in the motion."""
# share of the largest eigenvalue of a correlation below which one is no more than rounding
_ROUNDING = 1e-5
# share of the force below which what an inertance makes of it is none
_NO_INERTANCE = 1e-6
# how well a coordinate is known before any data: the exponent of a gas lies between 1 and 1.7.
# A shallow compression does not tell exponent, force and height of a gas apart
_KNOWN = {"gas_exponent": 0.7 / np.sqrt(12)}


def is_local(effect: str) -> bool:
    """Whether an effect may show in few stretches, or in one run alone."""
    return effect in EFFECTS and EFFECTS[effect].local


def is_turned(model: Model, sizes: Scales) -> bool:
    """Whether a negative stiffness stands in the place of all inertance.

    Along one sine that is the same, and along a free swing too: its motion follows from its force.
    """
    inertance, stiffness = (model.values.get(name, 0.0) for name in ("inertance", "stiffness"))
    none = inertance * sizes.acceleration < _NO_INERTANCE * sizes.force
    return stiffness < 0.0 and "inertance" in model.free and none


def is_shaft(effect: str) -> bool:
    """Whether an effect makes the noise of the motion larger near a resonance."""
    return effect in EFFECTS and EFFECTS[effect].kind == "shaft"


def is_distinct(
    effect: str, fit: Fit, baseline: Model, required: float = CRITERIA.distinction
) -> bool:
    """Whether a fitted effect differs from none by `required` standard errors, see below."""
    return distinction(effect, fit, baseline) > required


def distinction(effect: str, fit: Fit, baseline: Model) -> float:
    """Standard errors of its coordinates by which a fitted effect differs from none.

    What the baseline states and a fit sets free is distinct as it is: it may be that there is none.
    """
    if _contradicts(effect, fit.model, baseline):
        return np.inf
    if EFFECTS[effect].kind == "law" and (_loses_nothing(fit.model) or not bristle_is_known(fit)):
        return 0.0
    if effect == "digressive_damping":
        # with a knee that is passed at once it is friction, and no damping below it is known
        found = [_per_error(*parameter_errors(fit).get("viscous", (1.0, 0.0)))]
        if "damping_exponent" in (errors := _errors(fit)):
            # unless the power is known to be another than that of friction, and of a straight line
            power = fit.model.values["damping_exponent"]
            found.append(_per_error(min(abs(power), abs(1 - power)), errors["damping_exponent"]))
        return float(max(found))
    if effect == "damper_elasticity":
        return _per_error(*parameter_errors(fit).get("damper_stiffness", (1.0, 0.0)))
    if effect == "leak":
        known = parameter_errors(fit)
        told = (known.get(name, (0.0, 1.0)) for name in EFFECTS[effect].parameters)
        return float(max(_per_error(*each) for each in told))
    if EFFECTS[effect].kind == "shaft":
        # known through its resonance; without an inertance there is none, and no stiffness
        return _per_error(*parameter_errors(fit).get("series_stiffness", (1.0, 0.0)))
    errors = _errors(fit)
    known = [name for name in EFFECTS[effect].amplitudes if name in errors]
    if not known:
        return np.inf
    found = [_per_error(abs(fit.model.values[name]), errors[name]) for name in known]
    level = fit.model.values.get("coulomb_force", 0.0)
    if effect == "rate_state_friction" and level < errors.get("coulomb_force", 0.0):
        # all that it does is in proportion to its level, and of none there is nothing
        return _per_error(level, errors["coulomb_force"])
    if EFFECTS[effect].kind == "law" and len(known) > 1:
        found.append(_together(fit, known))
    if nodes := [name for name in known if node_of(name)]:
        found.append(_curve(fit, nodes))
    return float(max(found))


def _per_error(value: float, error: float) -> float:
    if error > 0.0:
        return value / error
    return np.inf if error == 0.0 < value else 0.0


def _together(fit: Fit, names: Sequence[str]) -> float:
    """Standard errors by which some coordinates together differ from none.

    Where only their difference is seen, as of friction that rises with speed and falls with it,
    none alone does.
    """
    places = [fit.model.free.index(name) for name in names]
    values = np.array([fit.model.values[name] for name in names])
    inverse = np.linalg.pinv(fit.covariance[np.ix_(places, places)], hermitian=True)
    return float(np.sqrt(max(values @ inverse @ values, 0.0)))


def _curve(fit: Fit, nodes: Sequence[str]) -> float:
    """Standard errors by which a curve differs from none, as of one value that is as unlikely.

    What lies beside it may take a share of every node, and leave none that is known alone. What
    the rounding of their covariance may have made of it counts for nothing.
    """
    places = [fit.model.free.index(name) for name in nodes]
    covariance = fit.covariance[np.ix_(places, places)]
    errors = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    sizes, ways = np.linalg.eigh(covariance / np.outer(errors, errors))
    sure = sizes > _ROUNDING * sizes[-1]
    along = ways.T @ (np.array([fit.model.values[name] for name in nodes]) / errors)
    count = int(sure.sum())
    # the cube root of a chi-squared value over its mean is nearly normal (Wilson and Hilferty)
    spread = 2.0 / (9.0 * count)
    ratio = float(np.sum(along[sure] ** 2 / sizes[sure])) / count
    return float((np.cbrt(ratio) - (1.0 - spread)) / np.sqrt(spread))


def bristle_is_known(fit: Fit) -> bool:
    """Whether a bristle's stiffness, if there is one, is told from one without end.

    Without a bristle that gives way a law with memory is one without.
    """
    stiffness, error = parameter_errors(fit).get("bristle_stiffness", (1.0, 0.0))
    return error < CRITERIA.known * stiffness


def _loses_nothing(model: Model) -> bool:
    """Whether the hysteresis of a Bouc-Wen law is none."""
    device = model.device()
    return bool(
        model.friction == "bouc_wen" and device.bw_beta < CRITERIA.losing * abs(device.bw_gamma)
    )


def _contradicts(effect: str, model: Model, baseline: Model) -> bool:
    """Whether an effect is one that the baseline states, with values of its own."""
    known = EFFECTS[effect]
    if known.kind == "law" and model.friction != baseline.friction:
        return False
    if known.kind == "shaft":
        return baseline.has_series
    names = (*(name for name in known.coordinates if name in model.free), *known.stated_as)
    return any(name in baseline.values and name not in baseline.free for name in names)


def _errors(fit: Fit) -> dict[str, float]:
    """Standard errors of a fit's free coordinates, with what is known of some beforehand."""
    covariance = fit.covariance
    for name, spread in _KNOWN.items():
        if name in fit.model.free:
            j = fit.model.free.index(name)
            along = covariance[:, j]
            covariance = covariance - np.outer(along, along) / (along[j] + spread**2)
    sizes = np.sqrt(np.maximum(np.diag(covariance), 0))
    return dict(zip(fit.model.free, sizes, strict=True))


def is_blur(model: Model, scales: Scales, plain: float, error: float) -> bool:
    """Whether a peak of friction is no more than smoothed data make of any reversal.

    The rms errors [N] are those with friction that does not fall with speed, and with the peak.
    """
    peak = FRICTION[model.friction].peak
    if peak not in model.values:
        return False
    if model.values.get("age_effect", 1.0) < model.values.get("rate_effect", 0.0):
        # friction that rises with the logarithm of speed has no peak
        return False
    narrow = CRITERIA.narrow_peak * search_range(peak, scales).lower
    return model.values[peak] < narrow and within_blur(model, plain, error)


def within_blur(model: Model, one: float, other: float) -> bool:
    """Whether an error [N] is above another by no more than the blur of reversals can make."""
    return one**2 - other**2 < (CRITERIA.blur * model.values["coulomb_force"]) ** 2


def width(model: Model) -> dict[str, float]:
    """The width of sign(v), which is fitted along: it depends on the velocity's noise."""
    return {"transition_velocity": model.values["transition_velocity"]}


LAW_EFFECT = {law.name: law.effect for law in FRICTION.values() if law.effect}
"""The effect that each friction law is named as."""
_DAMPERS = tuple(name for name, effect in EFFECTS.items() if effect.kind == "damper")
"""Effects that change a viscous damping, which belongs to them."""
_LEVELS = tuple(name for name, effect in EFFECTS.items() if effect.kind == "level")


def effects_of(model: Model, baseline: Model) -> list[tuple[str, str | None]]:
    """Effects (and friction law) that a model has beyond the baseline.

    A Coulomb level that varies with direction or position is one effect, not two, and so is a
    damping that bends; a play has its shaft in it.
    """
    added = {name for name in model.free if name not in baseline.free}
    law = LAW_EFFECT.get(model.friction)
    touched = model.friction != baseline.friction or not added.isdisjoint(LAW_COORDINATES)
    varied = [name for name in _LEVELS if not added.isdisjoint(EFFECTS[name].coordinates)]
    bent = any(not added.isdisjoint(EFFECTS[name].coordinates) for name in _DAMPERS)
    found: list[tuple[str, str | None]] = []
    for name, effect in EFFECTS.items():
        if effect.kind == "law":
            there = touched and name == law and not (model.friction == "coulomb" and varied)
        elif name == "viscous_friction" and bent:
            there = False
        elif effect.kind == "play":
            there = effect.coordinates[0] in added
        elif effect.kind == "shaft":
            there = "series_frequency" in added and PLAYS.isdisjoint(added)
        else:
            there = not added.isdisjoint(effect.coordinates)
        if there:
            found.append((name, law_of(name, model, added)))
    return found


def law_of(effect: str, model: Model, added: set[str]) -> str | None:
    """By which law a model has an effect, given the coordinates that came with it, if it says."""
    if not EFFECTS[effect].tells_law:
        return None
    if EFFECTS[effect].kind == "law":
        return model.friction
    quantity = next(each for each in QUANTITIES if each.effect == effect)
    if form := quantity.form(added):
        return form
    return "speed" if added & set(EFFECTS[effect].coordinates) <= _SPEED else "polynomial"


_SPEED = {"inertance_speed_gradient"}


def without_effect(model: Model, effect: str, baseline: Model) -> list[Model]:
    """Simpler models: without an effect, and for friction laws also with each simpler law."""
    names = [name for name, _ in effects_of(model, baseline)]
    without = submodel(model, [name for name in names if name != effect], baseline)
    if EFFECTS[effect].kind == "law":
        return [*simpler_laws(model), without]
    if EFFECTS[effect].kind == "play" and "series_frequency" in model.free:
        # its elasticity alone
        return [model.without(EFFECTS[effect].coordinates[:1]), without]
    if effect == "variable_inertance":
        # along the stroke alone, with the speed alone
        along, speed = ("inertance_gradient", "inertance_curvature"), ("inertance_speed_gradient",)
        if {*along, *speed} <= set(model.free):
            return [model.without(speed), model.without(along), without]
    if EFFECTS[effect].kind != "level" and (fewer := _fewer_periods(model, effect)):
        return [*fewer, without]
    if effect == "leak" and {*EFFECTS[effect].coordinates} <= {*model.free}:
        # laminar alone, turbulent alone
        return [*(model.without((each,)) for each in EFFECTS[effect].coordinates), without]
    if effect == "hardening_stiffness" and "rest_length" in model.free:
        return [model.without(("rest_length",)), without]
    if effect == "viscous_friction" and {*EFFECTS[effect].coordinates} <= {*model.free}:
        # between the terminals alone, at the flywheel alone
        return [*(model.without((each,)) for each in EFFECTS[effect].coordinates), without]
    if effect == "end_stop" and (fewer := _less_of_a_stop(model)):
        return [*fewer, without]
    if effect == "viscoelasticity" and "branch_time_2" in model.free:
        last = 3 if "branch_time_3" in model.free else 2
        return [model.without((f"branch_stiffness_{last}", f"branch_time_{last}")), without]
    if effect in (*_LEVELS, *_DAMPERS):
        # the variation of the level, the bend of the damping alone, which may be less of one
        if effect == "digressive_damping" and (fewer := bends_less(model)):
            return [*fewer, without]
        return [model.without(EFFECTS[effect].coordinates), without]
    return [without]


def _less_of_a_stop(model: Model) -> list[Model]:
    """The model with one of two stops, and with stops that do not stiffen."""
    ends = ("stop_lower", "stop_upper")
    names = [*ends] if all(name in model.free for name in ends) else []
    return [
        model.without((name,)) for name in (*names, "stop_stiffness_cubic") if name in model.free
    ]


def _fewer_periods(model: Model, effect: str) -> list[Model]:
    """The model with one period along the stroke less, the last; none where there are not two."""
    for quantity in QUANTITIES:
        numbers = [i for i in range(1, PERIODS + 1) if quantity.period(i)[0] in model.free]
        if quantity.effect == effect and len(numbers) > 1:
            return [model.without(quantity.period(numbers[-1]))]
    return []


def stripped(model: Model, effect: str, baseline: Model) -> Model:
    """The model without what is particular to an effect; a level that varies leaves the level."""
    if effect in (*_LEVELS, *_DAMPERS):
        return model.without(EFFECTS[effect].coordinates)
    names = [name for name, _ in effects_of(model, baseline) if name != effect]
    return submodel(model, names, baseline)


def submodel(model: Model, effects: Sequence[str], baseline: Model) -> Model:
    """The model reduced to the baseline and some of its effects."""
    present = dict(effects_of(model, baseline))
    dropped = [name for name in present if name not in effects]
    laws = [name for name in present if EFFECTS[name].kind == "law"]
    names: set[str] = set()
    for name in dropped:
        names.update(EFFECTS[name].coordinates if name not in laws else LAW_COORDINATES)
        names.update(EFFECTS[name].stated_as)
    kept_dampers = [name for name in _DAMPERS if name in effects and name in present]
    if any(name in dropped for name in _DAMPERS) and not kept_dampers:
        names.add("viscous")
    friction = model.friction
    kept_levels = [name for name in _LEVELS if name in effects and name in present]
    # a level came with the variation that it is known by, where the baseline has none to vary
    alone = not laws and not kept_levels and not FRICTION[baseline.friction].varies
    if (laws and laws[0] in dropped) or alone:
        level, _ = level_and_distance(model)
        names.update(LAW_COORDINATES)
        if not all(carries(baseline.friction, name) for name in kept_levels):
            # without its law, a level that varies needs Coulomb friction to act on
            names.update(PLAY_COORDINATES)
            others = names.difference(LAW_COORDINATES)
            bare = _restored(model.without(tuple(names), "none"), others, baseline)
            return bare.adding("coulomb", coulomb_force=level, **width(bare))
        friction = baseline.friction
        if friction not in BRISTLES:
            names.update(PLAY_COORDINATES)
        names.update(n for each in _LEVELS if not carries(friction, each) for n in _of_level(each))
    return _restored(model.without(tuple(names), friction), names, baseline)


def carries(law: str, effect: str) -> bool:
    """Whether a friction law has a level that can vary as an effect says.

    A drift is the record's, and so every law's; what differs along the stroke is not.
    """
    known = FRICTION[law]
    return known.varies or bool(known.level and not set(_of_level(effect)) & set(LEVEL_COORDINATES))


def _of_level(effect: str) -> tuple[str, ...]:
    return EFFECTS[effect].coordinates


def _restored(bare: Model, names: Iterable[str], baseline: Model) -> Model:
    """Put back what the baseline states of the names that were taken out."""
    stated = {name: baseline.values[name] for name in names if name in baseline.values}
    free = tuple(name for name in baseline.free if name in names and name not in bare.free)
    return Model(bare.friction, {**bare.values, **stated}, bare.free + free, bare.texts)


def level_and_distance(model: Model) -> tuple[float, float | None]:
    """Friction level [N] and pre-sliding distance [m], or what comes nearest to them in the law."""
    values = model.values
    device = model.device()
    bend = max(abs(device.bw_beta), abs(device.bw_gamma))
    if "bw_stiffness" in values and bend > 0:
        distance = bend ** (-1 / device.bw_exponent)
        return device.bw_stiffness * distance, distance
    distance = values.get("presliding", values.get("age_distance"))
    return values.get("coulomb_force", values.get("bw_level", 0.0)), distance


def simpler_laws(model: Model) -> list[Model]:
    """The model under each friction law with fewer parameters."""
    level, presliding = level_and_distance(model)
    known = dict(model.values) | {"coulomb_force": level} | width(model)
    if presliding:
        known["presliding"] = presliding
    bare = model.without(LAW_COORDINATES, "none")
    simpler = []
    for name in FRICTION[model.friction].simpler:
        law = FRICTION[name]
        names = (*law.coordinates, *(width(model) if law.smoothed else ()))
        if all(each in known for each in names):
            kept = bare if name in BRISTLES else bare.without(PLAY_COORDINATES)
            simpler.append(kept.adding(name, **{each: known[each] for each in names}))
    return simpler
