"""Devices in MuJoCo models."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

from inerter.cars.read import CarError
from inerter.cars.spec import is_car_file, model_spec
from inerter.core import Device, DeviceError
from inerter.engine_errors import COMPILE_ERRORS, cannot_be_opened, engine_text
from inerter.model_bounds import refuse_unbounded
from inerter.motion_units import ROTATION, TRANSLATION, Kind
from inerter.plugin import load_plugin


def device_of_model(path: Path) -> Device:
    """The device of a model that has exactly one `inerter.device`.

    Raises
    ------
    DeviceError
        The model cannot be read, has no device or several, or its device cannot be.
    """
    holder = _read(path)[1]
    values = {config.get("key", ""): config.get("value", "") for config in holder.iter("config")}
    try:
        return Device(**values)
    except DeviceError as error:
        raise DeviceError(f"{path}: {error}") from None


def motion_of_model(path: Path) -> Kind:
    """What the device of a model with exactly one `inerter.device` does: on a hinge it turns.

    Raises
    ------
    DeviceError
        As `device_of_model`.
    """
    return _motion(*_read(path))


def _read(path: Path) -> tuple[ElementTree.Element, ElementTree.Element]:
    """The root of a model, and the element that configures its one device."""
    load_plugin()
    try:
        if not is_car_file(path):
            refuse_unbounded(path)
        text = model_spec(path).to_xml()
    except CarError as error:
        raise DeviceError(str(error)) from None
    except OSError as error:
        raise DeviceError(cannot_be_opened(path, error)) from None
    except COMPILE_ERRORS as error:
        raise DeviceError(f"{path}: {engine_text(error)}") from None

    # a device is configured in its actuator, or in an instance that its actuator names
    root = ElementTree.fromstring(text)
    plugins = [
        holder
        for element in root.iter("plugin")
        if element.get("plugin") == "inerter.device"
        for holder in (element, *element.findall("instance"))
        if holder.find("config") is not None
    ]
    if len(plugins) != 1:
        raise DeviceError(
            f"{path}: {len(plugins)} configured inerter.device in the model, 1 is needed; give a "
            "device.toml with --device instead"
        )
    return root, plugins[0]


def _motion(root: ElementTree.Element, holder: ElementTree.Element) -> Kind:
    """Whether the actuator of a device, or the one that names its instance, is on a hinge."""
    name = holder.get("name")
    for actuator in root.iterfind("actuator/plugin"):
        if actuator is holder or (name and actuator.get("instance") == name):
            joints = [j for j in root.iter("joint") if j.get("name") == actuator.get("joint")]
            # a joint that does not say what it is is a hinge
            if joints and actuator.get("joint") and joints[0].get("type", "hinge") == "hinge":
                return ROTATION
    return TRANSLATION
