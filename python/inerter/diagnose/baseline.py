"""The model that a diagnosis starts from."""

from __future__ import annotations

from inerter.catalogue.friction import law_coordinates
from inerter.catalogue.scales import Scales
from inerter.core import Device, parameters
from inerter.identify.model import Model, stated_values

# width of sign(v) in fits, per rms velocity: wide enough for the velocity's noise at rest
TRANSITION = 0.005


def baseline_of(device: Device | None, sizes: Scales) -> Model:
    """The baseline for records of these sizes, see `baseline_model`."""
    width = max(parameters()["transition_velocity"].initial, TRANSITION * sizes.velocity)
    return baseline_model(device, sizes.force / sizes.acceleration, width)


def baseline_model(device: Device | None, inertance: float, transition: float) -> Model:
    """The ideal inerter with free inertance, or the device as stated.

    inertance: where a search for it begins [kg]; transition: the width of sign(v) in fits [m/s].

    Raises
    ------
    DeviceError
        The inertance follows from a channel, see `stated_values`.
    """
    if device is None:
        return Model(
            "none", {"inertance": inertance, "transition_velocity": transition}, ("inertance",)
        )
    values, texts = stated_values(device)
    values.setdefault("transition_velocity", transition)
    values = law_coordinates(device, values)
    free = () if "inertance" in values else ("inertance",)
    values.setdefault("inertance", inertance)
    return Model(device.friction, values, free, texts)
