"""Where a tone is looked for: found where there is one, nowhere else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose.tone import Witness, strongest_line, with_tone_above
from inerter.identify.fit import Fit, Problem
from inerter.identify.model import Model
from inerter.identify.prediction import force_along
from inerter.identify.runs import BenchRun, whole
from inerter.records import Record
from inerter.records.preparation import prepare

TIME = np.arange(0, 8, 1e-3)


def moving(frequency: float, seed: int) -> BenchRun:
    random = np.random.default_rng(seed)
    x = 5e-3 * np.sin(2 * np.pi * frequency * TIME)
    force = 40 * np.gradient(np.gradient(x, TIME), TIME) + random.standard_normal(TIME.size)
    return whole(prepare([Record(name="run", time=TIME, displacement=x, force=force)]).motions[0])


RUNS = [moving(1.1, 1), moving(2.3, 2)]
EVERYTHING = [np.ones(TIME.size, bool)] * 2


def noise(seed: int) -> list[np.ndarray]:
    random = np.random.default_rng(seed)
    return [random.standard_normal(TIME.size) for _ in RUNS]


@pytest.mark.parametrize("frequency", [0.7, 6.4, 44.0, 180.0])
def test_a_tone_of_a_tenth_of_the_noise_power_is_found(frequency: float) -> None:
    residual = [
        values + 0.45 * np.sin(2 * np.pi * frequency * TIME + phase)
        for phase, values in enumerate(noise(3))
    ]
    line = strongest_line(RUNS, residual, EVERYTHING)
    assert line is not None
    assert line[0] == pytest.approx(frequency, abs=0.1)
    assert line[1] == pytest.approx(0.45, rel=0.35)


def test_noise_has_no_tone() -> None:
    assert all(strongest_line(RUNS, noise(seed), EVERYTHING) is None for seed in range(20))


def test_a_line_of_the_motion_or_of_friction_along_it_is_no_tone() -> None:
    for run in RUNS:
        for wave in (run.displacement / 5e-3, np.sign(run.velocity)):
            assert strongest_line([run], [wave + 0.5 * noise(4)[0]], EVERYTHING[:1]) is None


@pytest.mark.parametrize("amplitude", [0.0, 0.4])
def test_a_tone_above_the_band_is_fitted_to_the_raw_force(amplitude: float) -> None:
    tone = amplitude * np.sin(2 * np.pi * 61.3 * TIME)
    shaken = [replace(run, force=run.force + tone) for run in RUNS]
    problem = Problem(shaken, EVERYTHING)
    fit = problem.fit(Model("none", {"inertance": 40.0}, ("inertance",)))
    witness = Witness(problem, [run.displacement for run in RUNS])
    found = with_tone_above(witness, fit, lowest=30.0)
    if not amplitude:
        assert found is None
        return
    assert found is not None
    assert found.model.values["disturbance_frequency"] == pytest.approx(61.3, abs=0.01)
    assert found.model.values["disturbance_amplitude"] == pytest.approx(amplitude, rel=0.1)
    # what was fitted in the band stays, with what is known of it
    assert found.model.values["inertance"] == fit.model.values["inertance"]
    assert found.covariance.shape == (3, 3)
    assert found.covariance[0, 0] == fit.covariance[0, 0]
    assert with_tone_above(witness, fit, lowest=100.0) is None


@pytest.mark.parametrize("seen", [True, False])
@pytest.mark.parametrize("hum", [0.0, 0.4])
def test_what_rings_in_the_motion_is_no_tone(seen: bool, hum: float, effects_seed: int) -> None:
    """Three near tones above the band; the displacement shows them, or its noise hides them."""
    draw = np.random.default_rng(effects_seed)
    runs, displacements = [], []
    for run in RUNS:
        ringing = np.zeros_like(TIME)
        acceleration = np.zeros_like(TIME)
        for frequency in 83.0 + np.array([-1.1, 0.0, 1.3]):
            wave = np.sin(2 * np.pi * frequency * TIME + draw.uniform(0, 6))
            ringing += 0.02 * wave / (2 * np.pi * frequency) ** 2
            acceleration -= 0.02 * wave
        mains = hum * np.sin(2 * np.pi * 50.0 * TIME + draw.uniform(0, 6))
        noise = (1e-7 if seen else 2e-6) * draw.standard_normal(TIME.size)
        runs.append(replace(run, force=run.force + 40.0 * acceleration + mains))
        displacements.append(run.displacement + ringing + noise)
    problem = Problem(runs, EVERYTHING)
    fit = problem.fit(Model("none", {"inertance": 40.0}, ("inertance",)))
    found = with_tone_above(Witness(problem, displacements), fit, lowest=30.0)
    if not hum:
        assert found is None
        return
    assert found is not None
    assert found.model.values["disturbance_frequency"] == pytest.approx(50.0, abs=0.02)


@pytest.mark.parametrize("share", [1.8, 0.05])
def test_a_line_that_a_coarse_displacement_tells_badly_is_of_the_motion(share: float) -> None:
    """A displacement that shows too much of a line, as steps do, still shows that it moves."""
    wave = 0.6 * np.sin(2 * np.pi * 47.3 * TIME)
    shaken = [replace(run, force=run.force + wave) for run in RUNS]
    problem = Problem(shaken, EVERYTHING)
    fit = problem.fit(Model("none", {"inertance": 40.0}, ("inertance",)))
    moved = -share * wave / (40.0 * (2 * np.pi * 47.3) ** 2)
    random = np.random.default_rng(4)
    seen = [run.displacement + moved + random.normal(0, 1e-7, TIME.size) for run in RUNS]
    found = with_tone_above(Witness(problem, seen), fit, lowest=30.0)
    # of a twentieth the force is none
    assert (found is None) == (share > 1.0)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("rings", [True, False])
def test_a_line_that_a_noisy_displacement_may_have_is_of_the_motion(rings: bool, seed: int) -> None:
    """Its line is eight or so times its noise, and out of step with the force."""
    angle = 2 * np.pi * 47.3 * TIME
    shaken = [replace(run, force=run.force + 0.6 * np.sin(angle)) for run in RUNS]
    problem = Problem(shaken, EVERYTHING)
    fit = problem.fit(Model("none", {"inertance": 40.0}, ("inertance",)))
    moved = -0.6 * np.sin(angle - 1.2) / (40.0 * (2 * np.pi * 47.3) ** 2) if rings else 0.0
    random = np.random.default_rng(seed)
    seen = [run.displacement + moved + random.normal(0, 1.4e-6, TIME.size) for run in RUNS]
    found = with_tone_above(Witness(problem, seen), fit, lowest=30.0)
    assert (found is None) is rings


@pytest.mark.parametrize("alone", [False, True])
def test_a_line_among_those_of_a_drive_that_rings_is_none(alone: bool) -> None:
    """The noise of the displacement hides one of three; one alone that it lacks is a tone."""
    frequencies = 47.3 * np.array([0.98, 1.0, 1.03])
    waves = [np.sin(2 * np.pi * f * TIME + i) for i, f in enumerate(frequencies)]
    force = 0.6 * (waves[1] if alone else sum(waves))
    shaken = [replace(run, force=run.force + force) for run in RUNS]
    problem = Problem(shaken, EVERYTHING)
    fit = problem.fit(Model("none", {"inertance": 40.0}, ("inertance",)))
    moved = sum(
        -0.6 * share * wave / (40.0 * (2 * np.pi * f) ** 2)
        for share, f, wave in zip((1.0, 0.3, 1.0), frequencies, waves, strict=True)
    )
    random = np.random.default_rng(3)
    seen = [
        run.displacement + (0.0 if alone else moved) + random.normal(0, 1e-7, TIME.size)
        for run in RUNS
    ]
    found = with_tone_above(Witness(problem, seen), fit, lowest=30.0)
    assert (found is not None) is alone


def behind_noise(force: np.ndarray) -> Fit | None:
    """What is told of lines in the force that the displacement's noise would hide."""
    shaken = [replace(run, force=run.force + force) for run in RUNS]
    problem = Problem(shaken, EVERYTHING)
    fit = problem.fit(Model("none", {"inertance": 40.0}, ("inertance",)))
    random = np.random.default_rng(5)
    seen = [run.displacement + random.normal(0, 1e-5, TIME.size) for run in RUNS]
    return with_tone_above(Witness(problem, seen), fit, lowest=30.0)


@pytest.mark.parametrize(("ringing", "named"), [(0.0, True), (47.4, False), (83.0, True)])
def test_a_line_of_the_mains_beside_a_higher_one_may_be_of_what_rings(
    ringing: float, named: bool
) -> None:
    """The displacement's noise hides both: only a frequency can tell hum, and not beside a ring."""
    hum = 0.4 * np.sin(2 * np.pi * 50.0 * TIME)
    ring = 1.2 * np.sin(2 * np.pi * ringing * TIME)
    found = behind_noise(hum + ring)
    assert (found is not None) is named
    if found:
        assert found.model.values["disturbance_frequency"] == pytest.approx(50.0, abs=0.02)


@pytest.mark.parametrize(("size", "named"), [(0.3, True), (0.8, False)])
def test_one_of_three_like_lines_is_not_of_the_mains(size: float, named: bool) -> None:
    """Lines of a drive, one of them at 50 Hz by chance; the displacement's noise hides them."""
    lines = [(size, 49.0), (1.0, 50.0), (size, 51.5)]
    waves = [share * np.sin(2 * np.pi * f * TIME + i) for i, (share, f) in enumerate(lines)]
    force = np.sum(waves, axis=0)
    found = behind_noise(force)
    assert (found is not None) is named


@pytest.mark.parametrize(
    ("delay", "one_sine", "clear"),
    [(0.0, True, True), (0.015, True, True), (-0.015, False, True), (-0.015, True, False)],
)
def test_a_late_displacement_may_have_lost_a_line_in_a_low_pass(
    delay: float, one_sine: bool, clear: bool
) -> None:
    """Along one sine, where a delay cannot be told from that; its noise would hide the rest."""
    model = Model("none", {"inertance": 40.0, "delay": delay}, ("inertance",))
    tone = 0.6 * np.sin(2 * np.pi * 47.3 * TIME)
    (run,) = (replace(r, force=force_along(model, r) + tone) for r in RUNS[:1])
    problem = Problem([run], EVERYTHING[:1])
    problem.scales = replace(problem.scales, one_tone=one_sine)
    random = np.random.default_rng(7)
    seen = [run.displacement + random.normal(0, 2e-6, TIME.size)]
    assert Witness(problem, seen).clears(model, 47.3) is clear
