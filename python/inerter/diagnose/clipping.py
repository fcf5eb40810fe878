"""Whether a channel that clips may be one: it shows some of the force."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inerter.identify.channel import clips
from inerter.identify.model import Model
from inerter.identify.prediction import beyond_limits
from inerter.identify.runs import BenchRun

# share of the samples at its limits from which on such a channel is a constant force
_MOST = 0.8


def hides_nearly_all(model: Model, runs: Sequence[BenchRun]) -> bool:
    """Whether a model's channel clips most of the force away, and is a constant beside the rest."""
    if not clips(model.values):
        return False
    beyond = [beyond_limits(model, run) for run in runs]
    return float(np.mean(np.concatenate(beyond))) > _MOST
