"""A spring in series with the dampers of the element.

    F = D(w)      w' = k_d (v - w) / D'(w)      stored D^2 / (2 k_d)      heat D w

w [m/s] velocity over the dampers, D their force [N] (`beside.py`), k_d `damper_stiffness` [N/m].
Sign: tension positive.
"""

from __future__ import annotations

from collections.abc import Sequence

from inerter.exudyn import beside
from inerter.exudyn.functions import Functions, Value
from inerter.exudyn.parameters import Parameters


def is_there(p: Parameters) -> bool:
    """Whether the dampers have a spring before them."""
    return bool(p.damper_stiffness)


def place(p: Parameters) -> int:
    """Where w stands among the states."""
    return p.state_names.index("damper_velocity")


def force(f: Functions, p: Parameters, z: Sequence[Value]) -> Value:
    """F [N]."""
    damper = beside.damper(f, p, 0.0, z[place(p)])
    return 0.0 if damper is None else damper


def rate(f: Functions, p: Parameters, v: Value, z: Sequence[Value]) -> Value:
    """W' [m/s^2]."""
    own = z[place(p)]
    return p.damper_stiffness * (v - own) / beside.damper_slope(f, p, own)


def stored_energy(f: Functions, p: Parameters, z: Sequence[Value]) -> Value:
    """Energy in the spring [J]."""
    bent = force(f, p, z)
    return 0.5 / p.damper_stiffness * bent * bent


def dissipated_power(f: Functions, p: Parameters, z: Sequence[Value]) -> Value:
    """Heat in the dampers [W]."""
    return force(f, p, z) * z[place(p)]
