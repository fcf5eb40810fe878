"""What a preparation is asked to do."""

from __future__ import annotations

import math
from dataclasses import dataclass

from inerter.records.denoise import METHODS
from inerter.records.record import RecordError


@dataclass(frozen=True, kw_only=True)
class Options:
    """What to do with records.

    denoise: one of `denoise.METHODS`; channels: which are denoised; noise: rms of their white noise
    in SI units, None to estimate it; derivatives: add velocity and acceleration where they were not
    measured; cutoff [Hz]: of the low-pass denoiser, None for its own choice, and of the smoother
    that gives derivatives and delay, None for that of a diagnosis; delay: None, "auto", or by how
    many seconds the force is late; rate: samples per second of the result, None to leave it.
    Raises RecordError for values that cannot be meant.
    """

    denoise: str = "none"
    channels: tuple[str, ...] = ("force",)
    noise: float | None = None
    derivatives: bool = False
    cutoff: float | None = None
    delay: float | str | None = None
    rate: float | None = None

    def __post_init__(self) -> None:
        if self.denoise not in METHODS:
            raise RecordError(f"--denoise is {self.denoise!r}; take one of {', '.join(METHODS)}")
        for name, value in (("rate", self.rate), ("cutoff", self.cutoff), ("noise", self.noise)):
            if value is not None and not (math.isfinite(value) and value > 0):
                option = {"rate": "resample"}.get(name, name)
                raise RecordError(f"--{option} is {value:g}; give a positive number")
        if isinstance(self.delay, str) and self.delay != "auto":
            raise RecordError(f"--delay is {self.delay!r}; give 'auto' or seconds, such as 0.002")
        if isinstance(self.delay, float) and not abs(self.delay) < 1:
            raise RecordError(f"--delay is {self.delay:g} s; give seconds, between -1 and 1")
