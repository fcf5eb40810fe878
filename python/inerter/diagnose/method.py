"""How a diagnosis was made: band, split, motion."""

from __future__ import annotations

from typing import Any

from inerter.diagnose.cannot_tell import goes_one_way, runs_up, sweeps
from inerter.diagnose.stages import Confirmed
from inerter.records.preparation import usable


def unused_in_words(stands: Confirmed) -> str:
    """Which measured channels of the motion were tried and not used, a sentence; "" where none."""
    data = stands.data
    names = [
        name
        for name in ("velocity", "acceleration")
        if name not in data.preparation.channels and usable(name, data.records)
    ]
    if not names:
        return ""
    were, them = ("were", "them") if len(names) > 1 else ("was", "it")
    return (
        f"The measured {' and '.join(names)} {were} not used: without {them} the motion foretells "
        "the force at least as well."
    )


def method_of(stands: Confirmed) -> dict[str, Any]:
    """What was done, and along which motion, as `method` of diagnosis.json."""
    data, given = stands.data, stands.searched.prepared.given
    band = data.preparation
    return {
        "cutoff": band.cutoff,
        "cutoffs_tried": [float(value) for value in band.cutoffs],
        # infinite where too little of a short record is left to judge a cut-off by
        "force_error_at_cutoffs": [float(value) for value in band.errors],
        "channels": ["displacement", *band.channels],
        "one_tone": data.band.scales.one_tone,
        "strokes": stands.searched.search.strokes,
        "one_way": goes_one_way(stands.searched.search.runs),
        "runs_up": runs_up(stands.searched.search.runs),
        "sweeps": sweeps(stands.searched.search.runs),
        "split": data.split.description,
        "held_out_samples": sum(int(mask.sum()) for mask in data.raw.masks),
        "clock_rate": (given.clock.value, given.clock.stderr) if given.clock else None,
        # where it ended the search
        "time_limit": given.time.seconds if given.time.was_felt else None,
        "searched_samples": sum(run.force.size for run in stands.searched.data.whole),
    }
