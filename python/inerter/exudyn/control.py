"""A control that sets a parameter of the element: at once, or with a lag.

    p = rest + z within the bounds      z' = (command - rest - z) / T

p the parameter that `control` names, in its unit; rest its value as stated; z "control_change", the
last state; T `control_lag` [s]. Without lag p is the command, which is no expression: the element
is recorded anew when it changes. Energy: the laws hold at the value of the moment.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy

from inerter.exudyn.functions import Functions, Value
from inerter.exudyn.parameters import Parameters


def lags(p: Parameters) -> bool:
    """Whether the control has a state."""
    return p.control != "force" and p.control_lag > 0.0


def present(f: Functions, p: Parameters, z: Sequence[Value]) -> Parameters:
    """The parameters at the states z."""
    if not lags(p):
        return p
    now = copy(p)
    value = f.least(p.control_upper, f.greatest(p.control_lower, p.control_rest + z[-1]))
    setattr(now, p.control, value)
    if p.control == "coulomb_force" and p.static_follows:
        now.static_force = value
    return now


def rate(p: Parameters, z: Sequence[Value]) -> Value:
    """Rate of the control's state."""
    return 0.0 * z[-1] if p.still else (p.aim - p.control_rest - z[-1]) / p.control_lag
