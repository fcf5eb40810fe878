"""Periodic random roads: sums of sinusoids with random phases, made by FFT.

    zr(t) = sum_i A_i sin(w_i t + phase_i),   A_i^2 / 2 = S(f_i) df,   S(f) = strength / f^2

Symbols: zr [m], f = w / 2 pi [Hz], df the spacing, 0.1 Hz or finer (the road repeats every 1/df),
S(f) [m^2/Hz] the one-sided density, `strength` [m^2 Hz], phases uniform in 0..2 pi. A mode that is
narrower than the spacing falls between two sinusoids: `refined` has closer ones, `resolution.py`
says how close.

Paper: A_i = sqrt(8 pi kappa V dw) / w_i at 0.1, 0.2 ... 1000 Hz, which is strength = 2 kappa V:
its kappa V / f^2 is a two-sided density. Source: Wang and Su, ACC 2008, eq. (10).
ISO 8608: one-sided G(n) = G(n0) (n / n0)^-2 along the road, n = f / V [cycles/m], n0 = 0.1
cycles/m, so that strength = G(n0) n0^2 V. Sinusoids where 0.01 <= n <= 10 cycles/m, the range that
the standard speaks of for roads.

A simulation holds the road over each of its steps. `held` gives those values: the road in the
middle of the step, each sinusoid divided by sinc(f h). The staircase then contains every sinusoid
exactly, in amplitude and phase, and only images beyond 1/(2h) are wrong, to which a car hardly
answers. Sinusoids at and above 1/(2h) cannot be followed; `left_out` has their mean square.
A tyre with damping takes zr + lead zr', lead = ct / kt [s]: the same sinusoids, each by
1 + i w lead.
Not modelled: discrete events, changes along the road.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.quarter_car import Road as Roughness

Array = NDArray[np.float64]

SPACING = 0.1
"""Distance of the frequencies [Hz], of Wang and Su."""

REFERENCE_FREQUENCY = 0.1
"""n0 of ISO 8608 [cycles/m]."""

_SECOND_SEED = 1_000_003

ISO_RANGE = (0.01, 10.0)
"""Spatial frequencies of ISO roads [cycles/m]: the limits that ISO 8608 names for on-road use."""

ISO_CLASSES: Mapping[str, float] = MappingProxyType(
    {name: 16e-6 * 4.0**i for i, name in enumerate("ABCDEFGH")}
)
"""G(n0) [m^3] of classes A to H: the geometric means of ISO 8608."""


@dataclass(frozen=True)
class PeriodicRoad:
    """Sinusoids `first` to `last` times `spacing` [Hz], of density strength / f^2.

    `name` to be shown, `strength` [m^2 Hz] one-sided, `speed` V [m/s] at which later axles follow.
    `band` [Hz] that the sinusoids stand for, however close; from 0 to the last one if not given.
    `lead` [s] as tyres with damping take it, see `led`.

    Raises
    ------
    ValueError
        No sinusoid, or a strength that is not positive.
    """

    name: str
    strength: float
    first: int = 1
    last: int = 10_000
    speed: float = 25.0
    spacing: float = SPACING
    band: tuple[float, float] | None = None
    lead: float = 0.0

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        if not 0.0 < self.spacing <= SPACING:
            raise ValueError(f"spacing is {self.spacing:g} Hz: give one above 0, up to {SPACING}")
        if not (math.isfinite(self.speed) and self.speed > 0.0):
            raise ValueError(f"speed is {self.speed:g} m/s: give a positive number")
        if not (math.isfinite(self.strength) and self.strength > 0.0):
            raise ValueError(f"strength of the road is {self.strength:g}: give a positive number")
        if not 1 <= self.first <= self.last:
            raise ValueError(
                f"sinusoids {self.first} to {self.last} of the road: count from 1 upwards"
            )

    @property
    def period(self) -> float:
        """[s]."""
        return 1.0 / self.spacing

    @property
    def limits(self) -> tuple[float, float]:
        """Lowest and highest frequency [Hz] that the sinusoids stand for."""
        return self.band or (0.0, self.last * self.spacing)

    def refined(self, times: int) -> PeriodicRoad:
        """The same density with sinusoids `times` as close; the road repeats that much later.

        Raises
        ------
        ValueError
            `times` is not a whole number from 1.
        """
        if times < 1:
            raise ValueError(f"times is {times}: give a whole number from 1")
        if times == 1:
            return self
        low, high = self.limits
        spacing = self.spacing / times
        return replace(
            self,
            first=max(1, math.ceil(low / spacing - 1e-9)),
            last=math.floor(high / spacing + 1e-9),
            spacing=spacing,
            band=(low, high),
        )

    def led(self, lead: float) -> PeriodicRoad:
        """The road plus `lead` [s] times its rate."""
        return replace(self, lead=lead) if lead else self

    @property
    def frequencies(self) -> Array:
        """[Hz], shape (sinusoids,)."""
        return np.asarray(self.spacing * np.arange(self.first, self.last + 1), dtype=np.float64)

    @property
    def amplitudes(self) -> Array:
        """[m], shape (sinusoids,)."""
        own = math.sqrt(2.0 * self.strength * self.spacing) / self.frequencies
        return own * np.abs(self._factors(self.lead, self.frequencies)) if self.lead else own

    @property
    def rms(self) -> float:
        """Root mean square [m] over a period."""
        return float(np.sqrt(0.5 * np.sum(self.amplitudes**2)))

    def phases(self, seed: int) -> Array:
        """[rad], shape (sinusoids,)."""
        return np.random.default_rng([seed]).uniform(0.0, 2.0 * np.pi, self.amplitudes.size)

    def at(self, times: Array | float, seed: int) -> Array:
        """The road [m] at times [s] of any shape, sinusoid by sinusoid."""
        angles = np.multiply.outer(times, 2.0 * np.pi * self.frequencies) + self._later(seed, 0.0)
        return np.sin(angles) @ self.amplitudes

    def instants(self, seed: int, count: int, behind: float = 0.0) -> Array:
        """The road [m] at `count` equidistant instants of its period, from 0; shape (count,).

        Under an axle that is `behind` [m] the first one. Without the sinusoids that `count` steps
        per period cannot follow.
        """
        kept = self._kept(count)
        return self._sum(self.amplitudes[:kept], self._later(seed, behind)[:kept], count)

    def held(self, seed: int, count: int, behind: float = 0.0) -> Array:
        """Values to hold over each of `count` steps per period [m], see the module; (count,)."""
        kept = self._kept(count)
        share = self.frequencies[:kept] * self.period / count
        amplitudes = self.amplitudes[:kept] / np.sinc(share)
        return self._sum(amplitudes, self._later(seed, behind)[:kept] + np.pi * share, count)

    def left_out(
        self,
        count: int,
        behind: Sequence[float] = (0.0,),
        gain: Callable[[Array], Array] = np.ones_like,
        leads: Sequence[float] = (),
    ) -> Array:
        """Mean products [m^2] of what `count` steps per period cannot follow, (axles, axles).

        `gain`: of frequencies [Hz], a factor of each sinusoid's mean square. `leads` [s] of the
        axles' tyres, as in `led`.
        """
        kept = self._kept(count)
        lags = np.subtract.outer(behind, behind) / self.speed
        f = self.frequencies[kept:]
        turns = np.multiply.outer(lags, 2.0 * np.pi * f)
        weights = 0.5 * self.amplitudes[kept:] ** 2 * gain(f)
        if not any(leads):
            return np.cos(turns) @ weights
        one = np.array([self._factors(lead, f) for lead in leads])
        pairs = one[:, None, :] * np.conj(one)[None, :, :] * np.exp(-1j * turns)
        return np.real(pairs) @ weights

    @staticmethod
    def _factors(lead: float, f: Array) -> NDArray[np.complex128]:
        return np.asarray(1.0 + 2j * np.pi * f * lead, dtype=np.complex128)

    def _later(self, seed: int, behind: float) -> Array:
        """Phases [rad] under an axle that is `behind` [m]."""
        late = self.phases(seed) - 2.0 * np.pi * self.frequencies * (behind / self.speed)
        return late + np.angle(self._factors(self.lead, self.frequencies)) if self.lead else late

    def _kept(self, count: int) -> int:
        """Number of sinusoids below half the sampling rate."""
        return max(min(self.last, (count - 1) // 2) - self.first + 1, 0)

    def _sum(self, amplitudes: Array, phases: Array, count: int) -> Array:
        """The sum of the lowest sinusoids at `count` instants."""
        lines = np.zeros(count // 2 + 1, dtype=complex)
        lines[self.first : self.first + amplitudes.size] = amplitudes * np.exp(1j * phases)
        # the imaginary part of the sum of exponentials
        return 0.5 * count * np.fft.irfft(-1j * lines, count)


def track(
    make: Callable[[int, int, float], Array],
    seed: int,
    count: int,
    behind: float,
    side: int,
    correlation: float,
) -> Array:
    """What `make` (`instants` or `held` of a road) gives under a wheel, (count,).

    Left (`side` 1) and right (-1) are sums of two independent roads with that correlation; 0 is the
    one track of a car that has no other.
    """
    one = make(seed, count, behind)
    if side == 0:
        return one
    together, apart = (math.sqrt((1.0 + sign * correlation) / 2.0) for sign in (1.0, -1.0))
    return together * one + side * apart * make(seed + _SECOND_SEED, count, behind)


def correlations(sides: Sequence[int], correlation: float) -> Array:
    """Of the roads under wheels on those sides, (wheels, wheels)."""
    return np.where(np.equal.outer(sides, sides), 1.0, correlation)


def paper_road(roughness: Roughness | None = None) -> PeriodicRoad:
    """The road of Wang and Su: 10 000 sinusoids, 20.3 mm rms at their speed and roughness."""
    given = roughness or Roughness()
    strength = 2.0 * given.roughness * given.velocity
    return PeriodicRoad("paper", strength, speed=given.velocity)


def iso_road(name: str, speed: float = 25.0) -> PeriodicRoad:
    """The road of an ISO 8608 class, "A" to "H", at `speed` [m/s].

    Raises
    ------
    ValueError
        No such class, or a speed that is not positive.
    """
    if name not in ISO_CLASSES:
        raise ValueError(f"ISO 8608 class {name!r}: there are {', '.join(ISO_CLASSES)}")
    if not (math.isfinite(speed) and speed > 0.0):
        raise ValueError(f"speed is {speed:g} m/s: give a positive number")
    strength = ISO_CLASSES[name] * REFERENCE_FREQUENCY**2 * speed
    # a hair of slack, so that a limit that is a multiple of the spacing counts
    first = max(1, math.ceil(ISO_RANGE[0] * speed / SPACING - 1e-9))
    last = max(first, math.floor(ISO_RANGE[1] * speed / SPACING + 1e-9))
    band = (ISO_RANGE[0] * speed, max(ISO_RANGE[1] * speed, first * SPACING))
    return PeriodicRoad(f"iso:{name}", strength, first, last, speed, band=band)


def road_named(name: str, speed: float = 25.0) -> PeriodicRoad:
    """A road by its name: "paper", or "iso:A" to "iso:H".

    Raises
    ------
    ValueError
        No such road.
    """
    if name == "paper":
        return paper_road(Roughness(velocity=speed))
    kind, colon, letter = name.partition(":")
    if kind == "iso" and colon and letter.upper() in ISO_CLASSES:
        return iso_road(letter.upper(), speed)
    raise ValueError(f"road {name!r}: give paper or iso:A, iso:B ... iso:H")
