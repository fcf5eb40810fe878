"""How the inertance changes with each input, against what the paper reads from its Figs. 13 to 17.

All at the same frequency and amplitude of motion, each input 10 % up and down.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.design.ball_screw.inputs import check_geometry
from inerter.design.ball_screw.losses import Losses
from inerter.design.inputs import DesignError, Values

# figure of the paper; does the inertance rise, does its dependence on frequency grow, when the
# input grows?
PAPER_TRENDS: dict[str, tuple[str, bool, bool]] = {
    "lead": ("Fig. 13", False, False),
    "nominal_radius": ("Fig. 14", False, True),
    "ball_radius": ("Fig. 15", True, False),
    "ball_number": ("Fig. 16", False, True),
    "contact_angle": ("Fig. 17", False, True),
}
STEP = 0.1


@dataclass(frozen=True)
class Trend:
    """Inertance over frequency at a smaller, the given and a larger value of one input.

    `values` (3,), `curves` (3, n) [kg]; NaN where a screw with that value cannot be.
    """

    name: str
    values: tuple[float, ...]
    curves: NDArray[np.float64]

    def row(self) -> dict[str, Any]:
        """What a larger value does here, and what the paper says.

        `change` of the inertance at the highest frequency, relative; `rises`: that it is positive;
        `bends_more`: the inertance at the lowest frequency lags farther behind, in kg.
        """
        figure, rises, grows = PAPER_TRENDS[self.name]
        low, high = self.curves[0], self.curves[-1]
        change = float(high[-1] / low[-1] - 1.0)
        drop = [float(curve[-1] - curve[0]) for curve in (low, high)]  # kg, as the figures show
        here_rises = None if math.isnan(change) else change > 0.0
        here_grows = None if any(map(math.isnan, drop)) else drop[1] > drop[0]
        return {
            "larger": self.name,
            "figure": figure,
            "change": None if math.isnan(change) else change,
            "rises": here_rises,
            "paper_rises": rises,
            "bends_more": here_grows,
            "paper_bends_more": grows,
            "agrees": here_rises == rises and here_grows == grows,
        }


def over_frequency(
    losses: Losses, frequency: Sequence[float] | NDArray[np.float64]
) -> NDArray[np.float64]:
    """b_n (n,) [kg] for a motion of the given amplitude at frequencies [Hz], driven by F = b a."""
    a = (2.0 * math.pi * np.asarray(frequency)) ** 2 * losses.values.number("amplitude")
    return losses.inertance * losses.efficiency(losses.inertance * a)


def trend(values: Values, name: str, frequency: NDArray[np.float64]) -> Trend:
    """One input varied by 10 %, whole numbers by at least 1."""
    middle = values.number(name)
    step = max(1, round(STEP * middle)) if name == "ball_number" else STEP * middle
    tried = (middle - step, middle, middle + step)
    curves = []
    for value in tried:
        try:
            if value <= 0 or (name == "contact_angle" and value >= math.pi / 2):
                raise DesignError(f"{name} is {value:g}: out of range")
            changed = values.replace(**{name: value})
            check_geometry(changed)
            curves.append(over_frequency(Losses(changed), frequency))
        except DesignError:
            curves.append(np.full(len(frequency), math.nan))
    return Trend(name, tried, np.array(curves))
