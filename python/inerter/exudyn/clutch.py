"""What slips in series with the inertance of the element: a clutch, a leak.

    S(u) = (F_c + c_l |u| + q_l u^2) sign(u), held within -F_c(-) <= F_s <= F_c(+)
    F_s = phi + c_s (s' - u)

Symbols: u [m/s] velocity of the slip, phi [N] force of the spring before it, s' [m/s] rate of the
whole deflection. `clutch_force` F_c grows by `clutch_asymmetry` in tension and falls in
compression. Sign: tension positive.
"""

from __future__ import annotations

from typing import NamedTuple

from inerter.exudyn.functions import Functions, Value
from inerter.exudyn.parameters import Parameters


class Clutch(NamedTuple):
    """Force through the element [N], velocity of the slip [m/s]."""

    force: Value
    rate: Value


def is_there(p: Parameters) -> bool:
    """Whether something slips."""
    return bool(p.clutch_force or p.leak_damping or p.leak_quadratic_damping)


def at(f: Functions, p: Parameters, spring: Value, rate: Value) -> Clutch:
    """What it does where the spring bears a force [N] and the deflection has a rate [m/s]."""
    upper = p.clutch_force * (1.0 + p.clutch_asymmetry)
    lower = -p.clutch_force * (1.0 - p.clutch_asymmetry)
    if not (p.series_stiffness or p.series_damping):
        return Clutch((p.leak_damping + p.leak_quadratic_damping * f.abs(rate)) * rate, rate)
    held = spring + p.series_damping * rate
    beyond = held - f.least(upper, f.greatest(lower, held))
    slope = p.series_damping + p.leak_damping
    if p.leak_quadratic_damping:
        # the root of slope u + q u |u| = beyond that loses no digits; q keeps it from 0 / 0
        root = f.sqrt(slope * slope + 4.0 * p.leak_quadratic_damping * f.abs(beyond))
        slip = 2.0 * beyond / (slope + root + _TINY)
    else:
        slip = beyond / slope
    return Clutch(held - p.series_damping * slip, slip)


# [N s/m], below any slope that counts
_TINY = 1e-150
