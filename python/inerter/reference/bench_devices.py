"""Random effects of a drawn size on an ideal inerter.

Most effects are sized by their share of the force, rms(F - b a) / rms(F), drawn from 5 to 40 %.
With the law's shape fixed such an effect is linear in one size p, so p solves

    p^2 <e e> (1 - s^2) - 2 s^2 p <i e> - s^2 <i i> = 0,   i = b a, e the effect at p = 1.

Sized otherwise: a stated inertance that is 3 to 20 % off; a half gap of 0.5 to 10 % of the
smallest stroke; a shaft whose resonance lies at 1.5 to 6 times, a low-pass whose cut-off at 1.5 to
4 times the highest frequency of the motion; a variable inertance whose factor stays within 0.3 ..
1.7 (so its share may stay lower); a force channel that clips 2 to 15 % of the samples.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from .bench_channel import Channel, Situation, answers, draw_filter
from .bench_effects import FRICTION_LAWS, LEVEL_CHANGES
from .bench_motions import Drive, highest_frequency, is_free_of
from .device import ReferenceDevice
from .sizes import rms, rounded, size_for_share


@dataclass(frozen=True)
class Drawn:
    """What an effect adds to the device and to the channel, and which of it was hidden."""

    device: dict[str, float | str] = field(default_factory=dict)
    channel: dict[str, float] = field(default_factory=dict)
    names: tuple[str, ...] = ()
    stated: dict[str, float] | None = None


@dataclass(frozen=True, kw_only=True)
class _Unit:
    """An effect of unit size; `scaling` lists what grows with it, `share` bounds what is drawn."""

    device: ReferenceDevice
    channel: Channel
    scaling: tuple[str, ...]
    names: tuple[str, ...]
    share: tuple[float, float] = (0.05, 0.40)
    largest: float = np.inf


def draw_effect(
    draw: Generator, effect: str, law: str | None, ideal: ReferenceDevice, runs: list[Situation]
) -> Drawn:
    """An effect on the ideal device, sized as if it were alone.

    Raises
    ------
    KeyError
        Saturation, which needs the force of the whole device: see `draw_limits`.
    """
    drives = [run.drive for run in runs]
    if effect in _UNSIZED:
        return _UNSIZED[effect](draw, ideal, drives)
    if effect in _UNITS:
        unit = _UNITS[effect](draw, ideal, runs)
    elif effect == "hysteretic_friction":
        travel = min(float(np.max(abs(drive.displacement))) for drive in drives)
        device, scaling, names = _unit_hysteresis(draw, str(law), ideal, travel)
        unit = _Unit(device=device, channel=Channel(), scaling=scaling, names=names)
    else:
        unit = _plain(draw, effect, ideal)

    share = draw.uniform(*unit.share)
    size = min(_size_for_share(share, ideal, unit, runs), unit.largest)
    sized = {
        key: rounded(getattr(unit.device if hasattr(ideal, key) else unit.channel, key) * size)
        for key in unit.scaling
    }
    device = replace(unit.device, **{k: v for k, v in sized.items() if hasattr(ideal, k)})
    channel = replace(unit.channel, **{k: v for k, v in sized.items() if not hasattr(ideal, k)})
    return Drawn(_differences(device, ideal), _differences(channel, Channel()), unit.names)


def joined(effects: tuple[str, ...], drawn: list[Drawn], ideal: ReferenceDevice) -> Drawn:
    """Several effects in one: the level of a friction law is that of the law, else of the first.

    `names` is then empty: see `own_names`.
    """
    device: dict[str, float | str] = {}
    channel: dict[str, float] = {}
    stated = None
    for effect, part in zip(effects, drawn, strict=True):
        borrowed = _borrows(effect, effects)
        device |= {k: v for k, v in part.device.items() if not borrowed or k not in _LEVEL}
        channel |= part.channel
        stated = stated if part.stated is None else part.stated
    return Drawn(device, channel, (), stated)


def own_names(effect: str, effects: tuple[str, ...], part: Drawn) -> tuple[str, ...]:
    """The parameters by which an effect is known among others."""
    borrowed = _borrows(effect, effects)
    return tuple(name for name in part.names if not borrowed or name not in _LEVEL)


_LEVEL = ("friction", "coulomb_force")


def _borrows(effect: str, effects: tuple[str, ...]) -> bool:
    """Whether an effect changes a level that another effect of the case brings."""
    owners = [name for name in effects if name in FRICTION_LAWS]
    owners += [name for name in effects if name in LEVEL_CHANGES]
    return effect in LEVEL_CHANGES and owners[0] != effect


def draw_limits(draw: Generator, force: NDArray[np.float64]) -> Drawn:
    """A sensor's range that clips 2 to 15 % of the force [N], shape (n,); a third on one side."""
    clipped = draw.uniform(0.02, 0.15)
    side = str(draw.choice(["both", "both", "both", "both", "upper", "lower"]))
    if side == "both":
        limit = rounded(np.quantile(abs(force), 1.0 - clipped))
        found = {"force_minimum": -limit, "force_maximum": limit}
    elif side == "upper":
        found = {"force_maximum": rounded(np.quantile(force, 1.0 - clipped))}
    else:
        found = {"force_minimum": rounded(np.quantile(force, clipped))}
    return Drawn({}, found, tuple(found))


# effects of unit size


def _stribeck(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    drives = [run.drive for run in runs]
    speed = float(np.median([rms(np.asarray(d.motion.velocity(d.time))) for d in drives]))
    unit = replace(
        ideal,
        friction="stribeck",
        coulomb_force=1.0,
        static_force=rounded(draw.uniform(1.5, 2.5)),
        stribeck_velocity=rounded(speed * draw.uniform(0.1, 0.4)),
    )
    scaling = ("coulomb_force", "static_force")
    return _Unit(
        device=unit, channel=Channel(), scaling=scaling, names=(*scaling, "stribeck_velocity")
    )


def _asymmetric(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    asymmetry = rounded(draw.uniform(0.2, 0.6) * draw.choice([-1.0, 1.0]))
    unit = replace(ideal, friction="coulomb", coulomb_force=1.0, friction_asymmetry=asymmetry)
    return _Unit(
        device=unit,
        channel=Channel(),
        scaling=("coulomb_force",),
        names=("coulomb_force", "friction_asymmetry"),
    )


def _uneven_damper(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    asymmetry = rounded(draw.uniform(0.2, 0.6) * draw.choice([-1.0, 1.0]))
    return _Unit(
        device=replace(ideal, viscous=1.0, damping_asymmetry=asymmetry),
        channel=Channel(),
        scaling=("viscous",),
        names=("viscous", "damping_asymmetry"),
    )


def _digressive(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    drives = [run.drive for run in runs]
    speed = float(np.median([rms(np.asarray(d.motion.velocity(d.time))) for d in drives]))
    unit = replace(
        ideal,
        viscous=1.0,
        damping_knee=rounded(speed * draw.uniform(0.3, 1.0)),
        damping_beyond=rounded(draw.uniform(0.1, 0.4)),
    )
    names = ("viscous", "damping_knee", "damping_beyond")
    return _Unit(device=unit, channel=Channel(), scaling=("viscous",), names=names)


def _position(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    gradient, curvature = _draw_level(draw, _travel(runs))
    unit = replace(
        ideal,
        friction="coulomb",
        coulomb_force=1.0,
        friction_gradient=gradient,
        friction_curvature=curvature,
    )
    names = ("coulomb_force", "friction_gradient", "friction_curvature")
    return _Unit(device=unit, channel=Channel(), scaling=("coulomb_force",), names=names)


def _friction_drift(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    # 30 to 100 % over the whole set; a level that falls keeps a twentieth
    change = draw.uniform(0.3, 1.0) * draw.choice([-1.0, 1.0])
    whole = runs[-1].start + float(runs[-1].drive.time[-1])
    channel = Channel(friction_drift=rounded(max(change, -0.95) / whole))
    unit = replace(ideal, friction="coulomb", coulomb_force=1.0)
    return _Unit(
        device=unit,
        channel=channel,
        scaling=("coulomb_force",),
        names=("coulomb_force", "friction_drift"),
    )


def _gas(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    area = rounded(np.exp(draw.uniform(np.log(1e-4), np.log(2e-3))))
    # at the end of the stroke half to a fifth of the gas is compressed away
    reach = _travel(runs) * draw.uniform(1.5, 4.0)
    unit = replace(
        ideal,
        gas_pressure=1.0 / area,
        gas_area=area,
        gas_volume=rounded(area * reach),
        gas_exponent=rounded(draw.uniform(1.05, 1.38)),
    )
    names = ("gas_pressure", "gas_area", "gas_volume", "gas_exponent")
    return _Unit(device=unit, channel=Channel(), scaling=("gas_pressure",), names=names)


def _end_stop(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    x = np.concatenate([run.drive.displacement for run in runs])
    v = np.concatenate([np.asarray(run.drive.motion.velocity(run.drive.time)) for run in runs])
    time = draw.uniform(0.03, 0.20)
    side = str(draw.choice(["upper", "lower", "both"]))
    within = 0.5 * time if side == "both" else time
    stops: dict[str, float] = {}
    if side != "lower":
        stops["stop_upper"] = rounded(float(np.quantile(x, 1.0 - within)))
    if side != "upper":
        stops["stop_lower"] = rounded(float(np.quantile(x, within)))
    damping = rounded(draw.uniform(0.1, 0.5) / float(np.max(abs(v))))
    unit = replace(ideal, **stops, stop_stiffness=1.0, stop_damping=damping)
    names = (*stops, "stop_stiffness", "stop_damping")
    return _Unit(
        device=unit, channel=Channel(), scaling=("stop_stiffness",), names=names, share=(0.10, 0.40)
    )


def _variable(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    kind = int(draw.integers(0, 4))
    sign = float(draw.choice([-1.0, 1.0]))
    names = (
        ("inertance_gradient",),
        ("inertance_curvature",),
        ("inertance_gradient", "inertance_curvature"),
        ("inertance_speed_gradient",),
    )[kind]
    travel = _travel(runs)
    fastest = max(float(np.max(abs(r.drive.motion.velocity(r.drive.time)))) for r in runs)
    ends = {
        "inertance_gradient": travel,
        "inertance_curvature": travel**2,
        "inertance_speed_gradient": fastest,
    }
    # the factor changes by 0.1 at the end of the stroke or of the speed; seven times that at most
    part = 0.1 / len(names)
    signs = [sign, float(draw.choice([-1.0, 1.0]))]
    values = {n: s * part / ends[n] for n, s in zip(names, signs, strict=False)}
    return _Unit(
        device=replace(ideal, **values),
        channel=Channel(),
        scaling=names,
        names=names,
        share=(0.05, 0.30),
        largest=7.0,
    )


def _tone(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    drives = [run.drive for run in runs]
    frequency = 45.0
    for _ in range(100):
        frequency = rounded(np.exp(draw.uniform(np.log(0.5), np.log(45.0))))
        if is_free_of(drives, frequency):
            break
    channel = Channel(disturbance_amplitude=1.0, disturbance_frequency=frequency)
    names = ("disturbance_amplitude", "disturbance_frequency")
    return _Unit(device=ideal, channel=channel, scaling=names[:1], names=names)


def _force_drift(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> _Unit:
    names = ("force_drift",)
    return _Unit(
        device=ideal,
        channel=Channel(force_drift=float(draw.choice([-1.0, 1.0]))),
        scaling=names,
        names=names,
    )


def _plain(draw: Generator, effect: str, ideal: ReferenceDevice) -> _Unit:
    """One parameter in proportion to the force."""
    key = _SIZES[effect]
    sign = float(draw.choice([-1.0, 1.0])) if effect == "force_offset" else 1.0
    friction = "coulomb" if effect == "coulomb_friction" else "none"
    # load friction is linear only up to 1, so its unit stays below
    size = 0.5 if effect == "load_dependent_friction" else sign
    return _Unit(
        device=replace(ideal, friction=friction, **{key: size}),
        channel=Channel(),
        scaling=(key,),
        names=(key,),
    )


_SIZES = {
    "viscous_friction": "viscous",
    "coulomb_friction": "coulomb_force",
    "load_dependent_friction": "load_friction",
    "parallel_stiffness": "stiffness",
    "hardening_stiffness": "stiffness_cubic",
    "force_offset": "force_offset",
    "quadratic_damping": "quadratic_damping",
}

_UNITS: dict[str, Callable[[Generator, ReferenceDevice, list[Situation]], _Unit]] = {
    "stribeck_friction": _stribeck,
    "asymmetric_friction": _asymmetric,
    "damper_asymmetry": _uneven_damper,
    "digressive_damping": _digressive,
    "position_dependent_friction": _position,
    "friction_drift": _friction_drift,
    "gas_spring": _gas,
    "end_stop": _end_stop,
    "variable_inertance": _variable,
    "periodic_disturbance": _tone,
    "force_drift": _force_drift,
}


def _draw_level(draw: Generator, travel: float) -> tuple[float, float]:
    """Gradient [1/m] and curvature [1/m^2] that keep the level within 0.1 .. 1.9 of its middle."""
    slope = draw.uniform(0.3, 0.8) * draw.choice([-1.0, 1.0])
    bend = draw.uniform(0.3, 0.8) * draw.choice([-1.0, 1.0])
    kind = int(draw.integers(0, 3))
    if kind == 0:
        bend = 0.0
    elif kind == 1:
        slope = 0.0
    else:
        slope, bend = 0.5 * slope, 0.5 * bend
    return rounded(slope / travel), rounded(bend / travel**2)


def _unit_hysteresis(
    draw: Generator, law: str, ideal: ReferenceDevice, travel: float
) -> tuple[ReferenceDevice, tuple[str, ...], tuple[str, ...]]:
    """A law that saturates at unit force after 5 to 50 % of the smallest run's travel [m]."""
    reach = float(np.exp(draw.uniform(np.log(0.05), np.log(0.5)))) * travel
    if law == "bouc_wen":
        exponent = rounded(draw.uniform(1.0, 2.0))
        narrowing = reach**-exponent
        shape = draw.uniform(0.5, 0.9)
        unit = replace(
            ideal,
            friction=law,
            bw_beta=rounded(shape * narrowing),
            bw_gamma=rounded((1.0 - shape) * narrowing),
            bw_exponent=exponent,
            bw_ratio=rounded(draw.uniform(0.0, 0.1)),
            bw_stiffness=1.0 / reach,
        )
        names = ("bw_alpha", "bw_beta", "bw_gamma", "bw_exponent", "bw_stiffness", "bw_ratio")
        return unit, ("bw_stiffness",), names
    scaling: tuple[str, ...] = ("coulomb_force", "bristle_stiffness")
    if law == "dahl":
        unit = replace(ideal, friction=law, coulomb_force=1.0, bristle_stiffness=1.0 / reach)
        return unit, scaling, scaling
    unit = replace(
        ideal,
        friction=law,
        coulomb_force=1.0,
        bristle_stiffness=1.0 / reach,
        static_force=rounded(draw.uniform(1.3, 2.0)),
        stribeck_velocity=rounded(np.exp(draw.uniform(np.log(3e-3), np.log(3e-2)))),
        bristle_damping=draw.uniform(0.2e-3, 1e-3) / reach,
    )
    scaling = (*scaling, "static_force", "bristle_damping")
    return unit, scaling, (*scaling, "stribeck_velocity")


# effects whose size is not a share of the force


def _delay(draw: Generator, ideal: ReferenceDevice, drives: list[Drive]) -> Drawn:
    return Drawn({}, {"delay": rounded(draw.uniform(1e-3, 6e-3))}, ("delay",))


def _filter(draw: Generator, ideal: ReferenceDevice, drives: list[Drive]) -> Drawn:
    return Drawn({}, draw_filter(draw, highest_frequency(drives)), ("force_filter",))


def _stated(draw: Generator, ideal: ReferenceDevice, drives: list[Drive]) -> Drawn:
    error = draw.uniform(0.03, 0.20) * draw.choice([-1.0, 1.0])
    stated = {"inertance": rounded(ideal.inertance * (1.0 + error))}
    return Drawn({}, {}, ("inertance",), stated)


def _shaft(draw: Generator, ideal: ReferenceDevice, drives: list[Drive]) -> Drawn:
    highest = highest_frequency(drives)
    for _ in range(50):
        frequency = highest * float(np.exp(draw.uniform(np.log(1.5), np.log(6.0))))
        ratio = float(np.exp(draw.uniform(np.log(0.03), np.log(0.3))))
        if 0.04 <= _shaft_share(frequency, ratio, drives) <= 0.6:
            break
    return _series(ideal, frequency, ratio)


def _backlash(draw: Generator, ideal: ReferenceDevice, drives: list[Drive]) -> Drawn:
    # teeth that meet: well above the motion, well damped
    stroke = min(float(np.ptp(drive.displacement)) for drive in drives)
    gap = rounded(stroke * np.exp(draw.uniform(np.log(0.005), np.log(0.10))))
    frequency = highest_frequency(drives) * draw.uniform(2.5, 5.0)
    shaft = _series(ideal, frequency, draw.uniform(0.4, 1.0))
    return Drawn({**shaft.device, "backlash": gap}, {}, ("backlash", *shaft.names))


def _series(ideal: ReferenceDevice, frequency: float, ratio: float) -> Drawn:
    stiffness = rounded(ideal.inertance * (2.0 * np.pi * frequency) ** 2)
    damping = rounded(2.0 * ratio * np.sqrt(stiffness * ideal.inertance))
    names = ("series_stiffness", "series_damping")
    return Drawn({"series_stiffness": stiffness, "series_damping": damping}, {}, names)


def _shaft_share(frequency: float, ratio: float, drives: list[Drive]) -> float:
    """rms(F - b a) / rms(F) of an inertance behind a spring and a damper, from its response."""
    apart = whole = 0.0
    for drive in drives:
        spectrum = abs(np.fft.rfft(drive.acceleration)) ** 2 / drive.time.size**2
        r = np.fft.rfftfreq(drive.time.size, 1.0 / drive.rate) / frequency
        above = 1.0 + 2.0j * ratio * r
        gain = above / (above - r * r)
        apart += drive.time.size * float(np.sum(spectrum * abs(gain - 1.0) ** 2))
        whole += drive.time.size * float(np.sum(spectrum * abs(gain) ** 2))
    return float(np.sqrt(apart / whole))


_UNSIZED: dict[str, Callable[[Generator, ReferenceDevice, list[Drive]], Drawn]] = {
    "none": lambda draw, ideal, drives: Drawn(),
    "sensor_delay": _delay,
    "sensor_filter": _filter,
    "inertance_error": _stated,
    "series_elasticity": _shaft,
    "backlash": _backlash,
}


def _size_for_share(
    share: float, ideal: ReferenceDevice, unit: _Unit, runs: list[Situation]
) -> float:
    """The factor on `unit`'s effect that makes it `share` of the force rms over all runs."""
    bare = np.concatenate([ideal.inertance * run.drive.acceleration for run in runs])
    found = answers(unit.device, unit.channel, runs, 1e-6)
    extra = np.concatenate([one.force for one in found]) - bare
    return size_for_share(share, bare, extra)


def _travel(runs: list[Situation]) -> float:
    """The largest displacement [m] of all runs."""
    return max(float(np.max(abs(run.drive.displacement))) for run in runs)


def _differences(one: object, other: object) -> dict:
    """Fields in which two of a kind differ; NaN counts as equal to NaN."""
    values = {name: (value, vars(other)[name]) for name, value in vars(one).items()}
    return {k: a for k, (a, b) in values.items() if a != b and not (a != a and b != b)}
