"""The flywheel's side: the inertance, which may vary, and what brakes or pushes the flywheel.

    N = B(y, w) w' + R(y, w) + G(y, w)
    B = b X(y) V(w),  R = b X'(y) E(w),  E' = w V       X, V not below 0.01
    X = 1 + q y + r y^2 + f(y), f from `stroke.py`, another one for w < 0 where it is given
    G = c_w w + pipe(w) + gas(y)

y [m] and w [m/s] are the flywheel's displacement and velocity, those of the terminals if there is
no series element. Sign: tension positive. Pipe: Churchill 1977, all regimes; gas: polytropic, or
its expansion to second order as a paper on the fluid inerter prints it.
"""

from __future__ import annotations

import math

from inerter.exudyn import stroke
from inerter.exudyn.functions import Functions, Value
from inerter.exudyn.parameters import Parameters

FLOOR = 0.01
"""The factors on the inertance do not fall below this."""
LEAST_VOLUME = 0.05
"""Share of the gas volume below which the polytropic law goes on along its tangent."""


def varies(p: Parameters) -> bool:
    """Whether the inertance depends on displacement or speed."""
    polynomial = p.inertance_gradient or p.inertance_curvature or p.inertance_speed_gradient
    return bool(polynomial) or _curved(p)


def _curved(p: Parameters) -> bool:
    return stroke.there(p, "inertance") or stroke.there(p, "inertance_back")


def inertance(f: Functions, p: Parameters, y: Value, w: Value) -> tuple[Value, Value]:
    """B [kg] and R [N]."""
    if not varies(p):
        return p.inertance, 0.0
    factor, slope = _along(f, p, y, w)
    speed = f.greatest(FLOOR, 1.0 + p.inertance_speed_gradient * f.abs(w))
    return p.inertance * factor * speed, p.inertance * slope * _kinetic(f, p, w)


def force(f: Functions, p: Parameters, y: Value, w: Value) -> Value:
    """G [N]."""
    total = 0.0
    if p.flywheel_viscous != 0.0:
        total = total + p.flywheel_viscous * w
    if p.channel_area:
        total = total + _pipe(f, p, w)
    if p.gas_pressure:
        total = total + _gas(f, p, y)
    return total


def stored_energy(f: Functions, p: Parameters, y: Value, w: Value) -> Value:
    """Kinetic energy and energy of the gas [J]."""
    kinetic = p.inertance * _along(f, p, y, w)[0] * _kinetic(f, p, w)
    return kinetic + (_gas_energy(f, p, y) if p.gas_pressure else 0.0)


def dissipated_power(f: Functions, p: Parameters, w: Value) -> Value:
    """Heat in the flywheel's damper and in the pipe [W]."""
    heat = p.flywheel_viscous * w * w
    return heat + _pipe(f, p, w) * w if p.channel_area else heat


def _along(f: Functions, p: Parameters, y: Value, w: Value) -> tuple[Value, Value]:
    """X [-] and X' [1/m]."""
    if not (p.inertance_gradient or p.inertance_curvature or _curved(p)):
        return 1.0, 0.0
    factor = 1.0 + (p.inertance_gradient + p.inertance_curvature * y) * y
    slope = p.inertance_gradient + 2.0 * p.inertance_curvature * y
    if _curved(p):
        rise = stroke.value(f, p, "inertance", y)
        steepness = stroke.slope(f, p, "inertance", y)
        if stroke.there(p, "inertance_back"):
            back = stroke.value(f, p, "inertance_back", y)
            rise = f.choose(w < 0.0, back, rise)
            steepness = f.choose(w < 0.0, stroke.slope(f, p, "inertance_back", y), steepness)
        factor, slope = factor + rise, slope + steepness
    return f.greatest(FLOOR, factor), f.choose(factor < FLOOR, 0.0, slope)


def _kinetic(f: Functions, p: Parameters, w: Value) -> Value:
    """E, the kinetic energy per inertance and X [m^2/s^2]."""
    gradient, speed = p.inertance_speed_gradient, f.abs(w)
    if gradient >= 0.0:
        return (0.5 + gradient * speed / 3.0) * w * w
    # up to the speed where the floor is reached, and beyond it
    corner = (FLOOR - 1.0) / gradient
    below = f.least(speed, corner)
    beyond = 0.5 * FLOOR * (speed * speed - below * below)
    return (0.5 + gradient * below / 3.0) * below * below + beyond


def _pipe(f: Functions, p: Parameters, w: Value) -> Value:
    """A1 (f l / D + K) rho u^2 / 2 sign(w) [N]."""
    ratio = p.piston_area / p.channel_area
    loss = 0.5 * p.fluid_density * ratio * p.minor_loss * f.abs(w)
    if p.fluid_viscosity:
        diameter = math.sqrt(4.0 * p.channel_area / math.pi)
        number = p.fluid_density * ratio * diameter / p.fluid_viscosity * f.abs(w)
        # f Re / 64 is 1 in laminar flow and finite at rest
        per_speed = 0.5 * p.fluid_viscosity * p.channel_length / diameter**2
        loss = loss + per_speed * _friction_number(f, p, number, diameter)
    return p.piston_area * ratio * loss * w


def _friction_number(f: Functions, p: Parameters, number: Value, diameter: float) -> Value:
    """Darcy's friction factor times the Reynolds number [-], by Churchill."""
    reynolds = f.greatest(number, 1e-6)
    rough = f.power(7.0 / reynolds, 0.9) + 0.27 * p.channel_roughness / diameter
    if p.coil_diameter:
        return _coiled(f, reynolds, rough, math.sqrt(diameter / p.coil_diameter))
    a = f.power(2.457 * f.log(1.0 / rough), 16.0)
    b = 37530.0**16
    turbulent = f.power(reynolds, 24.0) / f.power(a * f.power(reynolds, 16.0) + b, 1.5)
    # (P + Q)^-1.5 Re^12 with Re^-16 taken out of P + Q
    return 8.0 * f.power(8.0**12 + f.power(reynolds, 12.0) * turbulent, 1.0 / 12.0)


def _coiled(f: Functions, reynolds: Value, rough: Value, root: float) -> Value:
    """The same in a coil, `root` the square root of D / D_c: White, Mishra and Gupta."""
    fall = f.power(11.6 / f.greatest(11.6, reynolds * root), 0.45)
    laminar = 64.0 / (1.0 - f.power(f.greatest(0.0, 1.0 - fall), 2.2))
    a = f.power(2.457 * f.log(1.0 / rough), 16.0)
    sum_of_both = a * f.power(reynolds, 16.0) + 37530.0**16
    straight = 8.0 * reynolds * reynolds / f.power(sum_of_both, 0.125)
    ratio = reynolds * (straight + 0.03 * root) / laminar
    return laminar * f.power(1.0 + f.power(ratio, 12.0), 1.0 / 12.0)


def _gas(f: Functions, p: Parameters, y: Value) -> Value:
    """Force of the enclosed gas against the atmosphere [N]."""
    push, fill, gamma = _gas_numbers(p)
    if p.gas_law == "expanded":
        within = _growing(f, y, 1.0 / ((gamma + 1.0) * fill))
        return gamma * push * fill * within * (1.0 - 0.5 * (gamma + 1.0) * fill * within)
    edge = (LEAST_VOLUME - 1.0) / fill
    within = _pressed(f, y, edge)
    tangent = gamma * push * fill * LEAST_VOLUME ** (-gamma - 1.0)
    return push * (1.0 - f.power(1.0 + fill * within, -gamma)) + tangent * (y - within)


def _gas_energy(f: Functions, p: Parameters, y: Value) -> Value:
    """Integral of the gas force from 0 to y [J]."""
    push, fill, gamma = _gas_numbers(p)
    if p.gas_law == "expanded":
        within = _growing(f, y, 1.0 / ((gamma + 1.0) * fill))
        share = 0.5 - (gamma + 1.0) * fill * within / 6.0
        inside = gamma * push * fill * within * within * share
        return inside + _gas(f, p, within) * (y - within)
    within = _pressed(f, y, (LEAST_VOLUME - 1.0) / fill)
    swell = f.log1p(fill * within)
    work = swell if gamma == 1.0 else f.expm1((1.0 - gamma) * swell) / (1.0 - gamma)
    beyond = y - within
    tangent = gamma * push * fill * LEAST_VOLUME ** (-gamma - 1.0)
    outside = (_gas(f, p, within) + 0.5 * tangent * beyond) * beyond
    return push * (within - work / fill) + outside


def _growing(f: Functions, y: Value, edge: float) -> Value:
    """Where the gas has grown no further than at an edge [m]."""
    return f.least(y, edge) if edge > 0.0 else f.greatest(y, edge)


def _pressed(f: Functions, y: Value, edge: float) -> Value:
    """Where it is pressed no further than at an edge [m]."""
    return f.greatest(y, edge) if edge < 0.0 else f.least(y, edge)


def _gas_numbers(p: Parameters) -> tuple[float, float, float]:
    """p0 A [N], A / V0 [1/m], gamma [-]."""
    area = p.piston_area if math.isnan(p.gas_area) else p.gas_area
    return p.gas_pressure * area, area / p.gas_volume, p.gas_exponent
