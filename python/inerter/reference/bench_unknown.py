"""Test records with an effect that no name describes: whoever diagnoses them should say so.

A force along the motion of an ideal inerter, sized to 5 to 30 % of the force rms:

    beating              sin(2 pi x / l) sin(2 pi t / T): magnets that lock at places, and turn
    coupling             x v^2 alone, without the x^2 a that an inertance would bring
    softening            x (1 - m / max|x|), m the largest |x| so far: rubber that was new
    lagging_drag         q, q' = (v |v| - q) / T: a flow that takes time to build up
    catching             tanh(v / v_t) where |v| is above v_0: a clutch that flies out
    fading_inertance     -b a (t / T): what is engaged is lost as time goes on
    square_wave          of time alone, a controller that switches
    squeal               a decaying oscillation after each reversal
    dead_band            the force channel is silent near zero
Sources: softening: Mullins, Rubber Chem. Technol. 42, 1969, as a linear spring.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.signal import lfilter

from .bench import HiddenCase, NoiseLevels, draw_situations, record_case
from .bench_channel import Channel, answers
from .device import ReferenceDevice
from .motion import Response
from .sizes import rms, rounded, size_for_share

Array = NDArray[np.float64]
Shape = dict[str, float]
Force = Callable[[Generator, list[Response]], tuple[list[Array], Shape]]


def hide_unknown(
    seed: int,
    kind: str | None = None,
    noise: NoiseLevels | None = None,
    *,
    realistic: bool = False,
) -> HiddenCase:
    """Draw an ideal inerter with an unnamed effect, and its records.

    Parameters
    ----------
    seed
        Everything follows from it; print it where a test fails.
    kind
        One of `UNKNOWN`; drawn if not given.
    noise
        As for `hide_effect`.
    realistic
        As for `hide_effect`.

    The case's effect is "unknown"; its parameters are the effect's size [N, or per its unit] and
    shape.

    Raises
    ------
    ValueError
        Unknown kind.
    """
    choose, draw, move, shake, more = (
        np.random.default_rng(child) for child in np.random.SeedSequence([seed, 1]).spawn(5)
    )
    kind = kind if kind is not None else str(choose.choice(UNKNOWN))
    if kind not in UNKNOWN:
        raise ValueError(f"kind: '{kind}' is not one of {', '.join(UNKNOWN)}")
    ideal = ReferenceDevice(inertance=rounded(np.exp(draw.uniform(np.log(20.0), np.log(400.0)))))
    runs = draw_situations(move, more, ideal.inertance, one_clock=False, realistic=realistic)
    bare = answers(ideal, Channel(), runs)
    share = draw.uniform(0.05, 0.30)
    if kind == "dead_band":
        forces, parameters = _dead_band(share, bare)
    else:
        forces, parameters = _added(share, draw, _KINDS[kind], bare)
    truths = [replace(one, force=force) for one, force in zip(bare, forces, strict=True)]
    return record_case(
        runs, truths, Channel(), shake, noise,
        seed=seed, effect="unknown", law=None, device=ideal, kind=kind, parameters=parameters,
        ideal=ideal, realistic=realistic,
    )  # fmt: skip


def _added(
    share: float, draw: Generator, force: Force, bare: list[Response]
) -> tuple[list[Array], Shape]:
    """The force with an effect of the wanted share."""
    extra, shape = force(draw, bare)
    size = size_for_share(share, np.concatenate([one.force for one in bare]), np.concatenate(extra))
    forces = [one.force + size * more for one, more in zip(bare, extra, strict=True)]
    return forces, {"size": size, **shape}


def _dead_band(share: float, bare: list[Response]) -> tuple[list[Array], Shape]:
    """Forces below a threshold read zero; the threshold whose loss is the wanted share."""
    force = np.concatenate([one.force for one in bare])

    def excess(width: float) -> float:
        lost = np.where(abs(force) < width, force, 0.0)
        return rms(lost) - share * rms(force - lost)

    width = float(brentq(excess, 0.0, float(np.max(abs(force)))))  # pyright: ignore[reportArgumentType]
    return [np.where(abs(one.force) < width, 0.0, one.force) for one in bare], {"width": width}


def _direction(one: Response) -> Array:
    return np.tanh(one.velocity / ReferenceDevice().transition_velocity)


def _stroke(bare: list[Response]) -> float:
    return max(float(np.ptp(one.displacement)) for one in bare)


def _beating(draw: Generator, bare: list[Response]) -> tuple[list[Array], Shape]:
    length = rounded(_stroke(bare) * draw.uniform(0.12, 0.35))
    period = rounded(np.exp(draw.uniform(np.log(0.7), np.log(4.0))))
    found = [
        np.sin(2.0 * np.pi * one.displacement / length) * np.sin(2.0 * np.pi * one.time / period)
        for one in bare
    ]
    return found, {"length": length, "period": period}


def _coupling(draw: Generator, bare: list[Response]) -> tuple[list[Array], Shape]:
    sign = float(draw.choice([-1.0, 1.0]))
    return [sign * one.displacement * one.velocity**2 for one in bare], {}


def _softening(draw: Generator, bare: list[Response]) -> tuple[list[Array], Shape]:
    largest = max(float(np.max(abs(one.displacement))) for one in bare)
    found = [
        one.displacement * (1.0 - np.maximum.accumulate(abs(one.displacement)) / (1.1 * largest))
        for one in bare
    ]
    return found, {"largest": largest}


def _lagging(draw: Generator, bare: list[Response]) -> tuple[list[Array], Shape]:
    lag = rounded(np.exp(draw.uniform(np.log(0.05), np.log(0.4))))
    found = []
    for one in bare:
        step = one.time[1] - one.time[0]
        keep = np.exp(-step / lag)
        found.append(lfilter([1.0 - keep], [1.0, -keep], one.velocity * abs(one.velocity)))
    return found, {"lag": lag}


def _catching(draw: Generator, bare: list[Response]) -> tuple[list[Array], Shape]:
    middle = float(np.median([rms(one.velocity) for one in bare]))
    speed = rounded(middle * draw.uniform(0.7, 1.3))
    return [_direction(one) * (abs(one.velocity) > speed) for one in bare], {"speed": speed}


def _fading(draw: Generator, bare: list[Response]) -> tuple[list[Array], Shape]:
    longest = max(float(one.time[-1]) for one in bare)
    return [-one.force * one.time / longest for one in bare], {}


def _square_wave(draw: Generator, bare: list[Response]) -> tuple[list[Array], Shape]:
    period = rounded(np.exp(draw.uniform(np.log(0.3), np.log(3.0))))
    found = []
    for one in bare:
        phase = draw.uniform(0.0, 1.0)
        found.append(np.where((one.time / period + phase) % 1.0 < 0.5, 1.0, -1.0))
    return found, {"period": period}


def _squeal(draw: Generator, bare: list[Response]) -> tuple[list[Array], Shape]:
    frequency = rounded(draw.uniform(15.0, 40.0))
    decay = rounded(draw.uniform(0.05, 0.15))
    found = []
    for one in bare:
        force = np.zeros(one.time.size)
        for i in np.flatnonzero(np.diff(np.sign(one.velocity)) != 0.0):
            since = one.time[i:] - one.time[i]
            force[i:] += np.exp(-since / decay) * np.sin(2.0 * np.pi * frequency * since)
        found.append(force)
    return found, {"frequency": frequency, "decay": decay}


_KINDS: dict[str, Force] = {
    "beating": _beating,
    "coupling": _coupling,
    "softening": _softening,
    "lagging_drag": _lagging,
    "catching": _catching,
    "fading_inertance": _fading,
    "square_wave": _square_wave,
    "squeal": _squeal,
}

UNKNOWN = (*_KINDS, "dead_band")
