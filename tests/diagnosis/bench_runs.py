"""Runs of a bench: what a device does by the reference, measured with noise."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from inerter.records import Record
from inerter.reference import Motion, ReferenceDevice, response


def measured(
    device: ReferenceDevice,
    motions: Iterable[Motion],
    time: np.ndarray,
    seed: int = 5,
    force_noise: float = 0.2,
    displacement_noise: float = 1e-6,
) -> list[Record]:
    """A record of each motion; the noises are white [N, m rms]."""
    random, runs = np.random.default_rng(seed), []
    for index, motion in enumerate(motions):
        truth = response(device, motion, time)
        moved = truth.displacement + random.normal(0, displacement_noise, time.size)
        force = truth.force + random.normal(0, force_noise, time.size)
        runs.append(Record(name=f"run_{index}", time=time, displacement=moved, force=force))
    return runs
