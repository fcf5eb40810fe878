"""The tests of the experiment: which voltage is given to which configuration.

A sweep of 0.5 to 12 Hz in 60 s whose amplitude grows. A preload is a constant voltage before the
sweep, not during it: it acts on the sweep by the trapped air that it leaves behind, whose damping
c_a is a parameter of its own for each preload.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

START, END, RATE_OF_RISE = 0.5, 12.0, 11.5 / 60.0
"""First and last frequency [Hz] of the whole sweep and its rise [Hz/s]."""
WHOLE = 60.0
"""Duration of the whole sweep [s]."""


@dataclass(frozen=True, kw_only=True)
class Sweep:
    """One test: a sine whose frequency rises by 11.5 Hz in 60 s and whose amplitude grows.

    name: how it is called. first, last: amplitude at 0 and at 60 s [V], before the amplifier.
    preload: voltage that was on before the sweep [V], for the complete device. duration [s]: a
    shorter one is the first part of the whole sweep.
    """

    name: str
    first: float
    last: float
    preload: float | None = None
    duration: float = WHOLE

    def voltage(self, time: Array) -> Array:
        """Input of the amplifier at times (n,) [s], shape (n,) [V]."""
        phase = 2 * np.pi * (START + 0.5 * RATE_OF_RISE * time) * time
        return (self.first + (self.last - self.first) * time / WHOLE) * np.sin(phase)

    def shortened(self, duration: float) -> Sweep:
        """The first part of the test, `duration` [s]."""
        return replace(self, duration=duration)

    @property
    def highest(self) -> float:
        """Frequency at its end [Hz]."""
        return START + RATE_OF_RISE * self.duration


DRY = tuple(
    Sweep(name=f"{first:.2f}-{first + 0.2:.2f} V", first=first, last=round(first + 0.2, 2))
    for first in (0.35, 0.40, 0.50, 0.60)
)
"""The four levels of the dry configuration (Figs. 14 to 16)."""

COMPLETE = tuple(
    Sweep(name=f"{preload:.2f} V preload", first=0.40, last=0.60, preload=preload)
    for preload in (0.05, 0.10)
)
"""The complete configuration after both preloads (Figs. 17 to 19); the level is that of Fig. 20."""

LEVELS = tuple(
    Sweep(
        name=f"{first:.2f}-{first + 0.2:.2f} V",
        first=first,
        last=round(first + 0.2, 2),
        preload=0.10,
    )
    for first in (0.40, 0.50)
)
"""Two levels after one preload (Fig. 20). The paper takes that of 0.05 V; there, with 16 mm of air,
the water of the higher level goes to 10.2 mm, far beyond the 6.7 mm that the printed law of the air
is good for. After 0.10 V it still goes to 7.1 mm, which the study says."""
