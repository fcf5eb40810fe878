"""Damping that bends with the speed, where a search begins with it, and how it may bend more.

Two straight lines, of one valve or of one for each direction, gently or in a corner; or a power of
the speed beyond the knee, of oil that thins and of brakes whose force falls. The knee of a power
may be far below the speeds of the motion: there it is what rounds the corner of a true power.
"""

from __future__ import annotations

from collections.abc import Iterator

from inerter.catalogue.coordinates import FRICTION_SHARE
from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.scales import Scales
from inerter.diagnose.candidate import Candidate
from inerter.identify.model import Model

EFFECT = EFFECTS["digressive_damping"].name
SPRING = "damper_stiffness"
"""What says that the dampers are behind a spring."""
_LINE, _POWER = "damping_knee", "damping_power_knee"
_BACK = ("damping_knee_back", "damping_beyond_back")
# of a typical displacement
_PRESLIDING = 0.02
# stiffness of a mount over force per displacement
_MOUNT = 10.0
# slope at rest over that of a straight line, knee over a typical speed, power
_POWERS = ((20.0, 0.01, 0.35), (3.0, 0.2, 0.5), (2.0, 0.5, -0.8), (1.0, 1.5, -0.8))


def is_bent(model: Model) -> bool:
    """Whether damping bends already."""
    return not {_LINE, _POWER}.isdisjoint(model.free)


def knee_of(model: Model) -> float:
    """Its knee [m/s]."""
    return model.values[_POWER if _POWER in model.values else _LINE]


def may_lag(model: Model) -> bool:
    """Whether dampers may be behind a spring: a straight one there is a spring that relaxes."""
    shapes = ("damping_asymmetry", "quadratic_damping", _LINE, _POWER)
    shaped = any(model.values.get(name, 0.0) for name in shapes)
    falls = model.values.get("damping_exponent", 0.0) < 0.0
    return shaped and not falls and bool(model.values.get("viscous")) and SPRING not in model.values


def lags(model: Model, sizes: Scales) -> Iterator[Candidate]:
    """Dampers behind a spring that takes half of the stroke to a hundredth of it."""
    if may_lag(model):
        unit = sizes.force / sizes.displacement
        starts = tuple(
            model.adding(None, **{SPRING: ratio * unit}) for ratio in (2.0, 8.0, 30.0, 100.0)
        )
        yield Candidate("damper_elasticity", None, starts)


def struts(model: Model, sizes: Scales) -> list[Model]:
    """Damping that bends and dry friction, both behind a spring, as a strut behind its top mount.

    Friction behind a spring is Dahl's.
    """
    damped = "viscous" in model.free and SPRING not in model.values
    if sizes.one_tone or not damped or model.friction not in ("none", "coulomb", "dahl"):
        return []
    strut = model.adding(None, **{SPRING: _MOUNT * sizes.force / sizes.displacement})
    if not is_bent(model):
        strut = strut.adding(None, damping_knee=sizes.velocity, damping_beyond=0.3)
    if model.friction != "dahl":
        level = model.values.get("coulomb_force") or FRICTION_SHARE * sizes.force
        strut = _with_memory(strut, level, sizes)
    return [strut]


def bends(model: Model, linear: float, sizes: Scales) -> Iterator[Candidate]:
    """Of damping that is straight, about what it has for all of it [N s/m]."""
    lines = tuple(
        model.adding(
            None, viscous=slope * linear, damping_knee=knee * sizes.velocity, damping_beyond=beyond
        )
        for slope, knee, beyond in ((3.0, 0.25, 0.2), (1.5, 1.0, 0.3), (0.7, 1.0, 3.0))
    )
    yield Candidate(EFFECT, None, lines)
    bare = model.without(EFFECTS[EFFECT].coordinates).holding(damping_beyond=0.0)
    powers = tuple(
        bare.adding(
            None, viscous=slope * linear, damping_power_knee=knee * sizes.velocity,
            damping_exponent=power,
        )
        for slope, knee, power in _POWERS
    )  # fmt: skip
    yield Candidate(EFFECT, "power", powers)


def straight_bends(model: Model, sizes: Scales) -> list[Model]:
    """Of damping that goes with a power of the speed two straight lines, about as large there.

    They meet in a corner more or less; how sharp it is is free.
    """
    if _POWER not in model.free:
        return []
    knee, power, speed = knee_of(model), model.values["damping_exponent"], sizes.velocity
    linear = model.values["viscous"] * min(1.0, (knee / speed) ** (1.0 - power))
    bare = model.without((_POWER, "damping_exponent", "damping_beyond"))
    return [
        bare.holding(viscous=slope * linear).adding(
            None, damping_knee=share * speed, damping_beyond=beyond, damping_sharpness=8.0
        )
        for slope, share, beyond in ((3.0, 0.25, 0.2), (1.5, 1.0, 0.3))
    ]


def bends_more(model: Model) -> Iterator[Candidate]:
    """Of damping that bends: sharply, in each direction by itself, with a power, to a line."""
    values = model.values
    knee, beyond = knee_of(model), values["damping_beyond"]
    if _POWER in values:
        if "damping_beyond" not in model.free:
            yield Candidate(EFFECT, "beyond", (model.adding(None, damping_beyond=0.1),))
        return
    if "damping_sharpness" not in values:
        sharper = tuple(model.adding(None, damping_sharpness=n) for n in (3.0, 8.0))
        yield Candidate(EFFECT, "sharp", sharper)
    if "damping_knee_back" not in values:
        opens = tuple(
            model.adding(None, damping_knee_back=ratio * knee) for ratio in (1.0, 0.4, 2.5)
        )
        yield Candidate(EFFECT, "knees", opens)
        both = tuple(start.adding(None, damping_beyond_back=beyond) for start in opens)
        yield Candidate(EFFECT, "directions", both)
        bare = model.without((_LINE, "damping_sharpness"))
        powers = tuple(
            bare.adding(None, damping_power_knee=knee, damping_exponent=power)
            for power in (0.4, -0.6)
        )
        yield Candidate(EFFECT, "power", powers)
    elif "damping_beyond_back" not in values:
        slopes = model.adding(None, damping_beyond_back=beyond)
        yield Candidate(EFFECT, "slopes", (slopes,))


def bends_each_way(model: Model, sizes: Scales) -> list[Model]:
    """Of damping that bends all at once: in each direction by itself, rounded, beside friction.

    What lacks one of these has others stand in for it, and none of them is of use alone then: from
    the forms that it has, and anew.
    """
    found = []
    for bent in [model] if _LINE in model.free else straight_bends(model, sizes):
        kept = bent.without(("quadratic_damping",))
        beyond = max(kept.values["damping_beyond"], 0.2)
        forms = {"damping_asymmetry": 0.0, "damping_sharpness": 8.0}
        forms |= {_BACK[0]: kept.values[_LINE], _BACK[1]: beyond}
        more = {name: value for name, value in forms.items() if name not in kept.values}
        found += _beside_friction(kept.holding(damping_beyond=beyond).adding(None, **more), sizes)
    bare = model.without((*EFFECTS[EFFECT].coordinates, "quadratic_damping", SPRING))
    anew = dict.fromkeys((_LINE, _BACK[0]), 0.7 * sizes.velocity)
    anew |= dict.fromkeys(("damping_beyond", _BACK[1]), 0.3)
    anew |= {"viscous": sizes.force / sizes.velocity, "damping_asymmetry": 0.0}
    bare = bare.adding(None, **anew, damping_sharpness=3.0)
    found += _beside_friction(bare, sizes)
    return [each for each in found if each.shape != model.shape]


def _beside_friction(model: Model, sizes: Scales) -> list[Model]:
    """With dry friction, with memory too; what differs between the directions may be constant."""
    width, level = model.values["transition_velocity"], FRICTION_SHARE * sizes.force
    found = [model]
    if model.friction == "none":
        found = [model.adding("coulomb", coulomb_force=level, transition_velocity=width)]
    elif "friction_asymmetry" in model.free:
        level, uneven = model.values["coulomb_force"], model.values["friction_asymmetry"]
        offset = model.values.get("force_offset", 0.0) + uneven * level
        found.append(model.without(("friction_asymmetry",)).adding(None, force_offset=offset))
    if model.friction in ("none", "coulomb"):
        found.append(_with_memory(found[-1], level, sizes))
    return found


def _with_memory(model: Model, level: float, sizes: Scales) -> Model:
    """With Dahl friction of a level [N]."""
    dahl = {"coulomb_force": level, "presliding": _PRESLIDING * sizes.displacement}
    return model.without((), "none").adding("dahl", **dahl)


def bends_less(model: Model) -> list[Model]:
    """The model with damping that bends alike in both directions, gently, to a straight line."""
    parts = (_BACK, _BACK[1:], ("damping_sharpness",))
    less = [model.without(names) for names in parts if not {*names}.isdisjoint(model.free)]
    if _POWER not in model.free:
        return less
    knee, beyond = model.values[_POWER], model.values["damping_beyond"]
    line = model.without((_POWER, "damping_exponent"))
    less.append(line.adding(None, damping_knee=knee, damping_beyond=beyond))
    if "damping_beyond" in model.free:
        less.append(model.without(("damping_beyond",)).holding(damping_beyond=0.0))
    return less
