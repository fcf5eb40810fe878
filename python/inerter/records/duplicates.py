"""Records against each other: which repeats an earlier one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar, cast

import numpy as np

from .record import Array, Columns, Record, TimeRecord

R = TypeVar("R", bound=Columns)


def find_duplicate_records(records: Sequence[R]) -> list[R]:
    """`duplicate_record` on every record that repeats an earlier one; the caller drops it.

    The same kind and number of samples, and equal channels to 1e-6 of their ranges: of a bench run
    displacement and force, of a table its frequencies too; times may differ. Channels that are
    constant in both do not count as equal by themselves.
    """
    earlier: dict[tuple[str, int, tuple[str, ...]], list[Columns]] = {}
    checked = list(records)
    for index, record in enumerate(checked):
        compared = _compared(record)
        rivals = earlier.setdefault((record.kind, record.samples, tuple(compared)), [])
        twin = next((r for r in rivals if _equal(_compared(r), compared)), None)
        if twin is None:
            rivals.append(record)
        else:
            what = " and ".join(compared) if isinstance(record, Record) else "channels"
            text = f"the same {what} as {twin.name!r}: leave one of them out"
            checked[index] = cast(R, record.warn("duplicate_record", text))
    return checked


def _compared(record: Columns) -> dict[str, Array]:
    """The channels in which a record that repeats another equals it."""
    if isinstance(record, Record):
        return {"displacement": record.displacement, "force": record.force}
    first = {} if isinstance(record, TimeRecord) else {"": getattr(record, record.required[0])}
    return {**first, **record.channels()}


def _equal(one: dict[str, Array], other: dict[str, Array]) -> bool:
    """Whether two records of one length hold the same channels."""
    for name, first in one.items():
        second, allowed = other[name], 1e-6 * np.ptp(first)
        # a few samples tell most pairs apart
        few = slice(None, None, max(1, len(first) // 16))
        if np.any(np.abs(first[few] - second[few]) > allowed):
            return False
        if np.any(np.abs(first - second) > allowed):
            return False
    return any(np.ptp(channel) > 0.0 for channel in one.values())


def repeats_another(record: Columns) -> bool:
    """Whether a record was found to be a copy of an earlier one."""
    return any(warning.code == "duplicate_record" for warning in record.warnings)


def without_copies(records: Sequence[R], held_out: Sequence[str] = ()) -> list[R]:
    """The records that repeat no earlier one.

    Raises
    ------
    ValueError
        A record that is to be held out is a copy.
    """
    for record in records:
        if record.name in held_out and repeats_another(record):
            raise ValueError(f"--holdout {record.name}: {record.warnings[-1].text}")
    return [record for record in records if not repeats_another(record)]
