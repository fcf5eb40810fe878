"""What the extended model leaves of the held-out records: is it noise?"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.result import Unexplained
from inerter.diagnose.vehicle.problem import DrivenProblem
from inerter.diagnose.vehicle.search import BURSTS

Array = NDArray[np.float64]
# structure of less than this share of the channels' spread does not matter to anyone
_LEAST = 0.01
# samples a few apart that go together more surely than this are not noise alone
_CORRELATED = 5.0
_LAGS = 5


def remainder(
    residual: Array, problem: DrivenProblem, floor: float, step_error: float
) -> Unexplained:
    """Describe a stacked held-out residual.

    floor: white noise in it, and step_error: what the model's step does, both as
    `DrivenProblem.error`.
    """
    table = residual.reshape(-1, len(problem.channels))[np.concatenate(problem.masks)]
    rms = problem.error(residual)
    found = [(structure(table[:, i]), channel.name) for i, channel in enumerate(problem.channels)]
    found = sorted((pair for pair in found if pair[0] > _LEAST), reverse=True)
    left = np.sqrt(np.mean([size**2 for size, _ in found])) if found else 0.0
    fraction = min(max(1 - floor**2 / rms**2, left**2 / rms**2, 0.0), 1.0) if rms else 0.0
    if left <= _LEAST:
        return Unexplained(
            significant=False,
            fraction=fraction,
            depends_on=[],
            summary="What remains is noise as far as can be seen.",
        )
    if left <= 2 * step_error:
        text = (
            f"What remains, {100 * rms:.2g} % of the spread, can be the model's own timestep, "
            f"which makes an error of {100 * step_error:.2g} %: shorten it to see more."
        )
        return Unexplained(significant=False, fraction=fraction, depends_on=[], summary=text)
    names = [name for _, name in found]
    text = (
        f"What remains is not noise alone: {100 * left:.2g} % of the spread, most in "
        f"{names[0].replace('_', ' ')}, that no effect tried explains."
    )
    return Unexplained(
        significant=True, fraction=fraction, depends_on=names, summary=text, structure=float(left)
    )


def structure(column: Array) -> float:
    """Rms of what in a residual is no white noise: what goes together, or comes in bursts."""
    power = float(np.mean(column**2))
    if not power:
        return 0.0
    pairs = [float(np.mean(column[k:] * column[:-k])) / power for k in range(1, _LAGS + 1)]
    together = max(abs(pair) for pair in pairs)
    if together * np.sqrt(column.size) < _CORRELATED:
        together = 0.0
    if float(np.mean(column**4)) / power**2 - 3 > BURSTS:
        together = 1.0
    return float(np.sqrt(together * power))
