"""Laws within laws: what a simpler law found is a start for one that contains it.

    none in coulomb in stribeck; none in dahl in lugre and bouc_wen (gamma 0, exponent 1)
    coulomb is the limit of dahl for a bristle that yields at once, and of brown_mcphee for a
    Stribeck velocity of 0, but for what happens at speeds near 0

A start from there is no worse than the simpler law; a fit from it is no worse either.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from inerter.core import DeviceError
from inerter.identify.coordinates import Scales, coordinate
from inerter.identify.laws import PARTS, Law
from inerter.identify.model import Model

CONTAINED = {
    "none": ("none",),
    "coulomb": ("none", "coulomb"),
    "stribeck": ("none", "coulomb", "stribeck"),
    "brown_mcphee": ("none", "brown_mcphee"),
    "dahl": ("none", "dahl"),
    "lugre": ("none", "dahl", "lugre"),
    "bouc_wen": ("none", "dahl", "bouc_wen"),
}
"""Friction laws that are a friction law with some of its parameters at certain values."""

LIMITS = {"brown_mcphee": ("coulomb",), "dahl": ("coulomb",), "lugre": ("coulomb",),
          "bouc_wen": ("coulomb",)}  # fmt: skip
"""Friction laws that a friction law comes near to."""

# distances over which a bristle yields that stands for none, per rms displacement
_SHORT = (2e-5, 2e-4)
# a friction level that stands for none, per rms force
_FAINT = 1e-5
# how a part begins that is not there
_RIGID = ("series_frequency", "series_loss")
# of the friction laws themselves
_OWN = {
    name
    for part in PARTS.values()
    if part.friction and part.name != "fluid"
    for name in (*part.starts, "bw_stiffness")
}


def contains(law: Law, other: Law, limits: bool = False) -> bool:
    """Whether a law is another one at certain values of its parameters, or comes near to it."""
    inner = CONTAINED[law.friction] + (LIMITS.get(law.friction, ()) if limits else ())
    if law == other or other.friction not in inner:
        return False
    terms = {name for each in (law, other) for name in each.starts if name not in _OWN}
    more = terms - set(other.starts)
    return (
        terms <= set(law.starts)
        and set(other.linear) - _OWN <= set(law.linear)
        # a rigid shaft is at no value, nor is one bouc_wen within the other by its coordinates
        and not more & {*_RIGID, "backlash"}
        and not (
            law.friction == other.friction == "bouc_wen"
            and ("bw_stiffness" in law.linear) != ("bw_stiffness" in other.linear)
        )
    )


def embedded(model: Model, simpler: Sequence[Model], sizes: Scales) -> Iterator[Model]:
    """What simpler models found as models of a law, of which `model` is one."""
    for other in simpler:
        for values in _values(model, other, sizes):
            free = {name: values[name] for name in model.free if name in values}
            found = replace(model, values={**model.values, **free})
            try:
                found.device()
            except DeviceError:
                continue
            yield found


def _values(model: Model, other: Model, sizes: Scales) -> Iterator[dict[str, float]]:
    """Coordinates that say of a law what another model says."""
    inside = {
        name: value
        for name in model.free
        if (value := _neutral(name, sizes)) is not None and name not in other.values
    }
    inside |= {name: value for name, value in other.values.items() if name in model.free}
    if model.friction in ("none", other.friction):
        yield inside
        return
    if model.friction == "brown_mcphee":
        inside["stribeck_velocity"] = coordinate("stribeck_velocity", sizes).lower
    level = other.values.get("coulomb_force", _FAINT * sizes.force)
    inside["coulomb_force"] = inside["bw_level"] = level
    if "presliding" in other.values:
        distances = [other.values["presliding"]]
    else:
        distances = [share * sizes.displacement for share in _SHORT]
    for distance in distances:
        yield inside | {
            "presliding": distance,
            "bw_shape": 1.0,
            "bw_exponent": 1.0,
            "bw_stiffness": level / distance,
            "bw_beta": 1.0 / distance,
            "bw_gamma": 0.0,
        }
        if "presliding" not in model.free and "bw_beta" not in model.free:
            return


def _neutral(name: str, sizes: Scales) -> float | None:
    """Where a coordinate has no effect, within its range; None where it takes another to say."""
    how = coordinate(name, sizes)
    if name == "friction_backlash":
        return how.lower
    if name in ("inertance", "transition_velocity", *_RIGID) or name in _OWN - {
        "static_excess", "bristle_damping",
    }:  # fmt: skip
        return None
    return max(0.0, how.lower)
