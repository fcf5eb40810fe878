"""Elements of a spec as no default class has touched them.

`MjSpec` gives what it adds the values of the model's default classes, of the main one where no
other is named: `<default><tendon range="0 1"/></default>` would limit the tendon of a device. What
is added here has every field written: the engine's own initial value, or the one asked for.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np

# who and where an element is; the class stays, as its values have no say any more
_KEPT = {"name", "id", "signature", "compiler", "classname", "plugin", "path", "parent", "frame"}


def blank(element: Any) -> Any:
    """Give every field of a tendon, actuator, site or sensor the engine's initial value.

    Parameters
    ----------
    element : mjsTendon, mjsActuator, mjsSite or mjsSensor
        As `MjSpec` has just added it. Its name stays.

    Returns
    -------
    The element.
    """
    for field, value in _initial_values(type(element).__name__).items():
        part, _, leaf = field.rpartition(".")
        owner = getattr(element, part) if part else element
        setattr(owner, leaf, value)

    # what the range decides otherwise, and the writer of XML would leave to the class
    for field in ("limited", "actfrclimited", "ctrllimited", "forcelimited", "actlimited"):
        if hasattr(element, field):
            setattr(element, field, mujoco.mjtLimited.mjLIMITED_FALSE)
    return element


@functools.cache
def _initial_values(kind: str) -> dict[str, Any]:
    """Values by field of an element in a model without any default, by the name of its class."""
    spec = mujoco.MjSpec()
    fresh = {
        "MjsTendon": spec.add_tendon,
        "MjsActuator": spec.add_actuator,
        "MjsSite": spec.worldbody.add_site,
        "MjsSensor": spec.add_sensor,
    }[kind]()
    return dict(_values(fresh))


def _values(element: Any, prefix: str = "") -> Iterator[tuple[str, Any]]:
    for field in dir(element):
        value = getattr(element, field)
        if field.startswith("_") or field in _KEPT or callable(value):
            continue
        if type(value).__name__ == "MjsOrientation":
            yield from _values(value, f"{field}.")
        elif isinstance(value, np.ndarray):
            yield prefix + field, value.copy()
        elif type(value).__module__.startswith("mujoco._specs"):
            yield prefix + field, list(value)
        else:
            yield prefix + field, value
