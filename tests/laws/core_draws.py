"""Random devices and states for the core's tests, and how large a rounding error may be."""

from __future__ import annotations

from typing import Any

import numpy as np
from inerter.reference import ReferenceDevice, friction_level
from numpy.typing import NDArray

LAWS = ("none", "coulomb", "stribeck", "dahl", "lugre", "bouc_wen", "brown_mcphee")
MEMORY = ("dahl", "lugre", "bouc_wen")
AGING = ("rate_state",)
"""A state that is no deflection, and does not change its sign with the motion: tests of its own."""
SEVERAL = ("maxwell_slip",)
"""Laws with several states; they have tests of their own."""

Parameters = dict[str, Any]
Array = NDArray[np.float64]


def around(rng: np.random.Generator, middle: float, decades: float = 1.0) -> float:
    """A positive number, log-uniform over `decades` to either side of `middle`."""
    return float(middle * 10.0 ** rng.uniform(-decades, decades))


def draw_friction(rng: np.random.Generator, law: str, wide: float = 1.0) -> Parameters:
    """Parameters of a friction law; `wide` stretches the decades they are drawn from."""
    if law == "none":
        return {"friction": law}
    if law == "bouc_wen":
        n = float(rng.choice([1.0, 1.5, 2.0, 3.0, rng.uniform(1.0, 5.0)]))
        alpha, limit = around(rng, 1.0, wide), around(rng, 1e-3, wide)
        total = alpha / limit**n
        return {
            "friction": law,
            "bw_alpha": alpha,
            "bw_beta": total * (share := float(rng.uniform(0.1, 1.0))),
            "bw_gamma": total * (1.0 - share),
            "bw_exponent": n,
            "bw_stiffness": around(rng, 1e4, wide),
            "bw_ratio": float(rng.uniform(-0.5, 1.5)),
        }

    if law == "maxwell_slip":
        drawn: Parameters = {"friction": law}
        for i in range(1, int(rng.integers(2, 9))):
            drawn[f"slip_stiffness_{i}"] = around(rng, 1e4, wide)
            drawn[f"slip_force_{i}"] = around(rng, 5.0, wide)
        return drawn

    level = around(rng, 20.0, wide)
    drawn = {"friction": law, "coulomb_force": level}
    if law == "rate_state":
        return drawn | {
            "rate_effect": float(rng.uniform(0.0, 0.1)),
            "age_effect": float(rng.uniform(0.0, 0.1)),
            "rate_velocity": around(rng, 1e-3, wide),
            "age_distance": around(rng, 1e-4, wide),
        }
    if law != "dahl":
        drawn["static_force"] = level * float(rng.uniform(1.0, 5.0))
    if law in ("stribeck", "lugre", "brown_mcphee"):
        drawn["stribeck_velocity"] = around(rng, 1e-2, wide)
    if law in ("stribeck", "lugre"):
        drawn["stribeck_exponent"] = float(rng.choice([1.0, 2.0, rng.uniform(0.2, 5.0)]))
    if law in ("dahl", "lugre"):
        drawn["bristle_stiffness"] = around(rng, 1e5, 2.0 * wide)
    if law == "lugre":
        drawn["bristle_damping"] = float(rng.choice([0.0, around(rng, 100.0, wide)]))
    if law == "dahl":
        drawn["dahl_exponent"] = float(rng.choice([0.5, 1.0, 2.0, rng.uniform(0.3, 4.0)]))
    if law == "coulomb":
        del drawn["static_force"]
    return drawn


def draw_levels(rng: np.random.Generator) -> Parameters:
    """A friction level that differs between directions and along the stroke."""
    return {
        "transition_velocity": around(rng, 1e-4, 2.0),
        "friction_asymmetry": float(rng.uniform(-0.9, 0.9)),
        "friction_gradient": float(rng.normal(0.0, 10.0)),
        "friction_curvature": float(rng.normal(0.0, 100.0)),
    }


def draw_branches(rng: np.random.Generator, wide: float = 1.0) -> Parameters:
    """Everything beside the friction law; springs of either sign."""
    drawn: Parameters = {
        "inertance": around(rng, 100.0, wide),
        "inertance_gradient": float(rng.normal(0.0, 5.0)),
        "inertance_curvature": float(rng.normal(0.0, 50.0)),
        "viscous": around(rng, 50.0, wide),
        "quadratic_damping": around(rng, 50.0, wide),
        "stiffness": around(rng, 1e4, wide) * float(rng.choice([-1.0, 1.0])),
        "stiffness_cubic": around(rng, 1e6, wide) * float(rng.choice([-1.0, 1.0])),
        "rest_length": float(rng.normal(0.0, 0.05)),
        "force_offset": float(rng.normal(0.0, 30.0)),
        "load_friction": float(rng.uniform(0.0, 0.9)),
    }
    # by a generator of its own, so that the other draws stay
    shape = np.random.default_rng(int(1e6 * float(drawn["viscous"])))
    drawn["damping_asymmetry"] = float(shape.uniform(-0.9, 0.9)) * float(shape.random() < 0.5)
    drawn["damping_knee"] = around(shape, 0.1, wide) * float(shape.random() < 0.5)
    drawn["damping_beyond"] = float(shape.uniform(0.0, 3.0))
    if shape.random() < 0.5:
        drawn["damping_knee_back"] = around(shape, 0.1, wide) * float(shape.random() < 0.7)
        drawn["damping_beyond_back"] = float(shape.uniform(0.0, 3.0))
    if shape.random() < 0.5:
        drawn["damping_sharpness"] = float(shape.uniform(1.0, 20.0))
    if shape.random() < 0.5:
        drawn["damping_exponent"] = float(shape.uniform(-1.0, 1.0))
    return drawn


def draw_flywheel(rng: np.random.Generator, channel: bool, gas: bool) -> Parameters:
    """What stands at the flywheel: viscous damping, speed gradient; a channel, a gas spring."""
    drawn: Parameters = {
        "flywheel_viscous": around(rng, 30.0) * float(rng.random() < 0.5),
        "inertance_speed_gradient": float(rng.normal(0.0, 1.0)) * float(rng.random() < 0.5),
    }
    if channel:
        bore = around(rng, 6e-3, 0.5)
        drawn |= {
            "piston_area": around(rng, 1.6e-3, 0.3),
            "channel_area": np.pi * bore**2 / 4.0,
            "channel_length": around(rng, 1.7, 0.5),
            "fluid_density": around(rng, 1000.0, 0.1),
            "fluid_viscosity": around(rng, 1e-3, 1.5) * float(rng.random() < 0.8),
            "channel_roughness": bore * float(rng.uniform(0.0, 0.05)),
            "minor_loss": float(rng.uniform(0.0, 3.0)),
        }
    if gas:
        # volume for a stroke of some 0.05 m
        area = around(rng, 1.6e-3, 0.3)
        drawn |= {
            "gas_pressure": around(rng, 1e5, 0.5),
            "gas_area": area,
            "gas_volume": area * around(rng, 0.05, 0.5),
            "gas_exponent": float(rng.choice([1.0, 1.4, rng.uniform(0.5, 3.0)])),
            "gas_law": str(rng.choice(["polytropic", "expanded"])),
        }
    return drawn


def draw_stops(rng: np.random.Generator) -> Parameters:
    """A lower stop, an upper stop or both, within the usual stroke."""
    drawn: Parameters = {
        "stop_stiffness": around(rng, 1e5),
        "stop_damping": around(rng, 1.0) * float(rng.random() < 0.8),
    }
    if rng.random() < 0.5:
        drawn["stop_stiffness_cubic"] = around(rng, 1e9)
    which = rng.integers(3)
    if which != 0:
        drawn["stop_lower"] = -around(rng, 1e-2)
    if which != 1:
        drawn["stop_upper"] = around(rng, 1e-2)
    return drawn


def draw_series(rng: np.random.Generator, backlash: bool) -> Parameters:
    """A series element: damped or not, hardening or not; without backlash perhaps a dashpot."""
    drawn: Parameters = {
        "series_stiffness": around(rng, 1e5, 1.5),
        "series_damping": around(rng, 300.0) * float(rng.random() < 0.8),
        "series_hardening": float(rng.normal(0.0, 50.0)) * float(rng.random() < 0.5),
    }
    if backlash:
        drawn["backlash"] = around(rng, 1e-4)
    elif rng.random() < 0.1:
        drawn |= {"series_stiffness": 0.0, "series_damping": around(rng, 300.0)}
        drawn["series_hardening"] = 0.0
    return drawn


def draw_complete(rng: np.random.Generator) -> Parameters:
    """A device that may have every part; friction none, coulomb or dahl of exponent 1."""
    channel, gas, stops, series, backlash = (rng.random(5) < 0.6).tolist()
    drawn = draw_friction(rng, str(rng.choice(["none", "coulomb", "dahl"])))
    drawn |= {"dahl_exponent": 1.0} if drawn["friction"] == "dahl" else {}
    drawn |= draw_branches(rng) | draw_flywheel(rng, channel, gas)
    drawn |= draw_stops(rng) if stops else {}
    drawn |= draw_series(rng, backlash) if series else {}
    # by a source of its own, so that what follows is drawn as it was
    if np.random.default_rng(int(1e6 * drawn["viscous"])).random() < 0.4:
        drawn["friction_side"] = "flywheel"
    if channel:
        del drawn["inertance"]
    return drawn


def draw_states(rng: np.random.Generator, count: int, p: Parameters) -> Array:
    """States (count, nstate) of such a device: the gap inside, at either side, a little outside."""
    columns = []
    if p["friction"] == "maxwell_slip":
        for i in range(1, 1 + sum(name.startswith("slip_stiffness") for name in p)):
            limit = p[f"slip_force_{i}"] / p[f"slip_stiffness_{i}"]
            # at its limit on either side, within, beyond
            columns.append(limit * rng.choice([-1.0, 1.0], count))
            inside = rng.uniform(-1.5, 1.5, count) * limit
            columns[-1] = np.where(rng.random(count) < 0.7, inside, columns[-1])
    if p["friction"] in MEMORY:
        columns.append(rng.uniform(-2.0, 2.0, count) * state_limit(p))
    if p.get("series_stiffness", 0.0) > 0.0 or p.get("series_damping", 0.0) > 0.0:
        gap = p.get("backlash", 0.0)
        reach = gap + 10.0 ** rng.uniform(-6.0, -2.0, count)
        columns.append(reach * rng.uniform(-1.0, 1.0, count))
        columns.append(10.0 ** rng.uniform(-3.0, 0.5, count) * rng.choice([-1.0, 1.0], count))
        if gap:
            inside = rng.uniform(-1.0, 1.0, count)
            columns.append(gap * rng.choice([-1.0, 1.0, -1.1, 0.0], count))
            columns[-1] = np.where(rng.random(count) < 0.4, gap * inside, columns[-1])
    return np.stack(columns, axis=1) if columns else np.zeros((count, 0))


def state_limit(p: Parameters) -> float:
    """Deflection [m] beyond which a slide cannot lead, at a friction level of 1."""
    if p["friction"] == "rate_state":
        return 5.0  # no limit, but that of times and speeds that anybody meets
    if p["friction"] == "bouc_wen":
        return (p["bw_alpha"] / (p["bw_beta"] + p["bw_gamma"])) ** (1.0 / p["bw_exponent"])
    return p.get("static_force", p["coulomb_force"]) / p["bristle_stiffness"]


def draw_points(
    rng: np.random.Generator, count: int, reach: float, wide: float = 2.0
) -> tuple[Array, Array, Array, Array]:
    """Random x, v, a, z of either sign, a tenth of each zero; z within twice `reach`."""

    def spread(middle: float) -> Array:
        size = middle * 10.0 ** rng.uniform(-wide, wide, count)
        return size * rng.choice([-1.0, 1.0], count) * (rng.random(count) > 0.1)

    z = rng.uniform(-2.0, 2.0, count) * reach * (rng.random(count) > 0.1)
    return spread(1e-2), spread(1e-1), spread(5.0), z


def magnitudes(device: ReferenceDevice, x: Array, v: Array, a: Array, z: Array) -> dict[str, Array]:
    """Sum of the sizes of the terms of each quantity: what its rounding error is measured by."""
    s = x - device.rest_length
    stretch, size, speed = abs(s), abs(z), abs(v)
    factor = 1.0 + (device.inertance_gradient + device.inertance_curvature * s) * s
    slope = abs(device.inertance_gradient) + 2.0 * abs(device.inertance_curvature) * stretch
    inertia = device.inertance * np.maximum(0.01, factor)
    inertance = inertia * abs(a) + 0.5 * device.inertance * slope * v**2
    load = device.load_friction * inertance
    damper = (device.viscous + device.quadratic_damping * speed) * speed
    spring = (abs(device.stiffness) + abs(device.stiffness_cubic) * stretch**2) * stretch
    energy = 0.5 * inertia * v**2 + spring * stretch

    # state, its rate and what it carries
    rate = np.zeros_like(x)
    if device.friction == "bouc_wen":
        shape = abs(device.bw_beta) + abs(device.bw_gamma)
        rate = speed * (device.bw_alpha + shape * size**device.bw_exponent)
        yielding = device.bw_stiffness * abs(1.0 - device.bw_ratio) * size
        elastic = device.bw_stiffness * abs(device.bw_ratio) * stretch
        friction = yielding + elastic
        energy += elastic * stretch + yielding * size / device.bw_alpha
        stored = yielding * rate / device.bw_alpha + elastic * speed
    elif device.friction == "rate_state":
        aging = device.rate_velocity * np.exp(-z) + speed
        rate = (1.0 + size) * aging / device.age_distance
        spread = abs(np.log(np.hypot(v, device.transition_velocity) / device.rate_velocity))
        bracket = 1.0 + device.rate_effect * spread + device.age_effect * size
        level = np.asarray(friction_level(device, s, v)) * device.coulomb_force
        friction, stored = level * bracket, np.zeros_like(x)
    elif device.nstate:
        level = np.asarray(friction_level(device, s, v)) * device.coulomb_force
        overload = device.bristle_stiffness * size / level
        exponent = device.dahl_exponent if device.friction == "dahl" else 1.0
        rate = speed * (1.0 + overload) ** exponent
        damping = device.bristle_damping if device.friction == "lugre" else 0.0
        friction = device.bristle_stiffness * size + damping * rate
        energy += device.bristle_stiffness * size**2
        stored = device.bristle_stiffness * size * rate
    else:
        friction = abs(np.asarray(device.friction_force(x, v, z)))
        stored = np.zeros_like(x)
    return {
        "inertance": inertance,
        "friction": friction + load,
        "total": inertance + load + friction + damper + spring + abs(device.force_offset),
        "state_rate": rate,
        "stored_energy": energy,
        "dissipated_power": (damper + load + friction) * speed + stored,
    }
