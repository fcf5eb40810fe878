"""The friction laws of the element: force and rate of the state.

Every law is a function (f, p, x, v, z) -> Friction of the functions f, the device's parameters p,
displacement x [m], velocity v [m/s] and state z. Equations and sources are those of the friction
laws in `plugin_c/core`; here they are written anew, so that agreement means something.

    force = bound + damping * rate      z' = rate

`rate` is None for a law without state. The form lets an expression for the rate be evaluated once
for both. Sign: tension positive.
"""

from __future__ import annotations

from typing import NamedTuple

from inerter.exudyn.functions import Functions, Value
from inerter.exudyn.parameters import Parameters


class Friction(NamedTuple):
    """Force `bound + damping * rate` [N], and the state's rate if there is a state."""

    bound: Value
    damping: float = 0.0
    rate: Value | None = None


LEAST_LEVEL = 1e-3
"""The level along the stroke does not fall below this share."""


def level(f: Functions, p: Parameters, x: Value, v: Value) -> Value:
    """Factor on the friction level: direction times position along the stroke."""
    factor = 1.0
    if p.friction_asymmetry:
        factor = 1.0 + p.friction_asymmetry * f.tanh(v / p.transition_velocity)
    if p.friction_gradient or p.friction_curvature:
        along = 1.0 + (p.friction_gradient + p.friction_curvature * x) * x
        factor = f.greatest(LEAST_LEVEL, along) * factor
    return factor


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
    limit = p.coulomb_force * level(f, p, x, v) / p.bristle_stiffness
    if p.dahl_exponent == 1.0:
        rate = v - f.abs(v) * z / limit
    else:
        share = 1.0 - z * f.sign(v) / limit
        rate = v * f.sign(share) * f.power(f.abs(share), p.dahl_exponent)
    return Friction(p.bristle_stiffness * z, 0.0, rate)


def lugre(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """Z' = v - sigma0 |v| z / g(v); F = sigma0 z + sigma1 z'."""
    sliding = stribeck_curve(f, p, v) * level(f, p, x, v)
    rate = v - p.bristle_stiffness * f.abs(v) * z / sliding
    return Friction(p.bristle_stiffness * z, p.bristle_damping, rate)


def bouc_wen(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """Z' = alpha v - (beta |v| z + gamma v |z|) |z|^(n-1); F = A k0 x + (1 - A) k0 z."""
    narrowing = p.bw_beta * f.abs(v) * z + p.bw_gamma * v * f.abs(z)
    if p.bw_exponent != 1.0:
        narrowing = narrowing * f.power(f.abs(z), p.bw_exponent - 1.0)
    elastic, yielding = p.bw_ratio * p.bw_stiffness, (1.0 - p.bw_ratio) * p.bw_stiffness
    return Friction(elastic * x + yielding * z, 0.0, p.bw_alpha * v - narrowing)


def brown_mcphee(f: Functions, p: Parameters, x: Value, v: Value, z: Value) -> Friction:
    """f_d tanh(4 v / v_s) + (f_s - f_d) (v / v_s) / ((v / v_s)^2 / 4 + 3/4)^2, odd in v."""
    ratio = v / p.stribeck_velocity
    well = 0.25 * ratio * ratio + 0.75
    peak = (p.static_force - p.coulomb_force) * ratio / (well * well)
    return Friction((p.coulomb_force * f.tanh(4.0 * ratio) + peak) * level(f, p, x, v))


LAWS = {law.__name__: law for law in (none, coulomb, stribeck, dahl, lugre, bouc_wen, brown_mcphee)}
"""The laws by their names."""


def stored_energy(p: Parameters, x: float, z: float) -> float:
    """Energy in the bristle or the elastic branch [J]."""
    if p.friction in ("dahl", "lugre"):
        return 0.5 * p.bristle_stiffness * z * z
    if p.friction == "bouc_wen":
        elastic = p.bw_ratio * x * x
        return 0.5 * p.bw_stiffness * (elastic + (1.0 - p.bw_ratio) * z * z / p.bw_alpha)
    return 0.0


def stored_power(f: Functions, p: Parameters, x: Value, v: Value, z: Value, rate: Value) -> Value:
    """Rate of the stored energy [W]."""
    if p.friction in ("dahl", "lugre"):
        return p.bristle_stiffness * z * rate
    if p.friction == "bouc_wen":
        elastic = p.bw_ratio * x * v
        return p.bw_stiffness * (elastic + (1.0 - p.bw_ratio) * z * rate / p.bw_alpha)
    return 0.0
