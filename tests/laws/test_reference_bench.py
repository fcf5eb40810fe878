"""Hidden cases: reproducible, sized as promised, true to their device, silent in their files."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hidden_cases import extra, forces
from inerter.reference import (
    EFFECTS,
    HYSTERETIC_LAWS,
    NoiseLevels,
    hide_effect,
)
from inerter.reference.bench_devices import draw_limits
from inerter.reference.bench_motions import draw_drives, highest_frequency
from inerter.reference.sizes import rms
from scipy.signal import bessel, butter, freqs, lsim

QUIET = NoiseLevels(force=0.0, displacement=0.0)
# forces that act at once along the motion, or late
SIMPLE = [effect for effect in EFFECTS[: EFFECTS.index("inertance_error")]
          if effect != "hysteretic_friction"]  # fmt: skip
CASES: list[tuple[str, str | None]] = [(effect, None) for effect in ("none", *SIMPLE)]
CASES += [("hysteretic_friction", law) for law in HYSTERETIC_LAWS]


@pytest.mark.rarely(
    "11-hysteretic_friction-bouc_wen",
    "11-hysteretic_friction-dahl",
    "11-hysteretic_friction-lugre",
    "12-hysteretic_friction-bouc_wen",
    "12-hysteretic_friction-lugre",
)
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


def test_a_low_pass_is_in_the_force_and_not_in_the_displacement() -> None:
    """As its transfer function says, which the case's force is not made by."""
    case = hide_effect(5, "sensor_filter", noise=QUIET)
    channel = case.channel
    kind: Any = bessel if channel.force_filter_bessel else butter
    more: dict[str, Any] = {"norm": "mag"} if channel.force_filter_bessel else {}
    above, below = kind(
        int(channel.force_filter_order), 2 * np.pi * channel.force_filter, analog=True, **more
    )
    for run in case.runs:
        assert run.force.shape == run.displacement.shape == run.time.shape
        bare = case.device.inertance * run.truth.acceleration
        spacing = run.time[1] - run.time[0]
        frequency = np.fft.rfftfreq(bare.size, spacing)
        gain = freqs(above, below, 2 * np.pi * frequency)[1]
        # whatever comes round from the end is forgotten after some periods
        late = np.fft.irfft(np.fft.rfft(bare) * gain, bare.size)[bare.size // 4 :]
        error = late - run.force[bare.size // 4 :]
        assert rms(error) < 0.01 * rms(late)
        assert rms(run.force - bare) > 0.05 * rms(bare)


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


SHARED = [
    "friction_drift", "hardening_stiffness", "gas_spring", "end_stop", "variable_inertance",
    "force_drift", "periodic_disturbance",
]  # fmt: skip


@pytest.mark.parametrize("effect", SHARED)
@pytest.mark.parametrize("seed", [21, 22])
def test_new_effects_have_their_share(seed: int, effect: str) -> None:
    case = hide_effect(seed, effect, noise=QUIET)
    force = forces(case)
    share = rms(np.concatenate([extra(case, run) for run in case.runs])) / rms(force)
    assert case.share == pytest.approx(share, rel=1e-12)
    assert share <= 0.401
    # a factor that stays near one need not reach the share drawn
    assert share >= (0.01 if effect == "variable_inertance" else 0.049)
    assert case.stated is None
    for name in case.names[effect]:
        if name in case.parameters:
            owner = case.device if hasattr(case.device, name) else case.channel
            assert case.parameters[name] == getattr(owner, name) != 0.0


@pytest.mark.parametrize("seed", range(30, 36))
def test_stated_inertance_is_off(seed: int) -> None:
    case = hide_effect(seed, "inertance_error", noise=QUIET)
    assert case.stated is not None
    true = case.parameters["inertance"]
    assert true == case.device.inertance
    assert 0.0299 <= abs(case.stated["inertance"] / true - 1.0) <= 0.2001
    for run in case.runs:
        np.testing.assert_allclose(extra(case, run), 0.0, atol=1e-9)


def test_friction_drifts_on_one_clock() -> None:
    case = hide_effect(40, "friction_drift", noise=QUIET)
    level, drift = case.parameters["coulomb_force"], case.parameters["friction_drift"]
    ends = [(run.time[0], run.time[-1]) for run in case.runs]
    assert ends[0][0] == 0.0
    assert all(one[1] < other[0] for one, other in pairwise(ends))
    assert 0.299 <= abs(drift) * ends[-1][1] <= 1.001
    for run in case.runs:
        np.testing.assert_allclose(run.time, run.truth.time)
        sliding = abs(run.truth.velocity) > 20.0 * case.device.transition_velocity
        friction = extra(case, run)[sliding] * np.sign(run.truth.velocity[sliding])
        np.testing.assert_allclose(friction, level * (1.0 + drift * run.time[sliding]), rtol=1e-9)
    assert all(run.time[0] == 0.0 for run in hide_effect(40, "force_drift").runs)


def test_force_drift_and_hardening_are_their_formula() -> None:
    drift = hide_effect(41, "force_drift", noise=QUIET)
    for run in drift.runs:
        expected = drift.parameters["force_drift"] * run.time
        np.testing.assert_allclose(extra(drift, run), expected, atol=1e-9)
    hard = hide_effect(41, "hardening_stiffness", noise=QUIET)
    for run in hard.runs:
        expected = hard.parameters["stiffness_cubic"] * run.truth.displacement**3
        np.testing.assert_allclose(extra(hard, run), expected, atol=1e-9)
        assert hard.device.stiffness == 0.0


@pytest.mark.parametrize("seed", [42, 43])
def test_gas_follows_its_polytrope(seed: int) -> None:
    case = hide_effect(seed, "gas_spring", noise=QUIET)
    p0, area, volume, exponent = (
        case.parameters[f"gas_{name}"] for name in ("pressure", "area", "volume", "exponent")
    )
    for run in case.runs:
        # p V^n stays; outside stands p0
        now = volume + area * run.truth.displacement
        assert np.min(now) > 0.1 * volume
        inside = p0 * (volume / now) ** exponent
        np.testing.assert_allclose(extra(case, run), area * (p0 - inside), atol=1e-8)


@pytest.mark.parametrize("seed", range(44, 50))
def test_end_stop_is_hit_for_a_while(seed: int) -> None:
    case = hide_effect(seed, "end_stop", noise=QUIET)
    x = np.concatenate([run.truth.displacement for run in case.runs])
    v = np.concatenate([run.truth.velocity for run in case.runs])
    force = np.concatenate([extra(case, run) for run in case.runs])
    above = x > case.parameters.get("stop_upper", np.inf)
    below = x < case.parameters.get("stop_lower", -np.inf)
    assert 0.028 <= np.mean(above | below) <= 0.202
    np.testing.assert_allclose(force[~(above | below)], 0.0, atol=1e-9)

    # it pushes back, harder on the way in than on the way out
    assert np.min(force[above], initial=0.0) >= -1e-9
    assert np.max(force[below], initial=0.0) <= 1e-9
    assert float(force @ v) > 0.0


@pytest.mark.parametrize("seed", range(50, 58))
def test_variable_inertance_keeps_energy(seed: int) -> None:
    case = hide_effect(seed, "variable_inertance", noise=QUIET)
    b, d = case.device.inertance, case.device
    for run in case.runs:
        x, v = run.truth.displacement, run.truth.velocity
        factor = 1.0 + d.inertance_gradient * x + d.inertance_curvature * x * x
        assert np.min(factor) > 0.25
        shape = 0.5 * v * v + d.inertance_speed_gradient * abs(v) ** 3 / 3.0
        energy = b * factor * shape
        power = run.force * v
        work = np.concatenate(([0.0], np.cumsum(0.5 * (power[1:] + power[:-1]))))
        work = work / run.sample_rate
        np.testing.assert_allclose(work, energy - energy[0], atol=2e-3 * np.max(energy))


def test_range_of_the_sensor_clips_a_known_share() -> None:
    for seed in range(60, 66):
        case = hide_effect(seed, "sensor_saturation", noise=NoiseLevels(0.0, 0.01))
        lower, upper = case.channel.force_minimum, case.channel.force_maximum
        truth = np.concatenate([run.truth.force for run in case.runs])
        for force in (truth, forces(case)):
            clipped = np.mean((force <= lower) | (force >= upper))
            assert 0.01 <= clipped <= 0.165
            assert np.min(force) >= lower
            assert np.max(force) <= upper

    # one-sided in a third of the cases, by 300 draws from one force
    draw = np.random.default_rng(0)
    force = draw.standard_normal(5000)
    sides = [len(draw_limits(draw, force).channel) for _ in range(300)]
    assert 0.25 < np.mean(np.array(sides) == 1) < 0.42


@pytest.mark.parametrize("seed", [66, 67, 68])
def test_disturbance_is_one_line_that_the_motion_lacks(seed: int) -> None:
    case = hide_effect(seed, "periodic_disturbance", noise=QUIET)
    size, frequency = (
        case.parameters[f"disturbance_{name}"] for name in ("amplitude", "frequency")
    )
    assert 0.5 <= frequency <= 45.0
    phases = []
    for run in case.runs:
        turn = 2.0 * np.pi * frequency * run.time
        basis = np.column_stack((np.sin(turn), np.cos(turn)))
        found = np.linalg.lstsq(basis, extra(case, run), rcond=None)[0]
        assert np.hypot(*found) == pytest.approx(size, rel=1e-6)
        np.testing.assert_allclose(basis @ found, extra(case, run), atol=1e-6 * size)
        phases.append(np.arctan2(found[1], found[0]))

        # the motion's own force at that frequency is small beside the line
        shape = np.hanning(run.time.size)
        own = abs(np.sum(shape * np.exp(-1j * turn) * (run.truth.force - extra(case, run))))
        assert 2.0 * own / np.sum(shape) < 0.3 * size
    assert np.ptp(phases) > 1e-3


@pytest.mark.long
def test_shaft_is_an_inertance_behind_a_spring() -> None:
    case = hide_effect(70, "series_elasticity", noise=QUIET)
    b, k, c = case.device.inertance, case.device.series_stiffness, case.device.series_damping
    resonance = np.sqrt(k / b) / (2.0 * np.pi)
    assert 0.03 <= c / (2.0 * np.sqrt(k * b)) <= 0.3
    drives = draw_drives(np.random.default_rng(np.random.SeedSequence(70).spawn(4)[2]), b)
    assert 1.49 <= resonance / highest_frequency(drives) <= 6.01
    at_rest = [run for run in case.runs if run.kind in ("stepped_sines", "chirp", "strokes")]
    for run in at_rest:
        # b (c s + k) / (b s^2 + c s + k) of the acceleration
        a = np.asarray(run.truth.acceleration)
        _, force, _ = lsim(([b * c, b * k], [b, c, k]), a, run.time)
        # lsim takes the input as straight between samples
        np.testing.assert_allclose(force, run.force, atol=2e-3 * float(np.max(abs(run.force))))


@pytest.mark.long
def test_gap_is_traversed() -> None:
    case = hide_effect(71, "backlash", noise=QUIET)
    gap, b = case.parameters["backlash"], case.device.inertance
    stroke = min(float(np.ptp(run.truth.displacement)) for run in case.runs)
    assert 0.00499 <= gap / stroke <= 0.1001
    for run in case.runs:
        names = case.device.state_names
        place = run.truth.states[:, names.index("gap_position")]
        assert np.ptp(place) == pytest.approx(2.0 * gap, rel=1e-6)
        free = abs(place) < gap * (1.0 - 1e-6)
        np.testing.assert_allclose(run.force[free], 0.0, atol=1e-6 * np.max(abs(run.force)))

        # what passes in 40 ms is the flywheel's momentum; an impact is nearly as sharp as samples
        passed = np.cumsum(0.5 * (run.force[1:] + run.force[:-1])) / run.sample_rate
        speed = run.truth.states[:, names.index("flywheel_velocity")]
        steps = round(0.04 * run.sample_rate)
        gained, given = b * np.diff(speed[1::steps]), np.diff(passed[::steps])
        assert rms(given - gained) < 0.3 * rms(gained)
