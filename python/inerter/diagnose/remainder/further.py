"""Channels of the records beside motion and force: what a model leaves may go with one of them.

A voltage, a pressure, a temperature or a load that sets a parameter of the device. A channel that
is another measure of the motion or of the force says nothing of a cause, and is left out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.identify.runs import BenchRun
from inerter.records import Record

Array = NDArray[np.float64]

# least change of a channel, per its largest value, for anything to go with it
_CHANGE = 0.02
# share of a channel's power that the motion may tell of it, and that the force may
_ITS_OWN = 0.5
# channels that are looked at, the first of a record
_MOST = 12


def further_channels(records: Sequence[Record], runs: Sequence[BenchRun]) -> dict[str, list[Array]]:
    """By name, each channel that all records have at the samples of their runs, about 0 to 1."""
    channels = [record.beside() for record in records]
    headers = [h for h in channels[0] if all(h in each for each in channels)]
    found = {}
    for header in headers[:_MOST]:
        name = header.partition("[")[0].strip()
        values = [
            np.interp(run.time, record.time, each[header])
            for run, record, each in zip(runs, records, channels, strict=True)
        ]
        if not all(np.isfinite(each).all() for each in values):
            continue
        seen = np.concatenate([q[run.inner] for q, run in zip(values, runs, strict=True)])
        low, spread = float(seen.min()), float(np.ptp(seen))
        changes = spread > _CHANGE * float(np.abs(seen).max())
        if name and changes and not _is_measured_otherwise(seen, runs):
            found[name] = [(q - low) / spread for q in values]
    return found


def _is_measured_otherwise(seen: Array, runs: Sequence[BenchRun]) -> bool:
    """Whether a channel (n,) is motion or force in other words.

    Not one that takes both to tell: what acts on the device from elsewhere is what is left of the
    force beside the motion.
    """

    def of(name: str) -> Array:
        return np.concatenate([getattr(run, name)[run.inner] for run in runs])

    x, v, a, force = map(of, ("displacement", "velocity", "acceleration", "force"))
    seen = seen - seen.mean()
    return any(_told(seen, known) > _ITS_OWN for known in ((x, v, a, np.sign(v)), (force,)))


def _told(seen: Array, known: Sequence[Array]) -> float:
    """Share of a channel's power (n,) that others tell of it."""
    columns = np.column_stack(known)
    columns = columns - columns.mean(axis=0)
    sizes = np.sqrt(np.mean(columns**2, axis=0))
    columns = columns[:, sizes > 0] / sizes[sizes > 0]
    left = seen - columns @ np.linalg.lstsq(columns, seen, rcond=1e-9)[0]
    return 1.0 - float(np.mean(left**2) / np.mean(seen**2))


def columns_of_channels(linear: Array, channels: Mapping[str, Array]) -> dict[str, Array]:
    """Columns of a test of each: what is in proportion to the motion (n, m), and goes with it."""
    return {
        test_of(name): np.column_stack([linear * (q**k)[:, None] for k in range(3)])
        for name, q in channels.items()
    }


def test_of(channel: str) -> str:
    """The test's name, by which it is told too."""
    return f"the channel {channel}"


def measured_by(test: str) -> str:
    """What measures the law behind a test."""
    channel = test.removeprefix(test_of(""))
    return f'see `inerter identify --scaled-by "{channel}"`'


def channels_of(tests: Sequence[str]) -> list[str]:
    """Those of some tests that are of further channels."""
    return [test for test in tests if test.startswith(test_of(""))]
