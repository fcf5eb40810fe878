"""One force law per file; each gives its state's rate, force, stored energy, dissipated power.

Every friction law is a module with the same five names, called as
`force(parameters, displacement, velocity, state)`; `FRICTION` finds it by its name. The other laws
are functions of the parameters and of the quantities their equation names.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

from . import (
    branches,
    channel,
    clutch,
    control,
    damper_spring,
    end_stops,
    free_play,
    gas,
    inertance,
    load,
    parallel,
    series,
    series_spring,
)
from .device_parameters import FRICTION_SIDES, GAS_LAWS, DeviceParameters
from .level import friction_level
from .parameters import FRICTION_LAWS, FrictionParameters, Quantity, parameter

FRICTION: dict[str, ModuleType] = {
    name: import_module(f".{name}", __name__) for name in FRICTION_LAWS
}

__all__ = [
    "FRICTION",
    "FRICTION_LAWS",
    "FRICTION_SIDES",
    "GAS_LAWS",
    "DeviceParameters",
    "FrictionParameters",
    "Quantity",
    "branches",
    "channel",
    "clutch",
    "control",
    "damper_spring",
    "end_stops",
    "free_play",
    "friction_level",
    "gas",
    "inertance",
    "load",
    "parallel",
    "parameter",
    "series",
    "series_spring",
]
