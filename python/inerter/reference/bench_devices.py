"""Random effects of a drawn size on an ideal inerter.

Most effects are sized by their share of the force, rms(F - b a) / rms(F), drawn from 5 to 40 %.
With the law's shape fixed such an effect is linear in one size p, so p solves

    p^2 <e e> (1 - s^2) - 2 s^2 p <i e> - s^2 <i i> = 0,   i = b a, e the effect at p = 1.

Sized otherwise: a stated inertance that is 3 to 20 % off; a half gap of 0.5 to 10 % of the
smallest stroke; a shaft whose resonance lies at 1.5 to 6 times, a low-pass whose cut-off at 1.5 to
4 times the highest frequency of the motion; a variable inertance whose factor stays within 0.3 ..
1.7 (so its share may stay lower); a force channel that clips 2 to 15 % of the samples; a leak whose
corner lies at 0.3 to 3 times the highest frequency; a clutch that slips at a force which an ideal
inerter exceeds in 5 to 40 % of the samples.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from .bench_channel import Channel, Situation, answers, draw_filter
from .bench_effects import FRICTION_LAWS, LEVEL_CHANGES
from .bench_motions import Drive, highest_frequency
from .bench_units import UNITS, Unit, hysteresis, plain
from .device import ReferenceDevice
from .sizes import rounded, size_for_share


@dataclass(frozen=True)
class Drawn:
    """What an effect adds to the device and to the channel, and which of it was hidden."""

    device: dict[str, float | str] = field(default_factory=dict)
    channel: dict[str, float] = field(default_factory=dict)
    names: tuple[str, ...] = ()
    stated: dict[str, float] | None = None


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
    if effect in UNITS:
        unit = UNITS[effect](draw, ideal, runs)
    elif effect == "hysteretic_friction":
        travel = min(float(np.max(abs(drive.displacement))) for drive in drives)
        device, scaling, names = hysteresis(draw, str(law), ideal, travel)
        unit = Unit(device=device, channel=Channel(), scaling=scaling, names=names)
    else:
        unit = plain(draw, effect, ideal)

    share = draw.uniform(*unit.share)
    size = min(_size_for_share(share, ideal, unit, runs), unit.largest)
    sized = {
        key: _times(getattr(unit.device if hasattr(ideal, key) else unit.channel, key), size)
        for key in unit.scaling
    }
    device = replace(unit.device, **{k: v for k, v in sized.items() if hasattr(ideal, k)})
    channel = replace(unit.channel, **{k: v for k, v in sized.items() if not hasattr(ideal, k)})
    return Drawn(_differences(device, ideal), _differences(channel, Channel()), unit.names)


def _times(value: float | tuple[float, ...], size: float) -> float | tuple[float, ...]:
    """A parameter times a size; of periods along the stroke their amplitudes."""
    if isinstance(value, tuple):
        return tuple(rounded(v * size) if i % 3 == 1 else v for i, v in enumerate(value))
    return rounded(value * size)


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


def _leak(draw: Generator, ideal: ReferenceDevice, drives: list[Drive]) -> Drawn:
    # laminar or turbulent; the corner below which it lets a motion pass
    corner = highest_frequency(drives) * float(np.exp(draw.uniform(np.log(0.3), np.log(3.0))))
    damping = 2.0 * np.pi * corner * ideal.inertance
    if draw.random() < 0.5:
        return Drawn({"leak_damping": rounded(damping)}, {}, ("leak_damping",))
    speed = np.sqrt(
        np.mean(np.concatenate([drive.motion.velocity(drive.time) for drive in drives]) ** 2)
    )
    name = "leak_quadratic_damping"
    return Drawn({name: rounded(damping / float(speed))}, {}, (name,))


def _clutch(draw: Generator, ideal: ReferenceDevice, drives: list[Drive]) -> Drawn:
    frequency = highest_frequency(drives) * draw.uniform(2.5, 5.0)
    shaft = _series(ideal, frequency, draw.uniform(0.4, 1.0))
    bare = np.concatenate([ideal.inertance * drive.acceleration for drive in drives])
    level = rounded(float(np.quantile(abs(bare), draw.uniform(0.6, 0.95))))
    return Drawn({**shaft.device, "clutch_force": level}, {}, ("clutch_force", *shaft.names))


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
    "leak": _leak,
    "clutch_slip": _clutch,
}


def _size_for_share(
    share: float, ideal: ReferenceDevice, unit: Unit, runs: list[Situation]
) -> float:
    """The factor on `unit`'s effect that makes it `share` of the force rms over all runs."""
    bare = np.concatenate([ideal.inertance * run.drive.acceleration for run in runs])
    found = answers(unit.device, unit.channel, runs, 1e-6)
    extra = np.concatenate([one.force for one in found]) - bare
    return size_for_share(share, bare, extra)


def _differences(one: object, other: object) -> dict:
    """Fields in which two of a kind differ; NaN counts as equal to NaN."""
    names = (each.name for each in fields(one))  # type: ignore[arg-type]
    values = {name: (getattr(one, name), getattr(other, name)) for name in names}
    return {k: a for k, (a, b) in values.items() if a != b and not (a != a and b != b)}
