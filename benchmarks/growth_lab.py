"""Records of any length for `growth`: what an identification does with their samples."""

from __future__ import annotations

from functools import cache

import numpy as np
from inerter import Device
from inerter.benchmark.laws import LAWS, parameters_of
from inerter.benchmark.timing import Work
from inerter.identify.fit import Problem
from inerter.identify.laws import law_named
from inerter.identify.model import Model
from inerter.identify.multistart import search
from inerter.identify.runs import thin
from inerter.records import Record
from inerter.records.preparation import prepare
from inerter.reference import sum_of_sines

SPACING = 1e-3


def motion(samples: int) -> tuple[np.ndarray, ...]:
    """Time, displacement, velocity, acceleration of three sines."""
    sines = sum_of_sines([0.01, 0.003, 0.001], [0.7, 1.9, 4.1], [0.0, 1.0, 2.0])
    time = SPACING * np.arange(samples)
    names = ("displacement", "velocity", "acceleration")
    return time, *(np.asarray(getattr(sines, name)(time)) for name in names)


@cache
def record(samples: int) -> Record:
    """A LuGre device on a noisy bench."""
    time, x, v, a = motion(samples)
    random = np.random.default_rng(0)
    force = Device(**parameters_of("lugre")).along(SPACING, x, v, a)["total"]
    return Record(
        name="bench", time=time, displacement=x + 1e-6 * random.standard_normal(samples),
        force=force + 0.5 * random.standard_normal(samples),
    )  # fmt: skip


@cache
def problem(samples: int) -> Problem:
    """The record as a fit has it."""
    runs = [thin(one, 1 / SPACING) for one in prepare([record(samples)]).motions]
    return Problem(runs, [np.ones(run.force.size, bool) for run in runs])


def along(samples: int) -> Work:
    """A LuGre device along a motion."""
    device, (_, x, v, a) = Device(**parameters_of("lugre")), motion(samples)
    calls = max(1, 64000 // samples)

    def call() -> None:
        for _ in range(calls):
            device.along(SPACING, x, v, a)

    return Work(call, calls)


def smoothing(samples: int) -> Work:
    """The choice of a cut-off, and the record smoothed at it."""
    records = [record(samples)]
    return Work(lambda: prepare(records))


def jacobian(samples: int) -> Work:
    """Derivatives of the residual by the eight parameters of a LuGre device."""
    law = LAWS["lugre"]
    values = {
        "inertance": 113.0, "viscous": 10.0, "coulomb_force": law["coulomb_force"],
        "static_excess": law["static_force"] - law["coulomb_force"],
        "stribeck_velocity": law["stribeck_velocity"],
        "presliding": law["coulomb_force"] / law["bristle_stiffness"],
        "bristle_damping": law["bristle_damping"],
    }  # fmt: skip
    here, model = problem(samples), Model("lugre", values, tuple(values))
    return Work(lambda: here.jacobian(model))


def starts(count: int) -> Work:
    """A search from so many starting points."""
    here = problem(2500)
    return Work(lambda: search(here, law_named("dahl"), {}, starts=count))
