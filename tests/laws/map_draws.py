"""Random maps of force over displacement and velocity."""

from __future__ import annotations

import numpy as np
from core_draws import Parameters


def draw_map(rng: np.random.Generator) -> Parameters:
    """A map of any size that a device holds, with or without a scale, passive or not."""
    rows, columns = (int(rng.choice([2, 3, int(rng.integers(4, n)), n])) for n in (24, 16))
    speed, lower = 10.0 ** float(rng.uniform(-1.5, 0.5)), float(rng.normal(0.0, 0.03))
    drawn: Parameters = {
        "force_map": tuple(rng.normal(0.0, 40.0, rows * columns)),
        "force_map_columns": float(columns),
        "force_map_lower": lower,
        "force_map_upper": lower + 10.0 ** float(rng.uniform(-2.0, -0.5)),
        "force_map_speed": speed,
    }
    if rng.integers(2):
        drawn["force_map_scale"] = speed * 10.0 ** float(rng.uniform(-2.0, 0.5))
    if rng.integers(2):
        drawn["force_map_passive"] = 1.0
    return drawn
