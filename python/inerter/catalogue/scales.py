"""Sizes of a data set's channels, and ranges to search in that follow from them."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


def size_of(values: NDArray[np.float64], from_zero: bool = False) -> float:
    """Typical size of a channel, rms about its mean; 1 where nothing is there.

    What counts `from_zero`, a speed, is as large as its mean where it varies less than that: of a
    machine that only runs up it is not what it varies by.
    """
    if not values.size:
        return 1.0
    spread, middle = float(np.std(values)), abs(float(np.mean(values)))
    return (middle if from_zero and middle > spread else spread) or 1.0


@dataclass(frozen=True, kw_only=True)
class Scales:
    """Typical sizes of a data set's channels (see `size_of`), SI units; cut-off [Hz].

    one_tone: the motion is so nearly one sine that displacement and acceleration are proportional.
    travel, force_range: least and largest displacement [m] and measured force [N]; middle: of the
    displacements between which the device is half of the time [m]; elapsed: longest elapsed time
    [s]; run_length: the longest run [s].
    """

    force: float
    displacement: float
    velocity: float
    acceleration: float
    cutoff: float = np.inf
    one_tone: bool = False
    travel: tuple[float, float] = (-np.inf, np.inf)
    middle: float = 0.0
    elapsed: float = 1.0
    run_length: float = 1.0
    force_range: tuple[float, float] = (-np.inf, np.inf)

    @property
    def frequency(self) -> float:
        """Typical frequency of the motion [Hz]."""
        return float(np.sqrt(self.acceleration / self.displacement)) / (2 * np.pi)

    @property
    def highest_frequency(self) -> float:
        """The highest frequency that is told from noise [Hz]."""
        return self.cutoff if np.isfinite(self.cutoff) else 100 * self.frequency

    @property
    def speed_resolution(self) -> float:
        """What the velocity changes by within the smoother's memory [m/s]; nothing less is seen."""
        return 0.5 * self.acceleration / (2 * np.pi * self.cutoff)

    @property
    def place_resolution(self) -> float:
        """What the displacement changes by within that memory where the motion turns [m]."""
        return self.speed_resolution / (2 * np.pi * self.cutoff)


@dataclass(frozen=True)
class Range:
    """How one coordinate is searched: its typical size, bounds, and whether over its logarithm."""

    size: float
    lower: float = -np.inf
    upper: float = np.inf
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

    def unit(self, value: float) -> float:
        """Coordinate per search variable, at a value."""
        return value if self.logarithmic else self.size
