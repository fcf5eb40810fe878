"""The models that test an effect: the present one with the effect's coordinates set free.

Friction laws replace one another; everything else adds up. Where a fit is not convex a candidate
has several starting points. Most of the catalogue is built by the kind of the effect; what needs
starting points of its own has a function here, by the effect's name.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from inerter.catalogue.along_stroke import QUANTITIES
from inerter.catalogue.coordinates import COORDINATES, FRICTION_SHARE
from inerter.catalogue.effect import Effect
from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.friction import (
    BRISTLES,
    FRICTION,
    LAW_COORDINATES,
    LEVEL_COORDINATES,
    FrictionLaw,
)
from inerter.catalogue.scales import Scales
from inerter.diagnose import bent_damping
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.composition import carries, width
from inerter.diagnose.end_stops import end_stops
from inerter.diagnose.stated import shafts, stated_candidates
from inerter.diagnose.where_losses_act import (
    may_damp_behind,
    may_rub_behind,
    rubbing_behind,
)
from inerter.identify.model import Model
from inerter.identify.transient import RELAXING, SETTLING

Build = Callable[[Effect, Model, Scales], Iterator[Candidate]]


def candidates(model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Every candidate that adds something to a model, or sets free what it states."""
    for each in _built(model, sizes):
        # load friction, say, is none of a hysteresis that hardens without end
        starts = tuple(
            start for start in each.starts if start.is_possible and not _is_drawn(start, model)
        )
        if starts:
            yield replace(each, starts=starts)


def _built(model: Model, sizes: Scales) -> Iterator[Candidate]:
    for effect in EFFECTS.values():
        build = _SPECIAL.get(effect.name) or _OF_KIND[effect.kind]
        yield from build(effect, model, sizes)
    yield from stated_candidates(model, sizes)


def _is_drawn(start: Model, model: Model) -> bool:
    """Whether a start sets free what a curve of the model draws already: a spring, say.

    Beside what was there before it a curve is held at 0 where it would do the same.
    """
    added = set(start.free).difference(model.free)
    return any(
        not (added - model.values.keys()).isdisjoint(quantity.nodes_zero)
        or not added.isdisjoint(quantity.stands_for)
        for quantity in QUANTITIES
        if not model.values.keys().isdisjoint(quantity.nodes)
    )


# --- by kind -----------------------------------------------------------------------------------


def _term(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """An effect whose coordinates are simply added."""
    yield from _free(effect.name, effect.coordinates, model, sizes)


def _free(
    name: str, coordinates: Sequence[str], model: Model, sizes: Scales
) -> Iterator[Candidate]:
    if all(each in model.free for each in coordinates):
        return
    none = {each: COORDINATES[each].begin(sizes) for each in coordinates}
    stated = {each: model.values.get(each, value) for each, value in none.items()}
    starts = [stated] if stated == none else [stated, none]
    yield Candidate(name, None, tuple(model.adding(None, **each) for each in starts))


def _level_of(model: Model, sizes: Scales) -> float:
    return model.values.get("coulomb_force") or FRICTION_SHARE * sizes.force


def _load(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Friction of the load: without another law it reads the width of sign(v)."""
    for each in _term(effect, model, sizes):
        alone = model.friction == "none"
        starts = [start.adding(None, **width(start)) if alone else start for start in each.starts]
        yield replace(each, starts=tuple(starts))


def _law(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Every friction law of an effect that can take the present one's place."""
    for law in FRICTION.values():
        if law.effect == effect.name and model.friction in law.tried_on:
            starts = law_starts(law, model, sizes)
            if starts:
                yield Candidate(effect.name, law.name if effect.tells_law else None, starts)
                if effect.name == "coulomb_friction" and may_rub_behind(model):
                    # at the terminals it may take nothing of what it does behind a shaft
                    yield Candidate(effect.name, "behind", rubbing_behind(starts))
    # of a law that is there, the level alone
    there = effect.name == "coulomb_friction" and FRICTION[model.friction].varies
    if there and "coulomb_force" not in model.free:
        level = model.adding(coulomb_force=_level_of(model, sizes))
        yield Candidate(effect.name, None, (level,))


def law_starts(law: FrictionLaw, model: Model, sizes: Scales) -> tuple[Model, ...]:
    """A law in the place of a model's, from every row of its grid with every other."""
    bare = model
    if not law.varies:
        if any(name in model.values for name in LEVEL_COORDINATES):
            return ()
        bare = model.without(LAW_COORDINATES, "none")
    level = _level_of(model, sizes)
    rows = []
    for name, ratios in law.grid.items():
        known = model.values.get(name)
        unit = COORDINATES[name].start_unit(sizes)
        rows.append([known] if known else [ratio * unit for ratio in ratios])
    starts = []
    for point in product(*rows):
        values = dict(zip(law.grid, point, strict=True)) | {law.level: level}
        for name, share in law.begin.items():
            known = model.values.get(name) if law.varies else None
            of_level = name == "static_excess"
            unit = level if of_level else COORDINATES[name].start_unit(sizes)
            values[name] = share * unit if known is None else known
        if law.smoothed:
            values |= width(model)
        order = [name for name in (*law.coordinates, "transition_velocity") if name in values]
        starts.append(bare.adding(law.name, **{name: values[name] for name in order}))
    return tuple(starts) if law.name != "bouc_wen" else _bouc_wen(starts, bare, sizes)


def _bouc_wen(starts: Sequence[Model], bare: Model, sizes: Scales) -> tuple[Model, ...]:
    """With an elastic share, unless there is a spring, or it is an inertance; and one that hardens.

    Beta and gamma may have any sign: with beta < -gamma it hardens along a path away from rest,
    which the coordinates of a level cannot say; with an exponent above 1 it would run away.
    """
    told = "stiffness" not in bare.values and not (sizes.one_tone and "inertance" in bare.free)
    share = {"bw_ratio": 0.0} if told else {}
    per_distance = 0.5 / sizes.displacement
    hardening = bare.adding(
        "bouc_wen", bw_stiffness=0.5 * sizes.force / sizes.displacement, bw_beta=per_distance,
        bw_gamma=-1.5 * per_distance, **share,
    )  # fmt: skip
    return (*(start.adding(None, **share) for start in starts), hardening)


def _level(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """A friction level that varies: on top of the present law, or with Coulomb friction."""
    if effect.name == "friction_drift" and model.rubs_behind:
        # known at the terminals alone, see `where_losses_act`
        return
    along = effect.name == "position_dependent_friction"
    names = ("friction_gradient", "friction_curvature") if along else effect.coordinates
    zero = dict.fromkeys(names, 0.0)
    if model.friction == "none":
        zero |= {"coulomb_force": _level_of(model, sizes), **width(model)}
        yield Candidate(effect.name, None, (model.adding("coulomb", **zero),))
    elif carries(model.friction, effect.name) and not all(name in model.free for name in names):
        yield Candidate(effect.name, None, (model.adding(None, **zero),))


def _shaft(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    # along one sine a shaft is an inertance of another size
    if not model.has_series and not (sizes.one_tone and "inertance" in model.free):
        starts = tuple(model.adding(None, **shaft) for shaft in shafts(sizes))
        yield Candidate(effect.name, None, starts)
        # what is felt above the resonance of a shaft is what moves before it
        mass = 0.3 * model.values.get("inertance", sizes.force / sizes.acceleration)
        before = tuple(start.adding(None, grip_mass=mass) for start in starts)
        yield Candidate(effect.name, "behind a mass", before)


def _viscous(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Damping between the terminals, and behind a shaft that of the flywheel."""
    yield from _free(effect.name, ("viscous",), model, sizes)
    if may_damp_behind(model) and not sizes.one_tone:
        yield from _free(effect.name, ("flywheel_viscous",), model, sizes)


def _grip(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    # of a device that does not give it is inertance
    if model.has_series and not sizes.one_tone:
        yield from _term(effect, model, sizes)


def _turning(model: Model, sizes: Scales) -> Model | None:
    """The model with a flywheel that is felt, before which something may give; None without one.

    What gives may be why none has been found.
    """
    usual = sizes.force / sizes.acceleration
    if model.values.get("inertance", 0.0) > _FELT * usual:
        return model
    return model.holding(inertance=usual) if "inertance" in model.free else None


def _play(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Free play, or a clutch: a series element has one of them."""
    turning = _turning(model, sizes)
    if turning is None or {"backlash", "clutch_force", *_LEAK} & model.values.keys():
        return
    name, unit, ratios = effect.coordinates[0], sizes.displacement, _PLAYS
    if name == "clutch_force":
        unit, ratios = sizes.force, _CLUTCHES
    contacts: list[dict[str, float]] = [{}]
    if not model.has_series:
        slow = sizes.frequency
        contacts = [{"series_frequency": ratio * slow, "series_loss": 0.3} for ratio in (5, 20)]
    starts = tuple(
        turning.adding(None, **{name: ratio * unit}, **contact)
        for ratio in ratios
        for contact in contacts
    )
    yield Candidate(effect.name, None, starts)


def _leaking(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """A laminar leak, a turbulent one, or one that is both.

    Along one sine it is an inertance of another size and a damper.
    """
    turning = _turning(model, sizes)
    if sizes.one_tone or turning is None or {"backlash", "clutch_force"} & model.values.keys():
        return
    unit = sizes.force / sizes.velocity**2
    forms = {
        ("leak_corner", "leak_damping"): [
            ratio * sizes.frequency for ratio in (0.2, 0.7, 2.0, 6.0)
        ],
        ("leak_quadratic_damping",): [ratio * unit for ratio in (1.0, 5.0, 30.0)],
    }
    for names, values in forms.items():
        if model.values.keys().isdisjoint(names):
            starts = tuple(turning.adding(None, **{names[0]: value}) for value in values)
            yield Candidate(effect.name, names[0], starts)


def _damper(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """A damper's shape, with the damping that has it where there is none."""
    if all(name in model.free for name in effect.coordinates):
        return
    if effect.name == bent_damping.EFFECT and bent_damping.is_bent(model):
        yield from bent_damping.bends_more(model)
        return
    linear = model.values.get("viscous", 0.0) or 0.5 * sizes.force / sizes.velocity
    if effect.name == bent_damping.EFFECT:
        yield from bent_damping.bends(model, linear, sizes)
        return
    start = {"viscous": linear, effect.coordinates[0]: 0.0}
    yield Candidate(effect.name, None, (model.adding(None, **start),))


_OF_KIND: dict[str, Build] = {
    "term": _term, "law": _law, "level": _level, "damper": _damper, "shaft": _shaft, "play": _play,
}  # fmt: skip


# --- with starting points of their own ----------------------------------------------------------


def _gas(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    stated = {"gas_push", "gas_pressure"} & model.values.keys()
    if stated or not np.isfinite(sizes.travel).all():
        return
    # compressed as the device shortens, or on the other side of a piston as it lengthens
    for side, far in (("", -sizes.travel[0]), ("_above", sizes.travel[1])):
        deepest = max(far, 0.1 * sizes.displacement)
        starts = []
        for ratio in (1.2, 2.0, 5.0):
            push, reach = 0.3 * sizes.force * ratio, deepest * ratio
            gas = {"gas_push": push, f"gas_reach{side}": reach, "gas_exponent": 1.3}
            starts.append(model.adding(None, **gas))
        yield Candidate(effect.name, None, tuple(starts))


def _saturation(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if not np.isfinite(sizes.force_range).all():
        return
    low, high = sizes.force_range
    margin = 0.02 * (high - low)
    limits = {"force_maximum": high - margin, "force_minimum": low + margin}
    missing = {name: value for name, value in limits.items() if name not in model.values}
    if missing == limits:
        yield Candidate(effect.name, "both", (model.adding(None, **limits),))
    for name, value in missing.items():
        yield Candidate(effect.name, name, (model.adding(None, **{name: value}),))


def _variable_inertance(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    yield from _free(effect.name, ("inertance_gradient", "inertance_curvature"), model, sizes)
    # along one sine abs(v) a has the third harmonic of x^3, which the curvature has too
    if "inertance_speed_gradient" not in model.free and not sizes.one_tone:
        yield Candidate(effect.name, "speed", (model.adding(inertance_speed_gradient=0.0),))


def _stiffness(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """A spring, and one with a damper beside it: neither does much alone where both are strong."""
    # along one sine a spring is an inertance with the other sign: there is nothing to choose
    if sizes.one_tone and "inertance" in model.free:
        return
    yield from _term(effect, model, sizes)
    if model.values.keys().isdisjoint(("stiffness", "viscous")):
        both = model.adding(None, stiffness=0.0, viscous=0.5 * sizes.force / sizes.velocity)
        yield Candidate(effect.name, "beside a damper", (both,))


def _hardening(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """About the middle, or about another place, where a spring that is straight may not be there.

    Of a motion's zero nobody knows that it is the spring's.
    """
    yield from _free(effect.name, ("stiffness_cubic",), model, sizes)
    if "rest_length" in model.values or sizes.one_tone or not np.isfinite(sizes.travel).all():
        return
    low, high = sizes.travel
    cubic = sizes.force / sizes.displacement**3
    about = tuple(
        model.adding(None, stiffness=sign * 0.3 * cubic * sizes.displacement**2,
                     stiffness_cubic=model.values.get("stiffness_cubic", cubic),
                     rest_length=middle)
        for middle in (low + 0.35 * (high - low), low + 0.65 * (high - low))
        for sign in (1.0, -1.0)
    )  # fmt: skip
    yield Candidate(effect.name, "about", about)


def _inertance(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if "inertance" not in model.free:
        start = model.values.get("inertance") or sizes.force / sizes.acceleration
        yield Candidate(effect.name, None, (model.adding(inertance=start),))


def _play_of_friction(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    if model.friction in BRISTLES and "friction_backlash" not in model.values:
        starts = tuple(
            model.adding(None, friction_backlash=ratio * sizes.displacement, friction_place=0.0)
            for ratio in (0.003, 0.02, 0.1, 0.3)
        )
        yield Candidate(effect.name, None, starts)


def _behind_a_spring(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    yield from bent_damping.lags(model, sizes)


def _relaxing(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """A branch more, up to three, that relaxes within a period or over many."""
    # along one sine it is a stiffness and a damper
    if sizes.one_tone:
        return
    number = 1
    while f"branch_stiffness_{number}" in model.values:
        number += 1
    if number > len(RELAXING):
        return
    stiffness = 0.05 * sizes.force / sizes.displacement
    starts = tuple(
        model.adding(
            None,
            **{f"branch_stiffness_{number}": stiffness, f"branch_time_{number}": time},
        )
        for time in (0.03 / sizes.frequency, 0.2 / sizes.frequency, 1.5 / sizes.frequency)
    )
    yield Candidate(effect.name, None, starts)


def _settling(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """A zero that goes from one place to another, over some periods or most of the record."""
    if model.values.keys().isdisjoint(SETTLING):
        end = {} if "force_offset" in model.values else {"force_offset": 0.0}
        times = _slow_times(sizes)
        starts = tuple(model.adding(None, **end, settling_time=time) for time in times)
        yield Candidate(effect.name, None, starts)


def _coupled(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    """A high-pass of the force; along one sine it is an early force."""
    if model.values.keys().isdisjoint(SETTLING) and not sizes.one_tone:
        corners = [0.5 / np.pi / time for time in _slow_times(sizes)]
        starts = tuple(model.adding(None, force_coupling=corner) for corner in corners)
        yield Candidate(effect.name, None, starts)


def _slow_times(sizes: Scales) -> Sequence[float]:
    """Times [s] from a period to most of the record."""
    shortest = 1.0 / sizes.frequency
    longest = max(0.5 * sizes.run_length, 2.0 * shortest)
    return np.geomspace(shortest, longest, 3).tolist()


def _by_the_search(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    # read off the residual by the search, see `tone` and `along_stroke`
    return iter(())


def _filter(effect: Effect, model: Model, sizes: Scales) -> Iterator[Candidate]:
    # tried where a delay shows, see `low_passes`
    return iter(())


_LEAK = ("leak_corner", "leak_damping", "leak_quadratic_damping")
# force of an inertance from which on it is one, in typical forces
_FELT = 1e-6
# half of a play per stroke, force of a clutch per force
_PLAYS = (0.002, 0.005, 0.01, 0.02, 0.05, 0.2)
_CLUTCHES = (0.4, 0.8, 1.3)

_SPECIAL: dict[str, Build] = {
    "leak": _leaking,
    "viscous_friction": _viscous,
    "load_dependent_friction": _load,
    "sensor_filter": _filter,
    "zero_settling": _settling,
    "sensor_coupling": _coupled,
    "grip_mass": _grip,
    "damper_elasticity": _behind_a_spring,
    "position_force": _by_the_search,
    "friction_play": _play_of_friction,
    "viscoelasticity": _relaxing,
    "inertance_error": _inertance,
    "parallel_stiffness": _stiffness,
    "variable_inertance": _variable_inertance,
    "end_stop": end_stops,
    "hardening_stiffness": _hardening,
    "gas_spring": _gas,
    "sensor_saturation": _saturation,
    "periodic_disturbance": _by_the_search,
}
