"""A force channel that does not hold a constant force, and a zero that settles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from inerter.diagnose import Diagnosis, diagnose_bench
from inerter.diagnose.candidates import candidates
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.runs import scales, thin
from inerter.records import Record
from inerter.records.preparation import prepare
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid, solve_ivp
from scipy.interpolate import CubicSpline

Array = NDArray[np.float64]
Channel = Callable[[Array, Array], Array]

RATE, SECONDS = 250.0, 16.0
INERTANCE, DAMPING, LEVEL, BRISTLE = 40.0, 120.0, 25.0, 2e5
TONES = ((0.4, 0.02), (0.9, 0.012), (1.9, 0.006), (3.7, 0.002))


def sines(t: Array, number: int) -> tuple[Array, Array, Array]:
    """Displacement, velocity and acceleration of four sines, shape (n,) each."""
    phases = np.random.default_rng(number).uniform(0, 2 * np.pi, len(TONES))
    found = [np.zeros(t.size) for _ in range(3)]
    for (frequency, size), phase in zip(TONES, phases, strict=True):
        w = 2 * np.pi * frequency
        for order in range(3):
            found[order] += size * w**order * np.sin(w * t + phase + 0.5 * np.pi * order)
    return found[0], found[1], found[2]


def bench(number: int, channel: Channel, level: float = LEVEL, stiffness: float = 0.0) -> Record:
    """An inerter with viscous and Dahl friction [N] and a spring [N/m] before a force channel."""
    every, t = 8, np.arange(0, SECONDS, 1 / RATE / 8)
    x, v, a = sines(t, number)
    force = INERTANCE * a + DAMPING * v + stiffness * x
    if level:
        speed = CubicSpline(t, v)

        def bent(at: float, z: Array) -> Array:
            return speed(at) * (1 - BRISTLE * z / level * np.sign(speed(at)))

        solved = solve_ivp(bent, (0, t[-1]), [0.0], "LSODA", t, max_step=2e-3, rtol=1e-7)
        force = force + BRISTLE * solved.y[0]
    random, shown = np.random.default_rng(100 + number), channel(t, force)[::every]
    return Record(
        name=f"run{number}", time=t[::every],
        displacement=x[::every] + random.normal(0, 2e-6, shown.size),
        force=shown + random.normal(0, 0.5, shown.size),
    )  # fmt: skip


def discharged(time: float) -> Channel:
    """A charge amplifier: y' = F' - y / time, written as y + integral of y / time = F."""

    def shown(t: Array, force: Array) -> Array:
        grown = cumulative_trapezoid(force * np.exp(t / time), t, initial=0.0)
        return np.asarray(force - np.exp(-t / time) * grown / time)

    return shown


def settling(t: Array, force: Array) -> Array:
    """A zero that goes from 0 to 6 N within some seconds."""
    return force + 6.0 * (1 - np.exp(-t / 4.0))


def unchanged(t: Array, force: Array) -> Array:
    return force


def found_in(*records: Record) -> tuple[Diagnosis, dict[str, Any]]:
    diagnosis = diagnose_bench(records)
    return diagnosis, {finding.effect: finding for finding in diagnosis.findings}


@pytest.mark.long
def test_a_channel_that_does_not_hold_a_constant_force_is_named() -> None:
    """It was damping of 101 N s/m, a stiffness below 0 and 1.9 N left of 0.5."""
    _, found = found_in(*(bench(number, discharged(2.0)) for number in range(3)))
    assert found.keys() == {"hysteretic_friction", "viscous_friction", "sensor_coupling"}
    corner = found["sensor_coupling"].parameters["force_coupling"]
    assert corner.value == pytest.approx(0.5 / np.pi / 2.0, abs=4 * corner.stderr)
    assert corner.stderr < 0.03 * corner.value
    damping = found["viscous_friction"].parameters["viscous"]
    assert damping.value == pytest.approx(DAMPING, rel=0.02)
    assert not found["sensor_coupling"].members


@pytest.mark.long
def test_a_zero_that_settles_is_no_spring_that_relaxes() -> None:
    _, found = found_in(bench(1, settling))
    names = {"hysteretic_friction", "viscous_friction", "force_offset", "zero_settling"}
    assert found.keys() == names
    time = found["zero_settling"].parameters["settling_time"]
    assert time.value == pytest.approx(4.0, abs=4 * time.stderr)
    assert found["force_offset"].parameters["force_offset"].value == pytest.approx(6.0, abs=0.3)


def test_where_all_is_linear_a_branch_and_such_a_channel_are_one() -> None:
    """Told as one finding with two members."""
    runs = [bench(number, discharged(0.5), 0.0, 3000.0) for number in range(2)]
    diagnosis, found = found_in(*runs)
    told = found["viscoelasticity"]
    assert set(told.members) == {"viscoelasticity", "sensor_coupling"}
    assert told.parameters["force_coupling"].value == pytest.approx(1 / np.pi, rel=0.01)
    # b s^2 + (c - b w) s + K s / (s + w), K = k - w (c - b w)
    assert told.parameters["branch_stiffness_1"].value == pytest.approx(2920.0, rel=0.01)
    assert "this motion cannot tell; a known constant force would" in diagnosis.verdict


def test_along_one_sine_such_a_channel_is_not_looked_for() -> None:
    runs = [thin(motion) for motion in prepare([bench(1, unchanged, 0.0)]).motions]
    sizes = scales(runs)
    model = Model("none", {"inertance": 40.0, "transition_velocity": 1e-3}, ("inertance",))

    def names(one_tone: bool) -> set[str]:
        return {each.effect for each in candidates(model, replace(sizes, one_tone=one_tone))}

    assert names(False) - names(True) >= {"sensor_coupling"}
    assert "zero_settling" in names(True)


@pytest.mark.parametrize(
    ("channel", "name", "value"),
    [(discharged(1.5), "force_coupling", 0.5 / np.pi / 1.5), (settling, "settling_time", 4.0)],
)
def test_a_fit_finds_the_corner_and_the_time(channel: Channel, name: str, value: float) -> None:
    """What was in the channel as the record began is read off the record."""
    late = [bench(number, channel, 0.0) for number in (1, 2)]
    records = [
        Record(
            name=each.name, time=each.time[200:], displacement=each.displacement[200:],
            force=each.force[200:],
        )
        for each in late
    ]  # fmt: skip
    runs = [thin(motion) for motion in prepare(records).motions]
    problem = Problem(runs, [run.inner for run in runs])
    values = {"inertance": 30.0, "viscous": 80.0, "force_offset": 0.0, name: 3 * value}
    if name == "force_coupling":
        del values["force_offset"]
    found = problem.fit(Model("none", values, tuple(values))).model.values
    assert found[name] == pytest.approx(value, rel=0.05)
    assert found["viscous"] == pytest.approx(DAMPING, rel=0.01)
    assert found["inertance"] == pytest.approx(INERTANCE, rel=1e-3)
