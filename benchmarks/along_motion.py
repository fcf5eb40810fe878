"""What a sample along a measured motion costs in the core, per friction law, against the reference.

The reference is read for its equations, not for speed: its ratio says what the core saves an
identification, which evaluates such motions thousands of times.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from inerter import Device, friction_laws
from inerter.reference import ReferenceDevice, response, sum_of_sines

SAMPLES, SPACING = 20_000, 1e-3
DEVICE: dict[str, Any] = {"inertance": 113.0}
LEVELS = {"coulomb_force": 10.0}
PARAMETERS: dict[str, dict[str, Any]] = {
    "none": {},
    "coulomb": LEVELS,
    "stribeck": LEVELS | {"static_force": 14.0},
    "dahl": LEVELS | {"bristle_stiffness": 1e5},
    "lugre": LEVELS | {"static_force": 14.0, "bristle_stiffness": 1e5, "bristle_damping": 50.0},
    "bouc_wen": {"bw_stiffness": 1e4, "bw_beta": 800.0, "bw_gamma": 200.0},
    "brown_mcphee": LEVELS | {"static_force": 14.0},
}


def _seconds(function: Callable[[], object]) -> float:
    begin = time.perf_counter()
    function()
    return time.perf_counter() - begin


def run(quick: bool = False) -> list[dict[str, Any]]:
    """Rows: law, nanoseconds per sample, ratio to no friction, ratio of the reference to it."""
    motion = sum_of_sines([0.01, 0.003, 0.001], [0.7, 1.9, 4.1], [0.0, 1.0, 2.0])
    times = SPACING * np.arange(SAMPLES)
    x, v, a = (
        np.array([getattr(motion, name)(t) for t in times])
        for name in ("displacement", "velocity", "acceleration")
    )
    devices = {law: Device(**DEVICE, friction=law, **PARAMETERS[law]) for law in friction_laws()}
    rounds = 5 if quick else 25
    costs: dict[str, list[float]] = {law: [] for law in devices}
    for _ in range(rounds):
        for law, device in devices.items():
            costs[law].append(
                _seconds(lambda device=device: device.along(SPACING, x, v, a)) / SAMPLES
            )
    rows = []
    for law in devices:
        reference = ReferenceDevice(**DEVICE, friction=law, **PARAMETERS[law])
        few = times[: SAMPLES // (20 if quick else 5)]
        slow = _seconds(lambda r=reference, few=few: response(r, motion, few)) / few.size
        ratios = [cost / plain for cost, plain in zip(costs[law], costs["none"], strict=True)]
        cost = statistics.median(costs[law])
        rows.append(
            {
                "law": law,
                "nanoseconds_per_sample": 1e9 * cost,
                "ratio_to_none": statistics.median(ratios),
                "reference_ratio": slow / cost,
            }
        )
    return rows
