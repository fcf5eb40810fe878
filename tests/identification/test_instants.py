"""Jumps that a low-pass smoothed are followed between samples, those sampled as they are not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose.engines import simulate_engines
from inerter.identify.between import about_samples, between
from inerter.identify.channel_filter import Filter
from inerter.identify.estimate import identify
from inerter.identify.fit import Problem
from inerter.identify.instants import with_instants
from inerter.identify.model import Model
from inerter.identify.runs import thin, whole
from inerter.records import Record
from inerter.records.preparation import prepare
from inerter.reference import ReferenceDevice, response, sum_of_sines
from scipy.signal import bessel, sosfilt

MOTION = sum_of_sines([0.008, 0.004, 0.002], [0.7, 1.9, 3.7], [0.3, 1.0, 2.0])
MODEL = Model("none", {"inertance": 40.0, "transition_velocity": 1e-4}, ("inertance",))
FINE = 40


def record(rate: float, cutoff: float, friction: float = 60.0) -> Record:
    """What a converter tells, behind a low-pass or with a cut-off of 0 without one."""
    time = np.arange(0, 12, 1 / (FINE * rate))
    law = {"friction": "coulomb", "coulomb_force": friction} if friction else {}
    device = ReferenceDevice(inertance=50.0, **law)
    truth = response(device, MOTION, time)
    force = truth.force
    if cutoff:
        low_pass = bessel(4, cutoff, fs=FINE * rate, norm="mag", output="sos")
        force = np.asarray(sosfilt(low_pass, force))
    random, kept = np.random.default_rng(2), slice(0, None, FINE)
    noise = random.normal(0, 0.3, force[kept].size), random.normal(0, 2e-6, force[kept].size)
    return Record(
        name="run", time=time[kept], force=force[kept] + noise[0],
        displacement=truth.displacement[kept] + noise[1],
    )  # fmt: skip


@pytest.mark.parametrize("rate", [100.0, 250.0])
@pytest.mark.parametrize(("share", "friction", "more"), [(0.5, 60, 1), (0, 60, 0), (0.5, 0, 0)])
def test_more_instants_where_jumps_were_smoothed(
    rate: float, share: float, friction: float, more: int
) -> None:
    records = [record(rate, share * rate, friction)]
    motions = prepare(records).motions
    learnt = [np.ones(motion.force.size, bool) for motion in motions]
    found = with_instants(records, motions, MODEL, learnt)
    assert (found[0].instants > 1) is bool(more)
    if not more:
        assert found is records


def test_what_more_instants_tell() -> None:
    """Friction and delay as they are, and less than half of the error left, in the band and raw."""
    plain = record(250.0, 100.0)
    errors = {}
    for instants in (1, 4):
        (motion,) = prepare([plain]).motions
        motion = replace(motion, instants=instants)
        run, raw = thin(motion), whole(motion)
        model = MODEL.adding("coulomb", coulomb_force=50.0, transition_velocity=1e-3, delay=0.002)
        problem = Problem([run], [run.inner])
        fit = problem.fit(model)
        wide = Problem([raw], [raw.inner])
        errors[instants] = (
            fit.rmse(problem.masks), float(np.std(wide.errors(fit.model)[0][raw.inner])),
        )  # fmt: skip
        if instants > 1:
            assert fit.model.values["coulomb_force"] == pytest.approx(60.0, rel=0.01)
            assert fit.model.values["inertance"] == pytest.approx(50.0, rel=0.005)
    assert errors[4][0] < 0.5 * errors[1][0]
    assert errors[4][1] < errors[1][1]


def test_a_motion_between_its_samples() -> None:
    spacing, instants = 0.01, 5
    time = spacing * np.arange(200)
    fine = spacing / instants * np.arange(199 * instants + 1)

    def motion(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        w = 2 * np.pi * 3.0
        return np.sin(w * t), w * np.cos(w * t), -(w**2) * np.sin(w * t)

    x, v, a = between(spacing, motion(time), instants)
    for found, exact in zip((x, v, a), motion(fine), strict=True):
        np.testing.assert_allclose(found, exact, atol=1e-5 * np.max(np.abs(exact)))
        np.testing.assert_allclose(
            found[::instants], exact[::instants], rtol=0, atol=1e-9 * np.ptp(exact)
        )


def test_what_rests_goes_on_resting() -> None:
    x, v, a = np.array([0.0, 1.0, 1.001, 1.0]), np.array([1.0, 0.0, 0.0, 0.0]), np.ones(4)
    fine = between(0.1, (x, v, a), 4)
    assert np.all(fine[1][4:] == 0.0)
    np.testing.assert_array_equal(fine[0][4:], [1.0] * 4 + [1.001] * 4 + [1.0])


def test_engines_show_jumps_as_the_samples_do() -> None:
    """Four instants per sample in every engine, friction as a low-pass leaves it."""
    (motion,) = prepare([record(250.0, 100.0)]).motions
    raw = whole(replace(motion, instants=4))
    values = {"inertance": 50.0, "coulomb_force": 60.0, "transition_velocity": 1e-3}
    model = Model("coulomb", {**values, "delay": 0.002}, ())
    (error,) = Problem([raw], [raw.inner]).errors(model)
    expected = float(np.sqrt(np.mean(error[raw.inner] ** 2)))
    found = simulate_engines(model, [raw], [raw.inner])
    known = {name: value for name, value in found.items() if value is not None}
    assert {"mujoco", "reference"} <= known.keys()
    for name, value in known.items():
        assert value == pytest.approx(expected, rel=1e-5), name
    # at the samples' instants jumps lie elsewhere
    (plain,) = Problem([whole(motion)], [raw.inner]).errors(model)
    assert float(np.sqrt(np.mean(plain[raw.inner] ** 2))) > 1.05 * expected


@pytest.mark.parametrize("instants", [2, 3, 4, 8])
def test_friction_about_a_sample_jumps_when_it_does(instants: int) -> None:
    """A step in the middle between two samples is half of it at none; one at a sample, at that."""
    fine = np.arange(10 * instants + 1)
    zero = np.zeros(fine.size)
    for jump in (5 * instants, 5 * instants + instants // 2):
        friction = np.sign(fine - jump).astype(float)
        shown = about_samples({"total": friction, "friction": friction}, instants)["friction"]
        exact = np.clip(2.0 * (np.arange(11) * instants - jump) / instants, -1.0, 1.0)
        # between two samples to one instant
        within = 1.0 / instants if jump % instants else 1e-12
        np.testing.assert_allclose(shown, exact, rtol=0, atol=within)
    smooth = about_samples({"total": fine + zero, "friction": zero}, instants)
    np.testing.assert_array_equal(smooth["total"], fine[::instants])


def test_identify_follows_jumps_that_a_stated_low_pass_smoothed() -> None:
    """Level and inertance within their errors, which are a fourth smaller than at the samples."""
    stated = {"force": Filter("bessel", 4, 100.0)}
    (coulomb,) = identify([record(250.0, 100.0)], ["coulomb"], filters=stated).results
    assert all(run.instants > 1 for run in coulomb.runs)
    level, inertance = (coulomb.parameters[name] for name in ("coulomb_force", "inertance"))
    assert abs(level.value - 60.0) < 2 * level.stderr < 0.2
    assert abs(inertance.value - 50.0) < 2 * inertance.stderr < 0.1
