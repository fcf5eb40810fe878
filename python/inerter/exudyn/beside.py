"""What acts straight between the terminals: springs, dampers, a constant force, end stops.

    T = s (c D(v) + c2 v |v|) + k x + k3 x^3 + F_0 + stops + f(x) + F_map(x, v),  c = c_0 + c_x(x)
    D(v) = r v + (1 - r) v / sqrt(1 + (v / v_k)^2), v without a knee;  s = 1 + kappa sign(v)

f and c_x, force and damping of the place: `stroke.py`; F_map: `force_map.py`.

Sign: tension positive. A stop at x_e pushes back with (k_e delta + k_e3 delta^3) (1 + e delta'),
delta its compression, and never pulls (Hunt and Crossley 1975, exponents 1 and 3).
"""

from __future__ import annotations

import math

from inerter.exudyn import force_map, stroke
from inerter.exudyn.functions import Functions, Value
from inerter.exudyn.parameters import Parameters


def force(f: Functions, p: Parameters, x: Value, v: Value) -> Value:
    """The sum of all of them [N]."""
    total = p.force_offset
    # a value on a tape is no number that could be 0
    # behind a spring dampers are in damper_spring.py
    if not p.damper_stiffness and (drag := damper(f, p, x, v)) is not None:
        total = total + drag
    if p.stiffness != 0.0:
        total = total + p.stiffness * x
    if p.stiffness_cubic:
        total = total + p.stiffness_cubic * x * x * x
    if stroke.there(p, "force"):
        total = total + stroke.value(f, p, "force", x)
    if p.force_map:
        total = total + force_map.force(f, p, x, v)
    for direction, place in _stops(p):
        depth = f.greatest(0.0, direction * (x - place))
        approach = f.greatest(0.0, 1.0 + p.stop_damping * direction * v)
        total = total + direction * _elastic(p, depth) * approach
    return total


def _bent(f: Functions, p: Parameters, v: Value, knee: float, beyond: float) -> Value:
    """Velocity [m/s] that viscous damping is in proportion to."""
    if knee == 0.0:
        return v
    ratio, n, lost = v / knee, p.damping_sharpness, 1.0 - p.damping_exponent
    if n == 2.0 and lost == 1.0:
        return v * (beyond + (1.0 - beyond) / f.sqrt(1.0 + ratio * ratio))
    speed = f.abs(ratio)
    slow, fast = f.least(speed, 1.0), f.greatest(speed, 1.0)
    below = f.power(1.0 + f.power(slow, n), -lost / n)
    above = f.power(1.0 + f.power(fast, -n), -lost / n) * f.power(fast, -lost)
    return v * (beyond + (1.0 - beyond) * f.choose(speed < 1.0, below, above))


def _bent_slope(f: Functions, p: Parameters, v: Value, knee: float, beyond: float) -> Value:
    """Slope [-] of that over the velocity."""
    if knee == 0.0:
        return 1.0
    n, lost = p.damping_sharpness, 1.0 - p.damping_exponent
    speed = f.abs(v / knee)
    slow, fast = f.least(speed, 1.0), f.greatest(speed, 1.0)
    low, high = f.power(slow, n), f.power(fast, -n)
    below = f.power(1.0 + low, -lost / n - 1.0) * (1.0 + p.damping_exponent * low)
    above = f.power(1.0 + high, -lost / n - 1.0) * (high + p.damping_exponent)
    above = above * f.power(fast, -lost)
    return beyond + (1.0 - beyond) * f.choose(speed < 1.0, below, above)


def _bends(p: Parameters) -> list[tuple[float, float]]:
    """Knee [m/s] and slope beyond it, forth and back."""
    return [
        (getattr(p, f"damping_knee{side}"), getattr(p, f"damping_beyond{side}"))
        for side in ("", "_back")
    ]


def damper_slope(f: Functions, p: Parameters, v: Value) -> Value:
    """Slope of the dampers' force over the velocity [N s/m]."""
    forth, back = _bends(p)
    bent = _bent_slope(f, p, v, *forth)
    if back != forth:
        bent = f.choose(v < 0.0, _bent_slope(f, p, v, *back), bent)
    slope = p.viscous * bent
    if p.quadratic_damping != 0.0:
        slope = slope + 2.0 * p.quadratic_damping * f.abs(v)
    if p.damping_asymmetry == 0.0:
        return slope
    side = f.choose(v < 0.0, 1.0 - p.damping_asymmetry, 1.0 + p.damping_asymmetry)
    return slope * side


def damper(f: Functions, p: Parameters, x: Value, v: Value) -> Value | None:
    """Force of the dampers [N], None without any."""
    forth, back = _bends(p)
    total, bent = None, _bent(f, p, v, *forth)
    if back != forth:
        bent = f.choose(v < 0.0, _bent(f, p, v, *back), bent)
    if p.viscous != 0.0:
        total = p.viscous * bent
    if stroke.there(p, "viscous"):
        along = stroke.value(f, p, "viscous", x) * bent
        total = along if total is None else total + along
    if p.quadratic_damping != 0.0:
        turbulent = p.quadratic_damping * f.abs(v) * v
        total = turbulent if total is None else total + turbulent
    if total is None or p.damping_asymmetry == 0.0:
        return total
    return total + p.damping_asymmetry * f.abs(total)


def stored_energy(f: Functions, p: Parameters, x: Value) -> Value:
    """Energy in springs and stops [J]."""
    square = x * x
    energy = 0.5 * p.stiffness * square + 0.25 * p.stiffness_cubic * square * square
    energy = energy + stroke.integral(f, p, "force", x)
    if p.force_map:
        energy = energy + force_map.stored_energy(f, p, x)
    for direction, place in _stops(p):
        depth = f.greatest(0.0, direction * (x - place))
        energy = energy + 0.5 * p.stop_stiffness * depth * depth
        if p.stop_stiffness_cubic:
            energy = energy + 0.25 * p.stop_stiffness_cubic * depth * depth * depth * depth
    return energy


def dissipated_power(f: Functions, p: Parameters, x: Value, v: Value) -> Value:
    """Heat in dampers and stops [W]."""
    drag = None if p.damper_stiffness else damper(f, p, x, v)
    heat = 0.0 if drag is None else drag * v
    if p.force_map:
        heat = heat + force_map.dissipated_power(f, p, x, v)
    for direction, place in _stops(p):
        depth = f.greatest(0.0, direction * (x - place))
        approach = direction * v
        share = f.greatest(0.0, 1.0 + p.stop_damping * approach) - 1.0
        heat = heat + _elastic(p, depth) * share * approach
    return heat


def _elastic(p: Parameters, depth: Value) -> Value:
    """Elastic force of a stop [N] at a depth [m]."""
    force = p.stop_stiffness * depth
    if p.stop_stiffness_cubic:
        force = force + p.stop_stiffness_cubic * depth * depth * depth
    return force


def _stops(p: Parameters) -> list[tuple[float, float]]:
    """Direction and place [m] of each stop."""
    if not p.stop_stiffness:
        return []
    both = ((1.0, p.stop_upper), (-1.0, p.stop_lower))
    return [(direction, place) for direction, place in both if not math.isnan(place)]
