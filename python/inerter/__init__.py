"""Inerters for MuJoCo and Exudyn, and a lab that finds what a simulation of one gets wrong."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from inerter.core import Device, DeviceError, along_many, friction_laws, parameters
from inerter.plugin import load_plugin, plugin_path

if TYPE_CHECKING:
    from inerter.controls import device_controls, without_controls
    from inerter.device_in_model import DeviceInModel, device_of, devices_of
    from inerter.inverse import DeviceForces, device_force, inverse_dynamics
    from inerter.mjspec import AddedDevice, add_device, remove_device
    from inerter.running import Energy, SolveCounts, energy, solve_counts

__all__ = [
    "AddedDevice",
    "Device",
    "DeviceError",
    "DeviceForces",
    "DeviceInModel",
    "Energy",
    "SolveCounts",
    "add_device",
    "along_many",
    "device_controls",
    "device_force",
    "device_of",
    "devices_of",
    "energy",
    "friction_laws",
    "inverse_dynamics",
    "load_plugin",
    "parameters",
    "plugin_path",
    "remove_device",
    "solve_counts",
    "without_controls",
]
__version__ = "0.1.0"

# what needs `import mujoco` is loaded when it is asked for: every MuJoCo process imports this file
_LAZY = {
    "AddedDevice": "inerter.mjspec",
    "add_device": "inerter.mjspec",
    "remove_device": "inerter.mjspec",
    "device_controls": "inerter.controls",
    "without_controls": "inerter.controls",
    "DeviceForces": "inerter.inverse",
    "device_force": "inerter.inverse",
    "inverse_dynamics": "inerter.inverse",
    "DeviceInModel": "inerter.device_in_model",
    "device_of": "inerter.device_in_model",
    "devices_of": "inerter.device_in_model",
    "Energy": "inerter.running",
    "SolveCounts": "inerter.running",
    "energy": "inerter.running",
    "solve_counts": "inerter.running",
}


def __getattr__(name: str) -> Any:
    if name not in _LAZY:
        raise AttributeError(f"module 'inerter' has no attribute {name!r}")
    import importlib

    return getattr(importlib.import_module(_LAZY[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def _load_where_mujoco_does_not() -> None:
    """MuJoCo 3 looks for no plugins of others: there this import makes the plugin known."""
    import os
    import re
    from importlib.util import find_spec

    try:
        found = find_spec("mujoco")
    except ValueError:  # half imported
        return
    places = found.submodule_search_locations if found else None
    if not places or not os.path.isdir(places[0]):
        return
    if not any(re.match(r"libmujoco(\.so)?\.3\.", name) for name in os.listdir(places[0])):
        return
    try:
        load_plugin()
    except ImportError as error:
        import warnings

        warnings.warn(str(error), RuntimeWarning, stacklevel=3)


_load_where_mujoco_does_not()
