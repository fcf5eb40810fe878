"""Inerters for MuJoCo and Exudyn, and a lab that finds what a simulation of one gets wrong."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from inerter.core import Device, DeviceError, along_many, friction_laws, parameters
from inerter.plugin import load_plugin, plugin_path

if TYPE_CHECKING:
    from inerter.device_in_model import DeviceInModel, device_of, devices_of
    from inerter.mjspec import AddedDevice, add_device, remove_device
    from inerter.running import Energy, SolveCounts, energy, solve_counts

__all__ = [
    "AddedDevice",
    "Device",
    "DeviceError",
    "DeviceInModel",
    "Energy",
    "SolveCounts",
    "add_device",
    "along_many",
    "device_of",
    "devices_of",
    "energy",
    "friction_laws",
    "load_plugin",
    "parameters",
    "plugin_path",
    "remove_device",
    "solve_counts",
]
__version__ = "0.1.0"

# what needs `import mujoco` is loaded when it is asked for: every MuJoCo process imports this file
_LAZY = {
    "AddedDevice": "inerter.mjspec",
    "add_device": "inerter.mjspec",
    "remove_device": "inerter.mjspec",
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
