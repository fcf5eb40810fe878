"""Records that stand still for most of their time, before a motion or after it.

Where a device rests, dry friction holds whatever force is there: of such a rest no law without
memory says the force, and most of a record would be judged by what nothing tells. A free decay that
was recorded for ten times as long as it took is an example. Rests between motions stay: friction
with memory is told by them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.records import Record

# share of a record that rests at its ends from which on they are left out
MOST = 0.5
# what a rest may move by, per travel and per its own noise, and per travel however much that is:
# small cycles, sampled sparsely, look like noise and are none
TRAVEL, NOISE, LARGEST = 0.002, 6.0, 0.02
# share of a record at its end that says where it rests
END = 0.02


def without_standstill(records: Sequence[Record]) -> tuple[list[Record], str]:
    """Records without long rests at their ends, and a sentence on what was left out."""
    cut, told = [], []
    for record in records:
        first, last = _moving(record.displacement)
        rest = 1 - (last - first) / record.samples
        if rest <= MOST or last - first < 2:
            cut.append(record)
            continue
        part = _rows(record, slice(first, last))
        told.append(f"{record.name} ({record.duration - part.duration:.3g} s)")
        cut.append(part)
    if not told:
        return cut, ""
    return cut, (
        f"Most of the time nothing moves: the rests at the ends of {', '.join(told)} were left "
        "out, where dry friction holds whatever force is there."
    )


def _rows(record: Record, rows: slice) -> Record:
    """Some rows of a record."""
    columns = {"time": record.time, **record.channels()}
    extra = {name: values[rows] for name, values in record.extra.items()}
    return replace(record, extra=extra, **{name: v[rows] for name, v in columns.items()})


def _moving(x: NDArray[np.float64]) -> tuple[int, int]:
    """Samples between which a displacement (n,) moves: the first, and the one after the last."""
    last = _begins(x[::-1])
    return (_begins(x), x.size - last) if last < x.size else (0, x.size)


def _begins(x: NDArray[np.float64]) -> int:
    """The first sample that is away from where a displacement rests at its beginning."""
    end = x[: max(int(END * x.size), 5)]
    middle = float(np.median(end))
    # second differences of a motion are next to nothing
    noise = 1.4826 * float(np.median(np.abs(np.diff(end, 2)))) / np.sqrt(6.0)
    travel = float(np.ptp(x))
    away = np.abs(x - middle) > max(TRAVEL * travel, min(NOISE * noise, LARGEST * travel))
    return int(np.argmax(away)) if away.any() else x.size
