"""Models that may say the same with less: a spring for a curve, one cause for two, and the like.

The search comes upon the rich part first where the plain one is of no use alone: a gas spring, say,
beside a constant force that hides where its gas is at rest.
"""

from __future__ import annotations

import numpy as np

from inerter.catalogue.along_stroke import PERIODS, QUANTITIES, TURN
from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.friction import LAW_COORDINATES, LEVEL_COORDINATES
from inerter.catalogue.scales import Scales
from inerter.diagnose.bent_damping import SPRING, is_bent, knee_of, may_lag
from inerter.diagnose.composition import PLAYS, is_shaft, level_and_distance
from inerter.diagnose.statistics import Array
from inerter.identify.model import Model
from inerter.identify.prediction import lateness
from inerter.identify.transient import RELAXING

_FILTER = tuple(n for n in EFFECTS["sensor_filter"].coordinates if n.startswith("force"))
_SHAFT = EFFECTS["series_elasticity"].coordinates
_FORCE = next(each for each in QUANTITIES if each.name == "force")
# a power of the speed that is next to none
_NO_POWER = 0.3
# share of a typical speed below which a knee is no more than where friction begins
_FAR_BELOW = 0.05
# laws of friction with a peak near rest, in the place of those without one
_WITH_A_PEAK = {"coulomb": "stribeck", "dahl": "lugre", "lugre": "lugre"}
# time constants of a leak that the longest run lasts at least: e^-3 of its beginning, 5 %, is left
_CAUGHT = 3.0
# places at which a force of the place is read off
_PLACES = 41
# between slow (1) and quick (1.4)
_EXPONENT = 1.3


def has_plain_shaft(model: Model) -> bool:
    """Whether a shaft without play or clutch is searched for."""
    return set(_SHAFT) <= set(model.free) and PLAYS.isdisjoint(model.values)


def swings_on(model: Model, longest: float, frequency: float) -> bool:
    """Whether a shaft swings by itself through the longest run [s], about as slowly as the motion.

    How it began is free: it stands for any slow sine, and only one that dies away is told from it.
    """
    if not has_plain_shaft(model):
        return False
    swings = model.values["series_frequency"]
    lasting = 2 * np.pi * swings * model.values["series_loss"] * longest < 1.0
    return bool(lasting and swings < 2.0 * frequency)


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


def keeps_its_start(effect: str, model: Model, longest: float, frequency: float) -> bool:
    """Whether how a part moved as a run [s] began, which is free, lasts through all of it.

    A shaft that swings on is any slow sine; a flywheel that a leak does not catch up with turns as
    it did, and is a constant force of each run, and so is a spring that does not relax: what they
    add to the data is none of the motion's.
    """
    if is_shaft(effect) and swings_on(model, longest, frequency):
        return True
    # of the effect that is asked for alone: another one may be on its way
    own = {*EFFECTS[effect].coordinates} & {*model.free} if effect in EFFECTS else set()
    if "leak_corner" in own:
        return 2 * np.pi * model.values["leak_corner"] * longest < _CAUGHT
    return any(model.values[name] > longest for name in own if name.startswith("branch_time_"))


def as_plain_part(model: Model, longest: float, frequency: float) -> list[Model]:
    """A damper, friction, or a spring with any zero for what may be no more, plainest first.

    That is a leak before a flywheel that hardly turns at this frequency [Hz], damping that bends
    with the speed either way, a branch that hardly relaxes in the longest run [s], or so soon that
    it follows a motion of this frequency, one that is the spring before the dampers, a curve of the
    force, and a shaft on which little turns or so softly that it does not follow the motion.
    """
    found = []
    if "inertance" in model.free and has_plain_shaft(model):
        rigid, swings = model.without(_SHAFT), model.values["series_frequency"]
        found.append(rigid)
        if swings < frequency:
            stiffness = model.values["inertance"] * (2 * np.pi * swings) ** 2
            found.append(_with_spring(rigid.holding(inertance=0.0), stiffness, 0.0))
    for number in range(1, len(RELAXING) + 1):
        stiffness, time = f"branch_stiffness_{number}", f"branch_time_{number}"
        if stiffness not in model.free:
            continue
        size, lasts = model.values[stiffness], model.values[time]
        bare = _without_branch(model, number)
        if may_lag(bare):
            damping = bare.values["viscous"] + size * lasts
            found.append(bare.adding(None, viscous=damping, **{SPRING: size}))
        if lasts > 0.5 * longest:
            found.append(_with_spring(bare, size, 0.0))
        elif 2 * np.pi * frequency * lasts < 1.0:
            damping = model.values.get("viscous", 0.0) + size * lasts
            found.append(bare.adding(None, viscous=damping))
    return [
        *found, *_as_dampers(model, frequency), *_as_one_that_bends_less(model),
        *_as_law_of_the_place(model),
    ]  # fmt: skip


def _as_dampers(model: Model, frequency: float) -> list[Model]:
    """What leaks past a flywheel that hardly turns, as dampers between the terminals."""
    corner, bends = model.values.get("leak_corner", 0.0), "leak_quadratic_damping"
    inertance = model.values.get("inertance", 0.0)
    if "inertance" not in model.free or {"leak_corner", bends}.isdisjoint(model.free):
        return []
    typical = 2 * np.pi * corner * inertance
    if not corner < 0.5 * frequency:
        return []
    dampers = {"viscous": model.values.get("viscous", 0.0) + typical} if corner else {}
    if bends in model.values:
        quadratic = "quadratic_damping"
        dampers[quadratic] = model.values.get(quadratic, 0.0) + model.values[bends]
    leak = ("leak_corner", bends, *_SHAFT)
    # without a leak a mass before it would be inertance, and all that is left of it
    mass = model.values.get("grip_mass", 0.0)
    return [model.without(leak).holding(inertance=mass).adding(None, **dampers)]


def as_dampers_that_lag(model: Model) -> list[Model]:
    """Dampers behind a spring, as late, for a force channel that is by a delay or a low-pass."""
    names = [name for name in ("delay", *_FILTER) if name in model.values]
    late = lateness(model.values)
    bare = model.without(names)
    if late <= 0.0 or {"delay", _FILTER[0]}.isdisjoint(model.free) or not may_lag(bare):
        return []
    # beyond its knee a valve is less late
    slope = bare.values["viscous"] * max(bare.values.get("damping_beyond", 1.0), 0.1) ** 0.5
    return [bare.adding(None, **{SPRING: slope / late})]


def as_weight(model: Model) -> list[Model]:
    """A weight out of balance for a torque that bends with the angle: a period of one turn."""
    names = _FORCE.period_of_a_turn(model.values)
    if names is None or {"stiffness_cubic", *_FORCE.nodes}.isdisjoint(model.free):
        return []
    springs = ("stiffness", "stiffness_cubic", "force_offset", *_FORCE.nodes)
    bare = model.without([name for name in springs if name in model.free])
    length, cosine, sine = names
    begin = {
        cosine: model.values.get("force_offset", 0.0),
        sine: model.values.get("stiffness", 0.0),
    }
    return [bare.holding(**{length: TURN}).adding(None, **begin)]


def _as_one_that_bends_less(model: Model) -> list[Model]:
    """For damping that bends: quadratic damping, Coulomb friction, each with a damper, too.

    For a power of the speed that is hardly one Stribeck friction as well.
    """
    bends = EFFECTS["digressive_damping"].coordinates
    if not is_bent(model):
        return []
    damping, beyond = (model.values[name] for name in ("viscous", "damping_beyond"))
    knee = knee_of(model)
    bare = model.without((*bends, "viscous"))
    if beyond > 1.0:
        if "quadratic_damping" in model.values:
            return []
        quadratic = bare.adding(None, quadratic_damping=0.5 * damping * beyond / knee)
        return [quadratic, quadratic.adding(None, viscous=damping)]
    if model.friction != "none":
        return []
    level = damping * knee * max(1.0 - beyond, 0.1)
    friction = bare.adding("coulomb", coulomb_force=level, transition_velocity=0.1 * knee)
    found = [friction, friction.adding(None, viscous=damping * beyond)]
    if abs(model.values.get("damping_exponent", 1.0)) < _NO_POWER:
        # about as large at any speed, and more near rest
        peak = {"coulomb_force": 0.85 * level, "static_excess": 0.3 * level}
        found += [
            bare.adding("stribeck", **peak, stribeck_velocity=ratio * knee)
            for ratio in (30.0, 300.0)
        ]
    return found


def as_one_friction(model: Model, speed: float) -> list[Model]:
    """One friction for two: damping whose knee is far below a speed [m/s] is friction, too.

    Its level alone, with the damping beyond the knee, and with a peak where it falls.
    """
    if (
        not is_bent(model)
        or model.friction not in _WITH_A_PEAK
        or "coulomb_force" not in model.free
    ):
        return []
    knee, damping = knee_of(model), model.values["viscous"]
    if knee > _FAR_BELOW * speed or any(name in model.values for name in LEVEL_COORDINATES):
        return []
    beyond = model.values["damping_beyond"]
    level = model.values["coulomb_force"] + damping * knee * max(1.0 - beyond, 0.1)
    bare = model.without((*EFFECTS["digressive_damping"].coordinates, "viscous"))
    bare = bare.holding(coulomb_force=level)
    found = [bare, bare.adding(None, viscous=damping * max(beyond, 0.01))]
    law = _WITH_A_PEAK[model.friction]
    begin = {"bristle_damping": 0.0} if law == "lugre" and law != model.friction else {}
    for ratio in (3.0, 30.0) if law != model.friction else ():
        peak = {"static_excess": 0.3 * level, "stribeck_velocity": ratio * knee, **begin}
        found.append(bare.adding(law, **peak))
    return found


def as_constant_force(model: Model) -> list[Model]:
    """A constant force for a curve of force, which may be level."""
    nodes = [name for name in _FORCE.nodes if name in model.values]
    if set(nodes).isdisjoint(model.free):
        return []
    mean = float(np.mean([model.values[name] for name in nodes]))
    bare = model.without(nodes)
    return [bare.adding(None, force_offset=bare.values.get("force_offset", 0.0) + mean)]


def _as_law_of_the_place(model: Model) -> list[Model]:
    """A spring, one that hardens, and a gas, each beside a constant force, for a curve of force."""
    nodes = [name for name in _FORCE.nodes if name in model.values]
    if set(nodes).isdisjoint(model.free):
        return []
    places = np.linspace(model.values["curve_lower"], model.values["curve_upper"], len(nodes))
    forces = np.array([model.values[name] for name in nodes])
    return _laws_of_a_place(model.without(nodes), places, forces)


def as_law_of_long_waves(model: Model, sizes: Scales) -> list[Model]:
    """The same for periods of force that the travel does not hold once, and what bends beside.

    A fit may lengthen a period, which is a curve then as any other.
    """
    periods = [_FORCE.period(i) for i in range(1, PERIODS + 1)]
    fitted = [names for names in periods if names[0] in model.free]
    long = [names for names in fitted if model.values[names[0]] > np.ptp(sizes.travel)]
    if not long:
        return []
    names = (*sum(long, ()), "stiffness_cubic", "rest_length", "stiffness")
    alone = {name: model.values[name] for name in names if name in model.values}
    places = np.linspace(*sizes.travel, _PLACES)
    still = np.zeros_like(places)
    forces = Model("none", alone, ()).device().along(1.0, places, still, still)["total"]
    return _laws_of_a_place(model.without([n for n in alone if n in model.free]), places, forces)


def _laws_of_a_place(bare: Model, places: Array, forces: Array) -> list[Model]:
    spring = _with_spring(bare, *np.polyfit(places, forces, 1))
    found = [spring, spring.adding(None, stiffness_cubic=0.0)]
    if not {"gas_push", "gas_pressure"} & bare.values.keys():
        found += _as_gas(bare, places, forces)
    return found


def _as_gas(bare: Model, places: Array, forces: Array) -> list[Model]:
    """The gas, among some heights of it on either side, that comes nearest to forces at places."""
    nearest, gas = np.inf, []
    for side, sign in (("", 1.0), ("_above", -1.0)):
        # compressed where the sign makes a place negative
        pressed = sign * places
        for ratio in (1.2, 1.6, 2.5, 5.0) if np.min(pressed) < 0.0 else ():
            reach = -ratio * float(np.min(pressed))
            shape = sign * (1.0 - (1.0 + pressed / reach) ** -_EXPONENT)
            columns = np.column_stack([shape, np.ones_like(shape)])
            (push, offset), *_ = np.linalg.lstsq(columns, forces)
            missed = float(np.sum((columns @ (push, offset) - forces) ** 2))
            if push > 0.0 and missed < nearest:
                nearest = missed
                law = {"gas_push": float(push), f"gas_reach{side}": reach}
                law["gas_exponent"] = _EXPONENT
                offset += bare.values.get("force_offset", 0.0)
                gas = [bare.adding(None, **law, force_offset=float(offset))]
    return gas


def _without_branch(model: Model, number: int) -> Model:
    """A model without one of its branches; every later one takes the place before it."""
    this, following = (
        tuple(f"branch_{name}_{i}" for name in ("stiffness", "time")) for i in (number, number + 1)
    )
    if following[0] not in model.free:
        return model.without(this)
    moved = {a: model.values[b] for a, b in zip(this, following, strict=True)}
    return _without_branch(model.holding(**moved), number + 1)


def _with_spring(model: Model, stiffness: float, offset: float) -> Model:
    more = {"stiffness": stiffness, "force_offset": offset}
    return model.adding(None, **{name: model.values.get(name, 0.0) + more[name] for name in more})


def with_own_spring(model: Model) -> list[Model]:
    """Dahl friction beside a spring in the place of Bouc-Wen friction, whose law has a spring."""
    level, presliding = level_and_distance(model)
    if "bw_ratio" not in model.free or not presliding:
        return []
    spring = model.device().bw_ratio * model.device().bw_stiffness
    bare = model.without(LAW_COORDINATES, "none")
    return [bare.adding("dahl", coulomb_force=level, presliding=presliding, stiffness=spring)]
