"""device.toml: a device in a file, as the diagnosis writes it and reads it back.

motion = "rotation"         # of a device that turns: rad for m, N*m for N, kg*m^2 for kg

[device]
inertance = 113.0           # SI units, or a text with a unit: "113 kg"
friction = "lugre"
coulomb_force = "10 N"
force_periods = [[0.02, 3.0, 0.0]]  # lists in SI units
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from inerter.core import WORDS, Device, DeviceError, lists, parameters
from inerter.input_file import read_toml
from inerter.motion_units import ROTATION, TRANSLATION, Kind, parameter_unit
from inerter.printable import printable
from inerter.unit_text import parse_unit, split_quantity, unit_registry

SCHEMA = "inerter.device/1"
LARGEST = 1e15
"""Size of a parameter, in SI units, beyond which no unit can be right."""
LARGEST_DELAY = 0.05
"""Delay of the force channel [s] beyond which none is sought or held, either way."""


def read_device(path: Path | str) -> Device:
    """The device in a file.

    Raises
    ------
    DeviceError
        The file cannot be read, or a value in it cannot be used; names the file and the key.
    """
    path = Path(path)
    content = _content(path)
    table = content.get("device")
    if not isinstance(table, dict):
        raise DeviceError(
            f"{path}: no [device] table; write one, with keys such as inertance = 113.0"
        )
    values: dict[str, Any] = {}
    motion = read_motion(path) or TRANSLATION
    for key, value in table.items():
        if key in lists():
            values[key] = _numbers(path, key, value)
            continue
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            raise DeviceError(
                f"{path}: {key} is {_shown(value)}; give a number, or a text with a unit"
            )
        if isinstance(value, str) and key not in WORDS:
            value = _with_unit(path, key, value, motion)
        values[key] = value
    try:
        return Device(**values)
    except DeviceError as error:
        raise DeviceError(f"{path}: {error}") from None


def read_bench_device(path: Path) -> Device:
    """The device in a file, for computations that absurd values would end without a word.

    Raises
    ------
    DeviceError
        As `read_device`, or a value that no unit can make right.
    """
    device = read_device(path)
    for key, value in device.given.items():
        if not isinstance(value, str) and LARGEST < abs(value) < math.inf:
            raise DeviceError(
                f"{path}: {key} is {_shown(value)}, which no device has; give SI units, "
                f"at most {LARGEST:g}"
            )
    return device


def read_motion(path: Path) -> Kind | None:
    """What the device in a file does, as the file or the units in it say; None where they do not.

    Raises
    ------
    DeviceError
        `motion` is neither of both, or some units are of the one and some of the other.
    """
    content = _content(path)
    said, table = content.get("motion"), content.get("device")
    if said not in (None, TRANSLATION, ROTATION):
        raise DeviceError(
            f'{path}: motion is {_shown(said)}; write "{TRANSLATION}" or "{ROTATION}", or leave '
            "it out"
        )
    told: dict[Kind, str] = {} if said is None else {said: f'motion = "{said}"'}
    for key, value in (table if isinstance(table, dict) else {}).items():
        motion = _motion_of(key, value) if isinstance(value, str) else None
        if motion is not None:
            told.setdefault(motion, f'{key} = "{printable(value[:60])}"')
    if len(told) > 1:
        raise DeviceError(
            f"{path}: {told[TRANSLATION]} is of a device that moves along a line, and "
            f"{told[ROTATION]} of one that turns; correct one of them"
        )
    return next(iter(told), None)


def refuse_other_motion(where: Path, device: Kind | None, records: Iterable[Any]) -> None:
    """DeviceError where a device does not move as the records do; None: it does not say."""
    for record in records:
        if device is not None and record.motion != device:
            does = {TRANSLATION: "moves along a line (m, N, kg)", ROTATION: "turns (rad, N*m)"}
            raise DeviceError(
                f"{where}: the device {does[device]}, and {record.name} {does[record.motion]}; "
                "give a record and a device of one kind"
            )


def _motion_of(key: str, text: str) -> Kind | None:
    """The motion that the unit of a parameter tells; None where it is the same in both."""
    if key not in parameters() or key in WORDS:
        return None
    along, about = (parameter_unit(m, key, parameters()[key].unit) for m in (TRANSLATION, ROTATION))
    number, written = split_quantity(text) or (math.nan, "")
    given = parse_unit(written) if written else None
    if given is None or along == about or math.isnan(number):
        return None
    fits = [_fits(given, wanted) for wanted in (along, about)]
    if fits[0] == fits[1]:
        return None
    return TRANSLATION if fits[0] else ROTATION


def _fits(given: Any, wanted: str) -> bool:
    wanted = re.sub(r"(m|rad)\^-n", "dimensionless", wanted)
    return bool((1 * given).dimensionality == (1 * parse_unit(wanted)).dimensionality)


def read_delay(path: Path) -> float:
    """Time by which the force channel was late where the device was identified [s]; usually 0.

    Raises
    ------
    DeviceError
        No number and no time, or more than `LARGEST_DELAY`.
    """
    channels = _content(path).get("channels", {})
    if not isinstance(channels, dict):
        raise DeviceError(f"{path}: channels is {_shown(channels)}; write a [channels] table")
    delay = channels.get("force_delay", 0.0)
    if isinstance(delay, str):
        delay = _in_unit(path, "force_delay", delay, "s")
    number = isinstance(delay, (int, float)) and not isinstance(delay, bool)
    if not (number and abs(delay) < math.inf):
        raise DeviceError(
            f'{path}: force_delay is {_shown(delay)}; give seconds, or a text as "2 ms"'
        )
    if abs(delay) > LARGEST_DELAY:
        raise DeviceError(
            f"{path}: force_delay is {_shown(delay)} s, beyond the {LARGEST_DELAY:g} s that a "
            f"diagnosis looks at; shift the force with `inerter prepare --delay {_shown(delay)}`, "
            "and leave force_delay out"
        )
    return float(delay)


def read_filters(path: Path) -> dict[str, str]:
    """Low-passes that the channels of a record went through, as stated, by the channel's name.

    Raises
    ------
    DeviceError
        One that is no text.
    """
    channels = _content(path).get("channels", {})
    found = {}
    for name in ("force", "displacement"):
        key = f"{name}_filter"
        if isinstance(channels, dict) and key in channels:
            if not isinstance(channels[key], str):
                raise DeviceError(
                    f'{path}: {key} is {_shown(channels[key])}; give a text, such as "bessel:50:4"'
                )
            found[name] = channels[key]
    return found


def _numbers(path: Path, key: str, value: Any) -> Any:
    """A list of numbers, perhaps in threes; or a text with blanks, as MJCF has it."""
    flat: list[Any] = []
    for each in value if isinstance(value, list) else [value]:
        flat += each if isinstance(each, list) else [each]
    number = all(isinstance(each, (int, float)) and not isinstance(each, bool) for each in flat)
    if not number and not isinstance(value, str):
        raise DeviceError(f"{path}: {key} is {_shown(value)}; give a list of numbers in SI units")
    return value if isinstance(value, str) else flat


def _list_toml(device: Device, name: str) -> str:
    """A list as TOML has it, periods in threes."""
    numbers = list(getattr(device, name))
    if name == "force_map":
        rows = _rows(numbers, int(device.force_map_columns), ",\n  ")
        return f"[\n  {rows},\n]"
    return f"[{_rows(numbers, 3, ', ')}]" if lists()[name].periods else repr(numbers)


def _rows(numbers: list[float], columns: int, apart: str) -> str:
    return apart.join(repr(numbers[i : i + columns]) for i in range(0, len(numbers), columns))


def _content(path: Path) -> dict[str, Any]:
    try:
        return read_toml(path)
    except ValueError as error:
        raise DeviceError(str(error)) from None


def _shown(value: object) -> str:
    """A value for an error text, at most 60 characters."""
    if isinstance(value, int) and abs(value) > LARGEST:
        # of a long one, the digits are no help
        return f"about 1e{int(math.log10(abs(value)))}"
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _with_unit(path: Path, key: str, text: str, motion: Kind) -> float:
    """A text with a unit in the parameter's SI unit."""
    if key not in parameters():
        raise DeviceError(
            f"{path}: {key} is not a parameter of the device; `inerter parameters` lists them"
        )
    return _in_unit(path, key, text, parameter_unit(motion, key, parameters()[key].unit))


def _in_unit(path: Path, key: str, text: str, unit: str) -> float:
    """A text with a unit in another unit of the same quantity."""
    wanted = "" if unit == "1" else re.sub(r"(m|rad)\^-n", "dimensionless", unit)
    number, written = split_quantity(text) or (math.nan, "")
    given = parse_unit(written or "dimensionless")
    shown = printable(text if len(text) <= 60 else text[:57] + "...")
    refusal = DeviceError(f'{path}: {key} is "{shown}"; give a number, or a text in {unit}')
    if given is None or math.isnan(number):
        raise refusal
    try:
        value = unit_registry().Quantity(number, given).to(wanted)
    except (ArithmeticError, TypeError, ValueError):
        # another quantity
        raise refusal from None
    return float(value.magnitude)


def device_text(
    device: Device,
    comments: Mapping[str, str] | None = None,
    delay: float = 0.0,
    title: str = "",
    motion: Kind = TRANSLATION,
    filters: Mapping[str, str] | None = None,
) -> str:
    """The text of a device.toml.

    Parameters
    ----------
    device : Device
        What to write.
    comments : mapping, optional
        A comment for a parameter, such as its standard error.
    delay : float
        Time by which the force channel of the record was late [s]; not part of the device.
    title : str
        Comment for the first lines.
    motion : str
        What the device does.
    filters : mapping, optional
        Low-passes of the record's channels, as they are stated; not part of the device.
    """
    comments = comments or {}
    # names of records may hold what TOML does not allow
    lines = [f"# {printable(line)}" for line in title.splitlines()]
    lines += [f'schema = "{SCHEMA}"']
    lines += [f'motion = "{motion}"'] if motion != TRANSLATION else []
    lines += ["", "[device]"]
    for name, value in device.given.items():
        if name in lists():
            lines += [f"# {printable(comments[name])}"] if name in comments else []
            lines.append(f"{name} = {_list_toml(device, name)}")
            continue
        text = f'"{value}"' if isinstance(value, str) else repr(float(value))
        if isinstance(value, float) and not math.isfinite(value):
            continue
        own = "" if name in WORDS else parameter_unit(motion, name, parameters()[name].unit)
        note = comments.get(name, own)
        lines.append(f"{name} = {text}" + (f"  # {note}" if note and note != "1" else ""))
    if delay or filters:
        what = "what its channels do" if filters else "the force channel is late by this time"
        lines += ["", f"# of the measurement, not of the device: {what}", "[channels]"]
        lines += [f"force_delay = {delay!r}  # s"] if delay else []
        lines += [f'{name}_filter = "{each}"' for name, each in (filters or {}).items()]
    return "\n".join(lines) + "\n"
