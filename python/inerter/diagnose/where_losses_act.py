"""On which side of a shaft losses act: at the terminals, or on the flywheel behind it.

There they hold the flywheel, and friction sets it swinging. A whole device that stands on a base or
in a frame that gives is the same: all its losses are behind that spring.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from inerter.catalogue.coordinates import ENTANGLED
from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.result import Finding
from inerter.identify.model import BEHIND, Model

SIDE = "friction_side"
"""What a device states of it."""
# friction beside the laws and what varies their level
_RUBBING = ("load_dependent_friction", "friction_play")
# what makes a channel late
_LATE = tuple(
    name for effect in ("sensor_delay", "sensor_filter") for name in EFFECTS[effect].coordinates
)


def rubbing_on_the_other_side(model: Model, baseline: Model) -> list[Model]:
    """The model with its friction on the other side of its shaft, if it has both.

    Where the user states the side it stays. A level that drifts is known at the terminals alone:
    what its change does to the flywheel is not the change of its force.
    """
    drifts, stated = "friction_drift" in model.values, SIDE in baseline.texts
    if stated or drifts or model.friction == "none" or not model.has_series:
        return []
    if model.rubs_behind:
        return [replace(model, texts={**model.texts, SIDE: "terminals"})]
    return [*rubbing_behind([model])]


def damped_on_the_other_side(model: Model, baseline: Model) -> list[Model]:
    """The model with its viscous damping on the other side of its shaft, if it has both.

    What the user states stays. On the flywheel damping is straight: a bend of it, and also what
    makes a channel late, may have stood in for where it acts.
    """
    if "viscous" in baseline.values:
        return []
    if BEHIND in model.free:
        return [model.damped_at("viscous")]
    bends = [name for name in ENTANGLED["viscous"] if name in model.values]
    stated = any(name not in model.free for name in bends)
    if stated or "viscous" not in model.free or not may_damp_behind(model):
        return []
    straight = model.without(bends)
    late = [name for name in _LATE if name in model.free]
    if not late:
        return [straight.damped_at(BEHIND)]
    prompt = straight.without(late)
    half = 0.5 * prompt.values["viscous"]
    found = [straight.damped_at(BEHIND), prompt.damped_at(BEHIND)]
    found.append(prompt.adding(None, viscous=half, flywheel_viscous=half))
    # where the channel was late for both, both may be behind
    return [
        *found,
        *(rub for each in found[1:] for rub in rubbing_on_the_other_side(each, baseline)),
    ]


def may_damp_behind(model: Model) -> bool:
    """Whether there is a shaft, and no damping of its flywheel yet."""
    return model.has_series and BEHIND not in model.values


def may_rub_behind(model: Model) -> bool:
    """Whether there is a shaft, no friction yet, and nobody has stated its side."""
    return model.has_series and model.friction == "none" and SIDE not in model.texts


def rubbing_behind(models: Sequence[Model]) -> tuple[Model, ...]:
    """Models with their friction on the flywheel."""
    return tuple(replace(each, texts={**each.texts, SIDE: "flywheel"}) for each in models)


def with_side(finding: Finding, model: Model) -> Finding:
    """A finding of friction with where it acts; it, and that of a shaft, says what is behind it."""
    effect = EFFECTS[finding.effect]
    rubs, damps = model.rubs_behind, model.has_series and BEHIND in model.free
    if effect.kind == "shaft":
        return finding.remarked(_behind(rubs, damps)) if rubs or damps else finding
    if effect.name == "viscous_friction":
        behind = "" if not damps else "flywheel" if "viscous" not in model.free else "both"
    elif effect.kind in ("law", "level") or effect.name in _RUBBING:
        behind = "flywheel" if rubs else ""
    else:
        return finding
    told = replace(finding, side=behind or "terminals")
    if not behind:
        return told
    part = "A part of it (c_w)" if behind == "both" else "It"
    return told.remarked(f"{part} acts behind the elasticity, on the flywheel.")


def _behind(rubs: bool, damps: bool) -> str:
    what: Sequence[str] = [
        name for name, acts in (("friction", rubs), ("viscous damping", damps)) if acts
    ]
    verb = "act" if len(what) > 1 else "acts"
    named = " and ".join(what)
    return (
        f"The {named} {verb} behind it: a shaft with {named} in the bearings of its flywheel, or "
        "a base or a frame that gives under the whole device."
    )
