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

Ranges = Mapping[str, tuple[float, float]]

# factors between which the starting points lie: in the band contacts look soft and plays small
WIDE: Ranges = MappingProxyType(
    {
        "backlash": (0.8, 1.4),
        "series_frequency": (0.7, 2.5),
        "series_loss": (0.5, 2.0),
        "inertance": (0.97, 1.12),
    }
)
NARROW: Ranges = MappingProxyType(
    {
        "backlash": (0.95, 1.05),
        "series_frequency": (0.85, 1.2),
        "series_loss": (0.8, 1.25),
        "inertance": (0.98, 1.02),
    }
)
# starting points are two to this power
POWER = 8
NARROW_POWER = 6
# points that are followed, and how far
_FOLLOWED = 4
_EVALUATIONS = 20
_TOLERANCE = 1e-4


def fit_play(problem: Problem, model: Model, ranges: Ranges = WIDE, power: int = POWER) -> Fit:
    """The best of many fits about a model with free play.

    Parameters
    ----------
    problem
        Runs at the measured rate with the force as measured.
    model
        What the band told.
    ranges
        Factors of the coordinates between which the starting points lie.
    power
        Their number is two to this power.
    """
    names = [name for name in ranges if name in model.free]
    low, high = np.log([ranges[name] for name in names]).T
    points = low + (high - low) * qmc.Sobol(len(names), rng=0).random_base2(power)
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
