"""Hidden cases with several effects, with one that has no name, and the paper's record."""

from pathlib import Path

import numpy as np
import pytest
from hidden_cases import extra, forces
from inerter.reference import (
    UNKNOWN,
    NoiseLevels,
    compatible,
    hide_effect,
    hide_unknown,
    wang_su_bench,
)

QUIET = NoiseLevels(force=0.0, displacement=0.0)


def test_several_effects_are_sized_as_if_alone() -> None:
    alone = hide_effect(80, "viscous_friction", noise=QUIET)
    case = hide_effect(
        80, "viscous_friction", also=("asymmetric_friction", "force_drift"), noise=QUIET
    )
    assert case.effects == ("viscous_friction", "asymmetric_friction", "force_drift")
    assert case.parameters["viscous"] == alone.parameters["viscous"]
    assert case.names["asymmetric_friction"] == ("coulomb_force", "friction_asymmetry")
    for run in case.runs:
        v = run.truth.velocity
        sliding = abs(v) > 20.0 * case.device.transition_velocity
        p = case.parameters
        level = p["coulomb_force"] * (1.0 + p["friction_asymmetry"] * np.sign(v))
        expected = p["viscous"] * v + level * np.sign(v) + p["force_drift"] * run.time
        np.testing.assert_allclose(extra(case, run)[sliding], expected[sliding], rtol=1e-6)

    # with a friction law, its level is what differs between the directions
    case = hide_effect(81, "asymmetric_friction", also=("stribeck_friction",), noise=QUIET)
    assert case.names["asymmetric_friction"] == ("friction_asymmetry",)
    assert case.device.friction == "stribeck"
    assert case.device.friction_asymmetry == case.parameters["friction_asymmetry"]

    # saturation is that of the whole force
    case = hide_effect(82, "sensor_saturation", also=("parallel_stiffness",), noise=QUIET)
    lower, upper = case.channel.force_minimum, case.channel.force_maximum
    assert 0.019 <= np.mean((forces(case) <= lower) | (forces(case) >= upper)) <= 0.155


@pytest.mark.parametrize(
    ("effects", "words"),
    [
        (("coulomb_friction", "hysteretic_friction"), "two friction laws"),
        (("friction_drift", "coulomb_friction"), "its own Coulomb friction"),
        (("backlash", "series_elasticity"), "series element"),
        (("viscous_friction", "viscous_friction"), "twice"),
        (("none", "viscous_friction"), "alone"),
    ],
)
def test_impossible_combinations_are_refused(effects: tuple[str, ...], words: str) -> None:
    assert not compatible(effects)
    with pytest.raises(ValueError, match=words):
        hide_effect(1, effects[0], also=effects[1:])
    assert compatible(("gas_spring", "backlash", "hysteretic_friction"))
    with pytest.raises(ValueError, match="gremlins"):
        compatible(("gremlins",))
    with pytest.raises(ValueError, match="bouc_wen"):
        hide_effect(1, "hysteretic_friction", law="bouc_wen", also=("asymmetric_friction",))


@pytest.mark.parametrize("kind", UNKNOWN)
def test_unknown_effect_is_what_it_says(kind: str) -> None:
    case = hide_unknown(91, kind, QUIET)
    assert (case.effect, case.kind, case.effects) == ("unknown", kind, ())
    assert 0.049 <= case.share <= 0.301
    size = case.parameters.get("size", 1.0)
    longest = max(run.time[-1] for run in case.runs)
    for run in case.runs:
        x, v, bare = run.truth.displacement, run.truth.velocity, run.truth.force - extra(case, run)
        e = extra(case, run)
        moving = abs(v) > 20.0 * case.device.transition_velocity
        if kind == "beating":
            place = np.sin(2.0 * np.pi * x / case.parameters["length"])
            turn = np.sin(2.0 * np.pi * run.time / case.parameters["period"])
            np.testing.assert_allclose(e, size * place * turn, atol=1e-9 * size)
        elif kind == "coupling":
            np.testing.assert_allclose(
                abs(e), size * abs(x) * v * v, atol=1e-9 * float(np.max(abs(e)))
            )
        elif kind == "softening":
            # a spring that is softer at the same place after a longer stroke
            assert np.min(e * x) >= -1e-9
            off_middle = abs(x) > 1e-3 * np.max(abs(x))
            stiffness = (e / np.where(off_middle, x, 1.0))[off_middle]
            assert np.max(np.diff(stiffness)) <= 1e-6 * np.max(stiffness)
        elif kind == "lagging_drag":
            # q' T + q is the drag at once
            step, lag = run.time[1] - run.time[0], case.parameters["lag"]
            at_once = e + lag * np.gradient(e, step)
            drag = size * v * abs(v)
            assert np.sqrt(np.mean((at_once - drag)[5:-5] ** 2)) < 0.05 * np.max(abs(drag))
        elif kind == "catching":
            assert np.min((e * v)[moving]) >= -1e-9
            assert np.all(e[abs(v) < 0.99 * case.parameters["speed"]] == pytest.approx(0.0))
        elif kind == "fading_inertance":
            # of a force of one, a part that grows with time
            np.testing.assert_allclose(e, -size * bare * run.time / longest, atol=1e-9)
        elif kind == "square_wave":
            np.testing.assert_allclose(abs(e), size, rtol=1e-6)
        elif kind == "squeal":
            first = int(np.flatnonzero(np.diff(np.sign(v)) != 0.0)[0])
            np.testing.assert_allclose(e[:first], 0.0, atol=1e-9)
        else:
            width = case.parameters["width"]
            kept = abs(run.force) > 0.0
            assert np.min(abs(run.force[kept])) >= width
            np.testing.assert_allclose(run.force[kept], bare[kept])


def test_unknown_kinds_follow_from_the_seed() -> None:
    one, other = hide_unknown(5), hide_unknown(5)
    assert (one.kind, one.parameters) == (other.kind, other.parameters)
    np.testing.assert_array_equal(forces(one), forces(other))
    assert len({hide_unknown(seed, noise=QUIET).kind for seed in range(12)}) > 3
    with pytest.raises(ValueError, match="gremlins"):
        hide_unknown(1, "gremlins")


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
