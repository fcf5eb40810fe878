"""Inerters for MuJoCo, and a lab that finds what a simulation of one gets wrong."""

from inerter.core import Device, DeviceError, along_many, friction_laws, parameters
from inerter.plugin import load_plugin, plugin_path

__all__ = [
    "Device",
    "DeviceError",
    "along_many",
    "friction_laws",
    "load_plugin",
    "parameters",
    "plugin_path",
]
__version__ = "0.1.0"
