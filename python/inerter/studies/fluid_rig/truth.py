"""The measurements: the reference's equations, integrated adaptively.

The truth must not come from the simulator that a fit uses, or the fit would not see its simulator's
errors: so it is the independent reference, and this is the one place where the study leans on it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.model_parameters import FLUID_INERTER, FluidInerterParameters
from inerter.parallel import run_all
from inerter.studies.fluid_rig.rig import Configuration
from inerter.studies.fluid_rig.signals import Signals
from inerter.studies.fluid_rig.sweeps import Sweep

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Experiment:
    """One test as the reference runs it; air_damping only matters when complete [N s/m]."""

    configuration: Configuration
    sweep: Sweep
    air_damping: float = 0.0
    rate: float = 200.0
    parameters: FluidInerterParameters = FLUID_INERTER


def published_air_damping(preload: float) -> float:
    """c_a after a preload [N s/m].

    Raises
    ------
    ValueError
        The paper has no such preload.
    """
    known = dict(zip((0.05, 0.10), FLUID_INERTER.air_damping_preload, strict=True))
    if preload not in known:
        raise ValueError(f"preload: {preload:g} V; the paper has 0.05 V and 0.10 V")
    return known[preload]


def experiment(
    configuration: Configuration, sweep: Sweep, rate: float, parameters: FluidInerterParameters
) -> Experiment:
    """The test with the published damping of the air after its preload."""
    damping = 0.0 if sweep.preload is None else published_air_damping(sweep.preload)
    return Experiment(configuration, sweep, damping, rate, parameters)


def true_signals(test: Experiment) -> Signals:
    """What perfect instruments would record in a test."""
    from inerter.reference import FluidInerterTest, complete_device, dry_device

    samples = round(test.sweep.duration * test.rate)
    times = np.arange(samples) / test.rate
    if test.configuration == "dry":
        device = dry_device(test.parameters)
    else:
        device = complete_device(test.parameters, air_damping=test.air_damping)
    rig = FluidInerterTest(device=device, piston_mass=test.parameters.piston_mass)
    run = rig.simulate(
        lambda t: float(test.sweep.voltage(np.asarray(t))),
        times, method="LSODA", rtol=1e-9, atol=1e-12,
    )  # fmt: skip
    water = run.displacement - run.device_states[:, 0] if run.device_states.size else np.zeros(1)
    return Signals(test.rate, run.displacement, run.force, float(np.abs(water).max()))


def all_true_signals(
    tests: Sequence[Experiment],
    jobs: int | None = None,
    progress: Callable[[float], None] = lambda share: None,
) -> list[Signals]:
    """`true_signals` of tests on several processes."""
    return run_all(true_signals, tests, jobs=jobs, progress=progress)
