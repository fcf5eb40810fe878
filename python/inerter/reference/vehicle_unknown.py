"""What is hidden in a drawn vehicle and has no name; sizes as in `vehicle_draws.py`."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from .vehicle_draws import Draw, Making, Sizes

Array = NDArray[np.float64]


def _imbalance(d: Draw, seconds: float) -> None:
    del seconds
    frequency = float(d.random.uniform(5.0, 11.0))
    size = d.between(0.2, 0.5) * d.size.force
    d.making.on_wheel = lambda t, run: size * np.sin(2 * np.pi * frequency * t + run)


def _gusts(d: Draw, seconds: float) -> None:
    size = d.between(0.03, 0.08) * 9.81 * d.making.stated.body_mass
    seed = int(d.random.integers(2**31))

    def force(t: Array, run: int) -> Array:
        random = np.random.default_rng([seed, run])
        tones = np.arange(1, 6 * seconds) / seconds
        phases = random.uniform(0, 2 * np.pi, tones.size)
        weights = 1 / np.hypot(1.0, tones / 1.5)
        weights *= np.sqrt(2 / np.sum(weights**2))
        return size * (np.sin(2 * np.pi * np.multiply.outer(t, tones) + phases) @ weights)

    d.making.on_body = force


def _cogging(d: Draw, seconds: float) -> None:
    del seconds
    size = d.between(0.15, 0.4) * d.size.force
    length = d.size.x * float(d.random.uniform(0.6, 1.5))
    d.making.others.setdefault(d.corner, {})["extra"] = lambda x, v: (
        size * float(np.sin(2 * np.pi * x / length))
    )


def _rider(d: Draw, seconds: float) -> None:
    del seconds
    mass = d.between(0.06, 0.15) * d.making.stated.body_mass
    stiffness = mass * (2 * np.pi * float(d.random.uniform(3.0, 6.0))) ** 2
    d.making.rider = mass, stiffness, 0.3 * float(np.sqrt(stiffness * mass))


def _coupling(d: Draw, seconds: float) -> None:
    del seconds
    size = d.between(0.15, 0.4) * d.size.force / (d.size.x * d.size.v**2)
    d.making.others.setdefault(d.corner, {})["extra"] = lambda x, v: size * x * v**2


_UNKNOWN: dict[str, Callable[[Draw, float], None]] = {
    "imbalance": _imbalance, "gusts": _gusts, "cogging": _cogging, "rider": _rider,
    "coupling": _coupling,
}  # fmt: skip
VEHICLE_UNKNOWN = tuple(_UNKNOWN)
"""Without a name: a wheel out of balance, gusts on the body, a strut that cogs, somebody who sits
on springs, a force x v^2."""


def draw_vehicle_unknown(
    making: Making,
    kind: str,
    random: Generator,
    sizes: list[Sizes],
    strength: float,
    seconds: float,
) -> None:
    """Hide one that has no name."""
    corner = int(random.integers(len(sizes))) if kind != "imbalance" else 0
    draw = Draw(making, random, corner, sizes[corner], strength, [], 0.0)
    _UNKNOWN[kind](draw, seconds)
