"""What a user states of a column: which one it is, its unit, scale, offset, delay, filter.

One line says it, ``-200 N/V * (u + 0.115 V)`` or ``x / 55.4 V/m``, or a table of single keys.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from inerter.motion_units import ROTATION, TRANSLATION, Kind
from inerter.unit_text import parse_unit, split_quantity, unit_registry

from .header import bare_name, bench_unit, named_as, split_header
from .raw_table import listed
from .record import Array, RecordError
from .turning import OWN_NAMES, UNITS, turns
from .units import ACCELERATIONS, QUANTITIES, TURNING, motion_of_unit, si_factor

ROLES = ("measured", "leave out")
LETTERS = ("u", "x")  # that stand for the values of the column itself
VOLTS = ("V", "mV")
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_QUANTITY = rf"{_NUMBER}\s*[^\d\s()*][^()]*?|{_NUMBER}"
_LEFT = re.compile(
    rf"({_NUMBER})((?:\s+|(?<=\d))[A-Za-zµ%°](?:[^()*]|(?<=\S)\*(?=\S))*?)?\s+\*\s+(.+)|({_NUMBER})\s*\*\s*(.+)"
)
_RIGHT = re.compile(rf"(.+?)\s+/\s+({_NUMBER})\s*([A-Za-zµ%°][^()]*)?")
_AFTER = re.compile(rf"(.+?)\s+\*\s+({_NUMBER})\s*([A-Za-zµ%°][^()]*)?")
_INNER = re.compile(rf"\(\s*(.+?)\s+([+-])\s+(start|{_NUMBER}\s*[A-Za-zµ%°/^*0-9]*)\s*\)")
_OUTER = re.compile(rf"(.+?)\s+([+-])\s+(start|{_NUMBER}\s*[A-Za-zµ%°][A-Za-zµ%°/^*0-9]*)")
_EVERY = re.compile(rf"every\s+({_NUMBER})\s*([a-zµ]+)")


@dataclass(frozen=True, kw_only=True)
class Statement:
    """How one of our quantities is had from a column: ``gain * (column + offset)``.

    column: its header or name in the file; unit: of its values, None for what the file says;
    gain, offset: number and unit; from_start: less its first value; delay [s]: the channel is late
    by this; cutoff [Hz], order: of the low-pass (Butterworth) that the channel went through;
    interval [s]: of a time that is counted; turns: whether its quantity was called by the name that
    it has in rotation; text: as the user wrote it.
    """

    column: str = ""
    unit: str | None = None
    gain: tuple[float, str] | None = None
    offset: tuple[float, str] | None = None
    from_start: bool = False
    delay: float = 0.0
    cutoff: float | None = None
    order: int = 2
    interval: float | None = None
    role: str = "measured"
    turns: bool = False
    text: str = ""


def own_name(name: str) -> str:
    """Our name of a quantity that a statement calls by the one that it has in rotation."""
    return OWN_NAMES.get(name, name)


def read_statement(name: str, given: Any, where: str) -> Statement:
    """A statement from a line or a table of keys; RecordError names what is wrong with it."""
    if name in OWN_NAMES:
        return replace(read_statement(OWN_NAMES[name], given, where), turns=True)
    if name not in QUANTITIES and name != "run":
        raise RecordError(
            f"{where}: {name!r} is no quantity of a record; take one of {', '.join(QUANTITIES)}"
        )
    if isinstance(given, str):
        return replace(_formula(given.strip(), where), text=given.strip())
    if not isinstance(given, Mapping):
        raise RecordError(f"{where}: {name} is {given!r}; give a text, such as 'Kraft [kN]'")
    known = {"column", "unit", "scale", "offset", "polarity", "delay", "filter", "role"}
    if strange := sorted(set(given) - known):
        raise RecordError(
            f"{where}: {name} has a key {strange[0]!r}; the keys are {', '.join(sorted(known))}"
        )
    stated = Statement(column=str(given.get("column", "")), text=str(dict(given)))
    if "unit" in given:
        stated = replace(stated, unit=_unit(str(given["unit"]), where))
    if "scale" in given:
        stated = replace(stated, gain=_pair(given["scale"], where))
    if "offset" in given:
        stated = replace(stated, offset=_pair(given["offset"], where))
    polarity = given.get("polarity", 1)
    if polarity not in (1, -1):
        raise RecordError(f"{where}: polarity of {name} is {polarity!r}; give 1 or -1")
    if polarity == -1:
        value, unit = stated.gain or (1.0, "")
        stated = replace(stated, gain=(-value, unit))
    if "delay" in given:
        stated = replace(stated, delay=_in_unit(given["delay"], "s", where))
        if not abs(stated.delay) <= 1.0:
            raise RecordError(f"{where}: delay of {name} is {stated.delay:g} s; at most 1 s")
    if "filter" in given:
        stated = _filtered(stated, given["filter"], name, where)
    role = given.get("role", "measured")
    if role not in ROLES:
        raise RecordError(f"{where}: role of {name} is {role!r}; take one of {', '.join(ROLES)}")
    return replace(stated, role=role)


def _filtered(stated: Statement, given: Any, name: str, where: str) -> Statement:
    """``"60 Hz"``, or a table with `cutoff` and `order`."""
    order = given.get("order", 2) if isinstance(given, Mapping) else 2
    cutoff = given.get("cutoff") if isinstance(given, Mapping) else given
    if cutoff is None or order not in range(1, 9):
        raise RecordError(
            f"{where}: filter of {name} is {given!r}; give a cut-off, '60 Hz', or a table of "
            "cutoff and order (1 to 8)"
        )
    value = _in_unit(cutoff, "Hz", where)
    if not value > 0:
        raise RecordError(f"{where}: filter of {name} is {value:g} Hz; give a cut-off above 0")
    return replace(stated, cutoff=value, order=int(order))


def _formula(text: str, where: str) -> Statement:
    if len(text) > 300:
        raise RecordError(f"{where}: a text of {len(text)} characters; at most 300 are read")
    if match := _EVERY.fullmatch(text):
        return Statement(interval=_in_unit(f"{match[1]} {match[2]}", "s", where))
    gain: tuple[float, str] | None = None
    rest = text
    if match := _LEFT.fullmatch(rest):
        number, unit, rest = (
            (match[1], match[2], match[3]) if match[1] else (match[4], "", match[5])
        )
        gain = (float(number), (unit or "").strip())
    elif match := _AFTER.fullmatch(rest):
        rest, gain = match[1], (float(match[2]), (match[3] or "").strip())
    elif match := _RIGHT.fullmatch(rest):
        if float(match[2]) == 0:
            raise RecordError(f"{where}: {text!r} divides by 0; correct it")
        unit = (match[3] or "").strip()
        gain, rest = (1 / float(match[2]), f"1/({unit})" if unit else ""), match[1]
    elif rest.startswith("-") and len(rest) > 1 and not rest[1].isdigit():
        gain, rest = (-1.0, ""), rest[1:].strip()
    offset: tuple[float, str] | None = None
    from_start = False
    if match := (_INNER.fullmatch(rest) or (None if gain else _OUTER.fullmatch(rest))):
        rest = match[1]
        if match[3] == "start":
            if match[2] == "+":
                raise RecordError(f"{where}: {text!r} adds its start; write - start")
            from_start = True
        else:
            offset = _pair(match[2] + match[3], where)
    if gain is not None and gain[1]:
        gain = (gain[0], _unit(gain[1], where))
    column = rest.strip().strip("'\"")
    if not column:
        raise RecordError(f"{where}: {text!r} names no column; write, say, 'Kraft [kN]'")
    return Statement(column=column, gain=gain, offset=offset, from_start=from_start)


def _unit(unit: str, where: str) -> str:
    if unit in ACCELERATIONS or parse_unit(unit) is not None:
        return unit
    spelled = bench_unit(unit)
    if spelled is None:
        raise RecordError(f"{where}: unknown unit {unit!r}; write, say, N/V, mm or turn/min")
    return spelled


def _pair(given: Any, where: str) -> tuple[float, str]:
    if isinstance(given, int | float) and not isinstance(given, bool):
        return float(given), ""
    found = split_quantity(str(given).replace("+ ", "+").replace("- ", "-"))
    if found is None:
        raise RecordError(f"{where}: {given!r} is no quantity; write a number and its unit")
    return found[0], _unit(found[1], where) if found[1] else ""


def _in_unit(given: Any, unit: str, where: str) -> float:
    value, own = _pair(given, where)
    if not own:
        return value
    parsed = parse_unit(own)
    if parsed is None or parsed.dimensionality != parse_unit(unit).dimensionality:
        raise RecordError(f"{where}: {given!r} is not in {unit}; correct the unit")
    return float(unit_registry().Quantity(value, parsed).to(unit).magnitude)


# --- applied -----------------------------------------------------------------------------------


def is_there(stated: Statement, header: tuple[str, ...]) -> bool:
    """Whether a file has the column that a statement names."""
    wanted = bare_name(stated.column).casefold()
    return any(bare_name(text).casefold() == wanted for text in header if text.strip())


def own_column(stated: Statement, header: tuple[str, ...], name: str) -> str | None:
    """The column that the letter u or x of a formula means, where no column is called so.

    The one that is called as its quantity, else the only one in volts; None where there is none.
    """
    if stated.column.casefold() not in LETTERS or is_there(stated, header):
        return None
    texts = [text for text in header if text.strip()]
    called = [text for text in texts if named_as(text) == name]
    if not called:
        called = [t for t in texts if split_header(t)[1] in VOLTS and named_as(t) is None]
    return called[0] if len(called) == 1 else None


def column_of(stated: Statement, header: tuple[str, ...], name: str, path: Any) -> int:
    """Index of the column that a statement names; RecordError where there is none."""
    wanted = own_column(stated, header, name) or stated.column
    tries = (
        lambda text: text.strip() == wanted,
        lambda text: bare_name(text) == wanted,
        lambda text: text.strip().casefold() == wanted.casefold(),
        lambda text: bare_name(text).casefold() == wanted.casefold(),
        lambda text: bare_name(text).casefold() == bare_name(wanted).casefold(),
    )
    for fits in tries:
        found = [index for index, text in enumerate(header) if text.strip() and fits(text)]
        if len(found) == 1:
            return found[0]
        if found:
            raise RecordError(
                f"{path}: {name} is stated as column {wanted!r}, and {len(found)} columns are "
                "called so; rename one of them"
            )
    raise RecordError(
        f"{path}: {name} is stated as column {wanted!r}, which is not there (found: "
        f"{listed(header)}); correct the statement{_as_a_formula(wanted, header, name)}"
    )


def _as_a_formula(wanted: str, header: tuple[str, ...], name: str) -> str:
    """How a calibration is written, where what is called a column has one in it and a sign."""
    inside = [bare_name(text) for text in header if bare_name(text) and bare_name(text) in wanted]
    if not inside or not set(wanted) & set("*/+-"):
        return ""
    column = max(inside, key=len)
    return (
        f". A calibration is a number with its unit, times the column: --column {name}="
        f"'0.05 * {column}', or '-200 N/V * ({column} + 0.115 V)'"
    )


def applied(
    stated: Statement, name: str, values: Array, header: str, where: str
) -> tuple[Array, Kind | None]:
    """The values [SI] of a quantity from those of its column; the motion that the units tell."""
    own = split_header(header)[1] or _behind_name(header, stated, name)
    # a unit in the statement's name of the column is one, too
    written = split_header(stated.column)[1] if stated.column else None
    unit = stated.unit or (own if own is not None else written)
    if unit is None and stated.offset and stated.offset[1]:
        unit = stated.offset[1]
    if stated.offset is not None:
        values = values + _offset(stated.offset, unit, where)
    if stated.from_start:
        finite = values[np.isfinite(values)]
        values = values - finite[0] if len(finite) else values
    factor, motion = _factor(stated, name, unit, where)
    return values * factor, ROTATION if stated.turns and motion is None else motion


def _behind_name(header: str, stated: Statement, name: str) -> str | None:
    """The unit at the end of a name as `current_mA`, where a scale asks for one of its kind."""
    match = re.fullmatch(r".*[^\W_](?:_|\s+)([^\s_]+)", header.strip())
    unit = bench_unit(match[1]) if match else None
    if unit is None or stated.gain is None or not stated.gain[1]:
        return None
    registry = unit_registry()
    found = registry.Quantity(1, parse_unit(stated.gain[1])) * registry.Quantity(
        1, parse_unit(unit)
    )
    targets = [QUANTITIES[name].unit, *([UNITS[name]] if name in UNITS else [])]
    fits = any(found.dimensionality == parse_unit(each).dimensionality for each in targets)
    return unit if fits or turns(name, found.units) else None


def _offset(offset: tuple[float, str], unit: str | None, where: str) -> float:
    value, own = offset
    if not own or unit is None or own == unit:
        return value
    given, into = parse_unit(own), parse_unit(unit)
    if given is None or into is None or given.dimensionality != into.dimensionality:
        raise RecordError(f"{where}: an offset in {own} of a column in {unit}; correct the unit")
    return float(unit_registry().Quantity(value, given).to(into).magnitude)


def _factor(
    stated: Statement, name: str, unit: str | None, where: str
) -> tuple[float, Kind | None]:
    value, own = stated.gain or (1.0, "")
    if not own:
        column = bare_name(stated.column) if stated.column else "NAME"
        return value * si_factor(name, unit, where, column), motion_of_unit(name, unit)
    registry, target = unit_registry(), parse_unit(QUANTITIES[name].unit)
    gain = registry.Quantity(value, parse_unit(own))
    if unit is None:
        if _electric(target, own):
            return float(gain.to_base_units().magnitude), TRANSLATION
        if name in UNITS and _electric(parse_unit(UNITS[name]), own):
            return float(gain.to_base_units().magnitude), ROTATION
        fits = (
            each for each in ("V", "rpm", "mm", "N", "mm/s", "m/s^2", "A", "deg")
            if (gain * registry.Quantity(1, parse_unit(each))).dimensionality
            == target.dimensionality
        )  # fmt: skip
        raise RecordError(
            f"{where}: no unit is known of the column; write it behind its name, such as "
            f"'{stated.column} [{next(fits, 'unit')}]'"
        )
    total = gain * registry.Quantity(1, parse_unit(unit))
    if turns(name, total.units):
        return float(total.to_base_units().magnitude), ROTATION
    if total.dimensionality != target.dimensionality:
        raise RecordError(
            f"{where}: {own} times {unit} is not {QUANTITIES[name].meaning} "
            f"[{QUANTITIES[name].unit}]"
            + (f" nor {TURNING[name].meaning} [{TURNING[name].unit}]" if name in TURNING else "")
            + "; correct the scale"
        )
    return float(total.to(target).magnitude), TRANSLATION if name in TURNING else None


def _electric(target: Any, own: str) -> bool:
    """Whether a scale in a unit makes a target of volts, amperes or bare numbers."""
    registry = unit_registry()
    left = (registry.Quantity(1, target) / registry.Quantity(1, parse_unit(own))).to_base_units()
    electric = (registry.Unit("V"), registry.Unit("A"), registry.Unit("dimensionless"))
    return any(left.dimensionality == each.dimensionality for each in electric)
