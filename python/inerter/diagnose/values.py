"""Fitted parameters with their standard errors, beside those that the user states."""

from __future__ import annotations

import math

from inerter.catalogue.along_stroke import REPORTED_UNITS
from inerter.catalogue.coordinates import (
    CHANNEL_UNITS,
    COORDINATES,
    parameter_names,
    search_range,
)
from inerter.catalogue.friction import FRICTION
from inerter.catalogue.scales import Scales
from inerter.core import Device, parameters
from inerter.diagnose.result import ParameterValue, StatedValue
from inerter.identify.fit import Fit, parameter_errors
from inerter.identify.model import Model
from inerter.motion_units import TRANSLATION, Kind, parameter_unit, unit

# of a range, per its size: as near as this to an end is at it
AT_LIMIT = 1e-5


def parameter_units(motion: Kind) -> dict[str, str]:
    """Units of every parameter of a device and of its channels."""
    device = {n: parameter_unit(motion, n, entry.unit) for n, entry in parameters().items()}
    return device | {
        name: unit(motion, each) for name, each in {**CHANNEL_UNITS, **REPORTED_UNITS}.items()
    }


def parameter_values(
    fit: Fit,
    device: Device | None,
    delay: float = 0.0,
    motion: Kind = TRANSLATION,
    sizes: Scales | None = None,
) -> dict[str, ParameterValue]:
    """Every parameter that a fit decided, by name.

    device: the user's own, if any; what it states stands beside what was found, and so does the
    delay of the force channel that is stated with it [s]; motion: what the device does; sizes: of
    the data, by which it is known how far a value may go.
    """
    units = parameter_units(motion)
    found = parameter_errors(fit)
    ends = at_limits(fit.model, sizes) if sizes else frozenset()
    if device is None:
        return {
            n: ParameterValue(value, error, units[n], at_limit=n in ends)
            for n, (value, error) in found.items()
        }
    stated = {n: value for n, value in device.given.items() if not isinstance(value, str)}
    # what a stated law leaves to its defaults is simulated too
    for name in FRICTION[device.friction].set_free:
        for parameter in parameter_names(name):
            stated.setdefault(parameter, float(getattr(device, parameter)))
    if delay:
        stated["delay"] = delay
    return {
        n: StatedValue(value, error, units[n], stated.get(n), at_limit=n in ends)
        for n, (value, error) in found.items()
    }


def at_limits(model: Model, sizes: Scales) -> frozenset[str]:
    """Parameters whose own coordinate a fit left at an end of its range."""
    found = set()
    for name in model.free:
        if name not in COORDINATES or parameter_names(name) != (name,):
            continue
        ends, value = search_range(name, sizes), model.values[name]
        for end in (ends.lower, ends.upper):
            size = max(abs(end), ends.size)
            if math.isfinite(end) and abs(value - end) < AT_LIMIT * size:
                found.add(name)
    return frozenset(found)
