"""Viscoelastic branches of the element: a spring and a dashpot in series, between the terminals.

    F = sum of K e      e' = v - (K / C) e      stored K e^2 / 2      heat (K e)^2 / C

e [m] deflection of a branch's spring, K `branch_stiffness_i` [N/m], C `branch_damping_i` [N s/m].
Sign: tension positive.
"""

from __future__ import annotations

from collections.abc import Sequence

from inerter.exudyn.functions import Value
from inerter.exudyn.parameters import Parameters


def elements(p: Parameters) -> list[tuple[float, float]]:
    """Stiffness [N/m] and damping [N s/m] of each branch."""
    names = ((f"branch_stiffness_{i}", f"branch_damping_{i}") for i in (1, 2, 3))
    found = [(getattr(p, spring), getattr(p, dashpot)) for spring, dashpot in names]
    return [pair for pair in found if pair[0]]


def deflections(p: Parameters, z: Sequence[Value]) -> list[tuple[float, float, Value, int]]:
    """Stiffness, damping, deflection [m] and place among the states of each branch."""
    found = elements(p)
    after = sum(name in p.state_names for name in ("damper_velocity", "control_change"))
    first = p.nstate - len(found) - after
    return [(*pair, z[first + i], first + i) for i, pair in enumerate(found)]


def force(p: Parameters, z: Sequence[Value]) -> Value:
    """F [N]."""
    total: Value = 0.0
    for spring, _, e, _ in deflections(p, z):
        total = total + spring * e
    return total


def stored_energy(p: Parameters, z: Sequence[Value]) -> Value:
    """Energy in the springs [J]."""
    return sum(0.5 * spring * e * e for spring, _, e, _ in deflections(p, z))


def dissipated_power(p: Parameters, z: Sequence[Value]) -> Value:
    """Heat in the dashpots [W]."""
    heat: Value = 0.0
    for spring, dashpot, e, _ in deflections(p, z):
        heat = heat + spring * spring / dashpot * e * e
    return heat
