"""Core, reference and Exudyn element on devices that may have every part at once.

The rounding of a quantity is measured by the largest size that it has on the device's own motion.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from core_draws import (
    AGING,
    LAWS,
    MEMORY,
    SEVERAL,
    Array,
    around,
    draw_branches,
    draw_flywheel,
    draw_friction,
    draw_levels,
    draw_series,
    draw_stops,
    state_limit,
)
from curve_draws import draw_curves
from inerter.core import Device
from inerter.exudyn import control as element_control
from inerter.exudyn import device as element
from inerter.exudyn.functions import NUMBERS
from inerter.exudyn.parameters import Parameters
from inerter.reference import ReferenceDevice
from map_draws import draw_map

ALL = (*LAWS, *AGING, *SEVERAL)
POINTS, DEVICES = 40, 20
TOLERANCE = 1e-12
QUANTITIES: tuple[str, ...] = (
    "total", "inertance", "friction", "stored_energy", "dissipated_power", "state_rate",
)  # fmt: skip
CONTROLS = ("viscous", "inertance", "stiffness", "flywheel_viscous", "coulomb_force")


def draw(rng: np.random.Generator, law: str) -> dict[str, Any]:
    """Each part with a chance of its own."""
    series, channel, gas, stops, play, map_, curves, branches = (rng.random(8) < 0.5).tolist()
    p = draw_friction(rng, law, 0.5) | draw_branches(rng, 0.5) | draw_flywheel(rng, channel, gas)
    if channel:
        del p["inertance"]
        bore = 2.0 * np.sqrt(p["channel_area"] / np.pi)
        p |= {"coil_diameter": bore * around(rng, 30.0, 0.5)} if rng.random() < 0.5 else {}
    p |= draw_stops(rng) if stops else {}
    p |= draw_series(rng, play) if series else {}
    if series and rng.random() < 0.5:
        p["friction_side"] = "flywheel"
    if law not in ("none", "bouc_wen"):
        p |= draw_levels(rng)
    # one mu, one for each direction of power, or none
    load = p.pop("load_friction")
    if law == "bouc_wen" and p["bw_ratio"] == 1.0:
        pass
    elif rng.random() < 0.4:
        p |= {"mu_forward": float(rng.uniform(0.0, 1.5)), "mu_backward": load}
    elif rng.random() < 0.5:
        p["load_friction"] = load
    if law in MEMORY and rng.random() < 0.3:
        p["friction_backlash"] = state_limit(p) * float(rng.uniform(0.1, 2.0))
    for i in range(1, 1 + int(rng.integers(1, 4)) * branches):
        p |= {f"branch_stiffness_{i}": around(rng, 1e4), f"branch_damping_{i}": around(rng, 100.0)}
    p |= draw_map(rng) if map_ else {}
    if curves:
        strokes = ["inertance", "inertance_back", "force", "viscous"]
        strokes += ["friction", "friction_back"] if law != "none" else []
        p |= draw_curves(rng, tuple(strokes), 1e-2)
        if {"friction_back_curve", "friction_back_periods"} & p.keys():
            p.pop("friction_asymmetry", None)
    wanted = str(rng.choice(CONTROLS))
    if rng.random() < 0.5 and not (
        (wanted == "inertance" and channel)
        or (wanted == "coulomb_force" and law not in ("coulomb", "rate_state"))
    ):
        value = abs(p.get(wanted, 0.0)) or 30.0
        p |= {"control": wanted, "control_lower": 0.5 * value, "control_upper": 2.0 * value}
        p[wanted] = value
        p["control_lag"] = float(rng.choice([0.0, 0.1]))
    # by a source of its own, so that what follows is drawn as it was
    own = np.random.default_rng(int(1e6 * p["viscous"]))
    rises = p.get("damping_exponent", 0.0) >= 0.0
    fixed = {"viscous_curve", "viscous_periods"}.isdisjoint(p) and p.get("control") != "viscous"
    if rises and fixed and own.random() < 0.6:
        p["damper_stiffness"] = around(own, 1e4)
    if p.get("inertance") and not p.get("backlash") and own.random() < 0.4:
        p["leak_damping"] = around(own, 300.0) * float(own.random() < 0.7)
        p["leak_quadratic_damping"] = around(own, 300.0)
        if p.get("series_stiffness") and own.random() < 0.6:
            p |= {"clutch_force": around(own, 30.0), "clutch_asymmetry": own.uniform(-1.0, 1.0)}
    return p


def drawn_states(rng: np.random.Generator, device: Device, p: dict[str, Any]) -> Array:
    """Of each state numbers that a motion could have."""
    columns = []
    for name in device.state_names:
        size = {
            "series_deflection": 1e-3, "flywheel_velocity": 0.3, "gap_position": 0.0,
            "damper_velocity": 0.3, "slip_position": 1e-3,
            "control_change": 0.2 * p.get("control_lower", 0.0),
        }.get(name, 1e-3)  # fmt: skip
        if name == "friction_state":
            size = state_limit(p) if p["friction"] != "rate_state" else 3.0
        if name.startswith("friction_state_"):
            i = name.rsplit("_", 1)[1]
            size = p[f"slip_force_{i}"] / p[f"slip_stiffness_{i}"]
        column = size * rng.uniform(-1.0, 1.0, POINTS)
        if name == "gap_position":
            gap = p["backlash"]
            column = np.clip(columns[-2] if not p["series_damping"] else gap * rng.choice(
                [-1.0, -0.5, 0.3, 1.0], POINTS), -gap, gap)  # fmt: skip
        columns.append(column)
    return np.stack(columns, axis=1) if columns else np.zeros((POINTS, 0))


def told_by_reference(device: ReferenceDevice, x: Array, v: Array, a: Array, z: Array) -> dict:
    state = device.state_argument(z)
    return {
        "total": device.force(x, v, a, state),
        "inertance": device.inertance_force(x, v, a, state),
        "friction": device.total_friction(x, v, a, state),
        "stored_energy": device.stored_energy(x, v, state),
        "dissipated_power": device.dissipated_power(x, v, a, state),
        "state_rate": device.state_rate(x, v, state, a=a),
    }


def told_by_element(device: Device, command: float, x: Array, v: Array, a: Array, z: Array) -> dict:
    rows: dict[str, list[float]] = {name: [] for name in QUANTITIES[:5]}
    parameters = Parameters.of(device, command=command)
    for at in range(POINTS):
        state = z[at].tolist()
        p = element_control.present(NUMBERS, parameters, state)
        motion = float(x[at] - device.rest_length), float(v[at]), float(a[at])
        forces = element.forces(p, *motion, state)
        for name in ("total", "inertance", "friction"):
            rows[name].append(float(forces[name]))
        rows["stored_energy"].append(float(element.stored_energy(p, *motion[:2], state)))
        rows["dissipated_power"].append(
            float(element.dissipated_power(NUMBERS, p, *motion[:2], state, forces["inertance"]))
        )
    return {name: np.array(values) for name, values in rows.items()}


def worst_errors(seed: int, law: str, devices: int) -> dict[str, dict[str, float]]:
    """Largest error of each quantity, relative to its largest size, by telling."""
    rng = np.random.default_rng([seed, ALL.index(law)])
    worst: dict[str, dict[str, float]] = {
        who: dict.fromkeys(QUANTITIES, 0.0) for who in ("reference", "element")
    }
    for _ in range(devices):
        p = draw(rng, law)
        device = Device(**p)
        command = float(rng.uniform(0.7, 1.5)) * p["control_lower"] if "control" in p else np.nan
        x = device.rest_length + rng.normal(0.0, 0.01, POINTS)
        v, a = rng.normal(0.0, 0.3, POINTS), rng.normal(0.0, 5.0, POINTS)
        z = drawn_states(rng, device, p)
        commanded: dict[str, Any] = {"command": command} if "control" in p else {}
        core = device.evaluate(x, v, a, z, **commanded)
        reference = ReferenceDevice(**p, **commanded)
        told = {
            "reference": told_by_reference(reference, x, v, a, z),
            "element": told_by_element(device, command, x, v, a, z),
        }
        for who, found in told.items():
            for name, value in found.items():
                if not core[name].size:
                    continue
                mine = np.reshape(core[name], (POINTS, -1))
                off = np.abs(np.reshape(value, mine.shape) - mine).max(axis=0, initial=0.0)
                size = np.abs(mine).max(axis=0, initial=0.0) + 1e-300
                if name in ("inertance", "friction"):
                    # play that is open carries nothing but rounding
                    size = size + 1e-3 * np.abs(core["total"]).max()
                worst[who][name] = max(worst[who][name], float((off / size).max()))
    return worst


@pytest.mark.parametrize("law", ALL)
def test_three_tellings_of_any_device_agree(law: str) -> None:
    for who, errors in worst_errors(31, law, DEVICES).items():
        for name, error in errors.items():
            assert error <= TOLERANCE, (who, name, error)


if __name__ == "__main__":
    for law in ALL:
        for who, errors in worst_errors(32, law, 300).items():
            print(law, who, " ".join(f"{name} {error:.1e}" for name, error in errors.items()))
