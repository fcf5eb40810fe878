"""What the optimisers make of random starts: each model on its own data, all four tests."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inerter.studies.hysteresis.objective import Objective
from inerter.studies.hysteresis.optimisers import End, optimise, random_starts
from inerter.studies.hysteresis.published import MODELS
from inerter.studies.hysteresis.settings import Settings
from inerter.studies.hysteresis.virtual_tests import cleaned_tests


@dataclass(frozen=True)
class Starting:
    """Searches of one optimiser for one model.

    `ends`: from the paper's start, then from the random ones; `published_error`: rms force error
    [N] of the parameters that made the data, which a good search falls below.
    """

    model: str
    optimiser: str
    ends: tuple[End, ...]
    published_error: float

    def reached(self, best: float, within: float = 0.01) -> int:
        """How many searches end within a share of the `best` error [N]."""
        return sum(end.error <= (1 + within) * best for end in self.ends)

    def json(self) -> dict[str, object]:
        """Plain data."""
        return {
            "model": self.model,
            "optimiser": self.optimiser,
            "ends": [end.json() for end in self.ends],
            "published_error": self.published_error,
        }


def start_anywhere(model: str, optimiser: str, settings: Settings) -> Starting:
    """Search from the paper's start and from random ones within the mended bounds."""
    s = settings
    paper = MODELS[model]
    data = cleaned_tests(model, s.rate, s.duration, s.noise, s.seed, s.denoise)
    objective, box = Objective(paper, data), paper.box()
    starts = np.vstack([box.start, random_starts(box, s.random_starts, s.seed)])
    ends = tuple(optimise(objective, box, start, optimiser) for start in starts)
    return Starting(model, optimiser, ends, objective.error(np.array(paper.identified)))
