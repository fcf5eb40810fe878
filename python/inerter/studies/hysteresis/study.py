"""All of the study: independent pieces of work on processes, then tables and conclusions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

from inerter.parallel import run_all
from inerter.studies.hysteresis.bias import Bias, draw, summarised
from inerter.studies.hysteresis.conclusions import Conclusion, conclude
from inerter.studies.hysteresis.crossing import FITTERS, Crossing, cross
from inerter.studies.hysteresis.determined import Determined, determined
from inerter.studies.hysteresis.emd import Decomposed, decomposed
from inerter.studies.hysteresis.loops import Loop, loop
from inerter.studies.hysteresis.optimisers import OPTIMISERS
from inerter.studies.hysteresis.protocol import Prediction, predict
from inerter.studies.hysteresis.published import (
    FREQUENCIES,
    IDEAL_INERTANCE,
    MAKERS,
    MODELS,
)
from inerter.studies.hysteresis.settings import Settings
from inerter.studies.hysteresis.starting import Starting, start_anywhere
from inerter.studies.hysteresis.virtual_tests import bench_tests, virtual_tests

SCHEMA = "inerter.hysteresis_study/1"
# samples per second at which the peaks of all four sines are samples
_LOOP_RATE = 4800.0
Progress = Callable[[float], None]
Piece = tuple[str, tuple[Any, ...], Settings]


@dataclass(frozen=True, kw_only=True)
class Study:
    """Results; `loops`: of the published devices and the ideal one, four each."""

    settings: Settings
    loops: dict[str, tuple[Loop, ...]]
    emd: tuple[Decomposed, ...]
    predictions: tuple[Prediction, ...]
    crossings: tuple[Crossing, ...]
    starting: tuple[Starting, ...]
    bias: tuple[Bias, ...]
    determined: tuple[Determined, ...]
    conclusions: tuple[Conclusion, ...]

    def json(self) -> dict[str, Any]:
        """Plain data; schema inerter.hysteresis_study/1."""
        return {
            "schema": SCHEMA,
            "settings": asdict(self.settings),
            "mended": {name: list(model.box().mended) for name, model in MODELS.items()},
            "published_loops": {
                name: [each.json() for each in loops] for name, loops in self.loops.items()
            },
            "emd": [each.json() for each in self.emd],
            "fit_at_4_hz": [each.json() for each in self.predictions],
            "held_out": [each.json() for each in self.crossings],
            "starts": [each.json() for each in self.starting],
            "bias": [each.json() for each in self.bias],
            "determined": [each.json() for each in self.determined],
            "conclusions": [each.json() for each in self.conclusions],
        }


def study(
    settings: Settings | None = None,
    *,
    jobs: int | None = None,
    progress: Progress = lambda share: None,
) -> Study:
    """The whole study.

    Parameters
    ----------
    settings
        What to do; see `Settings`.
    jobs
        Processes; as many as processors if not given.
    progress
        Called with the share that is done.
    """
    s = settings or Settings()
    pieces = [(kind, arguments, s) for kind, arguments in _pieces(s)]
    results = run_all(_work, pieces, jobs=jobs, progress=progress)

    def of(kind: str) -> list[Any]:
        return [r for (k, _, _), r in zip(pieces, results, strict=True) if k == kind]

    loops = published_loops(s)
    emd = tuple(row for rows in of("emd") for row in rows)
    predictions, crossings = tuple(of("predict")), tuple(of("cross"))
    starting, told = tuple(of("start")), tuple(of("determined"))
    bias = tuple(summarised([each for drawn in of("draw") for each in drawn], s))
    return Study(
        settings=s,
        loops=loops,
        emd=emd,
        predictions=predictions,
        crossings=crossings,
        starting=starting,
        bias=bias,
        determined=told,
        conclusions=conclude(s, loops, emd, predictions, crossings, starting, told),
    )


def published_loops(settings: Settings) -> dict[str, tuple[Loop, ...]]:
    """Loops of the devices of Table 3 and of the ideal inerter, by maker."""
    duration = settings.duration
    sets = {maker: virtual_tests(maker, _LOOP_RATE, duration) for maker in MAKERS}
    sets["ideal"] = bench_tests({"inertance": IDEAL_INERTANCE}, _LOOP_RATE, duration)
    return {name: tuple(loop(test, test.truth) for test in tests) for name, tests in sets.items()}


def _pieces(s: Settings) -> list[tuple[str, tuple[Any, ...]]]:
    """Kinds of work and their arguments, the longest first."""
    found: list[tuple[str, tuple[Any, ...]]] = []
    for fitter in reversed(tuple(FITTERS)):
        for maker in MAKERS:
            for held in FREQUENCIES:
                fitted = tuple(f for f in FREQUENCIES if f != held)
                found.append(("cross", (maker, fitter, fitted)))
    found += [("start", (model, each)) for model in MODELS for each in OPTIMISERS]
    found += [("predict", (maker, model, "mended")) for maker in MAKERS for model in MODELS]
    found += [("predict", (maker, "bouc_wen", "printed")) for maker in MAKERS]
    found += [("draw", (model, number)) for number in range(s.draws) for model in MODELS]
    found += [("determined", (model, tests)) for model in MODELS for tests in ((4.0,), FREQUENCIES)]
    found += [("emd", (maker,)) for maker in MAKERS]
    return found


_KINDS: dict[str, Callable[..., Any]] = {
    "cross": cross,
    "start": start_anywhere,
    "predict": predict,
    "draw": draw,
    "determined": determined,
    "emd": decomposed,
}


def _work(piece: Piece) -> Any:
    kind, arguments, settings = piece
    return _KINDS[kind](*arguments, settings)
