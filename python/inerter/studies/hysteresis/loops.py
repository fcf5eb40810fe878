"""What a loop says whatever the model: quantities that no scaling of parameters changes.

Along x = X sin(w t) the settled force has a part in phase with x, a part in phase with v, and a
rest that is neither:

    F = b_eq a + c_eq v + rest,   a = -w^2 x

    inertance   b_eq, with b - k / w^2 for an inerter beside a spring k  [kg]
    damping     c_eq = work per cycle / (pi w X^2)                 [N s/m]
    work        dissipated per cycle, the loop's area              [J]
    rest        rms of the harmonics                               [N]
"""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.studies.hysteresis.virtual_tests import VirtualTest

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Loop:
    """A settled loop at `frequency` [Hz]; the others as above, `peak` of the force [N]."""

    frequency: float
    peak: float
    inertance: float
    damping: float
    work: float
    rest: float

    def json(self) -> dict[str, float]:
        """Plain data."""
        return asdict(self)


def loop(test: VirtualTest, force: Array) -> Loop:
    """The loop of a force (n,) [N] over the last whole second that counts of a test.

    Whole periods of a motion of 1, 2, 3 or 4 Hz fit into it.
    """
    last = np.flatnonzero(test.settled)[-round(1 / test.spacing) :]
    v, a, f = (values[last] for values in (test.velocity, test.acceleration, force))
    inertance = float(f @ a / (a @ a))
    damping = float(f @ v / (v @ v))
    rest = f - inertance * a - damping * v
    # of one cycle: mean power times the period
    work = float(np.mean(f * v)) / test.frequency
    return Loop(
        frequency=test.frequency,
        peak=float(np.max(np.abs(f))),
        inertance=inertance,
        damping=damping,
        work=work,
        rest=float(np.sqrt(np.mean(rest**2))),
    )
