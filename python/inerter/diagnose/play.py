"""Free play in the flywheel's drive, fitted to the force as measured.

Behind a play the flywheel is thrown from side to side. How hard and when it lands is in the force
far above the band of the motion, so the fit needs the force as measured; there it has many minima,
one for each way in which the impacts can be out of step. So it starts from many points about what
the band tells.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from scipy.stats import qmc

from inerter.diagnose.parallel import parallel
from inerter.identify.fit import Fit, Problem, rms
from inerter.identify.model import Model

# factors between which the starting points lie: in the band contacts look soft and plays small
RANGES: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "backlash": (0.8, 1.4),
        "series_frequency": (0.7, 2.5),
        "series_loss": (0.5, 2.0),
        "inertance": (0.97, 1.12),
    }
)
# starting points of a round are two to this power
_POWER = 8
# rounds at most; of those that do not take this share of the error away, so many end it
_ROUNDS = 8
_GAIN = 0.02
_PATIENCE = 2
# points that are followed, and how far
_FOLLOWED = 4
_EVALUATIONS = 20
_TOLERANCE = 1e-4


def fit_play(problem: Problem, model: Model) -> Fit:
    """The best of many fits about a model with free play, and again about that, while it gains.

    Parameters
    ----------
    problem
        Runs at the measured rate with the force as measured.
    model
        What the band told.
    """
    best, idle = _fit_about(problem, model, 0), 0
    for seed in range(1, _ROUNDS):
        fit = _fit_about(problem, best.model, seed)
        idle = 0 if fit.rmse(problem.masks) < (1 - _GAIN) * best.rmse(problem.masks) else idle + 1
        best = fit
        if idle == _PATIENCE:
            break
    return best


def _fit_about(problem: Problem, model: Model, seed: int) -> Fit:
    names = [name for name in RANGES if name in model.free]
    low, high = np.log([RANGES[name] for name in names]).T
    points = low + (high - low) * qmc.Sobol(len(names), rng=seed).random_base2(_POWER)
    points[0] = 0.0  # the model itself

    def moved(point: np.ndarray) -> Model:
        factors = dict(zip(names, np.exp(point), strict=True))
        values = {name: model.values[name] * float(factor) for name, factor in factors.items()}
        return replace(model, values={**model.values, **values})

    starts = [moved(point) for point in points]
    errors = parallel(lambda start: rms(problem.errors(start), problem.masks), starts)
    best = [starts[i] for i in np.argsort(errors)[:_FOLLOWED]]
    fits = parallel(lambda start: problem.fit(start, _EVALUATIONS, tolerance=_TOLERANCE), best)
    return min(fits, key=lambda fit: fit.rmse(problem.masks))
