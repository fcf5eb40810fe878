"""The complete device once more, in NumPy, for the core's tests; with the size of its rounding.

Each quantity is a pair (value, size): size is the sum of the sizes of the terms that make it up.
Friction: none, coulomb and dahl of exponent 1 (the other laws have tests of their own).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from inerter.core import parameters
from numpy.typing import NDArray

Array = NDArray[np.float64]
Pair = tuple[Array, Array]


def add(*pairs: Pair) -> Pair:
    """Sum of quantities; sizes add up whatever the signs."""
    value, size = np.zeros(1), np.zeros(1)
    for pair in pairs:
        value, size = value + pair[0], size + abs(pair[1])
    return value, size


def term(value: Array) -> Pair:
    """A quantity without cancellation."""
    return value, abs(value)


class Telling:
    """Forces, rates, energy and heat of a device given by its parameters."""

    def __init__(self, **stated: Any) -> None:
        self.p: dict[str, Any] = {name: entry.initial for name, entry in parameters().items()}
        names = {"friction": "none", "gas_law": "polytropic", "friction_side": "terminals"}
        self.p |= names | stated
        p = self.p
        if np.isnan(p["gas_area"]):
            p["gas_area"] = p["piston_area"]
        if p["channel_length"]:
            mass = p["fluid_density"] * p["channel_area"] * p["channel_length"]
            p["inertance"] = mass * (p["piston_area"] / p["channel_area"]) ** 2
        self.bristle = p["friction"] == "dahl"
        self.series = p["series_stiffness"] > 0.0 or p["series_damping"] > 0.0
        self.wheel = self.series and p["friction_side"] == "flywheel"

    def inertance(self, y: Array, w: Array) -> tuple[Pair, Pair, Pair]:
        """B, R and the kinetic energy."""
        p, speed = self.p, abs(w)
        rise = p["inertance_gradient"] * y + p["inertance_curvature"] * y**2
        slope = p["inertance_gradient"] + 2.0 * p["inertance_curvature"] * y
        slope = np.where(1.0 + rise < 0.01, 0.0, slope)
        along = p["inertance"] * np.maximum(0.01, 1.0 + rise)
        along_size = p["inertance"] * (
            1.0 + abs(p["inertance_gradient"] * y) + abs(p["inertance_curvature"] * y**2)
        )
        g = p["inertance_speed_gradient"]
        edge = 0.99 / -g if g < 0.0 else np.inf
        inner = np.minimum(speed, edge)
        energy = inner**2 / 2.0 + g * inner**3 / 3.0 + 0.005 * (speed**2 - inner**2)
        energy_size = speed**2 * (1.0 + abs(g) * inner)
        factor = np.maximum(0.01, 1.0 + g * speed)
        slope_size = abs(p["inertance_gradient"]) + abs(2.0 * p["inertance_curvature"] * y)
        return (
            (along * factor, along_size * (1.0 + abs(g) * speed)),
            (p["inertance"] * slope * energy, p["inertance"] * slope_size * energy_size),
            (along * energy, along_size * energy_size),
        )

    def flywheel_damper(self, w: Array) -> Pair:
        """Viscous damping and pipe loss."""
        p = self.p
        viscous = term(p["flywheel_viscous"] * w)
        if not p["channel_length"]:
            return viscous
        u = p["piston_area"] / p["channel_area"] * abs(w)
        bore = 2.0 * np.sqrt(p["channel_area"] / np.pi)
        head = p["minor_loss"] * p["fluid_density"] * u**2 / 2.0
        if p["fluid_viscosity"]:
            reynolds = p["fluid_density"] * u * bore / p["fluid_viscosity"]
            factor = churchill(reynolds, p["channel_roughness"] / bore)
            head = head + factor * p["channel_length"] / bore * p["fluid_density"] * u**2 / 2.0
        return add(viscous, term(p["piston_area"] * head * np.sign(w)))

    def gas(self, y: Array) -> tuple[Pair, Pair]:
        """Force and stored energy of the gas spring."""
        p = self.p
        pressure, area, volume, n = (
            p["gas_pressure"], p["gas_area"], p["gas_volume"], p["gas_exponent"],
        )  # fmt: skip
        if not pressure:
            return term(0.0 * y), term(0.0 * y)
        if p["gas_law"] == "expanded":
            stiff, half = n * pressure * area**2 / volume, (n + 1.0) / 2.0 * area / volume
            inner = np.minimum(y, 0.5 / half)
            force = stiff * (inner - half * inner**2)
            energy = stiff * (inner**2 / 2.0 - half * inner**3 / 3.0) + force * (y - inner)
            sizes = stiff * (abs(inner) + half * inner**2)
            return (force, sizes), (energy, sizes * abs(inner) + abs(force * (y - inner)))
        ratio = 1.0 + area * y / volume
        inner = np.maximum(ratio, 0.05)
        power, beyond = inner**-n, ratio - inner
        # the ratio's own rounding is that of 1 and its change, relative to what is left
        blur = 1.0 + n * (1.0 + abs(ratio - 1.0)) / inner
        force = 1.0 - power + n * power / inner * beyond
        gone = np.log(inner) if n == 1.0 else (inner ** (1.0 - n) - 1.0) / (1.0 - n)
        energy = (inner - 1.0) - gone + (1.0 - power) * beyond + n * power / inner * beyond**2 / 2.0
        force_size = (1.0 + power * (1.0 + n * abs(beyond) / inner)) * blur
        energy_size = (1.0 + abs(ratio) + inner * power + abs(gone) + power * abs(beyond)) * blur
        if n != 1.0:
            energy_size = energy_size / abs(1.0 - n)
        energy_size = energy_size + force_size * abs(beyond)
        return (
            (pressure * area * force, pressure * area * force_size),
            (pressure * volume * energy, pressure * volume * energy_size),
        )

    def element(self, v: Array, z: Array) -> dict[str, Pair]:
        """Force, stored energy, heat and rate of the gap of the series element."""
        p = self.p
        s, w = z[:, 0], z[:, 1]
        k, c, q, eps = (
            p["series_stiffness"], p["series_damping"], p["series_hardening"], p["backlash"],
        )  # fmt: skip
        gap = np.zeros_like(s)
        if eps:
            gap = np.clip(z[:, 2] if c else s, -eps, eps)
        d = s - gap
        edge = -0.5 / q if q else -np.inf
        inner = np.maximum(d, edge) if q >= 0.0 else np.minimum(d, edge)
        phi = k * (inner + q * inner**2)
        stored = k * (inner**2 / 2.0 + q * inner**3 / 3.0) + phi * (d - inner)
        span = abs(s) + abs(gap)
        phi_size = k * (1.0 + abs(2.0 * q * inner)) * span
        slip, slip_size = v - w, abs(v) + abs(w)
        rate = np.zeros_like(s)
        if eps and c:
            free = slip + phi / c
            rate = np.where(gap >= eps, np.minimum(0.0, free), free)
            rate = np.where(gap <= -eps, np.maximum(0.0, free), rate)
        elif eps:
            rate = np.where(abs(s) < eps, slip, 0.0)
        bend = slip - rate
        bend_size = slip_size + (phi_size / c if eps and c else 0.0)
        return {
            "force": (phi + c * bend, phi_size + c * bend_size),
            "energy": (stored, phi_size * span),
            # also told as F s' - phi d', whose terms cancel
            "heat": (c * bend**2, (phi_size + c * bend_size) * bend_size),
            "gap_rate": (rate, bend_size),
        }

    def stops(self, x: Array, v: Array) -> tuple[Pair, Pair, Pair]:
        """Force, stored energy and heat of the end stops."""
        p = self.p
        force, energy, heat = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
        k, cubic = p["stop_stiffness"], p["stop_stiffness_cubic"]
        reach, deepest = np.zeros_like(x), np.zeros_like(x)
        for place, side in ((p["stop_lower"], -1.0), (p["stop_upper"], 1.0)):
            if np.isnan(place):
                continue
            depth = np.maximum(0.0, side * (x - place))
            spring = k * depth + cubic * depth**3
            push = spring * np.maximum(0.0, 1.0 + p["stop_damping"] * side * v)
            force, energy = force + side * push, energy + k * depth**2 / 2 + cubic * depth**4 / 4
            heat = heat + (push - spring) * side * v
            reach = reach + np.where(depth > 0.0, abs(x) + abs(place), 0.0)
            deepest = np.maximum(deepest, depth)
        # by how much a place that is rounded may change them
        size = (k + 3.0 * cubic * deepest**2) * (1.0 + p["stop_damping"] * abs(v))
        return (force, size * reach), (energy, size * reach**2), (heat, size * reach * abs(v))

    def friction(self, v: Array, z: Array, load: Array) -> tuple[Pair, Pair, Pair, Pair]:
        """Force, rate of the state, stored energy, heat; a load raises the level of a bristle."""
        p, none = self.p, term(0.0 * v)
        if p["friction"] == "coulomb":
            force = term(p["coulomb_force"] * np.tanh(v / p["transition_velocity"]))
            return force, none, none, term(force[0] * v)
        if not self.bristle:
            return none, none, none, none
        stiff, limit = p["bristle_stiffness"], (p["coulomb_force"] + load) / p["bristle_stiffness"]
        rate = v - abs(v) * z[:, 0] / limit
        rate_size = abs(v) * (1.0 + abs(z[:, 0]) / limit)
        force, energy = term(stiff * z[:, 0]), term(stiff * z[:, 0] ** 2 / 2.0)
        return force, (rate, rate_size), energy, (force[0] * (v - rate), force[1] * 2.0 * rate_size)

    def quantities(self, x: Array, v: Array, a: Array, z: Array) -> dict[str, Pair]:
        """What Device.evaluate gives, z of shape (n, nstate); state_rate has shape (n, nstate)."""
        p = self.p
        x = x - p["rest_length"]
        place = 1 if self.bristle else 0
        s, w = (z[:, place], z[:, place + 1]) if self.series else (0.0 * x, v)
        slide = w if self.wheel else v
        felt, rest, kinetic = self.inertance(x - s, w)
        damper = self.flywheel_damper(w)
        gas, gas_energy = self.gas(x - s)
        stops, stop_energy, stop_heat = self.stops(x, v)
        element: dict[str, Pair] = {}
        share = p["load_friction"] * np.tanh(slide / p["transition_velocity"])
        share = 0.0 * slide if self.bristle else share
        through = term(0.0 * x)
        bearing = add((felt[0] * a, felt[1] * abs(a)), rest, damper, gas)
        if self.series:
            element = self.element(v, z[:, place:])
            bearing = element["force"]
        spring = p["bristle_stiffness"] * z[:, 0] if self.bristle and self.wheel else 0.0 * x
        on_bristle = p["load_friction"] * abs(bearing[0] - spring)
        rubbed = self.friction(slide, z, on_bristle)
        friction, bristle_rate, bristle_energy, friction_heat = rubbed
        rates = [bristle_rate] if self.bristle else []
        if self.series:
            carried = through = element["force"]
            if self.wheel:
                # what is left of the shaft's force by the friction law, and by its own load
                left, size = add(carried, (-friction[0], friction[1]))
                part = 1.0 / np.where(left > 0.0, 1.0 + share, 1.0 - share)
                carried = left * part, size * part * (1.0 + 1.0 / (1.0 - abs(share)))
            speed_up = add(carried, rest, damper, gas)[1] / abs(felt[0])
            turned = (carried[0] - rest[0] - damper[0] - gas[0]) / felt[0]
            rates += [(v - w, abs(v) + abs(w)), (turned, speed_up * felt[1] / abs(felt[0]))]
            rates += [element["gap_rate"]] if p["backlash"] else []
        else:
            carried = bearing
        load = share * abs(carried[0]), abs(share) * carried[1]
        spring = term(p["stiffness"] * x), term(p["stiffness_cubic"] * x**3)
        side = 1.0 + p["damping_asymmetry"] * np.sign(v)
        knee, beyond = (
            np.where((v < 0) & ~np.isnan(p[f"{name}_back"]), p[f"{name}_back"], p[name])
            for name in ("damping_knee", "damping_beyond")
        )
        bent = knee > 0
        n, most = p["damping_sharpness"], np.maximum(knee, abs(v))
        above, below = np.where(bent, (knee, abs(v)) / (most + ~bent), ((1.0,), (0.0,)))
        lost = 1.0 - p["damping_exponent"]
        bend = (above / (above**n + below**n) ** (1.0 / n)) ** np.where(bent, lost, 1.0)
        own_damper = (
            term(p["viscous"] * side * v * np.where(bent, beyond, 0.0)),
            term(p["viscous"] * side * v * bend * np.where(bent, 1.0 - beyond, 1.0)),
            term(p["quadratic_damping"] * side * v * abs(v)),
        )
        rubbing = add(friction, load)
        felt_there = (through,) if self.wheel else (carried, rubbing)
        total = add(*felt_there, *spring, *own_damper, stops, term(p["force_offset"] + 0.0 * x))
        none = term(0.0 * x)
        springs = term(p["stiffness"] * x**2 / 2.0), term(p["stiffness_cubic"] * x**4 / 4.0)
        series_energy, series_heat = element.get("energy", none), element.get("heat", none)
        heat = [(value * v, size * abs(v)) for value, size in own_damper]
        heat.append((load[0] * slide, load[1] * abs(slide)))
        stored = add(kinetic, *springs, bristle_energy, series_energy, gas_energy, stop_energy)
        lost = add(
            *heat, friction_heat, series_heat, (damper[0] * w, damper[1] * abs(w)), stop_heat
        )
        rate = (
            np.stack([rate[0] for rate in rates], axis=1) if rates else np.zeros((x.size, 0)),
            np.stack([rate[1] for rate in rates], axis=1) if rates else np.zeros((x.size, 0)),
        )
        return {
            "total": total, "inertance": carried, "friction": rubbing, "state_rate": rate,
            "stored_energy": stored, "dissipated_power": lost,
        }  # fmt: skip


def churchill(reynolds: Array, roughness: float) -> Array:
    """Darcy friction factor, Churchill 1977; roughness relative to the diameter. 0 for Re = 0."""
    number = np.maximum(reynolds, 1e-12)
    with np.errstate(over="ignore"):
        wall = 1.0 / ((7.0 / number) ** 0.9 + 0.27 * roughness)
        turbulent = (2.457 * np.log(wall)) ** 16
        transition = (37530.0 / number) ** 16
        factor = 8.0 * ((8.0 / number) ** 12 + (turbulent + transition) ** -1.5) ** (1.0 / 12.0)
    return np.where(reynolds > 0.0, factor, 0.0)
