"""What the rig records in a test, and the noise of its instruments.

Noise is white. Displacement: 10 um rms, the repeatability of a laser sensor of 100 mm range such as
the paper's. Force: 0.2 N rms, assumed; the paper states none. The voltage is what the test sends
out and is taken as known, as the paper takes it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Noise:
    """Rms of white noise: displacement [m], force [N]."""

    displacement: float = 10e-6
    force: float = 0.2


@dataclass(frozen=True)
class Signals:
    """Records of one test, equally spaced from time 0.

    rate: samples per second. displacement of the piston [m] and force of the load cell [N], shape
    (n,). farthest: largest displacement of the water [m], 0 when dry; no instrument sees it.
    """

    rate: float
    displacement: Array
    force: Array
    farthest: float = 0.0

    @property
    def time(self) -> Array:
        """Times of the samples [s]."""
        return np.arange(self.displacement.size) / self.rate

    def first(self, duration: float) -> Signals:
        """The first part, `duration` [s]."""
        count = round(duration * self.rate)
        return Signals(self.rate, self.displacement[:count], self.force[:count], self.farthest)

    def disturbed(self, noise: Noise, generator: np.random.Generator) -> Signals:
        """The records with noise on displacement and force."""
        size = self.displacement.size
        return Signals(
            self.rate,
            self.displacement + noise.displacement * generator.standard_normal(size),
            self.force + noise.force * generator.standard_normal(size),
            self.farthest,
        )
