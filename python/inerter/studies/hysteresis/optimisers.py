"""Two optimisers on the paper's problem.

    sqp            sequential quadratic programming (SciPy's SLSQP) on the rms force error, in the
                   parameters' own units, gradients by forward differences: what the paper did
    sqp_scaled     the same with every parameter in units of its starting value
    least_squares  bounded least squares (SciPy's trust region), scaled likewise

Sequential quadratic programming sees one number per evaluation; least squares sees every sample,
which tells it the curvature (Gauss-Newton).
"""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, minimize

from inerter.studies.hysteresis.objective import Objective
from inerter.studies.hysteresis.published import Box

Array = NDArray[np.float64]

OPTIMISERS = ("sqp", "sqp_scaled", "least_squares")
# the paper's program stops after as many; least squares needs fewer, each with a whole Jacobian
_ITERATIONS = {"sqp": 400, "sqp_scaled": 400, "least_squares": 100}
# a random start is at least this share of its upper bound
_SMALLEST = 1e-6


@dataclass(frozen=True)
class End:
    """Where a search ended: `vector` (p,) and rms force `error` [N].

    `evaluations` counts sets of tests simulated, `seconds` is processor time.
    """

    vector: Array
    error: float
    evaluations: int
    seconds: float

    def json(self) -> dict[str, object]:
        """Plain data."""
        return {
            "vector": self.vector.tolist(),
            "error": self.error,
            "evaluations": self.evaluations,
            "seconds": self.seconds,
        }


def optimise(
    objective: Objective,
    box: Box,
    start: Array,
    optimiser: str,
    iterations: int | None = None,
) -> End:
    """One search from one start.

    Parameters
    ----------
    objective
        What is minimised; its count of evaluations starts anew.
    box
        Bounds; its start gives the scales.
    start
        Where to begin, shape (p,), within the bounds.
    optimiser
        One of `OPTIMISERS`.
    iterations
        At most; default 400, least squares 100.
    """
    objective.evaluations = 0
    most = iterations or _ITERATIONS[optimiser]
    scale = np.ones(start.size) if optimiser == "sqp" else np.abs(box.start)
    begin = time.process_time()
    lower, upper = box.lower / scale, box.upper / scale
    # a parameter whose bounds are equal is held
    free = upper > lower
    whole = np.clip(start, box.lower, box.upper) / scale

    def full(part: Array) -> Array:
        vector = whole.copy()
        vector[free] = np.clip(part, lower[free], upper[free])
        return vector * scale

    if optimiser == "least_squares":
        inside = np.clip(whole, lower + 1e-10 * (upper - lower), upper - 1e-10 * (upper - lower))[
            free
        ]
        found = least_squares(
            lambda part: objective.residual(full(part)),
            inside,
            bounds=(lower[free], upper[free]),
            x_scale="jac",
            xtol=1e-7,
            ftol=1e-7,
            gtol=1e-7,
            max_nfev=most,
        ).x
    else:
        with warnings.catch_warnings():
            # steps a rounding error beyond a bound are clipped, and SciPy says so
            warnings.simplefilter("ignore", RuntimeWarning)
            found = minimize(
                lambda part: objective.error(full(part)),
                whole[free],
                method="SLSQP",
                jac="2-point",
                bounds=list(zip(lower[free], upper[free], strict=True)),
                options={"maxiter": most, "ftol": 1e-8},
            ).x
    vector = full(found)
    spent, seconds = objective.evaluations, time.process_time() - begin
    return End(vector, objective.error(vector), spent, seconds)


def random_starts(box: Box, count: int, seed: int) -> Array:
    """Starts (count, p) spread evenly over the logarithms between the bounds."""
    low = np.log(np.maximum(box.lower, _SMALLEST * box.upper))
    high = np.log(box.upper)
    share = np.random.default_rng(seed).random((count, low.size))
    return np.exp(low + share * (high - low))
