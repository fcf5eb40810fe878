"""Laws within laws: what a simpler law found is a start for one that contains it.

    none in coulomb in stribeck; none in dahl in lugre and bouc_wen (gamma 0, exponent 1)
    coulomb is the limit of dahl for a bristle that yields at once, and of brown_mcphee for a
    Stribeck velocity of 0, but for what happens at speeds near 0

A start from there is no worse than the simpler law; a fit from it is no worse either.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from inerter.catalogue.coordinates import COORDINATES, search_range
from inerter.catalogue.friction import FRICTION
from inerter.catalogue.scales import Scales
from inerter.core import DeviceError
from inerter.identify.laws import FittedLaw
from inerter.identify.model import Model

# distances over which a bristle yields that stands for none, per rms displacement
_SHORT = (2e-5, 2e-4)
# a friction level that stands for none, per rms force
_FAINT = 1e-5
# no value of these means that a shaft is rigid
_RIGID = ("series_frequency", "series_loss")
# of the friction laws themselves
_OWN = {name for law in FRICTION.values() for name in law.coordinates if name != law.level}


def contains(law: FittedLaw, other: FittedLaw, limits: bool = False) -> bool:
    """Whether a law is another one at certain values of its parameters, or comes near to it."""
    own = FRICTION[law.friction]
    inner = (law.friction, *own.contains, *(own.limits if limits else ()))
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
        if (value := COORDINATES[name].neutral(sizes)) is not None and name not in other.values
    }
    inside |= {name: value for name, value in other.values.items() if name in model.free}
    if model.friction in ("none", other.friction):
        yield inside
        return
    law = FRICTION[model.friction]
    if law.peak and law.limits and not law.memory:
        inside[law.peak] = search_range(law.peak, sizes).lower
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
