"""The core's library, and what it says that a device can be given."""

from __future__ import annotations

import ctypes
import functools
import os
import sys
from array import array
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

# beside this file; where the package is installed in place, in its other folder
_FOLDERS = [Path(place) / "lib" for place in sys.modules["inerter"].__path__]
LIBRARY_FOLDER = next((each for each in _FOLDERS if each.is_dir()), Path(__file__).parent / "lib")
MESSAGE_SIZE = 512


class _CParameter(ctypes.Structure):
    _fields_ = [
        ("name", ctypes.c_char_p),
        ("unit", ctypes.c_char_p),
        ("initial", ctypes.c_double),
        ("lower", ctypes.c_double),
        ("upper", ctypes.c_double),
        ("lower_open", ctypes.c_int),
        ("offset", ctypes.c_size_t),
        ("laws", ctypes.c_char_p),
        ("meaning", ctypes.c_char_p),
    ]


class _CList(ctypes.Structure):
    _fields_ = [
        ("name", ctypes.c_char_p),
        ("unit", ctypes.c_char_p),
        ("most", ctypes.c_int),
        ("periods", ctypes.c_int),
        ("laws", ctypes.c_char_p),
        ("meaning", ctypes.c_char_p),
    ]


FORCES = ("total", "inertance", "friction")
WORDS = ("friction", "gas_law", "friction_side", "control")
"""What of a device is stated by a name and not by a number."""


class CForce(ctypes.Structure):
    """Parts of a force."""

    _fields_ = [(name, ctypes.c_double) for name in FORCES]


@dataclass(frozen=True)
class Parameter:
    """What the core says of one parameter.

    `initial` is the default (NaN: derived from others, or the part is absent), `laws` the friction
    laws that read it (empty: the device itself).
    """

    name: str
    unit: str
    initial: float
    lower: float
    upper: float
    lower_open: bool
    laws: tuple[str, ...]
    meaning: str


@dataclass(frozen=True)
class NumberList:
    """What the core says of one list of numbers; periods: three numbers each, at most `most`."""

    name: str
    unit: str
    most: int
    periods: bool
    laws: tuple[str, ...]
    meaning: str


def library_path(stem: str, folder: str = "") -> Path:
    """Path of a shared library of this package, by its stem and the folder within `lib`."""
    suffix = {"darwin": ".dylib", "win32": ".dll"}.get(sys.platform, ".so")
    prefix = "" if sys.platform == "win32" else "lib"
    return LIBRARY_FOLDER / folder / f"{prefix}{stem}{suffix}"


@functools.cache
def library() -> ctypes.CDLL:
    """The shared library, with the types of its functions."""
    path = library_path("inerter_core")
    if not path.exists():
        raise ImportError(
            f"{path} is missing: reinstall with `pip install --force-reinstall inerter`"
        )
    found = ctypes.CDLL(os.fspath(path))
    found.inerter_parameter.restype = ctypes.POINTER(_CParameter)
    found.inerter_list.restype = ctypes.POINTER(_CList)
    found.inerter_device_size.restype = ctypes.c_size_t
    found.inerter_list_values.restype = ctypes.POINTER(ctypes.c_double)
    found.inerter_state_name.restype = ctypes.c_char_p
    for word in WORDS:
        for what in ("name", "meaning"):
            getattr(found, f"inerter_{word}_{what}").restype = ctypes.c_char_p
    at, number = ctypes.c_void_p, ctypes.c_double
    found.inerter_set_number.argtypes = [at, ctypes.c_int, number]
    found.inerter_set_list.argtypes = [at, ctypes.c_int, ctypes.c_int, at, ctypes.c_char_p]
    found.inerter_state_step.argtypes = [at, *[number] * 3, at, number]
    found.inerter_state_of_force.argtypes = [at, *[number] * 4, at]
    found.inerter_valid.argtypes = [at, number, at, ctypes.c_char_p]
    found.inerter_force_over_step.argtypes = [at, *[number] * 3, at, number, number, at]
    found.inerter_force_over_step.restype = CForce
    found.inerter_along_commanded.argtypes = [at, ctypes.c_int, number, *[at] * 8]
    found.inerter_low_pass.argtypes = [ctypes.c_int, ctypes.c_int, number, at, at]
    found.inerter_command.argtypes = [at, number, at]
    return found


@functools.cache
def parameters() -> Mapping[str, Parameter]:
    """Every parameter of a device by name, as declared in the core."""
    found: dict[str, Parameter] = {}
    while entry := library().inerter_parameter(len(found)):
        c = entry.contents
        name, unit, laws, meaning = (text.decode() for text in (c.name, c.unit, c.laws, c.meaning))
        limits = (c.initial, c.lower, c.upper, bool(c.lower_open))
        found[name] = Parameter(name, unit, *limits, tuple(laws.split()), meaning)
    return found


@functools.cache
def lists() -> Mapping[str, NumberList]:
    """Every list of numbers of a device by name: what changes along the stroke."""
    found: dict[str, NumberList] = {}
    while entry := library().inerter_list(len(found)):
        c = entry.contents
        name, unit, laws, meaning = (text.decode() for text in (c.name, c.unit, c.laws, c.meaning))
        numbers = (c.most, bool(c.periods))
        found[name] = NumberList(name, unit, *numbers, tuple(laws.split()), meaning)
    return found


@functools.cache
def _places() -> tuple[Mapping[str, int], Mapping[str, int]]:
    """Which parameter, and which list, the core has at a place."""
    number, row = ({name: i for i, name in enumerate(each)} for each in (parameters(), lists()))
    return number, row


@functools.cache
def names() -> tuple[str, ...]:
    """Everything that a device can be given, by name."""
    return (*parameters(), *lists(), *WORDS)


@functools.cache
def friction_laws() -> Mapping[str, str]:
    """The friction laws by name, with their meaning."""
    return _laws("friction")


@functools.cache
def gas_laws() -> Mapping[str, str]:
    """The laws of the gas spring by name, with their meaning."""
    return _laws("gas_law")


@functools.cache
def friction_sides() -> Mapping[str, str]:
    """The sides on which friction can act by name, with their meaning."""
    return _laws("friction_side")


@functools.cache
def controls() -> Mapping[str, str]:
    """What a control can be by name: a force, or the parameter that it sets; with its meaning."""
    return _laws("control")


def _laws(kind: str) -> Mapping[str, str]:
    name, meaning = (getattr(library(), f"inerter_{kind}_{what}") for what in ("name", "meaning"))
    found: dict[str, str] = {}
    while text := name(len(found)):
        found[text.decode()] = meaning(len(found)).decode()
    return found


@functools.cache
def device_type() -> type[ctypes.Structure]:
    """The C structure of a device."""
    fields: list[tuple[str, Any]] = [(name, ctypes.c_double) for name in parameters()]
    fields += [(name, ctypes.c_int) for name in WORDS]
    # a bit for each parameter and each word
    words = (len(parameters()) + 67) // 64
    fields += [("given", ctypes.c_uint64 * words)]
    fields += [("parts", ctypes.c_uint32), ("nstate", ctypes.c_int), ("nfriction", ctypes.c_int)]
    fields += [(name, ctypes.c_int) for name in ("nbranch", "ndamper", "ncontrol")]
    fields += [("control_rest", ctypes.c_double), ("command", ctypes.c_double)]
    known = type("_CKnown", (ctypes.Structure,), {"_fields_": fields})
    # what follows is read by functions of the core
    numbers = (library().inerter_device_size() - ctypes.sizeof(known)) // 8
    fields.append(("curves", ctypes.c_double * numbers))
    return type("_CDevice", (ctypes.Structure,), {"_fields_": fields})


def set_numbers(c: ctypes.Structure, name: str, value: object) -> bool:
    """Set a parameter or a list without a text in between; whether that did it."""
    parameters, rows = _places()
    if isinstance(value, float):
        at = parameters.get(name)
        return at is not None and not library().inerter_set_number(ctypes.addressof(c), at, value)
    row = rows.get(name)
    if row is None or not isinstance(value, tuple) or not value:
        return False
    if not all(isinstance(each, float) for each in value):
        return False
    values, message = array("d", value), ctypes.create_string_buffer(MESSAGE_SIZE)
    at, count = values.buffer_info()
    return not library().inerter_set_list(ctypes.addressof(c), row, count, at, message)


def message_text(message: ctypes.Array[ctypes.c_char]) -> str:
    """What the core said; a long value is cut, perhaps within a character."""
    return message.value.decode(errors="replace")
