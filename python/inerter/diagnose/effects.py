"""The effects that a diagnosis can name, and the models that test them.

Each effect turns the present model into one or more candidates: the model with the effect's
coordinates set free, from several starting values where the fit is not convex. Friction laws
replace one another; everything else adds up. `effects_of` reads the effects off a model, so that a
name depends on the model alone and not on the way the search took.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from inerter.identify.coordinates import Scales
from inerter.identify.fit import Fit, Model

# laws whose levels can differ with direction and position
LEVEL_LAWS = ("coulomb", "stribeck", "dahl", "lugre")

# coordinates that belong to a friction law and leave with it
LAW_COORDINATES = (
    "coulomb_force",
    "static_excess",
    "stribeck_velocity",
    "presliding",
    "bristle_damping",
    "bw_level",
    "bw_shape",
    "bw_exponent",
    "bw_ratio",
)
LEVEL_COORDINATES = ("friction_asymmetry", "friction_gradient", "friction_curvature")


@dataclass(frozen=True)
class Effect:
    """An effect by its contract name.

    Attributes
    ----------
    coordinates : tuple of str
        Coordinates that come and go with it (for hysteretic and Stribeck friction: see `law`).
    parameters : tuple of str
        Device parameters that a finding reports.
    meaning, cause : str
        What it adds to F = b a, and what makes it in a real device.
    taken_for : str
        What it is easily taken for, and the experiment that tells them apart.
    """

    name: str
    coordinates: tuple[str, ...]
    parameters: tuple[str, ...]
    meaning: str
    cause: str
    taken_for: str


EFFECTS = {
    effect.name: effect
    for effect in (
        Effect(
            "inertance_error",
            ("inertance",),
            ("inertance",),
            "b differs from what is stated",
            "flywheel inertia, lead or gear ratio other than in the data sheet",
            "a wrong force or displacement calibration: check both against a known mass",
        ),
        Effect(
            "viscous_friction",
            ("viscous",),
            ("viscous",),
            "c v",
            "lubricant shear in bearings, screw and seals",
            "sensor delay: repeat at twice the frequency, a delay grows with its cube",
        ),
        Effect(
            "coulomb_friction",
            ("coulomb_force",),
            ("coulomb_force",),
            "f_c sign(v)",
            "dry sliding in seals, guides and preloaded screws",
            "hysteretic friction: dwell at mid-stroke and watch whether the force stays",
        ),
        Effect(
            "stribeck_friction",
            ("coulomb_force", "static_excess", "stribeck_velocity"),
            ("coulomb_force", "static_force", "stribeck_velocity"),
            "[f_c + (f_s - f_c) exp(-(v/v_s)^2)] sign(v)",
            "lubricated contacts that lift off their asperities as the speed grows",
            "Coulomb with viscous friction: run slow strokes below the Stribeck velocity",
        ),
        Effect(
            "hysteretic_friction",
            LAW_COORDINATES,
            (
                "coulomb_force",
                "static_force",
                "stribeck_velocity",
                "bristle_stiffness",
                "bristle_damping",
                "bw_stiffness",
                "bw_beta",
                "bw_gamma",
                "bw_exponent",
                "bw_ratio",
            ),
            "friction with memory: it builds up over a pre-sliding distance and stays at rest",
            "elastic asperities, seals and preloaded balls that bend before they slide",
            "parallel stiffness or backlash: repeat with strokes shorter than the pre-sliding "
            "distance",
        ),
        Effect(
            "asymmetric_friction",
            ("friction_asymmetry",),
            ("coulomb_force", "friction_asymmetry"),
            "friction level differs between the two directions",
            "one-sided preload, a lip seal, a helical gear's thrust",
            "a constant force: repeat with the device turned round",
        ),
        Effect(
            "position_dependent_friction",
            ("friction_gradient", "friction_curvature"),
            ("coulomb_force", "friction_gradient", "friction_curvature"),
            "friction level changes along the stroke",
            "a bent screw, tight guides, wear at mid-stroke",
            "parallel stiffness: it does not change sign with the direction of motion",
        ),
        Effect(
            "load_dependent_friction",
            ("load_friction",),
            ("load_friction",),
            "mu |b a| sign(v)",
            "the flywheel's force pressed through screw threads or gear teeth",
            "Coulomb friction: repeat with another flywheel",
        ),
        Effect(
            "parallel_stiffness",
            ("stiffness",),
            ("stiffness",),
            "k x",
            "a centring spring, a rubber mount, trapped air",
            "a wrong inertance at one frequency: use at least two frequencies",
        ),
        Effect(
            "force_offset",
            ("force_offset",),
            ("force_offset",),
            "a constant force",
            "weight of the flywheel, preload, a load cell that was not zeroed",
            "asymmetric friction: a dwell shows the constant force alone",
        ),
        Effect(
            "sensor_delay",
            ("delay",),
            ("delay",),
            "the force channel is late by a constant time",
            "filters or clocks that differ between the channels",
            "series elasticity and viscous friction: they change with amplitude or with "
            "frequency, a delay does not",
        ),
        Effect(
            "variable_inertance",
            ("inertance_gradient", "inertance_curvature"),
            ("inertance", "inertance_gradient", "inertance_curvature"),
            "b depends on displacement: b(x) a + b'(x) v^2 / 2",
            "a ratio that varies along the stroke: rack and pinion, eccentric gear, moving fluid",
            "parallel stiffness: repeat at twice the frequency, the inertance force grows fourfold",
        ),
        Effect(
            "quadratic_damping",
            ("quadratic_damping",),
            ("quadratic_damping",),
            "c2 v |v|",
            "turbulent flow, windage of the flywheel",
            "viscous friction: repeat at twice the amplitude",
        ),
    )
}


# coordinates whose being zero means that the effect is absent, where not all of them do
_AMPLITUDES = {
    "stribeck_friction": ("static_excess",),
    "hysteretic_friction": ("coulomb_force", "bw_level"),
    "inertance_error": (),
}


def is_distinct(effect: str, fit: Fit, required: float) -> bool:
    """Whether a fitted effect differs from none by some standard errors of its coordinates."""
    names = _AMPLITUDES.get(effect, EFFECTS[effect].coordinates)
    errors = dict(zip(fit.model.free, np.sqrt(np.maximum(np.diag(fit.covariance), 0)), strict=True))
    known = [name for name in names if name in errors]
    return not known or any(abs(fit.model.values[name]) > required * errors[name] for name in known)


@dataclass(frozen=True)
class Candidate:
    """A model to try for an effect, with the starting points of its fit."""

    effect: str
    law: str | None
    starts: tuple[Model, ...]


def candidates(model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Every candidate that adds something to a model."""
    for name, build in _BUILDERS.items():
        yield from build(name, model, sizes)


def _free(*names: str) -> Callable[[str, Model, Scales], Iterator[Candidate]]:
    """An effect whose coordinates are simply added."""

    def build(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
        if not all(name in model.free for name in names):
            start = {name: model.values.get(name, _small(name, sizes)) for name in names}
            yield Candidate(effect, None, (model.adding(None, **start),))

    return build


def _small(name: str, sizes: Scales) -> float:
    # just off the bound at zero, where the trust region would be stuck
    return {
        "viscous": 0.01 * sizes.force / sizes.velocity,
        "quadratic_damping": 0.01 * sizes.force / sizes.velocity**2,
        "load_friction": 0.01,
    }.get(name, 0.0)


def _level(model: Model, sizes: Scales) -> float:
    return model.values.get("coulomb_force") or 0.1 * sizes.force


def _width(model: Model) -> dict[str, float]:
    # how sharp sign(v) looks depends on the velocity's noise: it is fitted along
    return {"transition_velocity": model.values["transition_velocity"]}


def _coulomb(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if model.friction == "none":
        start = model.adding("coulomb", coulomb_force=_level(model, sizes), **_width(model))
        yield Candidate(effect, None, (start,))
    elif model.friction in LEVEL_LAWS and "coulomb_force" not in model.free:
        yield Candidate(effect, None, (model.adding(coulomb_force=_level(model, sizes)),))


def _stribeck(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if model.friction in ("none", "coulomb"):
        level = _level(model, sizes)
        yield Candidate(
            effect,
            None,
            tuple(
                model.adding(
                    "stribeck",
                    coulomb_force=level,
                    static_excess=0.5 * level,
                    stribeck_velocity=ratio * sizes.velocity,
                    **_width(model),
                )
                for ratio in (0.03, 0.1, 0.4)
            ),
        )


def _hysteretic(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    level, x, v = _level(model, sizes), sizes.displacement, sizes.velocity
    if model.friction in ("none", "coulomb"):
        yield Candidate(
            effect,
            "dahl",
            tuple(
                model.adding("dahl", coulomb_force=level, presliding=ratio * x)
                for ratio in (0.003, 0.03, 0.3)
            ),
        )
    if model.friction in ("none", "coulomb", "stribeck", "dahl"):
        pre = model.values.get("presliding")
        speed = model.values.get("stribeck_velocity")
        yield Candidate(
            effect,
            "lugre",
            tuple(
                model.adding(
                    "lugre",
                    coulomb_force=level,
                    static_excess=model.values.get("static_excess", 0.5 * level),
                    stribeck_velocity=v_s,
                    presliding=distance,
                    bristle_damping=0.001 * sizes.force / v,
                )
                for distance in ((pre,) if pre else (0.003 * x, 0.03 * x, 0.2 * x))
                for v_s in ((speed,) if speed else (0.05 * v, 0.3 * v))
            ),
        )
    modulated = any(name in model.values for name in LEVEL_COORDINATES)
    if model.friction in ("none", "coulomb", "dahl") and not modulated:
        bare = model.without(LAW_COORDINATES, "none")
        pre = model.values.get("presliding")
        yield Candidate(
            effect,
            "bouc_wen",
            tuple(
                bare.adding(
                    "bouc_wen",
                    bw_level=level,
                    presliding=distance,
                    bw_shape=shape,
                    bw_exponent=1.2,
                    **({} if "stiffness" in model.values else {"bw_ratio": 0.0}),
                )
                for distance in ((pre,) if pre else (0.01 * x, 0.1 * x, 0.5 * x))
                for shape in (0.6, 1.0)
            ),
        )


def _modulated(*names: str) -> Callable[[str, Model, Scales], Iterator[Candidate]]:
    """A friction level that varies: on top of the present law, or with Coulomb friction."""

    def build(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
        zero = dict.fromkeys(names, 0.0)
        if model.friction in LEVEL_LAWS and not all(name in model.free for name in names):
            yield Candidate(effect, None, (model.adding(None, **zero),))
        elif model.friction == "none":
            zero |= {"coulomb_force": _level(model, sizes), **_width(model)}
            yield Candidate(effect, None, (model.adding("coulomb", **zero),))

    return build


def _inertance(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if "inertance" not in model.free:
        start = model.values.get("inertance") or sizes.force / sizes.acceleration
        yield Candidate(effect, None, (model.adding(inertance=start),))


_BUILDERS: dict[str, Callable[[str, Model, Scales], Iterator[Candidate]]] = {
    "inertance_error": _inertance,
    "viscous_friction": _free("viscous"),
    "coulomb_friction": _coulomb,
    "stribeck_friction": _stribeck,
    "hysteretic_friction": _hysteretic,
    "asymmetric_friction": _modulated("friction_asymmetry"),
    "position_dependent_friction": _modulated("friction_gradient", "friction_curvature"),
    "load_dependent_friction": _free("load_friction"),
    "parallel_stiffness": _free("stiffness"),
    "force_offset": _free("force_offset"),
    "sensor_delay": _free("delay"),
    "quadratic_damping": _free("quadratic_damping"),
    "variable_inertance": _free("inertance_gradient", "inertance_curvature"),
}

_LAW_EFFECT = {
    "coulomb": "coulomb_friction",
    "stribeck": "stribeck_friction",
    "dahl": "hysteretic_friction",
    "lugre": "hysteretic_friction",
    "bouc_wen": "hysteretic_friction",
}
_MODULATIONS = ("asymmetric_friction", "position_dependent_friction")
_SIMPLE = (
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
    if law_touched and model.friction in _LAW_EFFECT:
        effect = _LAW_EFFECT[model.friction]
        if not (effect == "coulomb_friction" and modulations):
            found.append((effect, model.friction if effect == "hysteretic_friction" else None))
    found += [(name, None) for name in modulations]
    found += [(n, None) for n in _SIMPLE if any(c in added for c in EFFECTS[n].coordinates)]
    if "inertance" in added:
        found.append(("inertance_error", None))
    return found


def without_effect(model: Model, effect: str, baseline: Model) -> list[Model]:
    """Simpler models: without an effect, and for friction laws also with each simpler law."""
    names = [name for name, _ in effects_of(model, baseline)]
    without = submodel(model, [name for name in names if name != effect], baseline)
    if effect in ("hysteretic_friction", "stribeck_friction"):
        return [*simpler_laws(model), without]
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
    laws = [name for name in present if name in _LAW_EFFECT.values()]
    names: set[str] = set()
    for name in dropped:
        names.update(EFFECTS[name].coordinates if name not in laws else LAW_COORDINATES)
    friction = model.friction
    kept_modulations = [name for name in _MODULATIONS if name in effects and name in present]
    if (laws and laws[0] in dropped) or (
        not laws and not kept_modulations and not _stated_friction(baseline)
    ):
        # without its law, a level that varies needs Coulomb friction to act on
        level = model.values.get("coulomb_force", model.values.get("bw_level", 0.0))
        names.update(LAW_COORDINATES)
        if kept_modulations and baseline.friction == "none":
            bare = _restored(model.without(tuple(names), "none"), names, baseline)
            return bare.adding("coulomb", coulomb_force=level, **_width(bare))
        friction = baseline.friction
        if friction == "none":
            names.update(LEVEL_COORDINATES)
    return _restored(model.without(tuple(names), friction), names, baseline)


def _stated_friction(baseline: Model) -> bool:
    return baseline.friction != "none"


def _restored(bare: Model, names: Iterable[str], baseline: Model) -> Model:
    """Put back what the baseline states of the names that were taken out."""
    stated = {name: baseline.values[name] for name in names if name in baseline.values}
    free = tuple(name for name in baseline.free if name in names and name not in bare.free)
    return Model(bare.friction, {**bare.values, **stated}, bare.free + free)


def simpler_laws(model: Model) -> list[Model]:
    """The model under each friction law with fewer parameters."""
    level = model.values.get("coulomb_force", model.values.get("bw_level", 0.0))
    presliding = model.values.get("presliding")
    bare = model.without(LAW_COORDINATES, "none")
    simpler = []
    if model.friction not in ("none", "coulomb"):
        simpler.append(bare.adding("coulomb", coulomb_force=level, **_width(bare)))
    if model.friction in ("lugre", "bouc_wen") and presliding:
        simpler.append(bare.adding("dahl", coulomb_force=level, presliding=presliding))
    if model.friction == "lugre":
        names = ("coulomb_force", "static_excess", "stribeck_velocity")
        values = {name: model.values[name] for name in names} | _width(bare)
        simpler.append(bare.adding("stribeck", **values))
    return simpler
