"""Random curves and periods along the stroke for the core's tests."""

from __future__ import annotations

import numpy as np
from core_draws import Parameters

STROKES = ("friction", "friction_back", "inertance", "inertance_back", "force", "viscous")
RELATIVE = STROKES[:4]


def draw_curves(
    rng: np.random.Generator, strokes: tuple[str, ...] = STROKES, shortest: float = 2e-3
) -> Parameters:
    """Curves or periods or both for some of `strokes`, at least one; a range if there is a curve.

    Relative rises stay above -0.6, damping above 0 with `viscous` of its own.
    """
    drawn: Parameters = {}
    while not drawn:
        for name in strokes:
            kind = rng.integers(4)
            size = 0.3 if name in RELATIVE else {"force": 40.0, "viscous": 30.0}[name]
            if kind in (1, 3):
                count = int(rng.choice([2, 3, int(rng.integers(4, 64)), 64]))
                values = size * rng.uniform(-0.6, 0.6, count)
                drawn[f"{name}_curve"] = tuple(values + (size if name == "viscous" else 0.0))
            if kind in (2, 3):
                count = int(rng.integers(1, 9))
                shares = rng.dirichlet(np.ones(count)) * size
                shares = shares * (0.3 if name == "viscous" else 1.0)
                lengths = shortest * 10.0 ** rng.uniform(0.0, 2.0, count)
                phases = rng.uniform(-4.0, 4.0, count)
                drawn[f"{name}_periods"] = tuple(
                    np.stack([lengths, shares * rng.choice([-1.0, 1.0], count), phases], 1).ravel()
                )
                if name == "viscous" and "viscous_curve" not in drawn:
                    drawn["viscous"] = size * float(rng.uniform(1.0, 2.0))
    if any(name.endswith("_curve") for name in drawn):
        lower = float(rng.normal(0.0, 0.02))
        drawn |= {"curve_lower": lower, "curve_upper": lower + 10.0 ** float(rng.uniform(-2, -0.5))}
    return drawn
