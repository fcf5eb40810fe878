"""What is known of a gas whose values are not known one by one: its stiffness.

A short part of a gas's curve is a spring and a little more: pressure, volume and exponent go
together along it.
"""

from __future__ import annotations

import numpy as np

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.result import Finding, ParameterValue
from inerter.diagnose.wording import quantity
from inerter.identify.fit import Fit
from inerter.motion_units import Kind, unit

_REACHES = ("gas_reach", "gas_reach_above")


def with_stiffness_of_gas(finding: Finding, fit: Fit, motion: Kind) -> Finding:
    """A finding; one of a gas with a value that is as large as its error says what is known."""
    if finding.effect != EFFECTS["gas_spring"].name:
        return finding
    values = finding.parameters.values()
    known = stiffness_of_gas(fit)
    if known is None or all(each.stderr < abs(each.value) for each in values):
        return finding
    stiffness, error = known
    if not error < 0.5 * stiffness:
        return finding
    spring = quantity(ParameterValue(stiffness, error, unit(motion, "N/m")))
    return finding.remarked(
        "Its values are not known one by one; where the displacement is 0 it is a spring of "
        f"{spring}."
    )


def stiffness_of_gas(fit: Fit) -> tuple[float, float] | None:
    """Stiffness gamma p0 A^2 / V0 [N/m] of a fit with its standard error; None without a gas."""
    values, free = fit.model.values, fit.model.free
    reach = next((name for name in _REACHES if name in free), None)
    if reach is None or "gas_push" not in free:
        return None
    stiffness = values["gas_push"] * values["gas_exponent"] / values[reach]
    gradient = np.zeros(len(free))
    for name, sign in (("gas_push", 1.0), ("gas_exponent", 1.0), (reach, -1.0)):
        if name in free:
            gradient[free.index(name)] = sign * stiffness / values[name]
    return stiffness, float(np.sqrt(max(gradient @ fit.covariance @ gradient, 0.0)))
