"""Which column of a file is which of our quantities, and what is said where that is not clear."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from .calibration import Statement, column_of
from .header import bare_name, guess, is_wanted, of_unit
from .raw_table import RawTable, listed
from .record import AnyRecord, BenchTable, Record, RecordError, VehicleRecord
from .turning import OWN_NAMES
from .units import QUANTITIES, motion_of_unit, split_header

Kind = Literal["bench", "vehicle", "table"]

CLASSES: dict[str, type[Record] | type[VehicleRecord] | type[BenchTable]] = {
    "bench": Record,
    "table": BenchTable,
    "vehicle": VehicleRecord,
}

# what stands for a displacement that was not measured
MOTION = (("velocity",), ("acceleration",), ("acceleration_1", "acceleration_2"))
_BENCH = ("time", "displacement", "force", "velocity", "acceleration")
_REQUIRED = ("time", "displacement", "force")


@dataclass(frozen=True)
class Columns:
    """Which column of a raw table holds what: index by name, unit by name, the rest, statements."""

    own: dict[str, int]
    units: dict[str, str | None]
    extra: dict[str, int]
    stated: Mapping[str, Statement]


def is_known(header: str, stated: Mapping[str, Statement]) -> bool:
    """Whether a column may be one of our quantities."""
    name = split_header(header)[0]
    if name in QUANTITIES or name == "run" or guess(header) is not None:
        return True
    # where no name tells, the only column of such a unit is taken
    if any(of_unit(header, quantity) for quantity in _REQUIRED):
        return True
    names = {bare_name(each.column).casefold() for each in stated.values()}
    return bare_name(header).casefold() in names or header.strip().casefold() in {
        each.column.casefold() for each in stated.values()
    }


def recognise(table: RawTable, kind: Kind | None, stated: Mapping[str, Statement]) -> Columns:
    """Names and units of the columns; RecordError when two columns hold the same thing."""
    own: dict[str, int] = {}
    units: dict[str, str | None] = {}
    extra: dict[str, int] = {}
    for name, statement in stated.items():
        if statement.column:
            own[name] = column_of(statement, table.header, name, table.path)
            units[name] = statement.unit or split_header(table.header[own[name]])[1]
    taken = set(own.values())
    turning = _names_of_turning(table.header, own)
    # formulas of one column may serve two quantities: such a column is none of the others
    for index, header in enumerate(table.header):
        name, unit = split_header(header)
        if turning and name in turning.values():
            # beside an angle and a torque, what is called a force is another channel
            name = ""
        name = turning.get(name, name)
        known = (name in QUANTITIES or name == "run") and _measured(name, stated)
        known = known and not (name in stated and stated[name].column)
        key = name if known else header.strip()
        # a column without a name is the row number of some export
        if not key or index in taken:
            continue
        target = own if known else extra
        if known and key in own and own[key] not in taken:
            # a sensor's volts beside what they were turned into
            less = _raw_one(name, table.header, own[key], index)
            if less is not None:
                kept = own[key] + index - less
                own[key], units[key] = kept, split_header(table.header[kept])[1]
                extra[table.header[less].strip()] = less
                continue
        if key in target or (known and key in extra):
            first = table.header[target[key]].strip()
            raise RecordError(
                f"{table.path}: columns {first!r} and {header.strip()!r} both hold {key!r}; "
                f"say which by --column {key}={header.strip()!r}"
            )
        target[key] = index
        if known:
            units[key] = unit
    found = Columns(own, units, extra, stated)
    if kind in (None, "bench") and not {"road", "frequency"} & set(own):
        _guess_others(table, found)
    return found


def _raw_one(name: str, header: tuple[str, ...], first: int, second: int) -> int | None:
    """Of two columns of one name that whose unit is none of this quantity, where the other's is."""
    units = [split_header(header[index])[1] for index in (first, second)]
    right = [motion_of_unit(name, unit) is not None for unit in units]
    if None in units or right[0] == right[1]:
        return None
    return second if right[0] else first


def _names_of_turning(header: tuple[str, ...], own: Mapping[str, int]) -> dict[str, str]:
    """Which of our quantities the columns called `angle`, `torque` and so on are, by their name.

    None where a file has a displacement and a force: there they are further channels.
    """
    names = {split_header(text)[0] for text in header if text.strip()} | set(own)
    if {"displacement", "force"} <= names or "road" in names:
        return {}
    found = {name: quantity for name, quantity in OWN_NAMES.items() if name in names}
    if {"angle", "torque"} <= set(found):
        return found
    return {name: quantity for name, quantity in found.items() if quantity not in names}


def turns_by_name(header: str) -> bool:
    """Whether the name of a column says that its device turns."""
    return split_header(header)[0] in OWN_NAMES


def _measured(name: str, stated: Mapping[str, Statement]) -> bool:
    return name not in stated or stated[name].role == "measured"


def _guess_others(table: RawTable, found: Columns) -> None:
    """Take columns with usual names for quantities that no column has the name of."""
    for quantity in _BENCH:
        if quantity in found.own or not _measured(quantity, found.stated):
            continue
        if quantity in found.stated and found.stated[quantity].interval is not None:
            continue
        ranked = [
            (guessed[1], index)
            for index in found.extra.values()
            if (guessed := guess(table.header[index])) and guessed[0] == quantity
        ]
        if quantity not in _REQUIRED:
            # a measured velocity counts: a unit has to say that it is one
            ranked = [
                (rank, i)
                for rank, i in ranked
                if _fits(quantity, table.header[i], found) and not is_wanted(table.header[i])
            ]
        best = [index for rank, index in ranked if rank == max(r for r, _ in ranked)]
        if quantity in _REQUIRED:
            best = _measured_ones(table, quantity, best, found)
        if len(best) > 1 and quantity in _REQUIRED:
            _ask(table, quantity, best)
        if len(best) == 1:
            header = table.header[best[0]]
            found.own[quantity] = best[0]
            found.units[quantity] = split_header(header)[1]
            del found.extra[header.strip()]


def _measured_ones(table: RawTable, quantity: str, best: list[int], found: Columns) -> list[int]:
    """Of several columns those that are no set points; of none the only one of such a unit."""
    if not best:
        alone = [
            index
            for index in found.extra.values()
            if of_unit(table.header[index], quantity)
            and guess(table.header[index]) is None
            and not is_wanted(table.header[index])
        ]
        return alone if len(alone) == 1 else []
    measured = [index for index in best if not is_wanted(table.header[index])]
    return measured or best


def _fits(quantity: str, header: str, found: Columns) -> bool:
    """Whether a column has a unit, and one of the motion that displacement and force have."""
    unit = split_header(header)[1]
    theirs = [motion_of_unit(name, found.units.get(name)) for name in ("displacement", "force")]
    motion = motion_of_unit(quantity, unit)
    return unit is not None and all(each in (None, motion) for each in theirs)


def _ask(table: RawTable, quantity: str, candidates: list[int]) -> None:
    names = [table.header[index].strip() for index in candidates]
    ways = " or ".join(f"--column {quantity}={name!r}" for name in names[:4])
    raise RecordError(
        f"{table.path}: {len(names)} columns may be the {quantity}: {listed(names)}; say {ways}"
    )


def choose_kind(table: RawTable, found: Columns, kind: Kind | None) -> type[AnyRecord]:
    """The wanted class, else the first whose columns are complete, else the most likely one."""
    complete = [name for name in CLASSES if not missing(found, CLASSES[name])]
    if kind is not None:
        if complete and kind not in complete:
            raise RecordError(
                f"{table.path}: this is a {complete[0]} record, a {kind} record is needed "
                f"(columns {', '.join(CLASSES[kind].required)}); give another file"
            )
        return CLASSES[kind]
    if complete:
        return CLASSES[complete[0]]
    share = {
        k: sum(n in found.own for n in c.required) / len(c.required) for k, c in CLASSES.items()
    }
    if "road" not in found.own:
        share["vehicle"] = 0.0
    return CLASSES[max(share, key=lambda k: share[k])]


def missing(found: Columns, cls: type[AnyRecord]) -> list[str]:
    """Required columns that are not there; a velocity or acceleration stands for a displacement."""
    lost = [name for name in cls.required if name not in found.own]
    counted = "time" in found.stated and found.stated["time"].interval is not None
    if counted and "time" in lost:
        lost.remove("time")
    if cls is Record and any(all(n in found.own for n in names) for names in MOTION):
        lost = [name for name in lost if name != "displacement"]
    return lost


def refuse_missing(table: RawTable, found: Columns, cls: type[AnyRecord]) -> None:
    """RecordError for every required column that is not there, with the likeliest stand-ins."""
    lost = missing(found, cls)
    if not lost:
        return
    spare = [table.header[index].strip() for index in found.extra.values()]
    ways, hints = [], []
    for name in lost:
        match = _stand_in(name, spare)
        if name == "time" and match is None:
            ways.append("--column time='every 1 ms'")
            continue
        ways.append(f"--column {name}={match or 'NAME'!r}")
        unit = split_header(match)[1] if match else None
        if unit in ("V", "mV"):
            si = QUANTITIES[name].unit
            ways[-1] = f"--column {name}='200 {si}/{unit} * {bare_name(match or '')}'"
            hints.append(f"{match!r} is in {unit}, its calibration has to be stated")
    absent = ", ".join(f"no column {name!r}" for name in lost)
    needs = f"a {cls.kind} record needs the columns {', '.join(cls.required)}"
    if cls is Record:
        needs += " (or a velocity or acceleration in place of the displacement)"
    hint = f" ({'; '.join(hints)})" if hints else ""
    raise RecordError(
        f"{table.path}: {absent} (found: {listed(table.header)}); {needs}: say which "
        f"{'it is' if len(lost) == 1 else 'they are'}, such as {' '.join(ways)}{hint}"
    )


def _stand_in(name: str, spare: list[str]) -> str | None:
    """The column that is most likely meant."""
    bare = {bare_name(header).casefold(): header for header in spare}
    close = difflib.get_close_matches(name, list(bare), n=1, cutoff=0.6)
    if close:
        return bare[close[0]]
    for header in spare:
        guessed = guess(bare_name(header))
        if guessed is not None and guessed[0] == name:
            return header
    return None
