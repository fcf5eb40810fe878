"""What records have to be for a preparation: one line of refusal each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inerter.records.record import AnyRecord, Record, RecordError, TimeRecord
from inerter.records.runs import MAX_MISSING_STRETCH


def over_time(record: AnyRecord) -> TimeRecord:
    """The record, if it is one over time whose gaps can be bridged; else RecordError."""
    if not isinstance(record, TimeRecord):
        raise RecordError(
            f"{record.source or record.name}: a table of amplitudes has no signal to prepare; "
            "give records over time"
        )
    steps = np.diff(record.time)
    worst = int(np.argmax(steps))
    missing = steps[worst] / np.median(steps) - 1
    if missing > MAX_MISSING_STRETCH + 0.5:
        raise RecordError(
            f"{record.source or record.name}: {round(missing)} samples are missing after "
            f"t = {record.time[worst]:.6g} s, at most {MAX_MISSING_STRETCH} are bridged; "
            "split the record there (a 'run' column)"
        )
    return record


def bench(record: TimeRecord) -> Record:
    """The record, if it has displacement and force; else RecordError."""
    if not isinstance(record, Record):
        raise RecordError(
            f"{record.source or record.name}: --delay and --derivatives need displacement and "
            "force, and this is a vehicle record; leave them out"
        )
    return record


def refuse_cutoff(records: Sequence[TimeRecord], cutoff: float) -> None:
    """RecordError where a cut-off [Hz] is beyond what a record can show."""
    for record in records:
        if cutoff >= 0.5 * record.sample_rate:
            raise RecordError(
                f"{record.source or record.name}: --cutoff is {cutoff:g} Hz and the record has "
                f"{record.sample_rate:.6g} samples per second; stay below half of that"
            )
