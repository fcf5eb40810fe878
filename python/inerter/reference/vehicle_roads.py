"""Roads under a drawn vehicle: random phases of an ISO class, bumps, a track for each side.

    G_v = (2 pi n_0)^2 G_d(n_0) V      spectral density of the road's vertical velocity [m^2/s]

Symbols: n_0 = 0.1 1/m, G_d(n_0) unevenness of the class [m^3], V speed [m/s].
Source: ISO 8608:2016, classes A to D by their middle, waviness 2 (white velocity).
A bump is h (1 - cos(2 pi s / l)) / 2 over its length l. With a contact patch of the length p the
tyre feels the mean of the road over p: every wave of frequency f shrinks by sinc(f p / V), and a
bump is averaged in closed form.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROUGHNESS = {"A": 16e-6, "B": 64e-6, "C": 256e-6, "D": 1024e-6}
"""Unevenness at n_0 by class [m^3]."""
TOP = 25.0
"""Highest frequency of a road [Hz]."""


@dataclass(frozen=True)
class Bump:
    """Begins at `start` [s], lasts `length` [s], `height` [m]."""

    start: float
    length: float
    height: float

    def integral(self, t: float) -> float:
        """Of its height from the beginning on [m s]."""
        s = float(np.clip(t - self.start, 0.0, self.length))
        omega = 2.0 * np.pi / self.length
        return 0.5 * self.height * (s - np.sin(omega * s) / omega)

    def at(self, t: float) -> float:
        """Its height [m]."""
        s = float(np.clip(t - self.start, 0.0, self.length))
        return 0.5 * self.height * (1.0 - np.cos(2.0 * np.pi * s / self.length))

    def rate(self, t: float) -> float:
        """Its rate [m/s]."""
        s = float(np.clip(t - self.start, 0.0, self.length))
        omega = 2.0 * np.pi / self.length
        return 0.5 * self.height * omega * np.sin(omega * s)


@dataclass(frozen=True, kw_only=True)
class Track:
    """The road under one wheel: height and rate at a time; 0 at the time 0.

    amplitude: rms of its vertical velocity [m/s]; late: time after the front wheel [s]; patch: time
    in which the wheel rolls over its contact patch [s].
    """

    seed: int
    duration: float
    amplitude: float
    bumps: tuple[Bump, ...] = ()
    late: float = 0.0
    patch: float = 0.0

    @cached_property
    def waves(self) -> tuple[Array, Array, Array]:
        """Angular frequency [rad/s], size [m] and phase of every wave."""
        frequency = np.arange(1.0, TOP * self.duration) / self.duration
        size = self.amplitude * np.sqrt(2 / frequency.size) / (2 * np.pi * frequency)
        size = size * np.sinc(frequency * self.patch)
        phase = np.random.default_rng(self.seed).uniform(0, 2 * np.pi, frequency.size)
        return 2 * np.pi * frequency, size, phase

    def __call__(self, t: float) -> float:
        """Height [m]."""
        omega, size, phase = self.waves
        s = t - self.late
        wave = float(size @ (np.sin(omega * s + phase) - np.sin(phase - omega * self.late)))
        return wave + sum(self._bump(bump, s) for bump in self.bumps)

    def rate(self, t: float) -> float:
        """Its rate [m/s]."""
        omega, size, phase = self.waves
        s, half = t - self.late, 0.5 * self.patch
        rates = [
            (bump.at(s + half) - bump.at(s - half)) / self.patch if half else bump.rate(s)
            for bump in self.bumps
        ]
        return float((size * omega) @ np.cos(omega * s + phase)) + sum(rates)

    def _bump(self, bump: Bump, s: float) -> float:
        half = 0.5 * self.patch
        if not half:
            return bump.at(s)
        return (bump.integral(s + half) - bump.integral(s - half)) / self.patch


@dataclass(frozen=True, kw_only=True)
class RoadRun:
    """One drive: its class, speed [m/s], length [s], bumps, and the seed of its two tracks."""

    road_class: str
    speed: float
    seconds: float
    seed: int
    bumps: tuple[Bump, ...] = field(default_factory=tuple)

    @property
    def amplitude(self) -> float:
        """Rms of the road's vertical velocity [m/s]."""
        density = (2.0 * np.pi * 0.1) ** 2 * ROUGHNESS[self.road_class] * self.speed
        return float(np.sqrt(density * TOP))

    def track(self, side: int, behind: float, patch_length: float = 0.0) -> Track:
        """Under a wheel `behind` [m] the first one, `side` 0 left or 1 right.

        patch_length: of the contact patch [m]; 0: the wheel touches in a point.
        """
        return Track(
            seed=self.seed + side, duration=self.seconds, amplitude=self.amplitude,
            bumps=self.bumps, late=behind / self.speed, patch=patch_length / self.speed,
        )  # fmt: skip


def draw_run(random: Generator, seconds: float) -> RoadRun:
    """A drive: class A to D, 10 to 25 m/s, a bump or two in half of the drives."""
    road_class = str(random.choice(["A", "B", "B", "C"]))
    speed = float(round(random.uniform(10.0, 25.0), 1))
    bumps = []
    for _ in range(int(random.choice([0, 0, 1, 2]))):
        length = float(random.uniform(1.0, 4.0)) / speed
        start = float(random.uniform(0.25, 0.85) * seconds)
        bumps.append(Bump(start, length, float(random.uniform(0.008, 0.03))))
    return RoadRun(
        road_class=road_class, speed=speed, seconds=seconds,
        seed=int(random.integers(1, 2**31 - 2)), bumps=tuple(bumps),
    )  # fmt: skip
