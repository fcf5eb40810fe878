"""One force law per file; each gives its state's rate, force, stored energy, dissipated power.

Every friction law is a module with the same five names, called as
`force(parameters, displacement, velocity, state)`; `FRICTION` finds it by its name. The other laws
are functions of the parameters and of the quantities their equation names.
"""

from __future__ import annotations

from types import ModuleType

from . import (
    bouc_wen,
    branches,
    brown_mcphee,
    channel,
    control,
    coulomb,
    dahl,
    end_stops,
    free_play,
    gas,
    inertance,
    load,
    lugre,
    maxwell_slip,
    none,
    parallel,
    rate_state,
    series,
    series_spring,
    stribeck,
)
from .device_parameters import FRICTION_SIDES, GAS_LAWS, DeviceParameters
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
    "maxwell_slip": maxwell_slip,
    "rate_state": rate_state,
}

__all__ = [
    "FRICTION",
    "FRICTION_LAWS",
    "FRICTION_SIDES",
    "GAS_LAWS",
    "DeviceParameters",
    "FrictionParameters",
    "Quantity",
    "bouc_wen",
    "branches",
    "brown_mcphee",
    "channel",
    "control",
    "coulomb",
    "dahl",
    "end_stops",
    "free_play",
    "friction_level",
    "gas",
    "inertance",
    "load",
    "lugre",
    "maxwell_slip",
    "none",
    "parallel",
    "parameter",
    "series",
    "series_spring",
    "stribeck",
]
