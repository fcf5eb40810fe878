"""Curves along the stroke: core, reference and Exudyn element say the same of random devices."""

from __future__ import annotations

import numpy as np
import pytest
from core_draws import (
    LAWS,
    MEMORY,
    Array,
    Parameters,
    draw_branches,
    draw_complete,
    draw_friction,
    draw_levels,
    draw_points,
    draw_states,
    magnitudes,
    state_limit,
)
from core_telling import Telling
from curve_draws import draw_curves
from inerter.core import Device, lists
from inerter.exudyn import device as element
from inerter.exudyn.parameters import Parameters as ElementParameters
from inerter.reference import ReferenceDevice
from inerter.reference.laws.stroke import LISTS

TOLERANCE = 1e-12


def expected_of(reference: ReferenceDevice, x: Array, v: Array, a: Array, z: Array) -> dict:
    state = reference.state_argument(z) if z.ndim > 1 else z
    carried = reference.inertance_force(x, v, a, state)
    return {
        "inertance": carried,
        "friction": reference.total_friction(x, v, a, state),
        "total": reference.force(x, v, a, state),
        "state_rate": reference.state_rate(x, v, state, a=a),
        "stored_energy": reference.stored_energy(x, v, state),
        "dissipated_power": reference.dissipated_power(x, v, a, state),
    }


def added(device: Device, x: Array, v: Array) -> dict[str, Array]:
    """What curves add to the sizes of the terms: N, N, W, J; their arguments are rounded too."""
    s = abs(x - device.rest_length)

    def size(name: str, derivative: int) -> Array:
        periods = getattr(device, f"{name}_periods")
        values = getattr(device, f"{name}_curve")
        found = np.zeros_like(s)
        if values:
            spacing = (device.curve_upper - device.curve_lower) / (len(values) - 1)
            reach = 1.0 + (s + abs(device.curve_lower)) / spacing
            found += 4.0 * max(map(abs, values)) * (1.0 + reach / 8.0) / spacing**derivative
        for length, amplitude, _ in zip(periods[::3], periods[1::3], periods[2::3], strict=True):
            wave = 2.0 * np.pi / length
            found += abs(amplitude) * wave**derivative * (1.0 + wave * s + 4.0)
        return found

    span = s + abs(device.curve_lower if device.curve_lower == device.curve_lower else 0.0)
    longest = max([0.0, *device.force_periods[::3]])
    bend = device.inertance * (size("inertance", 1) + size("inertance_back", 1)) * v * v
    mass = size("inertance", 0) + size("inertance_back", 0)
    level = size("friction", 0) + size("friction_back", 0)
    force, damper = size("force", 0), size("viscous", 0) * abs(v)
    return {
        "bend": bend, "mass": mass, "level": level, "force": force + damper,
        "energy": force * (span + longest), "power": damper * abs(v),
    }  # fmt: skip


def compare(p: Parameters, core: Device, sizes: dict[str, Array], points: tuple) -> None:
    x, v, a, z = points
    found, more = core.evaluate(x, v, a, z), added(core, x, v)
    # what is multiplied or divided by a level or an inertance has their rounding
    factor = (1.0 + more["mass"] + more["level"]) * 10.0
    inertia = core.inertance if core.inertance else 1.0
    extra = {
        "inertance": more["bend"],
        "friction": more["bend"],
        "total": more["bend"] + more["force"],
        "stored_energy": more["energy"],
        "dissipated_power": more["power"] + more["bend"] * abs(v),
        "state_rate": more["bend"] / inertia,
    }
    for name, value in expected_of(ReferenceDevice(**p), x, v, a, z).items():
        if core.nstate == 0 and name == "state_rate":
            continue
        size = np.reshape(sizes[name], (x.size, -1)) * factor[:, None]
        size = size + np.reshape(extra[name], (x.size, -1))
        error = abs(np.reshape(found[name], (x.size, -1)) - np.reshape(value, (x.size, -1)))
        assert np.all(error <= TOLERANCE * size), (p, name, (error / size).max())


def test_all_know_the_same_lists() -> None:
    assert tuple(lists()) == (*LISTS, "force_map")


@pytest.mark.parametrize("law", LAWS)
def test_core_is_the_reference_with_curves(law: str) -> None:
    rng = np.random.default_rng([28, LAWS.index(law)])
    for _ in range(25):
        strokes = ("inertance", "inertance_back", "force", "viscous")
        if law != "none":
            strokes += ("friction", "friction_back")
        p = draw_friction(rng, law) | draw_branches(rng)
        if law not in ("none", "bouc_wen"):
            p |= draw_levels(rng) | {"friction_asymmetry": 0.0}
        p |= draw_curves(rng, strokes)
        core = Device(**p)
        x, v, a, z = draw_points(rng, 60, state_limit(p) if law in MEMORY else 1e-3, 1.0)
        plain = {key: value for key, value in p.items() if key not in LISTS}
        plain = {key: value for key, value in plain.items() if not key.startswith("curve_")}
        sizes = magnitudes(ReferenceDevice(**plain), x, v, a, z)
        compare(p, core, sizes, (x, v, a, z))


def test_core_is_the_reference_of_the_complete_device_with_curves() -> None:
    rng = np.random.default_rng(2811)
    for _ in range(120):
        p = draw_complete(rng)
        plain = dict(p)
        strokes = ("inertance", "inertance_back", "force", "viscous")
        p |= draw_curves(rng, strokes + (("friction",) if p["friction"] != "none" else ()))
        core = Device(**p)
        x, v, a, _ = draw_points(rng, 40, 1.0, 1.0)
        z = draw_states(rng, 40, p)
        if p.get("backlash"):
            z[:, -1] = np.clip(z[:, -1], -p["backlash"], p["backlash"])
        # behind a series element the flywheel's place and speed count
        sizes = {n: s[1] for n, s in Telling(**plain).quantities(x, v, a, z).items()}
        y, w = x, v
        if "series_deflection" in core.state_names:
            at = core.state_names.index("series_deflection")
            y, w = abs(x) + abs(z[:, at]), abs(v) + abs(z[:, at + 1])
        if core.nstate == 0:
            sizes["state_rate"] = np.zeros(x.size)
        compare_complete(p, core, sizes, (x, v, a, z), y, w)


def compare_complete(
    p: Parameters, core: Device, sizes: dict[str, Array], points: tuple, y: Array, w: Array
) -> None:
    x, v, a, z = points
    more, here = added(core, y, w), added(core, x, v)
    found = core.evaluate(x, v, a, z)
    # an inertance of 0.01 where the polynomial meets its floor, and more with the curve on it
    factor = 1.0 + 10.0 * (1.0 + more["mass"] + here["level"]) * (1.0 + more["mass"] / 0.01)
    extra = {
        "inertance": more["bend"],
        "friction": more["bend"],
        "total": more["bend"] + here["force"],
        "stored_energy": here["energy"],
        "dissipated_power": here["power"] + more["bend"] * abs(w),
        "state_rate": more["bend"] / core.inertance * 100.0,
    }
    for name, value in expected_of(ReferenceDevice(**p), x, v, a, z).items():
        if core.nstate == 0 and name == "state_rate":
            continue
        size = np.reshape(sizes[name], (x.size, -1)) * factor[:, None]
        size = size + np.reshape(extra[name], (x.size, -1)) * factor[:, None]
        error = abs(np.reshape(found[name], (x.size, -1)) - np.reshape(value, (x.size, -1)))
        assert np.all(error <= TOLERANCE * size), (p, name, (error / size).max())


@pytest.mark.parametrize("law", LAWS)
def test_the_element_is_the_core_with_curves(law: str) -> None:
    rng = np.random.default_rng([29, LAWS.index(law)])
    for _ in range(12):
        strokes = ("inertance", "inertance_back", "force", "viscous")
        if law != "none":
            strokes += ("friction", "friction_back")
        p = draw_friction(rng, law) | draw_curves(rng, strokes)
        p |= {"inertance": 30.0}
        core = Device(**p)
        told = ElementParameters.of(core)
        x, v, a, z = draw_points(rng, 20, state_limit(p) if law in MEMORY else 1e-3, 1.0)
        found = core.evaluate(x, v, a, z)
        more = added(core, x, v)
        plain = {k: q for k, q in p.items() if k not in LISTS and not k.startswith("curve_")}
        sizes = magnitudes(ReferenceDevice(**plain), x, v, a, z)
        factor = (1.0 + more["mass"] + more["level"]) * 10.0
        for i in range(x.size):
            state = [float(z[i])] if core.nstate else []
            motion = float(x[i]), float(v[i])
            size = sizes["total"][i] * factor[i] + more["bend"][i] + more["force"][i]
            forces = element.forces(told, *motion, float(a[i]), state)
            assert abs(forces["total"] - found["total"][i]) <= TOLERANCE * size
            energy = element.stored_energy(told, *motion, state)
            size = sizes["stored_energy"][i] * factor[i] + more["energy"][i]
            assert abs(energy - found["stored_energy"][i]) <= TOLERANCE * size
