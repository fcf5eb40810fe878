"""How effects are read off a model and taken out of it.

`effects_of` looks at a model alone, so that a name does not depend on the way the search took.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from inerter.diagnose.effects import EFFECTS, LAW_COORDINATES, LEVEL_COORDINATES
from inerter.identify.coordinates import Scales, coordinate
from inerter.identify.fit import Fit, parameter_errors
from inerter.identify.model import Model

# coordinates whose being zero means that the effect is absent, where not all of them do
_AMPLITUDES = {
    "stribeck_friction": ("static_excess",),
    "hysteretic_friction": ("coulomb_force", "bw_level", "bw_stiffness"),
    "inertance_error": (),
    "series_elasticity": (),
    "backlash": (),
    "gas_spring": ("gas_push",),
    "end_stop": (),
    "sensor_saturation": (),
    "periodic_disturbance": ("disturbance_amplitude",),
}


# how well a coordinate is known before any data: the exponent of a gas lies between 1 and 1.7.
# A shallow compression does not tell exponent, force and height of a gas apart
_KNOWN = {"gas_exponent": 0.7 / np.sqrt(12)}
# a fall of the friction narrower than this many of the narrowest that is searched for may be the
# blur of a reversal, which any friction has in smoothed data: in 43 cases of plain friction it was
# up to 3.1 wide and explained up to 1.4 % of the friction (rms), the peaks of 43 others 13 to 31 %
_NARROW = 4.0
_BLUR = 0.04
# share of gamma that beta of a Bouc-Wen law has at least: without beta nothing is lost, and the law
# is a spring with any zero, which stands in for gas and offsets
_LOSING = 0.1


def has_series(model: Model) -> bool:
    """Whether a model has a series element."""
    names = ("series_frequency", "series_stiffness", "series_damping")
    return any(name in model.values for name in names)


def is_distinct(effect: str, fit: Fit, required: float, baseline: Model) -> bool:
    """Whether a fitted effect differs from none by some standard errors of its coordinates.

    What the baseline states and a fit sets free is distinct as it is: it may be that there is none.
    """
    if _contradicts(effect, fit.model, baseline):
        return True
    if effect == "hysteretic_friction" and fit.model.friction == "bouc_wen":
        device = fit.model.device()
        if device.bw_beta < _LOSING * abs(device.bw_gamma):
            return False
    if effect == "series_elasticity":
        # known through its resonance; without an inertance there is none, and no stiffness
        stiffness, error = parameter_errors(fit).get("series_stiffness", (1.0, 0.0))
        return stiffness > required * error
    names = _AMPLITUDES.get(effect, EFFECTS[effect].coordinates)
    errors = _errors(fit)
    known = [name for name in names if name in errors]
    return not known or any(abs(fit.model.values[name]) > required * errors[name] for name in known)


def _contradicts(effect: str, model: Model, baseline: Model) -> bool:
    """Whether an effect is one that the baseline states, with values of its own."""
    if effect in LAW_EFFECT.values() and model.friction != baseline.friction:
        return False
    if effect == "series_elasticity":
        return has_series(baseline)
    names = (*EFFECTS[effect].coordinates, *STATED_AS.get(effect, ()))
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
    if model.friction not in ("stribeck", "brown_mcphee"):
        return False
    narrow = _NARROW * coordinate("stribeck_velocity", scales).lower
    return model.values["stribeck_velocity"] < narrow and within_blur(model, plain, error)


def within_blur(model: Model, one: float, other: float) -> bool:
    """Whether an error [N] is above another by no more than the blur of reversals can make."""
    return one**2 - other**2 < (_BLUR * model.values["coulomb_force"]) ** 2


def width(model: Model) -> dict[str, float]:
    """The width of sign(v), which is fitted along: it depends on the velocity's noise."""
    return {"transition_velocity": model.values["transition_velocity"]}


LAW_EFFECT = {
    "coulomb": "coulomb_friction",
    "stribeck": "stribeck_friction",
    "brown_mcphee": "stribeck_friction",
    "dahl": "hysteretic_friction",
    "lugre": "hysteretic_friction",
    "bouc_wen": "hysteretic_friction",
}
# parameters that a user states for what is searched for in other coordinates
STATED_AS = {
    "series_elasticity": ("series_stiffness", "series_damping"),
    "gas_spring": ("gas_pressure", "gas_volume"),
}
_MODULATIONS = ("asymmetric_friction", "position_dependent_friction", "friction_drift")
_SIMPLE = (
    "hardening_stiffness",
    "gas_spring",
    "end_stop",
    "force_drift",
    "sensor_saturation",
    "periodic_disturbance",
    "viscous_friction",
    "load_dependent_friction",
    "parallel_stiffness",
    "force_offset",
    "sensor_delay",
    "quadratic_damping",
    "variable_inertance",
)


def effects_of(model: Model, baseline: Model) -> list[tuple[str, str | None]]:
    """Effects (and friction law) that a model has beyond the baseline.

    A Coulomb level that varies with direction or position is one effect, not two.
    """
    added = [name for name in model.free if name not in baseline.free]
    found: list[tuple[str, str | None]] = []
    modulations = [
        name for name in _MODULATIONS if any(c in added for c in EFFECTS[name].coordinates)
    ]
    law_touched = model.friction != baseline.friction or any(c in added for c in LAW_COORDINATES)
    if law_touched and model.friction in LAW_EFFECT:
        effect = LAW_EFFECT[model.friction]
        if not (effect == "coulomb_friction" and modulations):
            found.append((effect, model.friction if effect == "hysteretic_friction" else None))
    found += [(name, None) for name in modulations]
    found += [(n, None) for n in _SIMPLE if any(c in added for c in EFFECTS[n].coordinates)]
    if "backlash" in added:
        found.append(("backlash", None))
    elif "series_frequency" in added:
        found.append(("series_elasticity", None))
    if "inertance" in added:
        found.append(("inertance_error", None))
    return found


def without_effect(model: Model, effect: str, baseline: Model) -> list[Model]:
    """Simpler models: without an effect, and for friction laws also with each simpler law."""
    names = [name for name, _ in effects_of(model, baseline)]
    without = submodel(model, [name for name in names if name != effect], baseline)
    if effect in ("hysteretic_friction", "stribeck_friction"):
        return [*simpler_laws(model), without]
    if effect == "backlash" and "series_frequency" in model.free:
        # its elasticity alone
        return [model.without(("backlash",)), without]
    if effect == "variable_inertance":
        # along the stroke alone, with the speed alone
        along, speed = ("inertance_gradient", "inertance_curvature"), ("inertance_speed_gradient",)
        if {*along, *speed} <= set(model.free):
            return [model.without(speed), model.without(along), without]
    if effect in _MODULATIONS:
        # the variation of the level alone
        return [model.without(EFFECTS[effect].coordinates), without]
    return [without]


def stripped(model: Model, effect: str, baseline: Model) -> Model:
    """The model without what is particular to an effect; a level that varies leaves the level."""
    if effect in _MODULATIONS:
        return model.without(EFFECTS[effect].coordinates)
    names = [name for name, _ in effects_of(model, baseline) if name != effect]
    return submodel(model, names, baseline)


def submodel(model: Model, effects: Sequence[str], baseline: Model) -> Model:
    """The model reduced to the baseline and some of its effects."""
    present = dict(effects_of(model, baseline))
    dropped = [name for name in present if name not in effects]
    laws = [name for name in present if name in LAW_EFFECT.values()]
    names: set[str] = set()
    for name in dropped:
        names.update(EFFECTS[name].coordinates if name not in laws else LAW_COORDINATES)
        names.update(STATED_AS.get(name, ()))
    friction = model.friction
    kept_modulations = [name for name in _MODULATIONS if name in effects and name in present]
    if (laws and laws[0] in dropped) or (
        not laws and not kept_modulations and not _stated_friction(baseline)
    ):
        # without its law, a level that varies needs Coulomb friction to act on
        level, _ = _level_and_distance(model)
        names.update(LAW_COORDINATES)
        if kept_modulations and baseline.friction == "none":
            bare = _restored(model.without(tuple(names), "none"), names, baseline)
            return bare.adding("coulomb", coulomb_force=level, **width(bare))
        friction = baseline.friction
        if friction == "none":
            names.update((*LEVEL_COORDINATES, "friction_drift"))
    return _restored(model.without(tuple(names), friction), names, baseline)


def _stated_friction(baseline: Model) -> bool:
    return baseline.friction != "none"


def _restored(bare: Model, names: Iterable[str], baseline: Model) -> Model:
    """Put back what the baseline states of the names that were taken out."""
    stated = {name: baseline.values[name] for name in names if name in baseline.values}
    free = tuple(name for name in baseline.free if name in names and name not in bare.free)
    return Model(bare.friction, {**bare.values, **stated}, bare.free + free, bare.texts)


def _level_and_distance(model: Model) -> tuple[float, float | None]:
    """Friction level [N] and pre-sliding distance [m], or what comes nearest to them in the law."""
    values = model.values
    device = model.device()
    bend = max(abs(device.bw_beta), abs(device.bw_gamma))
    if "bw_stiffness" in values and bend > 0:
        distance = bend ** (-1 / device.bw_exponent)
        return device.bw_stiffness * distance, distance
    return values.get("coulomb_force", values.get("bw_level", 0.0)), values.get("presliding")


def as_one(model: Model) -> list[Model]:
    """The model with one cause in the place of two that do the same.

    Friction that differs between the directions is a level and a constant force, but at rest.
    """
    level = model.values.get("coulomb_force", 0.0)
    uneven = "friction_asymmetry" in model.values
    if model.friction != "coulomb" or "force_offset" not in model.free or uneven or level <= 0:
        return []
    share = float(np.clip(model.values["force_offset"] / level, -0.9, 0.9))
    return [model.without(("force_offset",)).adding(friction_asymmetry=share)]


def as_spring(model: Model) -> list[Model]:
    """A spring in the place of two stops: where these meet nothing moves freely between them."""
    if not {"stop_lower", "stop_upper"} <= set(model.free):
        return []
    stiffness = model.values["stop_stiffness"]
    middle = 0.5 * (model.values["stop_lower"] + model.values["stop_upper"])
    spring = {
        "stiffness": model.values.get("stiffness", 0.0) + stiffness,
        "force_offset": model.values.get("force_offset", 0.0) - stiffness * middle,
    }
    return [model.without(EFFECTS["end_stop"].coordinates).adding(None, **spring)]


def simpler_laws(model: Model) -> list[Model]:
    """The model under each friction law with fewer parameters."""
    level, presliding = _level_and_distance(model)
    bare = model.without(LAW_COORDINATES, "none")
    simpler = []
    if model.friction not in ("none", "coulomb"):
        simpler.append(bare.adding("coulomb", coulomb_force=level, **width(bare)))
    if model.friction in ("lugre", "bouc_wen") and presliding:
        simpler.append(bare.adding("dahl", coulomb_force=level, presliding=presliding))
    if model.friction == "lugre":
        names = ("coulomb_force", "static_excess", "stribeck_velocity")
        values = {name: model.values[name] for name in names} | width(bare)
        simpler.append(bare.adding("stribeck", **values))
    return simpler


def with_own_spring(model: Model) -> list[Model]:
    """Dahl friction beside a spring in the place of Bouc-Wen friction, whose law has a spring."""
    level, presliding = _level_and_distance(model)
    if "bw_ratio" not in model.free or not presliding:
        return []
    spring = model.device().bw_ratio * model.device().bw_stiffness
    bare = model.without(LAW_COORDINATES, "none")
    return [bare.adding("dahl", coulomb_force=level, presliding=presliding, stiffness=spring)]
