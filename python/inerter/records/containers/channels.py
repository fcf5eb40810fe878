"""Channels of a file, each perhaps on a clock of its own, and the table that is made of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from inerter.records.bounds import LONGEST_TEXT, refuse_packing, refuse_table
from inerter.records.header import guess
from inerter.records.interpolate import on_times
from inerter.records.record import RecordError

_MOST_NAMED = 8


@dataclass(frozen=True, kw_only=True)
class Channel:
    """A channel: its name with its unit, how many values, in which group, and what loads them.

    clock: start and interval [s] where the values have no time channel but a stated clock.
    """

    name: str
    rows: int
    group: str
    load: Callable[[], Any]
    clock: tuple[float, float] | None = None


def with_unit(name: str, unit: Any) -> str:
    """A name with its unit in brackets, where it has one."""
    text = unit.decode("utf-8", "replace") if isinstance(unit, bytes) else str(unit or "")
    text = text.strip().strip("[]()")
    return f"{name} [{text}]" if text and "[" not in name else name


def of_one_group(path: Path, channels: Sequence[Channel], wanted: str | None) -> list[Channel]:
    """The channels of one record: of the group that is wanted, or of all where they fit together.

    Raises
    ------
    RecordError
        There is no such group, or several groups hold a record each.
    """
    groups = list(dict.fromkeys(channel.group for channel in channels))
    if wanted is not None:
        chosen = [c for c in channels if c.group == wanted]
        if not chosen:
            raise RecordError(
                f"{path}: no group or sheet {wanted!r}; there are {_named(groups)}; say --sheet"
            )
        return chosen
    quantities = Counter(
        (found[0], channel.group) for channel in channels if (found := guess(channel.name))
    )
    holding = {
        name: [g for g in groups if (name, g) in quantities] for name in ("force", "displacement")
    }
    if all(len(found) > 1 for found in holding.values()):
        raise RecordError(
            f"{path}: several groups hold a record each ({_named(holding['force'])}); say "
            f"--sheet {holding['force'][0]!r}"
        )
    return list(channels)


def _named(groups: Sequence[str]) -> str:
    shown = ", ".join(repr(group) for group in groups[:_MOST_NAMED])
    return shown + (", ..." if len(groups) > _MOST_NAMED else "")


def header_of(channels: Sequence[Channel]) -> list[str]:
    """Names of channels, apart where two are the same."""
    count = Counter(channel.name for channel in channels)
    names = [f"{c.group}/{c.name}" if count[c.name] > 1 and c.group else c.name for c in channels]
    # a time of each group is one clock or another: the first keeps its name
    seen: Counter[str] = Counter()
    for index, name in enumerate(names):
        seen[name] += 1
        if seen[name] > 1:
            names[index] = f"{name} {seen[name]}"
    return names


def table_of(
    path: Path, channels: Sequence[Channel], chosen: Sequence[int]
) -> tuple[list[str], dict[int, Any], str]:
    """Header, values by index, and what is told, of the chosen channels on one clock."""
    header = header_of(channels)
    picked = [i for i in chosen if channels[i].rows]
    if not picked:
        return header, {}, ""
    refuse_table(path, max(channels[i].rows for i in picked), len(picked))
    refuse_packing(path, 8.0 * sum(channels[i].rows for i in picked))
    clocks = {c.group: _Clock(c.group, channels) for c in (channels[i] for i in picked)}
    # the clock of the force, else the one with the most values
    forces = [channels[i] for i in picked if (g := guess(channels[i].name)) and g[0] == "force"]
    known = forces or [channels[i] for i in picked]
    base = clocks[max(known, key=lambda c: c.rows).group]
    told = []
    columns: dict[int, Any] = {}
    moved: set[str] = set()
    for index in picked:
        channel = channels[index]
        values = _loaded(channel)
        if values is None:
            continue
        clock = clocks[channel.group]
        if clock is not base and not clock.same(base):
            if index == clock.time_index:
                continue
            if clock.time is None or base.time is None or not isinstance(values, np.ndarray):
                if len(values) != base.rows:
                    continue
            else:
                values = clock.brought(values, base)
                moved.add(channel.group)
        elif clock is not base and index == clock.time_index:
            continue
        if len(values) == base.rows:
            columns[index] = values
    if moved:
        told.append(f"{_named(sorted(moved))} brought to the clock of {base.group!r}")
    if base.time_index is None and base.time is not None:
        columns[len(header)] = base.time
        header = [*header, "time [s]"]
        told.append(f"a sample every {base.interval:g} s")
    elif base.time_index is not None:
        header[base.time_index] = channels[base.time_index].name
    return header, columns, ", ".join(told)


class _Clock:
    """The times of one group, from its time channel or its stated start and interval."""

    def __init__(self, group: str, channels: Sequence[Channel]) -> None:
        own = [(i, c) for i, c in enumerate(channels) if c.group == group]
        self.group = group
        self.rows = max(c.rows for _, c in own)
        self.interval = 0.0
        ranked = [(g[1], -i, i) for i, c in own if (g := guess(c.name)) and g[0] == "time"]
        self.time_index = max(ranked)[2] if ranked else None
        self.time: Any = None
        if self.time_index is not None:
            loaded = _loaded(channels[self.time_index])
            self.time = loaded if isinstance(loaded, np.ndarray) else None
            return
        stated = next(
            (c.clock for _, c in own if c.clock is not None and c.rows == self.rows), None
        )
        if stated is not None and stated[1] > 0:
            self.interval = stated[1]
            self.time = stated[0] + stated[1] * np.arange(self.rows)

    def same(self, other: _Clock) -> bool:
        if self.time is None or other.time is None:
            return self.rows == other.rows
        return self.rows == other.rows and bool(
            np.allclose(self.time, other.time, rtol=0, atol=1e-9 + 1e-6 * abs(self.interval))
        )

    def brought(self, values: Any, base: _Clock) -> Any:
        """Values on the times of another clock, NaN outside."""
        return on_times(values, self.time, base.time)


def _loaded(channel: Channel) -> Any:
    """Values as float64, or a list of texts; None for what is neither."""
    values = channel.load()
    if isinstance(values, list):
        return [str(value)[: LONGEST_TEXT + 1] for value in values]
    array = np.asarray(values)
    if array.dtype.kind == "M":
        seconds = array.astype("datetime64[ns]").astype(np.int64)
        day = 86_400_000_000_000
        first = seconds[0] // day * day if len(seconds) else 0
        return (seconds - first) * 1e-9
    if array.dtype.kind == "m":
        return array.astype("timedelta64[ns]").astype(np.int64) * 1e-9
    if array.dtype.kind in "biuf":
        return np.ascontiguousarray(array.ravel(), dtype=np.float64)
    if array.dtype.kind in "SU":
        return [
            v.decode("utf-8", "replace") if isinstance(v, bytes) else str(v) for v in array.ravel()
        ]
    return None
