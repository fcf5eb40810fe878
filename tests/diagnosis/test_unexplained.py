"""What no known effect explains is found, described and proposed a formula for; noise is not."""

from __future__ import annotations

import json
import time
from collections.abc import Callable

import numpy as np
import pytest
from inerter.blind_test.case import records_of
from inerter.diagnose.remainder import columns
from inerter.diagnose.remainder.learning import chance
from inerter.diagnose.remainder.library import unit_of
from inerter.diagnose.unexplained import FALSE_ALARM
from inerter.reference import NoiseLevels, hide_effect
from scipy.signal import lfilter
from unknown_forces import (
    ageing,
    cogging,
    coupling,
    dead_band_records,
    fading,
    log_speed,
    motions,
    periodic_friction,
    remaining,
    square_wave,
    squeal,
    unknown_records,
    viscoelastic,
    with_stated,
)

# each unknown force and what it may be said to go with
UNKNOWN: list[tuple[Callable, set[str]]] = [
    (cogging, {"displacement (periodic)", "displacement"}),
    (coupling, {"state"}),
    (viscoelastic, {"history"}),
    (log_speed, {"velocity"}),
    (periodic_friction, {"displacement (periodic) and direction", "displacement and direction"}),
    (fading, {"time"}),
    (square_wave, {"frequency"}),
    # sliding renews the contact, so a steady speed has a steady age: less friction when faster
    (ageing, {"events", "history", "velocity"}),
    (squeal, {"bursts"}),
]
NAMES = [law.__name__ for law, _ in UNKNOWN]


@pytest.mark.parametrize(("law", "expected"), UNKNOWN, ids=NAMES)
@pytest.mark.parametrize("share", [0.07, 0.25])
def test_unknown_force_is_found_and_described(
    law: Callable, expected: set[str], share: float, effects_seed: int
) -> None:
    seed = effects_seed + NAMES.index(law.__name__)
    records, _ = unknown_records(seed, law, share)
    found = remaining(records)
    assert found.significant, f"seed {seed}: {found.summary}"
    assert expected & set(found.depends_on), f"seed {seed}: {found.summary}"
    assert found.structure > 0


def test_dead_band_of_the_channel_goes_with_the_force(effects_seed: int) -> None:
    found = remaining(dead_band_records(effects_seed, 0.15))
    assert found.significant, f"seed {effects_seed}"
    assert found.depends_on[0] in ("acceleration", "force"), found.summary
    assert found.proposal is not None
    assert any("clip(F" in term["term"] for term in found.proposal["terms"]), found.proposal


@pytest.mark.parametrize("noise", [0.005, 0.01, 0.05])
@pytest.mark.parametrize(
    ("effect", "law"),
    [
        ("none", None),
        ("coulomb_friction", None),
        ("stribeck_friction", None),
        ("hysteretic_friction", "dahl"),
        ("quadratic_damping", None),
    ],
)
def test_noise_about_a_right_model_is_nothing(
    effect: str, law: str | None, noise: float, effects_seed: int
) -> None:
    levels = NoiseLevels(0.0, noise, 1e-6 * noise / 0.01)
    seed = effects_seed + round(1e3 * noise)
    case = hide_effect(seed, effect, law=law, noise=levels)
    found = remaining(records_of(case), with_stated(case))
    assert not found.significant, f"seed {seed}: {found.summary}"
    assert found.depends_on == []
    assert found.proposal is None
    assert found.structure == 0


def test_proposal_has_the_true_coefficient(effects_seed: int) -> None:
    """The coupling x v^2 of known size, in N s^2/m^3."""
    records, size = unknown_records(effects_seed, coupling, 0.2)
    proposal = remaining(records).proposal
    assert proposal is not None
    term = {t["term"]: t for t in proposal["terms"]}["x v^2"]
    assert term["coefficient"] == pytest.approx(size, rel=0.03)
    assert 0 < term["stderr"] < 0.05 * size
    assert term["unit"] == "N*s^2/m^3"
    assert proposal["share"] > 0.9
    assert proposal["note"] == "a proposal by regression, not a cause"


def test_proposal_has_the_true_period(effects_seed: int) -> None:
    """A sine along the stroke: amplitude, period and phase."""
    records, size = unknown_records(effects_seed, cogging, 0.15)
    stroke = motions(hide_effect(effects_seed, "none"))[0].stroke
    proposal = remaining(records).proposal
    assert proposal is not None
    (term,) = [t for t in proposal["terms"] if t["term"].startswith("sin(2 pi x/")]
    period = float(term["term"].removeprefix("sin(2 pi x/").split()[0])
    assert period == pytest.approx(0.3 * stroke, rel=0.02)
    assert term["coefficient"] == pytest.approx(size, rel=0.05)
    assert term["unit"] == "N"


def test_is_quick_and_fits_into_json(effects_seed: int) -> None:
    records, _ = unknown_records(effects_seed, viscoelastic, 0.2)
    remaining(records)
    begin = time.process_time()
    found = remaining(records)
    assert time.process_time() - begin < 5  # with preparation and fit
    text = json.loads(json.dumps(vars(found)))
    assert {"significant", "fraction", "depends_on", "summary", "tests", "proposal"} <= text.keys()
    assert text["false_alarm_rate"] == FALSE_ALARM
    assert {test["goes_with"] for test in text["tests"]} >= {"displacement", "history", "bursts"}


def test_chance_holds_for_correlated_residuals() -> None:
    """Residual and prediction of one low-pass each, unrelated: p below 0.05 in 5 % of the draws."""
    random = np.random.default_rng(0)
    stretch = np.arange(2000) // 40
    values = []
    for _ in range(1000):
        residual, predicted = lfilter([1], [1, -0.9], random.standard_normal((2, 2000)))
        values.append(chance(residual, predicted, stretch))
    for level in (0.01, 0.05, 0.5):
        spread = np.sqrt(level * (1 - level) / len(values))
        assert np.mean(np.array(values) < level) < level + 4 * spread


def test_units_of_coefficients() -> None:
    """Products of x, v, a, t whose coefficient makes newtons of them, by hand."""
    assert unit_of(x=1) == "N/m"
    assert unit_of(v=1) == "N*s/m"
    assert unit_of(a=1) == "kg"
    assert unit_of(x=1, v=2) == "N*s^2/m^3"
    assert unit_of(t=1) == "N/s"
    assert unit_of(a=1, t=1) == "N*s/m"


def test_memory_of_a_step_is_an_exponential() -> None:
    """The fading mean of a step of 1 is 1 - exp(-t / memory)."""
    step = np.r_[0.0, np.ones(1000)]
    mean = columns.filtered_past(step, 1e-3, 0.2)
    assert mean[1:] == pytest.approx(1 - np.exp(-1e-3 * np.arange(1, 1001) / 0.2), abs=1e-12)


def test_play_follows_behind_its_half_width() -> None:
    """Up from 0 to 5 and down to 3 with a half-width of 1: 4, then still 4."""
    x = np.r_[np.linspace(0, 5, 51), np.linspace(5, 3, 21)]
    out = columns.play(x, 1.0)
    assert out[50] == pytest.approx(4)
    assert out[-1] == pytest.approx(4)
    assert np.max(np.abs(out - x)) <= 1 + 1e-12
