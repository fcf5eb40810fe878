"""Coordinates of a fit: what is searched over, and how it becomes the parameters of a device.

Most coordinates are parameters. Where a parameter's effect depends on another one, the coordinate
is the combination that the data see:

    static_excess   static_force - coulomb_force                     [N]
    presliding      coulomb_force / bristle_stiffness, the distance over which a bristle yields [m]
    bw_level        largest hysteretic Bouc-Wen force (alpha = 1)                      [N]
    bw_shape        beta / (beta + gamma), with beta + gamma = presliding^-bw_exponent       [-]
    series_frequency  sqrt(series_stiffness / inertance) / 2 pi, of the inertance on its shaft  [Hz]
    series_loss     series_damping / (2 sqrt(series_stiffness inertance))                      [-]
    leak_corner     leak_damping / (2 pi inertance), below which a leak lets a motion pass      [Hz]
    gas_push        gas_pressure gas_area, the force of the atmosphere on the piston            [N]
    gas_reach       gas_volume / gas_area, the height of the gas                                [m]
    gas_reach_above  the same of a gas that is compressed as the device lengthens               [m]
    branch_time_1, _2, _3  branch_damping / branch_stiffness, in which a branch relaxes          [s]
    damping_power_knee  damping_knee where damping goes with a power of the speed beyond it  [m/s]
    friction_place  where in the free play before the friction a run begins, where its first force
                    does not tell: -1 ... 1 of half the play   [-], not a device parameter

What the force channel does (see `identify.channel`) has coordinates of its own, no parameters.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from inerter.catalogue import along_stroke, combinations, damper_shape, drive
from inerter.catalogue.combinations import Values
from inerter.catalogue.coordinate import Coordinate
from inerter.catalogue.scales import Range, Scales
from inerter.device_file import LARGEST_DELAY

LOWEST_TONE = 0.2
"""Lowest frequency [Hz] that counts as a tone, and not as a drift or an offset."""
FRICTION_SHARE = 0.1
"""Friction level at which a search begins, per rms force."""


def _zero(s: Scales) -> float:
    return 0.0


def _reach(s: Scales, pressed: float | None = None) -> float:
    """A gas is not pressed to a twentieth of its height, as far as the device shortens, or [m]."""
    pressed, least = -s.travel[0] if pressed is None else pressed, 0.1 * s.displacement
    return 1.05 * max(pressed, least) if np.isfinite(pressed) else least


def _low_pass(channel: str) -> tuple[Coordinate, ...]:
    """The cut-off of a channel's low-pass; its order and kind (1 for Bessel), which are held."""
    name = f"{channel}_filter"
    return (
        Coordinate(
            name=name, unit="Hz", words={name: f"cut-off of the {channel} channel"},
            belongs_to="channel", logarithmic=True, none=None, size=lambda s: s.frequency,
            lower=lambda s: 0.3 * s.frequency, upper=lambda s: 20 * s.highest_frequency,
        ),
        Coordinate(name=f"{name}_order", unit="1", belongs_to="channel", none=None),
        Coordinate(name=f"{name}_bessel", unit="1", belongs_to="channel", none=None),
    )  # fmt: skip


def _branch(number: int) -> tuple[Coordinate, ...]:
    """Stiffness of a viscoelastic branch, and the time in which it relaxes."""
    stiffness, time = f"branch_stiffness_{number}", f"branch_time_{number}"
    return (
        Coordinate(
            name=stiffness, unit="N/m", words={stiffness: f"stiffness of branch {number}"},
            size=lambda s: s.force / s.displacement,
            lower=lambda s: 1e-6 * s.force / s.displacement,
        ),
        Coordinate(
            name=time, unit="s", words={f"branch_damping_{number}": f"damping of branch {number}"},
            logarithmic=True, none=None, size=lambda s: 1 / s.frequency,
            lower=lambda s: 1e-3 / s.frequency, upper=lambda s: s.elapsed,
            to_parameters=combinations.branch,
            of_device=lambda d: getattr(d, f"branch_damping_{number}") / getattr(d, stiffness),
        ),
    )  # fmt: skip


# --- every coordinate --------------------------------------------------------------------------

_ALL = (
    # linear terms
    Coordinate(
        name="inertance", unit="kg", words={"inertance": "b"}, none=None,
        size=lambda s: s.force / s.acceleration, lower=_zero, column=lambda x, v, a, t: a,
    ),
    Coordinate(
        name="viscous", unit="N*s/m", words={"viscous": "c"},
        size=lambda s: s.force / s.velocity, lower=_zero,
        begin=lambda s: 0.01 * s.force / s.velocity, column=lambda x, v, a, t: v,
    ),
    Coordinate(
        name="stiffness", unit="N/m", words={"stiffness": "k"},
        size=lambda s: s.force / s.displacement, column=lambda x, v, a, t: x,
    ),
    Coordinate(
        name="stiffness_cubic", unit="N/m^3", words={"stiffness_cubic": "k3"},
        size=lambda s: s.force / s.displacement**3, column=lambda x, v, a, t: x**3,
    ),
    Coordinate(
        name="rest_length", unit="m", words={"rest_length": "length at rest"},
        size=lambda s: s.displacement, lower=lambda s: 2 * s.travel[0] - s.travel[1],
        upper=lambda s: 2 * s.travel[1] - s.travel[0],
    ),
    Coordinate(
        name="force_offset", unit="N", words={"force_offset": "offset"},
        size=lambda s: s.force, column=lambda x, v, a, t: np.ones_like(v),
    ),
    Coordinate(
        name="quadratic_damping", unit="N*s^2/m^2", words={"quadratic_damping": "c2"},
        size=lambda s: s.force / s.velocity**2, lower=_zero,
        begin=lambda s: 0.01 * s.force / s.velocity**2, column=lambda x, v, a, t: v * np.abs(v),
    ),
    *damper_shape.COORDINATES,
    # friction
    Coordinate(
        name="coulomb_force", unit="N", words={"coulomb_force": "sliding level f_c"},
        size=lambda s: FRICTION_SHARE * s.force, lower=lambda s: 1e-6 * s.force,
    ),
    Coordinate(
        name="static_excess", unit="N", words={"static_force": "breakaway level f_s"},
        size=lambda s: 0.1 * s.force, lower=_zero, upper=lambda s: s.force,
        start=(0.03, 1.5), start_unit=lambda s: FRICTION_SHARE * s.force,
        to_parameters=combinations.breakaway, proportional_to="level",
        of_device=lambda d: max(d.static_force - d.coulomb_force, 0.0),
    ),
    Coordinate(
        name="stribeck_velocity", unit="m/s", words={"stribeck_velocity": "Stribeck velocity v_s"},
        size=lambda s: s.velocity, upper=lambda s: 3 * s.velocity, logarithmic=True, none=None,
        lower=lambda s: min(max(5e-3 * s.velocity, s.speed_resolution), s.velocity),
        start=(0.03, 1.0), start_unit=lambda s: s.velocity,
    ),
    Coordinate(
        name="transition_velocity", unit="m/s", logarithmic=True, none=None, nuisance=True,
        size=lambda s: s.velocity, lower=lambda s: 1e-4 * s.velocity,
        # filters that both channels have round off the jump of a quick sine by that much
        upper=lambda s: (0.3 if s.one_tone else 0.05) * s.velocity,
    ),
    Coordinate(
        name="presliding", unit="m", words={"bristle_stiffness": "bristle stiffness sigma0"},
        size=lambda s: s.displacement, lower=lambda s: 1e-5 * s.displacement,
        upper=lambda s: 3 * s.displacement, logarithmic=True, none=None,
        start=(1e-3, 1.0), start_unit=lambda s: s.displacement, to_parameters=combinations.bristle,
        of_device=lambda d: d.coulomb_force / d.bristle_stiffness,
    ),
    Coordinate(
        name="bristle_damping", unit="N*s/m", words={"bristle_damping": "bristle damping sigma1"},
        size=lambda s: 0.1 * s.force / s.velocity, lower=_zero, proportional_to="level",
        start=(1e-3, 0.3), start_unit=lambda s: s.force / s.velocity,
    ),
    Coordinate(
        name="rate_effect", unit="1", words={"rate_effect": "rise of the level per ln(v), A"},
        size=lambda s: 0.02, lower=_zero, upper=lambda s: 0.5, start=(3e-3, 0.1),
    ),
    Coordinate(
        name="age_effect", unit="1", words={"age_effect": "rise of the level per ln(age), B"},
        size=lambda s: 0.02, lower=_zero, upper=lambda s: 0.5, start=(3e-3, 0.1),
    ),
    Coordinate(
        name="age_distance", unit="m", words={"age_distance": "way that renews the contacts, L"},
        size=lambda s: 0.01 * s.displacement, upper=lambda s: 3 * s.displacement,
        lower=lambda s: min(max(1e-5 * s.displacement, 0.5 * s.place_resolution), s.displacement),
        logarithmic=True, none=None,
        start=(1e-4, 0.3), start_unit=lambda s: s.displacement,
    ),
    Coordinate(
        name="bw_level", unit="N", size=lambda s: 0.1 * s.force, lower=lambda s: 1e-6 * s.force,
    ),
    Coordinate(
        name="bw_shape", unit="1", size=lambda s: 0.5, lower=_zero, upper=lambda s: 5.0,
        start=(0.3, 1.2), none=None,
    ),
    Coordinate(
        name="bw_stiffness", unit="N/m", words={"bw_stiffness": "Bouc-Wen stiffness k0"},
        size=lambda s: s.force / s.displacement, lower=lambda s: 1e-6 * s.force / s.displacement,
        none=None,
    ),
    Coordinate(
        name="bw_beta", unit="m^-n", words={"bw_beta": "beta"}, size=lambda s: 1 / s.displacement,
        start=(0.03, 3.0), start_unit=lambda s: 1 / s.displacement, none=None,
    ),
    Coordinate(
        name="bw_gamma", unit="m^-n", words={"bw_gamma": "gamma"}, none=None,
        size=lambda s: 1 / s.displacement,
    ),
    Coordinate(
        name="bw_ratio", unit="1", words={"bw_ratio": "elastic share A"}, size=lambda s: 0.1,
        lower=lambda s: -0.5, upper=lambda s: 0.9,
    ),
    Coordinate(
        name="bw_exponent", unit="1", words={"bw_exponent": "n"}, size=lambda s: 1.0,
        lower=lambda s: 1.0, upper=lambda s: 6.0, start=(1.05, 2.5), none=None,
    ),
    Coordinate(
        name="friction_backlash", unit="m",
        words={"friction_backlash": "half of the free play before the friction"},
        size=lambda s: s.displacement, logarithmic=True,
        lower=lambda s: 1e-5 * s.displacement, upper=lambda s: 2 * s.displacement,
        start=(1e-3, 0.3), start_unit=lambda s: s.displacement,
    ),
    Coordinate(
        name="friction_place", unit="1", lower=lambda s: -1.0, upper=lambda s: 1.0,
        start=(-0.75, 0.75), belongs_to="run", nuisance=True,
    ),
    Coordinate(
        name="load_friction", unit="1", words={"load_friction": "mu"}, size=lambda s: 0.1,
        lower=_zero, upper=lambda s: 0.95, begin=lambda s: 0.01, start=(0.01, 0.05),
        jumps=True, entangled=True, also=("mu_forward", "mu_backward"),
    ),
    # a friction level that varies
    Coordinate(
        name="friction_asymmetry", unit="1", words={"friction_asymmetry": "asymmetry"},
        size=lambda s: 0.1, lower=lambda s: -0.95, upper=lambda s: 0.95,
    ),
    Coordinate(
        name="friction_gradient", unit="1/m",
        words={"friction_gradient": "gradient along the stroke"},
        size=lambda s: 0.1 / s.displacement, lower=lambda s: -3 / s.displacement,
        upper=lambda s: 3 / s.displacement,
    ),
    Coordinate(
        name="friction_curvature", unit="1/m^2",
        words={"friction_curvature": "curvature along the stroke"},
        size=lambda s: 0.1 / s.displacement**2, lower=lambda s: -3 / s.displacement**2,
        upper=lambda s: 3 / s.displacement**2,
    ),
    # an inertance that varies
    Coordinate(
        name="inertance_gradient", unit="1/m", entangled=True,
        words={"inertance_gradient": "gradient of b along the stroke"},
        size=lambda s: 0.1 / s.displacement, lower=lambda s: -3 / s.displacement,
        upper=lambda s: 3 / s.displacement,
    ),
    Coordinate(
        name="inertance_curvature", unit="1/m^2", entangled=True,
        words={"inertance_curvature": "curvature of b along the stroke"},
        size=lambda s: 0.1 / s.displacement**2, lower=lambda s: -3 / s.displacement**2,
        upper=lambda s: 3 / s.displacement**2,
    ),
    Coordinate(
        name="inertance_speed_gradient", unit="s/m", entangled=True,
        words={"inertance_speed_gradient": "gradient of b along the speed"},
        size=lambda s: 0.1 / s.velocity, lower=lambda s: -3 / s.velocity,
        upper=lambda s: 3 / s.velocity,
    ),
    # between the terminal and the flywheel
    *drive.COORDINATES,
    *_branch(1), *_branch(2), *_branch(3),
    *along_stroke.COORDINATES,
    # stops
    Coordinate(
        name="stop_lower", unit="m", words={"stop_lower": "lower stop"}, jumps=True,
        size=lambda s: s.displacement, lower=lambda s: s.travel[0],
        upper=lambda s: s.middle - 1e-3 * s.displacement,
    ),
    Coordinate(
        name="stop_upper", unit="m", words={"stop_upper": "upper stop"}, jumps=True,
        size=lambda s: s.displacement, lower=lambda s: s.middle + 1e-3 * s.displacement,
        upper=lambda s: s.travel[1],
    ),
    Coordinate(
        name="stop_stiffness", unit="N/m", words={"stop_stiffness": "stop stiffness k_e"},
        jumps=True, size=lambda s: s.force / s.displacement, logarithmic=True,
        lower=lambda s: 0.01 * s.force / s.displacement,
        upper=lambda s: 1e6 * s.force / s.displacement,
    ),
    Coordinate(
        name="stop_stiffness_cubic", unit="N/m^3", jumps=True,
        words={"stop_stiffness_cubic": "rise of the stop stiffness k_e3"},
        size=lambda s: 100 * s.force / s.displacement**3, lower=_zero,
    ),
    Coordinate(
        name="stop_damping", unit="s/m", words={"stop_damping": "stop damping"}, jumps=True,
        size=lambda s: 1 / s.velocity, lower=_zero,
    ),
    # gas
    Coordinate(
        name="gas_push", unit="N",
        words={"gas_pressure": "pressure p0", "gas_area": "piston area A"},
        size=lambda s: s.force, lower=lambda s: 1e-4 * s.force, upper=lambda s: 1e4 * s.force,
        logarithmic=True, to_parameters=combinations.gas,
        of_device=lambda d: d.gas_pressure * abs(d.gas_area),
    ),
    Coordinate(
        name="gas_reach", unit="m", words={"gas_volume": "volume V0"},
        size=lambda s: s.displacement, lower=_reach, upper=lambda s: 1e3 * s.displacement,
        logarithmic=True, of_device=lambda d: d.gas_volume / abs(d.gas_area),
    ),
    Coordinate(
        name="gas_reach_above", unit="m", words={"gas_volume": "volume V0"},
        size=lambda s: s.displacement, lower=lambda s: _reach(s, s.travel[1]),
        upper=lambda s: 1e3 * s.displacement, logarithmic=True,
        of_device=lambda d: d.gas_volume / abs(d.gas_area),
    ),
    Coordinate(
        name="gas_exponent", unit="1", words={"gas_exponent": "exponent gamma"},
        size=lambda s: 1.0, lower=lambda s: 1.0, upper=lambda s: 1.7,
    ),
    # the force channel
    Coordinate(
        name="delay", unit="s", words={"delay": "delay"}, belongs_to="channel",
        size=lambda s: 1e-3, lower=lambda s: -LARGEST_DELAY, upper=lambda s: LARGEST_DELAY,
    ),
    *_low_pass("force"),
    *_low_pass("displacement"),
    Coordinate(
        name="force_drift", unit="N/s", words={"force_drift": "drift"}, belongs_to="channel",
        size=lambda s: s.force / s.elapsed, column=lambda x, v, a, t: t,
    ),
    Coordinate(
        name="force_coupling", unit="Hz", words={"force_coupling": "lowest frequency"},
        belongs_to="channel", logarithmic=True, none=None, size=lambda s: s.frequency,
        lower=lambda s: 0.5 / np.pi / s.run_length, upper=lambda s: 3 * s.frequency,
    ),
    Coordinate(
        name="settling_time", unit="s", words={"settling_time": "time in which it settles"},
        belongs_to="channel", logarithmic=True, none=None, size=lambda s: 1 / s.frequency,
        lower=lambda s: 0.3 / s.frequency,
        upper=lambda s: max(s.run_length, 0.6 / s.frequency),
    ),
    Coordinate(
        name="grip_mass", unit="kg", words={"grip_mass": "mass before the shaft"}, lower=_zero,
        belongs_to="channel", size=lambda s: s.force / s.acceleration, column=lambda x, v, a, t: a,
        begin=lambda s: 0.01 * s.force / s.acceleration,
    ),
    Coordinate(
        name="force_maximum", unit="N", words={"force_maximum": "upper limit"},
        belongs_to="channel", size=lambda s: s.force,
    ),
    Coordinate(
        name="force_minimum", unit="N", words={"force_minimum": "lower limit"},
        belongs_to="channel", size=lambda s: s.force,
    ),
    Coordinate(
        name="disturbance_amplitude", unit="N", words={"disturbance_amplitude": "amplitude"},
        belongs_to="channel", size=lambda s: 0.1 * s.force, lower=_zero,
    ),
    Coordinate(
        name="disturbance_frequency", unit="Hz", words={"disturbance_frequency": "frequency"},
        belongs_to="channel", size=lambda s: 1 / s.elapsed, lower=lambda s: LOWEST_TONE,
    ),
    # of the device, but a device of a simulator knows no clock: the record has them, as its channel
    Coordinate(
        name="viscous_drift", unit="1/s", words={"viscous_drift": "drift of the viscous damping"},
        size=lambda s: 0.5 / s.elapsed, lower=lambda s: -0.95 / s.elapsed, belongs_to="channel",
    ),
    Coordinate(
        name="friction_drift", unit="1/s", words={"friction_drift": "drift of the friction level"},
        size=lambda s: 0.5 / s.elapsed, lower=lambda s: -0.95 / s.elapsed, belongs_to="channel",
    ),
)  # fmt: skip

COORDINATES: Mapping[str, Coordinate] = MappingProxyType({each.name: each for each in _ALL})
"""Every coordinate by its name."""

# a level that breaks away is told from the distance of a bristle before that is taken
_CONVERTED = tuple(
    COORDINATES[name]
    for name in (
        "gas_push",
        "series_frequency",
        "leak_corner",
        "static_excess",
        "presliding",
        "branch_time_1",
        "damping_power_knee",
    )
)

CHANNEL_UNITS: Mapping[str, str] = MappingProxyType(
    {each.name: each.unit for each in _ALL if each.belongs_to == "channel"}
)
"""Units of what the force channel does."""
NOT_OF_DEVICE = tuple(each.name for each in _ALL if each.belongs_to != "device")
"""Coordinates of the record: of its force channel, of where its runs begin."""
NUISANCES = tuple(each.name for each in _ALL if each.nuisance)
"""Coordinates that name no effect."""
_BENT = tuple(each.name for each in damper_shape.COORDINATES)
ENTANGLED: Mapping[str, tuple[str, ...]] = MappingProxyType({
    "inertance": (
        *(each.name for each in _ALL if each.entangled),
        "gas_pressure", "series_stiffness", "series_damping", "leak_damping",
    ),
    "viscous": (*_BENT, "viscous_drift"), "quadratic_damping": _BENT,
})  # fmt: skip
"""With one of these the force is no longer the coordinate times its column."""
JUMPS = tuple(name for each in _ALL if each.jumps for name in (each.name, *each.also))
"""Beside the friction laws' own, those by which a force is not smooth in the motion."""
BENDS = (
    "stiffness_cubic", "quadratic_damping", *_BENT, "leak_quadratic_damping",
    "inertance_gradient", "inertance_curvature", "inertance_speed_gradient",
    "gas_pressure", "gas_area", "gas_volume", "gas_exponent",
)  # fmt: skip
"""Those by which it is not linear in the motion, and has harmonics that the motion has not."""
PARAMETER_WORDS: Mapping[str, str] = MappingProxyType(
    {name: words for each in _ALL for name, words in each.words.items()}
)
"""What the parameters of a finding are called in running text."""


@functools.lru_cache(maxsize=512)
def search_range(name: str, sizes: Scales) -> Range:
    """How a coordinate is searched, given the sizes of the data's channels."""
    return COORDINATES[name].range(sizes)


def parameters_of(coordinates: Mapping[str, float]) -> Values:
    """Parameters of the device that coordinates stand for (without what is none of the device)."""
    values = {name: value for name, value in coordinates.items() if name not in NOT_OF_DEVICE}
    for each in _CONVERTED:
        if each.name in values and each.to_parameters:
            each.to_parameters(values)
    # of a law that is there no more
    values.pop("bw_level", None)
    along_stroke.told(values)
    return values


def device_values(coordinates: Mapping[str, float]) -> dict[str, float | tuple[float, ...]]:
    """What a device is made of: parameters and lists."""
    values = {name: float(value) for name, value in parameters_of(coordinates).items()}
    return {**along_stroke.lists(values), **values}


def parameter_names(coordinate: str) -> tuple[str, ...]:
    """Parameters that a coordinate stands for."""
    known = COORDINATES.get(coordinate)
    return tuple(known.words) if known and known.words else (coordinate,)
