"""The friction laws of the element: force and rate of the state.

Every law is a function (f, p, x, v, z) -> Friction of the functions f, the device's parameters p,
displacement x [m], velocity v [m/s] and state z. Equations and sources are those of the friction
laws in `plugin_c/core`; here they are written anew, so that agreement means something.

    force = bound + damping * rate      z' = rate

`rate` is None for a law without state, and a tuple for one with several. The form lets an
expression for the rate be evaluated once for both. Sign: tension positive.

Free play before a bristle: its state s is place in the play and deflection z in one, z = s less s
limited to +-eps (`friction_backlash`). Within the play s' = v and the bristle's force is 0; beyond
it a damper never pulls. At the edge the force of LuGre's damper jumps; `smooth_play` makes a corner
of the jump: the damper bears at most `EAGER` times what the bristle's spring does.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from inerter.exudyn import stroke
from inerter.exudyn.functions import Functions, Value
from inerter.exudyn.parameters import Parameters


class Friction(NamedTuple):
    """Force `bound + damping * rate` [N], and the state's rate if there is a state."""

    bound: Value
    damping: float = 0.0
    rate: Any = None


LEAST_LEVEL = 1e-3
"""The level along the stroke does not fall below this share."""


EAGER = 10.0
"""With smooth play a damper bears at most this many times the spring's force."""


def bristle(f: Functions, p: Parameters, s: Value) -> Value:
    """Deflection of the bristle [m]."""
    eps = p.friction_backlash
    return s - f.least(eps, f.greatest(-eps, s)) if eps else s


def _engaged(f: Functions, p: Parameters, v: Value, s: Value) -> Value:
    """1 where the bristle moves with the terminals, 0 in the play."""
    eps, place = p.friction_backlash, f.abs(s)
    at_edge = f.choose(place < eps, 0.0, 1.0)
    return f.choose(s * v > 0.0, at_edge, f.choose(place > eps, 1.0, 0.0))


def _behind_play(f: Functions, p: Parameters, v: Value, s: Value, law: Friction) -> Friction:
    """A law that was worked out at the bristle's deflection, behind its free play."""
    if not p.friction_backlash:
        return law
    engaged = _engaged(f, p, v, s)
    rate = engaged * law.rate + (1.0 - engaged) * v
    if not law.damping:
        return Friction(law.bound, 0.0, rate)
    spring, damper = law.bound, engaged * law.damping * law.rate
    side = f.sign(s)
    pressing, most = side * spring, side * damper
    if p.smooth_play:
        most = f.least(most, EAGER * pressing)
    return Friction(side * f.greatest(0.0, pressing + most), 0.0, rate)


def level(f: Functions, p: Parameters, x: Value, v: Value) -> Value:
    """Factor on the friction level: direction times position along the stroke."""
    if curved(p):
        return _curved_level(f, p, x, v)
    factor = 1.0
    if p.friction_asymmetry:
        factor = 1.0 + p.friction_asymmetry * f.tanh(v / p.transition_velocity)
    if p.friction_gradient or p.friction_curvature:
        along = 1.0 + (p.friction_gradient + p.friction_curvature * x) * x
        factor = f.greatest(LEAST_LEVEL, along) * factor
    return factor


def curved(p: Parameters) -> bool:
    """Whether the level has a curve or periods (`stroke.py`)."""
    return stroke.there(p, "friction") or stroke.there(p, "friction_back")


def varies(p: Parameters) -> bool:
    """Whether the level is not the same at every place and in both directions."""
    return curved(p) or any((p.friction_asymmetry, p.friction_gradient, p.friction_curvature))


def _curved_level(f: Functions, p: Parameters, x: Value, v: Value) -> Value:
    """The same with curves; that of v < 0 passes into that of v > 0 as sign(v) does."""
    rise = 1.0 + (p.friction_gradient + p.friction_curvature * x) * x
    forth = f.greatest(LEAST_LEVEL, rise + stroke.value(f, p, "friction", x))
    side = f.tanh(v / p.transition_velocity)
    if not stroke.there(p, "friction_back"):
        return forth * (1.0 + p.friction_asymmetry * side)
    back = f.greatest(LEAST_LEVEL, rise + stroke.value(f, p, "friction_back", x))
    return 0.5 * (forth + back) + 0.5 * (forth - back) * side


def stribeck_curve(f: Functions, p: Parameters, v: Value) -> Value:
    """f_c + (f_s - f_c) exp(-(|v| / v_s)^delta) [N]."""
    excess = p.static_force - p.coulomb_force
    if excess == 0.0:
        return p.coulomb_force
    ratio = v / p.stribeck_velocity
    if p.stribeck_exponent == 2.0:
        decay = -(ratio * ratio)
    else:
        decay = -f.power(f.abs(ratio), p.stribeck_exponent)
    return p.coulomb_force + excess * f.exp(decay)


def sign_width(p: Parameters) -> float:
    """Width [m/s] of sign(v) = tanh(v / width) in a law without states."""
    return p.stribeck_velocity / 4.0 if p.friction == "brown_mcphee" else p.transition_velocity


def none(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """No friction."""
    return Friction(0.0)


def coulomb(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """f_c level tanh(v / v_t)."""
    return Friction(p.coulomb_force * level(f, p, x, v) * f.tanh(v / p.transition_velocity))


def stribeck(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """The Stribeck curve, without memory."""
    size = stribeck_curve(f, p, v) * level(f, p, x, v)
    return Friction(size * f.tanh(v / p.transition_velocity))


def dahl(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """Z' = v sgn(u) |u|^n, u = 1 - sigma0 z sgn(v) / (f_c level); F = sigma0 z."""
    limit = (p.coulomb_force * level(f, p, x, v) + p.load_level) / p.bristle_stiffness
    s, z = z, bristle(f, p, z)
    if p.dahl_exponent == 1.0:
        rate = v - f.abs(v) * z / limit
    else:
        share = 1.0 - z * f.sign(v) / limit
        rate = v * f.sign(share) * f.power(f.abs(share), p.dahl_exponent)
    return _behind_play(f, p, v, s, Friction(p.bristle_stiffness * z, 0.0, rate))


def lugre(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """Z' = v - sigma0 |v| z / g(v); F = sigma0 z + sigma1 z'."""
    sliding = stribeck_curve(f, p, v) * level(f, p, x, v) + p.load_level
    s, z = z, bristle(f, p, z)
    rate = v - p.bristle_stiffness * f.abs(v) * z / sliding
    law = Friction(p.bristle_stiffness * z, p.bristle_damping, rate)
    return _behind_play(f, p, v, s, law)


def loaded_by(p: Parameters) -> bool:
    """Whether a load adds to the level of a bristle."""
    return not isinstance(p.load_level, float) or p.load_level != 0.0


def yield_force(p: Parameters) -> float:
    """Force at which bouc_wen or maxwell_slip yields [N]."""
    if p.friction == "maxwell_slip":
        return sum(slip for _, slip in elements(p))
    bound = (p.bw_alpha / (p.bw_beta + p.bw_gamma)) ** (1.0 / p.bw_exponent)
    return abs(1.0 - p.bw_ratio) * p.bw_stiffness * bound


def bouc_wen(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """Z' = alpha v - (beta |v| z + gamma v |z|) |z|^(n-1); F = A k0 x + (1 - A) k0 z.

    Along the stroke and under a load, beta and gamma over level^n; beyond its level z comes back no
    slower than from there.
    """
    s, z = z, bristle(f, p, z)
    narrowing = p.bw_beta * f.abs(v) * z + p.bw_gamma * v * f.abs(z)
    if p.bw_exponent != 1.0:
        narrowing = narrowing * f.power(f.abs(z), p.bw_exponent - 1.0)
    if curved(p) or loaded_by(p):
        height = level(f, p, x, v) if curved(p) else 1.0
        if loaded_by(p):
            height = height + p.load_level / yield_force(p)
        narrowing = narrowing / f.power(height, p.bw_exponent)
    if p.bw_gamma > p.bw_beta > -p.bw_gamma:
        most = p.bw_alpha * (p.bw_gamma - p.bw_beta) / (p.bw_gamma + p.bw_beta) * f.abs(v)
        returning = f.greatest(-most, f.least(most, narrowing))
        narrowing = f.choose(v * z < 0.0, returning, narrowing)
    elastic, yielding = p.bw_ratio * p.bw_stiffness, (1.0 - p.bw_ratio) * p.bw_stiffness
    law = Friction(elastic * x + yielding * z, 0.0, p.bw_alpha * v - narrowing)
    return _behind_play(f, p, v, s, law)


def brown_mcphee(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """f_d tanh(4 v / v_s) + (f_s - f_d) (v / v_s) / ((v / v_s)^2 / 4 + 3/4)^2, odd in v."""
    ratio = v / p.stribeck_velocity
    well = 0.25 * ratio * ratio + 0.75
    peak = (p.static_force - p.coulomb_force) * ratio / (well * well)
    return Friction((p.coulomb_force * f.tanh(4.0 * ratio) + peak) * level(f, p, x, v))


REACHED = 1e-12
"""Share of its limit within which an element of maxwell_slip counts as being there."""


KNEE = 1e-3
"""Share of its limit over which it begins to slip, where limits may rise, and with solvers that
iterate: an element is held at a limit that rises, between the two rates, and without a knee an
iteration finds nothing there, or jumps between the two."""


def elements(p: Parameters) -> list[tuple[float, float]]:
    """Stiffness [N/m] and slip force [N] of each element of maxwell_slip."""
    pairs = ((f"slip_stiffness_{i}", f"slip_force_{i}") for i in range(1, 9))
    found = [(getattr(p, spring), getattr(p, slip)) for spring, slip in pairs]
    return [pair for pair in found if pair[0]]


def maxwell_slip(f: Functions, p: Parameters, x: Value, v: Value, z: Any) -> Friction:
    """Z_i' = v while it sticks, v u_i where u_i = 1 - k_i z_i sgn(v) / (f_i level) is not above 0.

    F = sum of k_i z_i.
    """
    factor, side = level(f, p, x, v), f.sign(v)
    rises = p.soft_slip or varies(p) or loaded_by(p)
    if loaded_by(p):
        factor = factor + p.load_level / yield_force(p)
    total: Value = 0.0
    rates = []
    for (spring, slip), each in zip(elements(p), z, strict=True):
        u = 1.0 - spring * each * side / (slip * factor)
        if rises:
            rates.append(v * f.choose(u < 0.0, u, f.least(1.0, u / KNEE)))
        else:
            rates.append(v * f.choose(u > REACHED, 1.0, u))
        total = total + spring * each
    return Friction(total, 0.0, tuple(rates))


YOUNGEST = -300.0
"""Least logarithm of an age, so that its rate is a number."""


def rate_state(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """Z' = (v0 exp(-z) - |v|) / L; F = f_c level (1 + A ln(V / v0) + B z) tanh(v / v_t).

    V^2 = v^2 + v_t^2; at least 0.001 is left of the bracket.
    """
    aging = 0.0 if p.still else p.rate_velocity * f.exp(-f.greatest(YOUNGEST, z))
    rate = (aging - f.abs(v)) / p.age_distance
    size = p.coulomb_force * level(f, p, x, v) * bracket(f, p, v, z)
    return Friction(size * f.tanh(v / p.transition_velocity), 0.0, rate)


def bracket(f: Functions, p: Parameters, v: Value, z: Value) -> Value:
    """1 + A ln(V / v0) + B z of rate_state, at least 0.001."""
    width = p.transition_velocity
    speed = 0.5 * f.log((v * v + width * width) / (p.rate_velocity * p.rate_velocity))
    return f.greatest(LEAST_LEVEL, 1.0 + p.rate_effect * speed + p.age_effect * z)


_ALL = (none, coulomb, stribeck, dahl, lugre, bouc_wen, brown_mcphee, maxwell_slip, rate_state)
LAWS = {law.__name__: law for law in _ALL}
"""The laws by their names."""


def stored_energy(f: Functions, p: Parameters, x: Value, z: Any) -> Value:
    """Energy in the bristle, the elements or the elastic branch [J]."""
    if p.friction == "maxwell_slip":
        return sum(
            0.5 * spring * each * each for (spring, _), each in zip(elements(p), z, strict=True)
        )
    z = bristle(f, p, z)
    if p.friction in ("dahl", "lugre"):
        return 0.5 * p.bristle_stiffness * z * z
    if p.friction == "bouc_wen":
        elastic = p.bw_ratio * x * x
        return 0.5 * p.bw_stiffness * (elastic + (1.0 - p.bw_ratio) * z * z / p.bw_alpha)
    return 0.0


def stored_power(f: Functions, p: Parameters, x: Value, v: Value, z: Any, rate: Any) -> Value:
    """Rate of the stored energy [W]; `rate` that of an engaged bristle."""
    if p.friction == "maxwell_slip":
        total: Value = 0.0
        for (spring, _), each, changing in zip(elements(p), z, rate, strict=True):
            total = total + spring * each * changing
        return total
    z = bristle(f, p, z)
    if p.friction in ("dahl", "lugre"):
        return p.bristle_stiffness * z * rate
    if p.friction == "bouc_wen":
        elastic = p.bw_ratio * x * v
        return p.bw_stiffness * (elastic + (1.0 - p.bw_ratio) * z * rate / p.bw_alpha)
    return 0.0
