"""The laws that are compared, each acting: friction sticks and slides, play opens, stops are hit.

Parameters are those of a quarter-car with an inertance of 128.57 kg. For another model they are
read in other units: a law written in (kg, m, s) is the same law in (mass kg, length m, s), and so
acts in the same way on motions that are `length` times as large with forces
`mass * length` times as large. What each parameter's unit says decides; nothing is listed by hand.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Literal

from inerter.core import lists, parameters

Kind = Literal["smooth", "corner", "contact"]
INERTANCE = 128.57
"""Inertance [kg] to which the parameters below belong."""

# kg, m of each unit that a parameter is declared in; seconds are not changed
_UNITS = {"1": (0, 0), "kg": (1, 0), "m": (0, 1), "s": (0, 0), "N": (1, 1), "Pa": (1, -1)}


@dataclass(frozen=True)
class Law:
    """A named set of device parameters.

    `kind` says how smooth its force is along a motion: "smooth" (all derivatives that an
    integrator of fourth order wants), "corner" (a kink, or a rise steeper than a step resolves),
    "contact" (a state that starts and stops). `command` is what the device's control is told, in
    the unit of what it sets.
    """

    name: str
    kind: Kind
    device: dict[str, float | str]
    command: float = math.nan


def _law(name: str, kind: Kind, command: float = math.nan, **device: float | str) -> Law:
    # a channel's geometry gives the inertance
    own = {} if "channel_area" in device else {"inertance": INERTANCE}
    return Law(name, kind, own | device, command)


_SLIDING = {"coulomb_force": 200.0, "static_force": 300.0, "stribeck_velocity": 0.05}
_SHAFT = {"series_stiffness": 1e6, "series_damping": 3200.0}

LAWS = {
    law.name: law
    for law in (
        _law("ideal", "smooth"),
        _law("linear", "smooth", viscous=500.0, stiffness=2e4, force_offset=20.0),
        _law("cubic_stiffness", "smooth", stiffness_cubic=2e8),
        _law("gas_spring", "smooth", gas_pressure=5e5, gas_area=2e-3, gas_volume=1e-4),
        _law("variable_inertance", "smooth", inertance_gradient=8.0, inertance_curvature=500.0),
        _law("along_the_stroke", "smooth", inertance_periods="0.02 0.05 1.0",
             force_periods="0.015 60.0 0.5", viscous=300.0, viscous_periods="0.03 200.0 0.0"),
        _law("curve", "corner", inertance_curve="0 0.1 0.05 -0.05 0.1", curve_lower=-0.06,
             curve_upper=0.06),
        _law("force_map", "corner", force_map="-90 -20 60 80 -40 10 30 20 -50 -30 40 120",
             force_map_columns=4.0, force_map_lower=-0.04, force_map_upper=0.04,
             force_map_speed=0.5, force_map_scale=0.1),
        _law("coil", "corner", piston_area=1.649e-3, channel_area=2.827e-5, channel_length=1.34,
             fluid_density=998.0, fluid_viscosity=2e-2, coil_diameter=0.2),
        _law("series", "smooth", **_SHAFT),
        _law("series_hardening", "smooth", **_SHAFT, series_hardening=200.0,
             flywheel_viscous=100.0),
        _law("brown_mcphee", "smooth", friction="brown_mcphee", coulomb_force=200.0,
             static_force=300.0, stribeck_velocity=0.2),
        _law("quadratic_damping", "corner", quadratic_damping=5e3),
        _law("damper", "corner", viscous=2e3, damping_asymmetry=0.4, damping_knee=0.1,
             damping_beyond=0.25),
        _law("damper_each_way", "corner", viscous=2e3, damping_asymmetry=0.4, damping_knee=0.1,
             damping_beyond=0.25, damping_knee_back=0.2, damping_beyond_back=1.5,
             damping_sharpness=6.0),
        _law("damper_behind_a_spring", "corner", viscous=2e3, damping_asymmetry=0.4,
             damping_knee=0.1, damping_beyond=0.25, quadratic_damping=200.0, damper_stiffness=1e5),
        _law("eddy_current_brake", "smooth", viscous=2e3, damping_knee=0.1, damping_beyond=0.0,
             damping_exponent=-1.0),
        _law("speed_inertance", "corner", inertance_speed_gradient=1.0),
        _law("channel", "corner", piston_area=1.649e-3, channel_area=2.827e-5, channel_length=1.34,
             fluid_density=998.0, fluid_viscosity=1e-3, channel_roughness=1e-5, minor_loss=2.5),
        _law("load_friction", "corner", load_friction=0.1, transition_velocity=2e-2),
        _law("load_on_dahl", "corner", friction="dahl", coulomb_force=100.0, bristle_stiffness=1e5,
             mu_forward=0.2, mu_backward=0.1),
        _law("load_on_bouc_wen", "corner", friction="bouc_wen", bw_stiffness=1e5, bw_beta=400.0,
             bw_gamma=100.0, bw_ratio=0.05, load_friction=0.1),
        _law("load_on_lugre", "corner", friction="lugre", coulomb_force=100.0, static_force=150.0,
             stribeck_velocity=0.05, bristle_stiffness=1e5, bristle_damping=300.0,
             mu_forward=0.1, mu_backward=0.05),
        _law("load_on_maxwell_slip", "corner", friction="maxwell_slip", slip_stiffness_1=5e4,
             slip_force_1=30.0, slip_stiffness_2=3e4, slip_force_2=40.0, slip_stiffness_3=1e4,
             slip_force_3=30.0, mu_forward=0.2, mu_backward=0.1),
        _law("load_on_rate_state", "corner", friction="rate_state", coulomb_force=100.0,
             rate_effect=0.03, age_effect=0.01, rate_velocity=1e-2, age_distance=1e-2,
             transition_velocity=2e-2, load_friction=0.1),
        _law("load_on_dahl_at_flywheel", "corner", friction="dahl", coulomb_force=100.0,
             bristle_stiffness=1e5, load_friction=0.1, series_stiffness=1e5, series_damping=300.0,
             friction_side="flywheel"),
        _law("coulomb", "corner", friction="coulomb", coulomb_force=200.0,
             transition_velocity=2e-3),
        _law("stribeck", "corner", friction="stribeck", **_SLIDING, transition_velocity=2e-3),
        _law("dahl", "corner", friction="dahl", coulomb_force=200.0, bristle_stiffness=1e5),
        _law("lugre", "corner", friction="lugre", **_SLIDING, bristle_stiffness=1e5,
             bristle_damping=300.0),
        _law("bouc_wen", "corner", friction="bouc_wen", bw_stiffness=1e5, bw_beta=400.0,
             bw_gamma=100.0, bw_ratio=0.05),
        _law("maxwell_slip", "corner", friction="maxwell_slip", slip_stiffness_1=5e4,
             slip_force_1=60.0, slip_stiffness_2=3e4, slip_force_2=80.0, slip_stiffness_3=1e4,
             slip_force_3=60.0),
        _law("rate_state", "corner", friction="rate_state", coulomb_force=200.0, rate_effect=0.03,
             age_effect=0.05, rate_velocity=0.05, age_distance=2e-3, transition_velocity=2e-3),
        _law("friction_side", "corner", **_SHAFT, friction="coulomb", coulomb_force=200.0,
             transition_velocity=2e-3, friction_side="flywheel"),
        _law("control", "smooth", 300.0, control="inertance", control_lower=60.0,
             control_upper=400.0, control_lag=0.3),
        _law("end_stops", "corner", stop_lower=-5e-3, stop_upper=6e-3, stop_stiffness=1e6,
             stop_damping=0.5),
        _law("rubber_stops", "corner", stop_lower=-5e-3, stop_upper=6e-3, stop_stiffness=2e5,
             stop_stiffness_cubic=5e10, stop_damping=0.5),
        _law("backlash", "contact", **_SHAFT, backlash=5e-4),
        _law("clutch", "corner", **_SHAFT, clutch_force=400.0, clutch_asymmetry=0.3),
        _law("one_way_clutch", "corner", **_SHAFT, clutch_force=1e5, clutch_asymmetry=1.0),
        _law("leak", "corner", leak_damping=2e3, leak_quadratic_damping=2e4),
        _law("leak_behind_a_spring", "corner", series_stiffness=1e5, leak_damping=2e3,
             leak_quadratic_damping=2e4),
    )
}  # fmt: skip
"""The laws by name."""


def exponents(name: str, device: dict[str, float | str] | None = None) -> tuple[float, float]:
    """Powers of mass and length in the unit of a parameter; `m^-n` takes n from `device`."""
    device = device or {}
    power = float(device.get("bw_exponent", parameters()["bw_exponent"].initial))
    if name in ("control_lower", "control_upper"):
        # in the unit of what the control sets
        name = str(device.get("control", name))
    return _powers(parameters()[name].unit, power)


def state_exponents(name: str, device: dict[str, float | str]) -> tuple[float, float]:
    """Powers of mass and length in the unit of a state: most are lengths or velocities."""
    if name == "control_change":
        return exponents("control_upper", device)
    aging = name == "friction_state" and device.get("friction") == "rate_state"
    return (0.0, 0.0) if aging else (0.0, 1.0)


def _powers(unit: str, power: float = 1.0) -> tuple[float, float]:
    mass = length = 0.0
    sign = 1
    for part in re.split(r"([*/])", unit):
        if part in ("*", "/"):
            sign = 1 if part == "*" else -1
            continue
        base, _, raised = part.partition("^")
        times = sign * (-power if raised == "-n" else int(raised or 1))
        mass, length = mass + times * _UNITS[base][0], length + times * _UNITS[base][1]
    return mass, length


def in_units(
    device: dict[str, float | str], *, mass: float = 1.0, length: float = 1.0
) -> dict[str, float | str]:
    """The same device for forces `mass * length` times and motions `length` times as large.

    Parameters that are not given but have a default with such a unit (`transition_velocity`,
    `stribeck_velocity`, `bristle_stiffness`) are written down where the law reads them.
    """
    friction = str(device.get("friction", "none"))
    found: dict[str, float | str] = {}
    for name, declared in parameters().items():
        read = friction in declared.laws or (
            name == "transition_velocity" and (friction != "none" or "load_friction" in device)
        )
        value = device.get(name, declared.initial if read else math.nan)
        if isinstance(value, str) or math.isnan(value) or (value == 0.0 and name not in device):
            continue
        of_mass, of_length = exponents(name, device)
        found[name] = value * mass**of_mass * length**of_length
    words = {name: value for name, value in device.items() if isinstance(value, str)}
    for name in lists().keys() & words.keys():
        words[name] = _list_in_units(name, words[name], mass, length)
    return words | found


def _list_in_units(name: str, text: str, mass: float, length: float) -> str:
    """The same for a list, as a text; periods are length, amplitude and phase."""
    declared = lists()[name]
    of_mass, of_length = _powers(declared.unit)
    scale, values = mass**of_mass * length**of_length, [float(word) for word in text.split()]
    if declared.periods:
        factors = (length, scale, 1.0) * (len(values) // 3)
        values = [value * factor for value, factor in zip(values, factors, strict=True)]
    else:
        values = [value * scale for value in values]
    return " ".join(map(repr, values))
