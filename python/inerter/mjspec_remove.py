"""Taking a device out of a model that is made with `mujoco.MjSpec`, and finding it renamed.

`MjSpec.attach` puts a prefix and a suffix around every name of the attached model.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import mujoco

from inerter.core import Device, DeviceError, names
from inerter.device_in_model import PLUGIN

# what the fields are called that name a tendon or a site
_NAMING = ("target", "slidersite", "refsite", "objname", "refname", "name1", "name2")


def new_name(name: str, device: Device, present: Mapping[str, Device]) -> str | None:
    """Name under which a device is there now, that was added as `name`.

    Parameters
    ----------
    name : str
        As it was added.
    device : Device
        As it was configured.
    present : mapping
        The devices that are there, by name.

    Returns
    -------
    str or None
        The same name, else the only one that is `name` with a prefix or a suffix and is configured
        alike; None where there is none.

    Raises
    ------
    ValueError
        More than one is.
    """
    if name in present:
        return name
    alike = [
        other for other, found in present.items() if name in other and found.given == device.given
    ]
    if len(alike) > 1:
        listed = ", ".join(map(repr, alike))
        raise ValueError(
            f"device {name!r} is there more than once: {listed}; say which by its name"
        )
    return alike[0] if alike else None


def devices_in(spec: mujoco.MjSpec) -> dict[str, Device]:
    """The devices of a spec that have a named instance, by the name of their actuator.

    By that of the instance where the actuator is gone. Those whose configuration cannot be are left
    out.
    """
    carriers = {each.plugin.name: each.name for each in spec.actuators if _is_device(spec, each)}
    found = {}
    for instance in spec.plugins:
        if instance.plugin_name == PLUGIN and instance.name:
            try:
                device = Device(**dict(instance.config))
            except DeviceError:
                continue
            found[carriers.get(instance.name) or instance.name] = device
    return found


def remove(
    spec: mujoco.MjSpec, name: str, tendon: str | None = None, sites: Sequence[str] = ()
) -> None:
    """Take out a device by the name of its actuator or instance, with what only it uses.

    Parameters
    ----------
    spec : mujoco.MjSpec
        The model; keyframes lose the values of the device's states and control.
    name : str
        Of the actuator, or of the plugin instance where the actuator is gone.
    tendon, sites : str, sequence of str
        What was made for the device: taken out unless something else refers to it.

    Raises
    ------
    ValueError
        There is no such device.
    """
    actuator = spec.actuator(name)
    if actuator is not None and not _is_device(spec, actuator):
        raise ValueError(f"actuator {name!r} is no {PLUGIN}; give the name of a device")
    instance = name if actuator is None else actuator.plugin.name
    readers = [
        each
        for each in spec.sensors
        if instance and each.plugin.name == instance and _is_device(spec, each)
    ]
    holder = spec.plugin(instance) if instance else None
    if holder is not None and holder.plugin_name != PLUGIN:
        holder = None
    if actuator is None and holder is None and not readers:
        names = [each.name for each in spec.actuators if _is_device(spec, each)]
        listed = ", ".join(map(repr, names)) or "none"
        raise ValueError(f"no device {name!r} in the spec; its devices: {listed}")

    places = _places(spec, name) if actuator is not None and len(spec.keys) else {}
    for element in [*_numerics(spec, name), *readers, actuator]:
        if element is not None:
            spec.delete(element)
    # of an attached model the engine has deleted the instance with the first that referred to it
    if holder is not None and spec.plugin(instance) is not None:
        spec.delete(spec.plugin(instance))
    _shorten_keyframes(spec, places)
    rope = None if tendon is None else spec.tendon(tendon)
    if rope is not None and tendon not in _named_by(
        [*spec.actuators, *spec.sensors, *spec.equalities]
    ):
        spec.delete(rope)
    _remove_sites(spec, sites)


def _is_device(spec: mujoco.MjSpec, element: Any) -> bool:
    """Whether an actuator or a sensor is one of ours; in XML only its instance may say so."""
    plugin = element.plugin
    if not plugin.active:
        return False
    instance = spec.plugin(plugin.name) if plugin.name else None
    return PLUGIN in (plugin.plugin_name, None if instance is None else instance.plugin_name)


def _numerics(spec: mujoco.MjSpec, name: str) -> list[Any]:
    """The live parameters of an actuator: HEAD.key, and what a suffix has put after both."""
    found = []
    for numeric in spec.numerics:
        head, dot, tail = numeric.name.rpartition(".")
        if dot and name.startswith(head):
            suffix = name[len(head) :]
            key = tail.removesuffix(suffix) if suffix else tail
            if tail.endswith(suffix) and key in names():
                found.append(numeric)
    return found


def _named_by(elements: Iterable[Any]) -> set[str]:
    return {getattr(each, field) for each in elements for field in _NAMING if hasattr(each, field)}


def _remove_sites(spec: mujoco.MjSpec, sites: Sequence[str]) -> None:
    used = _named_by([*spec.actuators, *spec.sensors, *spec.equalities])
    for tendon in spec.tendons:
        used |= {wrap.target.name for wrap in tendon.path if wrap.target is not None}
    for name in sites:
        site = spec.site(name)
        if site is not None and name not in used:
            spec.delete(site)


def _places(spec: mujoco.MjSpec, name: str) -> dict[str, tuple[int, int, int]]:
    """Size of act and ctrl, first index and number of an actuator's values there."""
    try:
        model = spec.copy().compile()
    except ValueError:
        return {}  # the engine has its own say of such a model
    actuator = model.actuator(name).id
    act = int(model.actuator_actadr[actuator]), int(model.actuator_actnum[actuator])
    ctrl = int(model.actuator_ctrladr[actuator]), int(model.actuator_ctrlnum[actuator])
    return {"act": (model.na, *act), "ctrl": (model.nu, *ctrl)}


def _shorten_keyframes(spec: mujoco.MjSpec, places: dict[str, tuple[int, int, int]]) -> None:
    """Take a deleted actuator's values out of keyframes.

    The engine does so itself in a spec that was compiled or attached; there they are empty now.
    """
    for key in spec.keys:
        for field, (size, first, count) in places.items():
            values = list(getattr(key, field))
            if len(values) == size and count:
                setattr(key, field, values[:first] + values[first + count :])
