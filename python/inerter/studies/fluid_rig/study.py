"""The whole study: tests by the reference, noise, identification dry then complete, statements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from inerter.model_parameters import FLUID_INERTER
from inerter.parallel import run_all
from inerter.rig import quiet
from inerter.studies.fluid_rig.identify import Held, IdentifiedRig, identify
from inerter.studies.fluid_rig.objective import Measured
from inerter.studies.fluid_rig.rig import Configuration, Rig
from inerter.studies.fluid_rig.settings import Settings
from inerter.studies.fluid_rig.signals import Signals
from inerter.studies.fluid_rig.statements import Statement, statements
from inerter.studies.fluid_rig.sweeps import COMPLETE, DRY, LEVELS, Sweep
from inerter.studies.fluid_rig.truth import all_true_signals, experiment
from inerter.studies.fluid_rig.unknowns import (
    COMPLETE_LIVE,
    device_values,
    left_the_law,
    random_start,
)

Truth = dict[tuple[Configuration, Sweep], Signals]
Progress = Callable[..., None]


@dataclass(frozen=True)
class RigRun:
    """One seed and objective: the measured tests, and what was identified from them."""

    seed: int
    objective: str
    dry: IdentifiedRig
    complete: IdentifiedRig


@dataclass(frozen=True, kw_only=True)
class Study:
    """All of it.

    truth: signals without noise by configuration and test. measured: those of the first seed. runs:
    seed by seed, objective by objective. level: the fitted model in the test that no fit has seen
    (Fig. 20). seconds: wall time of the true tests and of the identifications.
    """

    settings: Settings
    truth: Truth
    measured: dict[Configuration, Measured]
    runs: tuple[RigRun, ...]
    level: Signals
    statements: tuple[Statement, ...]
    seconds: tuple[float, float]

    @property
    def shown(self) -> RigRun:
        """The run in the pictures: the first seed, the first objective."""
        return self.runs[0]


def study(
    settings: Settings, jobs: int | None = None, progress: Progress = lambda *given: None
) -> Study:
    """Simulate the tests, disturb them, identify, and check what the paper states.

    Parameters
    ----------
    settings
        What is asked for.
    jobs
        Processes; one per processor if not given.
    progress
        Called with the share that is done and a text.

    Raises
    ------
    ValueError
        No start leads to a simulation that reaches its end.
    """
    begin = perf_counter()
    dry, complete, levels = (
        tuple(sweep.shortened(settings.duration) for sweep in group)
        for group in (DRY, COMPLETE, LEVELS)
    )
    tests: list[tuple[Configuration, Sweep]] = [
        *(("dry", sweep) for sweep in dry),
        *(("complete", sweep) for sweep in (*complete, levels[1])),
    ]
    experiments = [experiment(*test, settings.rate, FLUID_INERTER) for test in tests]
    found = all_true_signals(
        experiments, jobs, lambda share: progress(0.4 * share, "tests by the reference")
    )
    truth: Truth = dict(zip(tests, found, strict=True))
    middle = perf_counter()
    work = [
        (settings, seed, objective, truth, jobs)
        for seed in settings.seeds
        for objective in settings.objectives
    ]
    runs = run_all(
        _run, work, jobs=jobs, progress=lambda share: progress(0.4 + 0.6 * share, "identifying")
    )
    shown = runs[0]
    values = shown.dry.parameters | device_values(shown.complete.parameters, levels[1])
    with quiet():
        (level,) = Rig("complete", COMPLETE_LIVE, settings.rate).simulate([(levels[1], values)])
    if level is None:
        raise ValueError("the fitted model does not reach the end of the higher level")
    return Study(
        settings=settings,
        truth=truth,
        measured=measured_tests(settings, settings.seeds[0], truth),
        runs=tuple(runs),
        level=level,
        statements=statements(truth, dry, complete, levels, shown.dry, shown.complete, level),
        seconds=(middle - begin, perf_counter() - middle),
    )


def measured_tests(settings: Settings, seed: int, truth: Truth) -> dict[Configuration, Measured]:
    """The tests with the noise of a seed."""
    generator = np.random.default_rng([seed, 0])
    found: dict[Configuration, Measured] = {}
    groups: dict[Configuration, tuple[Sweep, ...]] = {"dry": DRY, "complete": COMPLETE}
    for configuration, group in groups.items():
        sweeps = tuple(sweep.shortened(settings.duration) for sweep in group)
        signals = tuple(
            truth[configuration, sweep].disturbed(settings.noise, generator) for sweep in sweeps
        )
        found[configuration] = Measured(sweeps, signals)
    return found


def outside(truth: Truth) -> dict[str, float]:
    """Tests in which the water left the printed law of the air, and how far it went [m]."""
    return {
        f"{configuration}, {sweep.name}": signals.farthest
        for (configuration, sweep), signals in truth.items()
        if left_the_law(signals)
    }


def _run(work: tuple[Settings, int, str, Truth, int | None]) -> RigRun:
    """One seed and objective, in a process of its own."""
    settings, seed, objective, truth, jobs = work
    measured = measured_tests(settings, seed, truth)
    generator = np.random.default_rng([seed, 1])
    # the processes share the processors among themselves
    threads = 0 if jobs == 1 else 1

    def starts(configuration: Configuration) -> list[dict[str, float]]:
        sweeps = measured[configuration].sweeps
        return [
            random_start(configuration, sweeps, generator, settings.factor)
            for _ in range(settings.starts)
        ]

    with quiet():
        dry = identify("dry", measured["dry"], objective, starts("dry"), threads=threads)
        held = Held(dry.parameters, dry.covariance)
        complete = identify(
            "complete", measured["complete"], objective, starts("complete"), held, threads
        )
    return RigRun(seed, objective, dry, complete)
