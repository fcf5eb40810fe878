"""What of a device.toml a strut carries beside its inertance, and what it refuses.

Displacements of a strut count from the ride height, so `rest_length` has no part.
"""

from __future__ import annotations

from inerter.core import Device

_FLUID = "gives the inertance by geometry; state the inertance of `inerter design fluid` instead"
_GAS = "is of a gas spring; a strut has one spring beside the device, linear: its stiffness"
_REFUSED = {
    "force_offset": "moves the ride height, in S3 without end; leave it out",
    **dict.fromkeys(
        (
            "piston_area",
            "channel_area",
            "channel_length",
            "fluid_density",
            "fluid_viscosity",
            "channel_roughness",
            "minor_loss",
        ),
        _FLUID,
    ),
    **dict.fromkeys(
        ("gas_pressure", "gas_area", "gas_volume", "gas_exponent", "gas_law"),
        _GAS,
    ),
}
_ABSENT = ("series_stiffness", "series_damping", "backlash", "stiffness")


def strut_device(device: Device) -> dict[str, float | str]:
    """Keys and values (SI) of a device in a strut; without its inertance, and what is not there.

    Raises
    ------
    ValueError
        A key that a strut cannot carry: named, with what to do.
    """
    given = device.given
    for key, value in given.items():
        if key in _REFUSED and value not in (0.0, ""):
            raise ValueError(f"{key} = {value} {_REFUSED[key]}")
    skipped = {*_REFUSED, "inertance", "rest_length"}
    values = {key: x for key, x in given.items() if key not in skipped}
    stiffness = values.get("stiffness", 0.0)
    if not isinstance(stiffness, str) and stiffness < 0.0:
        raise ValueError(
            f"stiffness = {stiffness:g} is negative: behind a damper it has no equilibrium; "
            "leave it out, and lower the strut's stiffness by as much"
        )
    # what is 0 is not there
    values = {key: x for key, x in values.items() if x or key not in _ABSENT}
    if "backlash" in values and not {"series_stiffness", "series_damping"} & set(values):
        raise ValueError("backlash without series_stiffness: state the stiffness of the contact")
    return values
