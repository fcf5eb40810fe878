"""The extended device simulated again, in each engine, along the measured motion."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.identify.bench import Run
from inerter.identify.fit import Model, delayed, first_state
from inerter.rig import simulate_along


def simulate_engines(
    model: Model, runs: Sequence[Run], masks: Sequence[NDArray[np.bool_]]
) -> dict[str, float | None]:
    """Rms force error [N] of each engine over the masked samples; None: engine not run."""
    return {"mujoco": _mujoco(model, runs, masks), "exudyn": None, "reference": None}


def _mujoco(model: Model, runs: Sequence[Run], masks: Sequence[NDArray[np.bool_]]) -> float:
    device = model.device()
    square, count = 0.0, 0
    for run, mask in zip(runs, masks, strict=True):
        if not mask.any():
            continue
        force = simulate_along(
            device,
            run.spacing,
            run.displacement,
            run.velocity,
            run.acceleration,
            first_state(device, run),
        )["total"]
        residual = run.force - delayed(force, model.delay, run.spacing)
        square += float(np.sum(residual[mask] ** 2))
        count += int(mask.sum())
    return float(np.sqrt(square / count))
