"""Whether a friction level that is found may go with the speed.

Rate-and-state friction holds F (1 + a ln(v / v0) + b ln(v0 theta / L)): it rises at once with the
speed and falls as contacts are renewed along the way L. At a steady speed theta is L / v, and the
level changes by a - b for each factor of e in the speed. Noise where the motion turns hides a and b
alone, which make up for each other; their difference a record tells far better. Where that may be
so much that it matters, Coulomb friction is one of two members of its finding.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from inerter.catalogue.friction import FRICTION
from inerter.diagnose import wording
from inerter.diagnose.candidates import law_starts
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.result import Finding, ParameterValue
from inerter.diagnose.search import Search
from inerter.identify.fit import Fit, parameter_errors, rms
from inerter.parallel_steps import parallel

# what a friction level changes by per e-fold of the speed where that is next to nothing
_SLIGHT = 1e-3


def with_rate_of_level(
    finding: Finding,
    search: Search,
    fit: Fit,
    covered: Callable[[Fit], Fit] = lambda found: found,
) -> Finding:
    """A friction level that is found, and whether it may go with the logarithm of the speed.

    It may where rate-and-state friction does as well, and such as matters is within its error.
    """
    model, masks = fit.model, search.problem.masks
    if finding.effect != "coulomb_friction" or finding.members or model.friction != "coulomb":
        return finding
    starts = law_starts(FRICTION["rate_state"], model, search.problem.scales)
    # as far as it goes, and from next to none of it on
    starts += tuple(start.holding(rate_effect=_SLIGHT, age_effect=_SLIGHT) for start in starts)
    fits = parallel(search.problem.fit, [start for start in starts if search.may_be(start)])
    best = min(fits, key=lambda each: each.rmse(masks), default=None)
    # the fit may be to more than was searched
    limit = (1 + CRITERIA.tolerated_loss) * rms(search.problem.residual(model), masks)
    if best is None or best.rmse(masks) > limit:
        return finding
    best = covered(best)
    change, spread = steady_change(best)
    if abs(change) + 2 * spread < CRITERIA.rate_that_matters:
        return finding
    known = parameter_errors(best)
    level, moved = finding.parameters["coulomb_force"], known["coulomb_force"][0]
    wide = replace(level, stderr=max(level.stderr, abs(moved - level.value)))
    parameters = {**finding.parameters, "coulomb_force": wide}
    for name in ("rate_effect", "age_effect"):
        value, error = known[name]
        parameters[name] = ParameterValue(value, max(error, abs(value) / CRITERIA.distinction), "")
    members = (finding.effect, "rate_state_friction")
    rivals = [rival for rival in finding.rivals if rival.effect not in members]
    told = replace(finding, members=members, parameters=parameters, rivals=rivals)
    most = 100 * (abs(change) + 2 * spread)
    return replace(
        told,
        evidence=f"{wording.evidence(told)} At steady speeds the level may change by up to "
        f"{most:.2g} % for each factor of e in the speed.",
    )


def steady_change(fit: Fit) -> tuple[float, float]:
    """Share by which a level changes per e-fold of a steady speed, and its standard error."""
    free, values = fit.model.free, fit.model.values
    sides = np.array([(name == "rate_effect") - float(name == "age_effect") for name in free])
    variance = float(sides @ fit.covariance @ sides)
    return values["rate_effect"] - values["age_effect"], float(np.sqrt(max(variance, 0.0)))
