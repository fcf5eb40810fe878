"""Hidden cases: reproducible, sized as promised, true to their device, silent in their files."""

from pathlib import Path

import numpy as np
import pytest
from inerter.reference import (
    EFFECTS,
    HYSTERETIC_LAWS,
    HiddenCase,
    NoiseLevels,
    hide_effect,
    wang_su_bench,
)

QUIET = NoiseLevels(force=0.0, displacement=0.0)
CASES = [(effect, None) for effect in EFFECTS if effect != "hysteretic_friction"]
CASES += [("hysteretic_friction", law) for law in HYSTERETIC_LAWS]


def forces(case: HiddenCase) -> np.ndarray:
    return np.concatenate([run.force for run in case.runs])


@pytest.mark.parametrize(("effect", "law"), CASES)
@pytest.mark.parametrize("seed", [11, 12])
def test_case_is_what_it_says(seed: int, effect: str, law: str | None) -> None:
    case = hide_effect(seed, effect, law=law, noise=QUIET)
    assert (case.effect, case.law) == (effect, law)
    assert 20.0 <= case.device.inertance <= 400.0
    assert 3 <= len(case.runs) <= 4
    assert len({run.kind for run in case.runs}) == len(case.runs)

    # the effect's share, and that nothing else is in the force
    bare = [case.device.inertance * run.truth.acceleration for run in case.runs]
    extra = forces(case) - np.concatenate(bare)
    share = np.sqrt(np.mean(extra**2) / np.mean(forces(case) ** 2))
    if effect == "none":
        assert share == 0.0
        assert case.parameters == {}
    elif effect == "sensor_delay":
        assert share == 0.0
        assert 1e-3 <= case.parameters["delay"] == case.delay <= 6e-3
    else:
        assert 0.049 <= share <= 0.401
        assert case.share == pytest.approx(share, rel=1e-12)

    for run in case.runs:
        assert 6.0 <= run.time[-1] - run.time[0] + 1.0 / run.sample_rate <= 10.01
        assert np.max(abs(run.displacement)) <= 0.0601
        truth = run.truth
        again = case.device.force(
            truth.displacement, truth.velocity, truth.acceleration, truth.state
        )
        np.testing.assert_array_equal(run.force, np.asarray(again))
    for name, value in case.parameters.items():
        assert value == (case.delay if name == "delay" else getattr(case.device, name))


def test_delay_shifts_the_force_behind_the_displacement() -> None:
    case = hide_effect(5, "sensor_delay", noise=QUIET)
    for run in case.runs:
        np.testing.assert_allclose(run.time - run.truth.time, case.delay, atol=1e-12)
        # b x''(t - delay) from the record's own displacement
        a = np.gradient(np.gradient(run.displacement, run.time), run.time)
        late = np.interp(run.time - case.delay, run.time, a) * case.device.inertance
        inner = slice(50, -50)
        error = np.sqrt(np.mean((late - run.force)[inner] ** 2))
        assert error < 0.02 * np.sqrt(np.mean(run.force[inner] ** 2))


def test_reproducible_from_the_seed() -> None:
    for seed in (1, 2):
        one, other = hide_effect(seed), hide_effect(seed)
        assert (one.effect, one.parameters, one.device) == (
            other.effect, other.parameters, other.device
        )  # fmt: skip
        np.testing.assert_array_equal(forces(one), forces(other))
    assert hide_effect(1, "none").device != hide_effect(2, "none").device


def test_noise_is_as_asked() -> None:
    quiet = hide_effect(3, "viscous_friction", noise=QUIET)
    noisy = hide_effect(3, "viscous_friction", noise=NoiseLevels(0.0, 0.01, 2e-6))
    difference = forces(noisy) - forces(quiet)
    assert noisy.noise["force"] == pytest.approx(0.01 * np.sqrt(np.mean(forces(quiet) ** 2)))
    assert difference.std() == pytest.approx(noisy.noise["force"], rel=0.03)
    spread = np.concatenate(
        [a.displacement - b.displacement for a, b in zip(noisy.runs, quiet.runs, strict=True)]
    )
    assert spread.std() == pytest.approx(2e-6, rel=0.03)
    assert hide_effect(3, "viscous_friction").noise == {"force": 0.2, "displacement": 1e-6}


def test_files_are_readable_and_silent(tmp_path: Path) -> None:
    case = hide_effect(4, "coulomb_friction")
    paths = case.write(tmp_path / "records")
    assert len(paths) == len(case.runs)
    for path, run in zip(paths, case.runs, strict=True):
        text = path.read_text(encoding="utf-8").lower()
        for word in ("coulomb", "friction", "lugre", "dahl"):
            assert word not in text
            assert word not in path.name
        body = [line for line in text.splitlines() if not line.startswith("#")]
        assert body[0] == "time,displacement,force"
        table = np.loadtxt(body[1:], delimiter=",")
        np.testing.assert_allclose(table[:, 0], run.time, rtol=1e-8)
        np.testing.assert_allclose(table[:, 1], run.displacement, rtol=1e-9)
        np.testing.assert_allclose(table[:, 2], run.force, rtol=1e-9)


def test_unknown_names_are_refused() -> None:
    with pytest.raises(ValueError, match="gremlins"):
        hide_effect(1, "gremlins")
    with pytest.raises(ValueError, match="law"):
        hide_effect(1, "hysteretic_friction", law="coulomb")
    with pytest.raises(ValueError, match="law"):
        hide_effect(1, "none", law="dahl")


def test_wang_su_record(tmp_path: Path) -> None:
    bench = wang_su_bench(1)
    assert bench.device.inertance == 113.0
    assert bench.device.coulomb_force == 10.0
    assert bench.time.size == 10_000
    np.testing.assert_array_equal(bench.force, wang_su_bench(1).force)

    # slow part as in the paper's figure 7: a square wave of 10 N
    slow = (bench.time > 1.0) & (bench.time < 4.0)
    assert np.median(bench.force[slow]) == pytest.approx(-10.0, abs=0.2)
    # 3 Hz part: the inertance force of cos(6 pi t) mm, 113 * 1e-3 * (6 pi)^2 N, and the friction
    fast = (bench.time > 11.0) & (bench.time < 15.0)
    tone = np.cos(6.0 * np.pi * (bench.time[fast] - 10.0))
    amplitude = 2.0 * np.mean(tone * bench.force[fast])
    assert amplitude == pytest.approx(-113.0 * 1e-3 * (6.0 * np.pi) ** 2, rel=0.01)

    text = bench.write_csv(tmp_path / "bench.csv").read_text(encoding="utf-8").lower()
    assert text.startswith("# synthetic")
    for word in ("friction", "coulomb", "lugre", "hysteresis"):
        assert word not in text
