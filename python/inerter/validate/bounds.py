"""How far off a run may be, from what its step can resolve. No number here is fitted to a result.

Integrators of high order (RK4, RK44, RK67, DOPRI5), smooth laws: 1e-6, in every quantity.

The same with a law that has corners (friction, stops, play): 1e-6 and twice the law's own
sensitivity to the step. That is how far the reference's own equations get off when they are taken
through classical Runge-Kutta steps of that size instead of being solved, contacts located; the
worst of steps that begin with the samples and steps that are shifted by half a step, because
where a corner falls within a step is chance. An engine has no part in this number: what exceeds
it is the engine's, not the step's. Twice, because other formulas of that order look at other
instants of the same step.

Integrators of low order (order p = 1, generalized-alpha 2): their error is large but must be that
of the step, so it has to shrink with it. With runs at two steps h and h/2, an error that falls at
least by 2^q is at most |y(h) - y(h/2)| / (2^q - 1) at h/2; q = p - 0.4 leaves room for steps that
are not small yet. An engine that converges to another motion keeps its error while the difference
goes to 0. With corners p is 1 at most, the sensitivity above is added, and to the force what the
law makes of a motion that is off by the bounds on displacement and velocity: where friction
reverses, a slightly wrong velocity is a very wrong force. Force and states of a contact have no
bound here: at an impact they jump, and whoever is late by a step is wrong by all of the jump.
Where the sign of load friction is that of an evaluation before (Exudyn's explicit solvers), a
sample just after a change of sign has mu |N| of the wrong sign: off by 2 mu |N|, and |N| is what N
changes in a step at most. How much of that a run shows is chance: halving the step does not tell.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from inerter.validate.case import SAMPLE, Case
from inerter.validate.run import QUANTITIES, ValidationRun, errors
from inerter.validate.truth import force_change, stepped

AGREEMENT = 1e-6
"""What engines of high order have to agree to on smooth laws."""
ROOM = 0.4
"""By how much an observed order may stay below the nominal one."""
PHASES = (0.0, 0.5)
LOADS = ("load_friction", "mu_forward", "mu_backward")
HIGH_ORDER = 4.0

Figures = Mapping[str, float | None]


def sensitivity(case: Case, step: float, true: ValidationRun) -> dict[str, float]:
    """The law's own sensitivity to a step [s], by quantity; 0 for smooth laws.

    `true` is the reference at the case's sample times.
    """
    worst = dict.fromkeys(QUANTITIES, 0.0)
    if case.kind == "smooth":
        return worst
    for phase in PHASES:
        for quantity, value in errors(stepped(case, step, phase), true).items():
            worst[quantity] = max(worst[quantity], value or 0.0)
    return worst


def bound(
    case: Case,
    order: float | None,
    own: Mapping[str, float],
    change: Figures,
    true: ValidationRun,
    late: float = 0.0,
) -> dict[str, float | None]:
    """Largest admissible error of each quantity; None where there is no bound.

    Parameters
    ----------
    case, true
        What ran, and the reference.
    order
        Nominal order of the integrator, None for adaptive steps.
    own
        From `sensitivity`.
    change
        Relative difference between the runs at h and h/2.
    late
        By how much the sign of load friction may be late [s].
    """
    found = {quantity: AGREEMENT + 2.0 * own[quantity] for quantity in QUANTITIES}
    if late and true.force.size:
        device, steepest = case.device() or {}, np.abs(np.diff(true.force, axis=0)).max() / SAMPLE
        mu = max(float(device.get(name, 0.0)) for name in LOADS)
        found["force"] += float(2.0 * mu * steepest * late / np.abs(true.force).max())
    if order is None or order >= HIGH_ORDER:
        return {**found}
    least = (order if case.kind == "smooth" else 1.0) - ROOM
    for quantity in QUANTITIES:
        found[quantity] += (change[quantity] or 0.0) / (2.0**least - 1.0)
    if case.kind == "contact":
        return {**found, "force": None, "state": None}
    if case.kind == "corner":
        found["force"] += force_change(case, true, found["displacement"], found["velocity"])
    return {**found}


def observed_order(coarse: float | None, fine: float | None, floor: float) -> float | None:
    """Order from the errors at h and h/2; None where the finer one is near the `floor`."""
    if coarse is None or fine is None or fine <= floor or coarse <= 0.0:
        return None
    return math.log2(coarse / fine)


def beyond(errors_found: Figures, bounds: Figures) -> list[str]:
    """The quantities whose errors are larger than their bounds, or not numbers."""
    found: list[str] = []
    for name, value in errors_found.items():
        limit = bounds[name]
        if value is not None and limit is not None and not value <= limit:
            found.append(name)
    return found


def is_within(
    case: Case, errors_found: Figures, bounds: Figures, order: tuple[float | None, ...]
) -> bool:
    """Whether every error is within its bound, and a smooth law shows the order.

    `order` is the observed and the nominal one, each None where there is none.
    """
    if beyond(errors_found, bounds):
        return False
    observed, nominal = order
    if case.kind != "smooth" or observed is None or nominal is None:
        return True
    return observed >= nominal - ROOM
