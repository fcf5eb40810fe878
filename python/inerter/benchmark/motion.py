"""What a sample along a measured motion costs in the core, per friction law.

An identification evaluates such motions thousands of times.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from inerter.benchmark.laws import LAWS, parameters_of
from inerter.benchmark.rows import Row, spread_of
from inerter.benchmark.timing import Work, interleaved
from inerter.core import Device
from inerter.reference import Motion, ReferenceDevice, response, sum_of_sines

SPACING = 1e-3
"""Between samples [s]."""


def motion() -> Motion:
    """Three sines: sliding back and forth, with rests and reversals of all sizes."""
    return sum_of_sines([0.01, 0.003, 0.001], [0.7, 1.9, 4.1], [0.0, 1.0, 2.0])


def samples(count: int) -> tuple[NDArray, NDArray, NDArray]:
    """Displacement, velocity and acceleration at `count` times, each (count,)."""
    path, times = motion(), SPACING * np.arange(count)
    names = ("displacement", "velocity", "acceleration")
    x, v, a = (np.array([getattr(path, name)(t) for t in times]) for name in names)
    return x, v, a


def core_work(law: str, count: int) -> Work:
    """The core along the motion."""
    device, (x, v, a) = Device(**parameters_of(law)), samples(count)
    return Work(lambda: device.along(SPACING, x, v, a), count)


def reference_work(law: str, count: int) -> Work:
    """The reference equations, states by an adaptive stiff solver.

    They are read for their equations, not for speed.
    """
    device, path = ReferenceDevice(**parameters_of(law)), motion()
    times = SPACING * np.arange(count)
    return Work(lambda: response(device, path, times), count)


def along_costs(
    rounds: int, count: int, progress: Callable[[float], None] = lambda share: None
) -> list[Row]:
    """Rows: law, nanoseconds of a sample, samples per second, ratio of the reference to it."""
    rows: list[Row] = []
    for done, law in enumerate(LAWS):
        works = {"core": core_work(law, count), "reference": reference_work(law, count // 10)}
        times = interleaved(works, rounds, clock=time.process_time)
        cost = times["core"].spread
        rows.append(
            {
                "law": law,
                **spread_of("nanoseconds", cost.times(1e9)),
                "million_samples_per_second": 1e-6 / cost.median,
                **spread_of("reference_ratio", times["reference"].ratio(times["core"])),
            }
        )
        progress((done + 1) / len(LAWS))
    return rows
