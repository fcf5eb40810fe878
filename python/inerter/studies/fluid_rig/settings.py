"""What a study of the rig is asked for."""

from __future__ import annotations

from dataclasses import dataclass, field

from inerter.studies.fluid_rig.objective import OBJECTIVES
from inerter.studies.fluid_rig.signals import Noise
from inerter.studies.fluid_rig.sweeps import WHOLE

SHORTEST = 30.0
"""The sweep has to pass the anti-resonance, and the first hertz in the dry tests [s]."""


class StudyError(ValueError):
    """A study that cannot be: names the option, its value, what is allowed."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Of a study.

    objectives: "spectra", "time". seeds: of noise and starting values, one identification each.
    duration: of every sweep [s]. rate: samples per second. factor: starting values are off by up
    to this factor. starts: how many at most, the next one where a fit explains the tests badly.
    """

    objectives: tuple[str, ...] = ("spectra", "time")
    seeds: tuple[int, ...] = (0,)
    duration: float = WHOLE
    noise: Noise = field(default_factory=Noise)
    rate: float = 200.0
    factor: float = 2.0
    starts: int = 3

    def __post_init__(self) -> None:
        for name in self.objectives:
            if name not in OBJECTIVES:
                raise StudyError(f"objective: {name!r} is none of {', '.join(OBJECTIVES)}")
        if not self.objectives or not self.seeds:
            raise StudyError("objective, seeds: give at least one of each")
        if not SHORTEST <= self.duration <= WHOLE:
            raise StudyError(
                f"duration: {self.duration:g} s; give {SHORTEST:g} to {WHOLE:g} s, so that the "
                "sweep passes the anti-resonance"
            )
        for name in ("displacement", "force"):
            value = getattr(self.noise, name)
            if not 0 < value < float("inf"):
                raise StudyError(f"noise of {name}: {value:g}; give an rms above 0")
        if not 1 <= self.factor <= 8:
            raise StudyError(f"factor: {self.factor:g}; starting values are off by 1 to 8 times")
        if self.starts < 1:
            raise StudyError(f"starts: {self.starts}; give at least 1")
