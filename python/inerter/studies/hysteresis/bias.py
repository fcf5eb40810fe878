"""What denoising does to estimates: each model on its own data, over many draws of the noise.

The fit starts at the truth, so that nothing but the data moves it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.core import Device
from inerter.studies.hysteresis.denoising import WAYS, clean
from inerter.studies.hysteresis.loops import loop
from inerter.studies.hysteresis.objective import Objective, force_of
from inerter.studies.hysteresis.optimisers import optimise
from inerter.studies.hysteresis.published import MODELS
from inerter.studies.hysteresis.settings import Settings
from inerter.studies.hysteresis.virtual_tests import measured, virtual_tests

Array = NDArray[np.float64]

QUANTITIES = ("inertance", "work_1_hz", "work_4_hz", "force_error")
"""Inertance [kg], work per cycle at 1 and 4 Hz [J], rms distance of the fitted force from the
truth over all tests [N]."""
LEVELS = ("coulomb_force", "bristle_stiffness")
"""Parameters that are reported beside them where the tests determine them: Dahl's."""

# along what the data leave open a search has nowhere to go
_ITERATIONS = 25


@dataclass(frozen=True, kw_only=True)
class Bias:
    """Mean error and scatter of estimates in one way to denoise, `draws` noises each.

    `truth`, `mean`, `scatter` by quantity; `left`: rms distance [N] of the cleaned force from the
    truth.
    """

    model: str
    way: str
    draws: int
    truth: dict[str, float]
    mean: dict[str, float]
    scatter: dict[str, float]
    left: float

    def share(self, name: str) -> tuple[float, float]:
        """Bias and scatter of a quantity per its true value."""
        true = self.truth[name]
        return (self.mean[name] - true) / true, self.scatter[name] / true

    def json(self) -> dict[str, object]:
        """Plain data."""
        return {
            "model": self.model,
            "way": self.way,
            "draws": self.draws,
            "truth": self.truth,
            "mean": self.mean,
            "scatter": self.scatter,
            "left": self.left,
        }


@dataclass(frozen=True)
class Drawn:
    """Estimates from one draw in one way."""

    model: str
    way: str
    estimates: dict[str, float]
    left: float


def draw(model: str, number: int, settings: Settings) -> list[Drawn]:
    """Estimates of one model from noise number `number`, in every way to denoise."""
    s, paper = settings, MODELS[model]
    tests = virtual_tests(model, s.rate, s.duration)
    forces = [measured(model, test, s.noise, s.seed + 1000 * (number + 1)) for test in tests]
    found = []
    for way in WAYS:
        cleaned = [clean(f, t.spacing, way) for f, t in zip(forces, tests, strict=True)]
        objective = Objective(paper, list(zip(tests, cleaned, strict=True)))
        truth = np.array(paper.identified)
        end = optimise(objective, paper.box(), truth, "least_squares", _ITERATIONS)
        left = np.concatenate(
            [(c.force - t.truth)[t.settled] for c, t in zip(cleaned, tests, strict=True)]
        )
        estimates = _quantities(model, end.vector, settings)
        found.append(Drawn(model, way, estimates, float(np.sqrt(np.mean(left**2)))))
    return found


def _quantities(model: str, vector: Array | tuple[float, ...], s: Settings) -> dict[str, float]:
    paper = MODELS[model]
    device = Device(**paper.values(vector))
    tests = virtual_tests(model, s.rate, s.duration)
    forces = [force_of(device, test) for test in tests]
    apart = np.concatenate([(f - t.truth)[t.settled] for f, t in zip(forces, tests, strict=True)])
    values = dict(zip(paper.names, map(float, vector), strict=True))
    return {
        "inertance": values["inertance"],
        "work_1_hz": loop(tests[0], forces[0]).work,
        "work_4_hz": loop(tests[-1], forces[-1]).work,
        "force_error": float(np.sqrt(np.mean(apart**2))),
        **({name: values[name] for name in LEVELS} if model == "dahl" else {}),
    }


def summarised(drawn: list[Drawn], settings: Settings) -> list[Bias]:
    """One row for each model and way, from all draws."""
    rows = []
    for model in dict.fromkeys(each.model for each in drawn):
        truth = _quantities(model, MODELS[model].identified, settings)
        for way in WAYS:
            part = [each for each in drawn if (each.model, each.way) == (model, way)]
            table = {name: np.array([p.estimates[name] for p in part]) for name in truth}
            rows.append(
                Bias(
                    model=model, way=way, draws=len(part), truth=truth,
                    mean={name: float(v.mean()) for name, v in table.items()},
                    scatter={name: float(v.std(ddof=1)) for name, v in table.items()},
                    left=float(np.sqrt(np.mean([p.left**2 for p in part]))),
                )
            )  # fmt: skip
    return rows
