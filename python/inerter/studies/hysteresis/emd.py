"""What EMD makes of the paper's tests: how many modes, which one is the force, what is left."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.studies.hysteresis.settings import Settings
from inerter.studies.hysteresis.virtual_tests import VirtualTest, cleaned_tests

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Decomposed:
    """EMD of one force.

    Attributes
    ----------
    modes, kept
        How many there are, and how many of them the noise rule keeps.
    loudest
        Number of the mode of most energy, 1 the fastest: what the paper takes for the force.
    before, rule
        Rms distance [N] from the force without noise: as measured, with the modes of the rule.
    single, single_ten
        The same with the loudest mode alone, sifted to the conditions of a mode, and sifted ten
        times as for the rule.
    """

    maker: str
    frequency: float
    modes: int
    kept: int
    loudest: int
    before: float
    rule: float
    single: float
    single_ten: float

    def json(self) -> dict[str, object]:
        """Plain data."""
        return asdict(self)


def decomposed(maker: str, settings: Settings) -> list[Decomposed]:
    """The four tests of a device of `published.MAKERS`."""
    s = settings
    rows = []
    sets = [
        cleaned_tests(maker, s.rate, s.duration, s.noise, s.seed, way)
        for way in ("none", "emd", "emd_loudest")
    ]
    for (test, raw), (_, ruled), (_, single) in zip(*sets, strict=True):
        modes = ruled.modes
        assert modes is not None
        assert single.number is not None
        ten = modes.modes[int(np.argmax(modes.energy))]
        rows.append(
            Decomposed(
                maker=maker,
                frequency=test.frequency,
                modes=len(modes.modes),
                kept=int(modes.kept.sum()),
                loudest=single.number,
                before=_off(test, raw.force),
                rule=_off(test, ruled.force),
                single=_off(test, single.force),
                single_ten=_off(test, ten),
            )
        )
    return rows


def _off(test: VirtualTest, force: Array) -> float:
    return float(np.sqrt(np.mean((force - test.truth)[test.settled] ** 2)))
