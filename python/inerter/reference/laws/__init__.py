"""One force law per file; each gives its state's rate, force, stored energy, dissipated power.

Every friction law is a module with the same five names, called as
`force(parameters, displacement, velocity, state)`; `FRICTION` finds it by its name.
"""

from __future__ import annotations

from types import ModuleType

from . import bouc_wen, brown_mcphee, coulomb, dahl, load, lugre, none, parallel, stribeck
from .level import friction_level
from .parameters import FRICTION_LAWS, FrictionParameters, Quantity, parameter

FRICTION: dict[str, ModuleType] = {
    "none": none,
    "coulomb": coulomb,
    "stribeck": stribeck,
    "dahl": dahl,
    "lugre": lugre,
    "bouc_wen": bouc_wen,
    "brown_mcphee": brown_mcphee,
}

__all__ = [
    "FRICTION",
    "FRICTION_LAWS",
    "FrictionParameters",
    "Quantity",
    "bouc_wen",
    "brown_mcphee",
    "coulomb",
    "dahl",
    "friction_level",
    "load",
    "lugre",
    "none",
    "parallel",
    "parameter",
    "stribeck",
]
