"""What a study of the hysteresis paper can be asked for."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from inerter.studies.hysteresis.denoising import WAYS


@dataclass(frozen=True, kw_only=True)
class Settings:
    """A study; equal settings give equal results.

    Attributes
    ----------
    noise
        Rms of the white noise on the force [N]. The paper shows a "very noisy" force in pictures
        that are lost; 10 N on a force of 60 to 80 N at 1 Hz is this project's reading.
    rate, duration
        Samples per second [Hz] and length [s] of a test.
    seed
        Of the noise and of the random starts.
    denoise
        The way (see `denoising`) the force is cleaned before the fits.
    draws
        Noises over which the bias of estimates is averaged.
    random_starts
        Of the optimisers.
    starts
        Of the fits that are compared on held-out tests; None: as many as `inerter identify` takes.
    """

    noise: float = 10.0
    rate: float = 1000.0
    duration: float = 6.0
    seed: int = 1
    denoise: str = "emd"
    draws: int = 10
    random_starts: int = 20
    starts: int | None = None

    def __post_init__(self) -> None:
        for name, low, high in (
            ("noise", 0.0, 1e3), ("rate", 200.0, 1e4), ("duration", 4.0, 60.0),
        ):  # fmt: skip
            value = getattr(self, name)
            if not (math.isfinite(value) and low <= value <= high):
                raise ValueError(f"{name} {value:g}: give a number from {low:g} to {high:g}")
        for name, low in (("draws", 2), ("random_starts", 1), ("seed", 0)):
            if getattr(self, name) < low:
                raise ValueError(f"{name} {getattr(self, name)}: must be at least {low}")
        if self.denoise not in WAYS:
            raise ValueError(f"denoise {self.denoise!r}: choose from {', '.join(WAYS)}")

    def quick(self) -> Settings:
        """The same study with few draws and starts: its tables are rough."""
        return replace(self, draws=3, random_starts=4, starts=24)
