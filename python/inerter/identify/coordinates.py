"""Coordinates of a fit: what is searched over, and how it becomes the parameters of a device.

Most coordinates are parameters. Where a parameter's effect depends on another one, the coordinate
is the combination that the data see:

    static_excess   static_force - coulomb_force                     [N]
    presliding      coulomb_force / bristle_stiffness, the distance over which a bristle yields [m]
    bw_level        largest hysteretic Bouc-Wen force (alpha = 1)                      [N]
    bw_shape        beta / (beta + gamma), with beta + gamma = presliding^-bw_exponent       [-]
    series_frequency  sqrt(series_stiffness / inertance) / 2 pi, of the inertance on its shaft  [Hz]
    series_loss     series_damping / (2 sqrt(series_stiffness inertance))                      [-]
    gas_push        gas_pressure gas_area, the force of the atmosphere on the piston            [N]
    gas_reach       gas_volume / gas_area, the height of the gas                                [m]
    friction_place  where in the free play before the friction a run begins, where its first force
                    does not tell: -1 ... 1 of half the play   [-], not a device parameter

What the force channel does (see `channel`) has coordinates of its own, which are no parameters.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from inerter.device_file import LARGEST_DELAY
from inerter.identify.channel import UNITS

LOWEST_TONE = 0.2
"""Lowest frequency [Hz] that counts as a tone, and not as a drift or an offset."""


@dataclass(frozen=True)
class Scales:
    """Typical sizes of a data set's channels: rms about the mean, SI units; cut-off [Hz].

    one_tone: the motion is so nearly one sine that displacement and acceleration are proportional.
    travel, force_range: least and largest displacement [m] and measured force [N]; elapsed: longest
    elapsed time [s].
    """

    force: float
    displacement: float
    velocity: float
    acceleration: float
    cutoff: float = np.inf
    one_tone: bool = False
    travel: tuple[float, float] = (-np.inf, np.inf)
    elapsed: float = 1.0
    force_range: tuple[float, float] = (-np.inf, np.inf)

    @property
    def frequency(self) -> float:
        """Typical frequency of the motion [Hz]."""
        return float(np.sqrt(self.acceleration / self.displacement)) / (2 * np.pi)


@dataclass(frozen=True)
class Coordinate:
    """How one coordinate is searched: its typical size, bounds, and whether over its logarithm."""

    size: float
    lower: float
    upper: float
    logarithmic: bool = False

    def encode(self, value: float) -> float:
        """Coordinate value to search variable."""
        value = float(min(max(value, self.lower), self.upper))
        return float(np.log(value)) if self.logarithmic else value / self.size

    def decode(self, variable: float) -> float:
        """Search variable to coordinate value."""
        if self.logarithmic:
            low, high = self.bounds
            return float(np.exp(min(max(variable, low), high)))
        return float(min(max(variable * self.size, self.lower), self.upper))

    @functools.cached_property
    def bounds(self) -> tuple[float, float]:
        """Bounds of the search variable."""
        if self.logarithmic:
            return float(np.log(self.lower)), float(np.log(self.upper))
        return self.lower / self.size, self.upper / self.size


# force per coordinate: these enter the force linearly, with these columns
LINEAR = (
    "inertance",
    "viscous",
    "stiffness",
    "stiffness_cubic",
    "force_offset",
    "quadratic_damping",
    "force_drift",
)


GAS_AREA = 1e-3
"""Piston area [m^2] that a gas is reported under where none is stated: a force has p0 A, V0 / A."""

NOT_OF_DEVICE = (*UNITS, "friction_place")
"""Coordinates of the record: of its force channel, of where its runs begin."""


@functools.lru_cache(maxsize=512)
def coordinate(name: str, scales: Scales) -> Coordinate:
    """How a coordinate is searched, given the sizes of the data's channels."""
    force, x, v, a = scales.force, scales.displacement, scales.velocity, scales.acceleration
    infinity = np.inf

    # what the velocity changes by within the smoother's memory: nothing narrower can be seen
    resolution = 0.5 * a / (2 * np.pi * scales.cutoff)

    # frequency of the motion, and the highest one that is told from noise
    slow = scales.frequency

    low, high = scales.travel
    middle = 0.5 * (low + high) if np.isfinite(scales.travel).all() else 0.0

    # a gas is not pressed to a twentieth of its height
    reach = 1.05 * max(-low, 0.1 * x) if np.isfinite(low) else 0.1 * x
    fast = scales.cutoff if np.isfinite(scales.cutoff) else 100 * slow
    table = {
        "inertance": Coordinate(force / a, 0, infinity),
        "inertance_gradient": Coordinate(0.1 / x, -3 / x, 3 / x),
        "inertance_curvature": Coordinate(0.1 / x**2, -3 / x**2, 3 / x**2),
        "viscous": Coordinate(force / v, 0, infinity),
        "stiffness": Coordinate(force / x, -infinity, infinity),
        "stiffness_cubic": Coordinate(force / x**3, -infinity, infinity),
        "force_offset": Coordinate(force, -infinity, infinity),
        "quadratic_damping": Coordinate(force / v**2, 0, infinity),
        "load_friction": Coordinate(0.1, 0, 0.95),
        "coulomb_force": Coordinate(0.1 * force, 1e-6 * force, infinity),
        "static_excess": Coordinate(0.1 * force, 0, force),
        "stribeck_velocity": Coordinate(
            v, min(max(5e-3 * v, resolution), v), 3 * v, logarithmic=True
        ),
        "transition_velocity": Coordinate(v, 1e-4 * v, 0.05 * v, logarithmic=True),
        "presliding": Coordinate(x, 1e-5 * x, 3 * x, logarithmic=True),
        "bristle_damping": Coordinate(0.1 * force / v, 0, infinity),
        "friction_asymmetry": Coordinate(0.1, -0.95, 0.95),
        "friction_gradient": Coordinate(0.1 / x, -3 / x, 3 / x),
        "friction_curvature": Coordinate(0.1 / x**2, -3 / x**2, 3 / x**2),
        "bw_level": Coordinate(0.1 * force, 1e-6 * force, infinity),
        "bw_shape": Coordinate(0.5, 0.0, 5.0),
        "bw_stiffness": Coordinate(force / x, 1e-6 * force / x, infinity),
        "bw_beta": Coordinate(1 / x, -infinity, infinity),
        "bw_gamma": Coordinate(1 / x, -infinity, infinity),
        "bw_ratio": Coordinate(0.1, -0.5, 0.9),
        "bw_exponent": Coordinate(1.0, 1.0, 6.0),
        "series_frequency": Coordinate(slow, 0.1 * slow, 8 * fast, logarithmic=True),
        "series_loss": Coordinate(0.1, 1e-4, 1e2, logarithmic=True),
        "series_hardening": Coordinate(0.1 / x, -3 / x, 3 / x),
        "flywheel_viscous": Coordinate(force / v, 0, infinity),
        "inertance_speed_gradient": Coordinate(0.1 / v, -3 / v, 3 / v),
        "backlash": Coordinate(x, 1e-5 * x, 2 * x, logarithmic=True),
        "stop_lower": Coordinate(x, low, middle - 1e-3 * x),
        "stop_upper": Coordinate(x, middle + 1e-3 * x, high),
        "stop_stiffness": Coordinate(force / x, 0.01 * force / x, 1e6 * force / x, True),
        "stop_damping": Coordinate(1 / v, 0, infinity),
        "gas_push": Coordinate(force, 1e-4 * force, 1e4 * force, logarithmic=True),
        "gas_reach": Coordinate(x, reach, 1e3 * x, logarithmic=True),
        "gas_exponent": Coordinate(1.0, 1.0, 1.7),
        "friction_backlash": Coordinate(x, 1e-5 * x, 2 * x, logarithmic=True),
        "friction_place": Coordinate(1.0, -1.0, 1.0),
        "delay": Coordinate(1e-3, -LARGEST_DELAY, LARGEST_DELAY),
        "force_drift": Coordinate(force / scales.elapsed, -infinity, infinity),
        "friction_drift": Coordinate(0.5 / scales.elapsed, -0.95 / scales.elapsed, infinity),
        "force_maximum": Coordinate(force, -infinity, infinity),
        "force_minimum": Coordinate(force, -infinity, infinity),
        "disturbance_amplitude": Coordinate(0.1 * force, 0, infinity),
        "disturbance_frequency": Coordinate(1 / scales.elapsed, LOWEST_TONE, infinity),
    }
    return table[name]


def device_values(coordinates: Mapping[str, float]) -> dict[str, float]:
    """Parameters of the device that coordinates stand for (without what is none of the device)."""
    values = {name: value for name, value in coordinates.items() if name not in NOT_OF_DEVICE}
    if (push := values.pop("gas_push", None)) is not None:
        area = values.setdefault("gas_area", values.get("piston_area", GAS_AREA))
        values |= {"gas_pressure": push / area, "gas_volume": values.pop("gas_reach") * area}
    presliding = values.pop("presliding", None)
    if (frequency := values.pop("series_frequency", None)) is not None:
        rate, inertance = 2 * np.pi * frequency, values["inertance"]
        values["series_stiffness"] = inertance * rate**2
        if (loss := values.pop("series_loss", None)) is not None:
            values["series_damping"] = 2 * loss * rate * inertance
    if (excess := values.pop("static_excess", None)) is not None:
        values["static_force"] = values["coulomb_force"] + excess
        if presliding is None and {"transition_velocity", "stribeck_velocity"} <= values.keys():
            # a rise wider than the fall would take breakaway away again
            narrow = values["stribeck_velocity"] / 5
            values["transition_velocity"] = min(values["transition_velocity"], narrow)
    if (level := values.pop("bw_level", None)) is not None and presliding is not None:
        shape = values.pop("bw_shape")
        limit = presliding ** -values.get("bw_exponent", 1.0)
        values |= {
            "bw_stiffness": level / presliding / (1 - values.get("bw_ratio", 0.0)),
            "bw_beta": shape * limit,
            "bw_gamma": (1 - shape) * limit,
        }
    elif presliding is not None:
        values["bristle_stiffness"] = values["coulomb_force"] / presliding
    return values
