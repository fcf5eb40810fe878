"""The parameters of a device as plain attributes, which user functions read often."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import SimpleNamespace
from typing import Any

from inerter.core import WORDS, Device, DeviceError, lists, parameters

ALIASES = {
    "damping": "viscous",
    "referenceLength": "rest_length",
    "offset": "rest_length",
    "force": "force_offset",
    "torque": "force_offset",
}
"""Keywords of Exudyn's own connectors, and the parameters that they mean here."""


def own_names(given: Mapping[str, Any]) -> dict[str, Any]:
    """Parameters under their own names; raise DeviceError for one that is given twice."""
    found: dict[str, Any] = {}
    for key, value in given.items():
        own = ALIASES.get(key, key)
        if own in found or (own != key and own in given):
            raise DeviceError(f"{key}: is {own}, which is given as well; give one of them")
        found[own] = value
    return found


class Parameters(SimpleNamespace):
    """Parameters and lists of the device by name, those of `WORDS`, `nstate`, `state_names`.

    `smooth_play` is this element's own, see `series.py`; `load_level` [N] what a load adds to the
    level of a bristle at the moment; `still` that nothing changes at rest, for a static solution;
    `soft_slip` that elements of maxwell_slip begin to slip over a knee, for a solver that iterates.
    For a control that sets a parameter
    (`control.py`): `command`, `aim` (the same within the bounds), `control_rest`, `static_follows`.
    """

    @classmethod
    def of(cls, device: Device, smooth_play: bool = False, command: float = math.nan) -> Parameters:
        """The parameters of a device that the core has checked, at a command of its control."""
        numbers = {name: getattr(device, name) for name in (*parameters(), *lists())}
        names = (*WORDS, "nstate", "state_names")
        numbers["smooth_play"] = smooth_play
        found = cls(**numbers, **{name: getattr(device, name) for name in names})
        found.command, found.load_level, found.still = command, 0.0, False
        found.soft_slip = False
        if device.control == "force":
            return found
        found.control_rest = getattr(device, device.control)
        found.static_follows = "static_force" not in device.given
        found.aim = found.control_rest
        if not math.isnan(command):
            found.aim = min(max(command, device.control_lower), device.control_upper)
        if not device.control_lag:
            setattr(found, device.control, found.aim)
            if device.control == "coulomb_force" and found.static_follows:
                found.static_force = found.aim
        return found

    def with_device(self, device: Device, command: float | None = None) -> Parameters:
        """Those of another device, the rest as it is."""
        now = self.command if command is None else command
        found = Parameters.of(device, self.smooth_play, now)
        found.still, found.soft_slip = self.still, self.soft_slip
        return found
