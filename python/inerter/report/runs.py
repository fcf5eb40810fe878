"""Which runs and which of their samples the report is about."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inerter.diagnose.result import Diagnosis, RecordSummary, RunCurves
from inerter.pictures.thinning import Mask

# more runs than these would make the page too large to pass on
PICTURED_RUNS = 12
_ROLES = {"fit": "fitted", "holdout": "held out"}


def pictured(curves: Sequence[RunCurves]) -> list[RunCurves]:
    """The runs that get pictures, held-out ones first."""
    return sorted(curves, key=lambda run: not run.holdout.any())[:PICTURED_RUNS]


def judged(run: RunCurves) -> Mask:
    """The samples that a run's figures are about: held out if any are, never near the ends."""
    held = run.holdout & run.inner
    if held.any():
        return held
    return run.inner if run.inner.any() else np.ones(len(run.time), bool)


def rmse(run: RunCurves, force: np.ndarray) -> float:
    """Rms force error over the judged samples [N]."""
    mask = judged(run)
    return float(np.sqrt(np.mean((run.force[mask] - force[mask]) ** 2)))


def part_held_out(run: RunCurves) -> str:
    """One of "held out", "partly held out" and "fitted", for people to read."""
    if run.holdout.all():
        return "held out"
    return "partly held out" if run.holdout.any() else "fitted"


def role(record: RecordSummary, diagnosis: Diagnosis) -> str:
    """How a record was used, in words."""
    # of a vehicle each channel of a run has curves
    alone, channel = record.name, f"{record.name}: "
    for run in sorted(diagnosis.curves, key=lambda run: run.name != alone):
        if run.name == alone or run.name.startswith(channel):
            return part_held_out(run)
    if diagnosis.points is not None and record.role == "fit":
        # of a table's frequencies some are held out
        return "partly held out"
    return _ROLES.get(record.role, record.role)
