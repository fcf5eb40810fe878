"""The parameters of a device as plain attributes, which user functions read often."""

from __future__ import annotations

from types import SimpleNamespace

from inerter.core import Device, lists, parameters


class Parameters(SimpleNamespace):
    """Parameters and lists of the device by name, `friction`, `gas_law`, `nstate`, `state_names`.

    `smooth_play` is this element's own, see `series.py`.
    """

    @classmethod
    def of(cls, device: Device, smooth_play: bool = False) -> Parameters:
        """The parameters of a device that the core has checked."""
        numbers = {name: getattr(device, name) for name in (*parameters(), *lists())}
        names = ("friction", "gas_law", "nstate", "state_names")
        numbers["smooth_play"] = smooth_play
        return cls(**numbers, **{name: getattr(device, name) for name in names})
