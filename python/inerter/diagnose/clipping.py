"""A force channel that clips: where records show it, and whether it may be one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from inerter.catalogue.effects import EFFECTS
from inerter.identify.channel import clips
from inerter.identify.model import Model
from inerter.identify.prediction import beyond_limits
from inerter.identify.runs import BenchRun
from inerter.records import Record
from inerter.records.clipping import cut_levels

SATURATION = EFFECTS["sensor_saturation"].name
_LIMITS = {"upper": "force_maximum", "lower": "force_minimum"}
# share of the range by which a limit begins within the level that records show
_WITHIN = 0.005
# the same within which a smoothed force is at it
_BESIDE = 0.03
# share of the samples at its limits from which on such a channel is a constant force
_MOST = 0.8


def begun_clipped(records: Sequence[Record], model: Model) -> Model | None:
    """A model with the limits at which records show again and again that the force is cut off.

    What flat tops hide looks like a friction that falls with the speed, a spring, a curve; found
    before the limits, they lead astray. None where no record shows any, or another one goes beyond.
    """
    found = limits_of(records)
    missing = {name: value for name, value in found.items() if name not in model.values}
    return model.adding(None, **missing) if missing else None


def limits_of(records: Sequence[Record]) -> dict[str, float]:
    """Limits [N] at which records show again and again that the force is cut off, by name."""
    high = max(float(record.force.max()) for record in records)
    low = min(float(record.force.min()) for record in records)
    found: dict[str, float] = {}
    for record in records:
        levels, _ = cut_levels(record.force, record.displacement)
        for end, level in levels.items():
            beyond = high - level if end == "upper" else level - low
            if beyond <= _WITHIN * (high - low):
                inwards = -1.0 if end == "upper" else 1.0
                found[_LIMITS[end]] = level + inwards * _WITHIN * (high - low)
    return found


def apart_from(limits: Mapping[str, float], runs: Sequence[BenchRun]) -> list[BenchRun]:
    """Runs without the samples whose force is at limits [N], where it says nothing."""
    high = limits.get(_LIMITS["upper"], np.inf)
    low = limits.get(_LIMITS["lower"], -np.inf)
    within = _BESIDE * (max(run.force.max() for run in runs) - min(r.force.min() for r in runs))
    return [
        replace(run, inner=run.inner & (run.force < high - within) & (run.force > low + within))
        for run in runs
    ]


def hides_nearly_all(model: Model, runs: Sequence[BenchRun]) -> bool:
    """Whether a model's channel clips most of the force away, and is a constant beside the rest."""
    if not clips(model.values):
        return False
    beyond = [beyond_limits(model, run) for run in runs]
    return float(np.mean(np.concatenate(beyond))) > _MOST
