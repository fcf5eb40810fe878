"""The models that test an effect: the present one with the effect's coordinates set free.

Friction laws replace one another; everything else adds up. Where a fit is not convex a candidate
has several starting points.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from inerter.diagnose.candidate import Candidate
from inerter.diagnose.composition import has_series, width
from inerter.diagnose.effects import LAW_COORDINATES, LEVEL_COORDINATES, LEVEL_LAWS
from inerter.diagnose.stated import shafts, stated_candidates
from inerter.identify.coordinates import Scales
from inerter.identify.model import Model


def candidates(model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Every candidate that adds something to a model, or sets free what it states."""
    for name, build in _BUILDERS.items():
        yield from build(name, model, sizes)
    yield from stated_candidates(model, sizes)


def _free(*names: str) -> Callable[[str, Model, Scales], Iterator[Candidate]]:
    """An effect whose coordinates are simply added."""

    def build(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
        if not all(name in model.free for name in names):
            none = {name: _small(name, sizes) for name in names}
            stated = {name: model.values.get(name, value) for name, value in none.items()}
            starts = [stated] if stated == none else [stated, none]
            yield Candidate(effect, None, tuple(model.adding(None, **each) for each in starts))

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


def _coulomb(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if model.friction == "none":
        start = model.adding("coulomb", coulomb_force=_level(model, sizes), **width(model))
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
                    **width(model),
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
            (
                *(
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
                _hardening(bare, sizes),
            ),
        )


def _hardening(bare: Model, sizes: Scales) -> Model:
    """Bouc-Wen hysteresis without a largest force: beta and gamma of any sign, here beta < -gamma.

    Along a path away from rest it hardens, which the coordinates of a level cannot say; with an
    exponent above 1 it would run away.
    """
    per_distance = 0.5 / sizes.displacement
    return bare.adding(
        "bouc_wen",
        bw_stiffness=0.5 * sizes.force / sizes.displacement,
        bw_beta=per_distance,
        bw_gamma=-1.5 * per_distance,
        **({} if "stiffness" in bare.values else {"bw_ratio": 0.0}),
    )


def _modulated(
    *names: str, laws: Sequence[str] = LEVEL_LAWS
) -> Callable[[str, Model, Scales], Iterator[Candidate]]:
    """A friction level that varies: on top of the present law, or with Coulomb friction."""

    def build(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
        zero = dict.fromkeys(names, 0.0)
        if model.friction in laws and not all(name in model.free for name in names):
            yield Candidate(effect, None, (model.adding(None, **zero),))
        elif model.friction == "none":
            zero |= {"coulomb_force": _level(model, sizes), **width(model)}
            yield Candidate(effect, None, (model.adding("coulomb", **zero),))

    return build


def _series(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if has_series(model):
        return
    yield Candidate(effect, None, tuple(model.adding(None, **shaft) for shaft in shafts(sizes)))


def _backlash(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if "backlash" in model.values:
        return
    x, slow = sizes.displacement, sizes.frequency
    contacts: list[dict[str, float]] = [{}]
    if not has_series(model):
        contacts = [{"series_frequency": ratio * slow, "series_loss": 0.3} for ratio in (5, 20)]
    starts = tuple(
        model.adding(None, backlash=ratio * x, **contact)
        for ratio in (0.002, 0.01, 0.05, 0.2)
        for contact in contacts
    )
    yield Candidate(effect, None, starts)


def _end_stop(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if "stop_stiffness" in model.values or not np.isfinite(sizes.travel).all():
        return
    low, high = sizes.travel
    contact = {
        "stop_stiffness": 5 * sizes.force / sizes.displacement,
        "stop_damping": 0.1 / sizes.velocity,
    }
    share = 0.5 * (high - low)
    forms = {"upper": (False, True), "lower": (True, False), "both": (True, True)}
    for form, (below, above) in forms.items():
        starts = []
        for depth in (0.03, 0.12, 0.3):
            stops = {"stop_lower": low + depth * share} if below else {}
            stops |= {"stop_upper": high - depth * share} if above else {}
            starts.append(model.adding(None, **stops, **contact))
        yield Candidate(effect, form, tuple(starts))


def _gas(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if (
        "gas_push" in model.values
        or "gas_pressure" in model.values
        or not np.isfinite(sizes.travel).all()
    ):
        return
    deepest = max(-sizes.travel[0], 0.1 * sizes.displacement)
    starts = tuple(
        model.adding(
            gas_push=0.3 * sizes.force * ratio, gas_reach=deepest * ratio, gas_exponent=1.3
        )
        for ratio in (1.2, 2.0, 5.0)
    )
    yield Candidate(effect, None, starts)


def _saturation(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if not np.isfinite(sizes.force_range).all():
        return
    low, high = sizes.force_range
    inside = 0.02 * (high - low)
    limits = {"force_maximum": high - inside, "force_minimum": low + inside}
    missing = {name: value for name, value in limits.items() if name not in model.values}
    if missing == limits:
        yield Candidate(effect, "both", (model.adding(None, **limits),))
    for name, value in missing.items():
        yield Candidate(effect, name, (model.adding(None, **{name: value}),))


def _variable_inertance(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    yield from _free("inertance_gradient", "inertance_curvature")(effect, model, sizes)
    if "inertance_speed_gradient" not in model.free:
        yield Candidate(effect, "speed", (model.adding(inertance_speed_gradient=0.0),))


def _stiffness(effect: str, model: Model, sizes: Scales) -> Iterator[Candidate]:
    # along one sine a spring is an inertance with the other sign: there is nothing to choose
    if not (sizes.one_tone and "inertance" in model.free):
        yield from _free("stiffness")(effect, model, sizes)


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
    "parallel_stiffness": _stiffness,
    "force_offset": _free("force_offset"),
    "sensor_delay": _free("delay"),
    "quadratic_damping": _free("quadratic_damping"),
    "variable_inertance": _variable_inertance,
    "hardening_stiffness": _free("stiffness_cubic"),
    "friction_drift": _modulated("friction_drift", laws=(*LEVEL_LAWS, "bouc_wen")),
    "force_drift": _free("force_drift"),
    "series_elasticity": _series,
    "backlash": _backlash,
    "end_stop": _end_stop,
    "gas_spring": _gas,
    "sensor_saturation": _saturation,
}
