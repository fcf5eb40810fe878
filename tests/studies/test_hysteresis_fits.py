"""Optimisers, crossings, what is determined, what denoising does."""

import numpy as np
import pytest
from inerter.studies.hysteresis.bias import Drawn, summarised
from inerter.studies.hysteresis.conclusions import held_out
from inerter.studies.hysteresis.crossing import Crossing, cross
from inerter.studies.hysteresis.denoising import WAYS, clean
from inerter.studies.hysteresis.determined import determined
from inerter.studies.hysteresis.emd import decomposed
from inerter.studies.hysteresis.objective import Objective
from inerter.studies.hysteresis.optimisers import OPTIMISERS, optimise, random_starts
from inerter.studies.hysteresis.protocol import predict
from inerter.studies.hysteresis.published import FREQUENCIES, MODELS, Box
from inerter.studies.hysteresis.settings import Settings
from inerter.studies.hysteresis.virtual_tests import cleaned_tests, virtual_tests

QUIET = Settings(noise=0.0, duration=4.0, denoise="none", random_starts=3, draws=2)
NOISY = Settings(duration=4.0, denoise="none", random_starts=3, draws=2)


@pytest.mark.parametrize("optimiser", OPTIMISERS)
def test_optimisers_recover_dahl_without_noise(optimiser: str) -> None:
    model = MODELS["dahl"]
    objective = Objective(model, cleaned_tests("dahl", 1000.0, 4.0, 0.0, 1, "none"))
    end = optimise(objective, model.box(), 1.3 * np.array(model.identified), optimiser)
    assert end.error < 0.05
    np.testing.assert_allclose(end.vector, model.identified, rtol=0.02)
    assert end.evaluations > 10


@pytest.mark.parametrize("optimiser", OPTIMISERS)
def test_equal_bounds_hold_and_cost(optimiser: str) -> None:
    # as printed: b = 250 from both sides, and n not below what a device can have
    model = MODELS["bouc_wen"]
    printed = model.printed_box()
    lower = np.where(np.array(model.names) == "bw_exponent", 1.0, printed.lower)
    data = cleaned_tests("bouc_wen", 1000.0, 4.0, 0.0, 1, "none")[3:]
    end = optimise(Objective(model, data), Box(printed.start, lower, printed.upper),
                   printed.start, optimiser)  # fmt: skip
    assert end.vector[-1] == 250.0
    assert np.all((end.vector >= lower) & (end.vector <= printed.upper))
    # (250 - 154.4) kg on 2.53 m/s^2, less what a spring of k0 A <= 10^4 N/m takes back
    assert end.error > 0.5 * (250.0 - 154.4) * 2.527 / np.sqrt(2)


def test_random_starts_are_within_the_bounds_and_repeat() -> None:
    for model in MODELS.values():
        box = model.box()
        starts = random_starts(box, 50, 3)
        assert np.all((starts >= box.lower) & (starts <= box.upper))
        np.testing.assert_array_equal(starts, random_starts(box, 50, 3))
        assert np.all(np.ptp(np.log(starts), axis=0) > 0.3 * np.log(box.upper / starts.min(axis=0)))


def test_a_model_fits_its_own_data_and_predicts_what_was_held_out() -> None:
    own = cross("dahl", "dahl", FREQUENCIES[1:], QUIET)
    other = cross("dahl", "viscous", FREQUENCIES[1:], QUIET)
    assert own.held_out == (1.0,)
    assert max(own.true_errors) < 0.1
    assert own.device["inertance"] == pytest.approx(174.0, rel=1e-3)
    # dry friction is no damper: at 1 Hz it is most of the force
    assert other.true_errors[0] > 10.0
    shares = held_out(QUIET, [_other(own, held) for held in FREQUENCIES], "dahl", "dahl")
    assert max(shares) < 0.002


def _other(crossing: Crossing, held: float) -> Crossing:
    fitted = tuple(f for f in FREQUENCIES if f != held)
    return Crossing(
        maker=crossing.maker,
        fitter=crossing.fitter,
        fitted=fitted,
        fit_error=crossing.fit_error,
        true_errors=crossing.true_errors,
        measured_errors=crossing.measured_errors,
        device=crossing.device,
        seconds=0.0,
    )


def test_bouc_wen_of_table_3_is_a_damper() -> None:
    # inertance and damping alone leave little of its force
    found = cross("bouc_wen", "viscous", FREQUENCIES, QUIET)
    assert max(found.true_errors) < 1.0
    assert found.device["viscous"] == pytest.approx(132.0, rel=0.02)


def test_a_fit_at_4_hz_leaves_1_hz_open() -> None:
    found = predict("bouc_wen", "dahl", "mended", NOISY)
    assert found.spread is not None
    assert found.true_errors[3] < 1.0
    assert found.true_errors[0] > 10 * found.true_errors[3]
    assert found.end.vector[-1] > 156.0


def test_errors_of_parameters_grow_with_the_noise_alone() -> None:
    one = determined("dahl", FREQUENCIES, Settings(noise=1.0, duration=4.0))
    ten = determined("dahl", FREQUENCIES, Settings(noise=10.0, duration=4.0))
    for name, error in one.errors.items():
        assert ten.errors[name] == pytest.approx(10 * error, rel=1e-6)


def test_what_bouc_wen_leaves_open_and_what_not() -> None:
    found = determined("bouc_wen", FREQUENCIES, NOISY)
    assert found.errors["b"] < 0.01
    assert found.errors["c_0"] < 0.05
    assert all(found.errors[name] > 1.0 for name in ("alpha", "A", "k_0"))
    named = {name for group in found.groups for name in group}
    assert {"bw_alpha", "bw_ratio", "bw_stiffness"} <= named
    # the stiffnesses are not known, their sum is, a thousand times better
    whole = found.quantities["their sum [N/m]"]
    part = found.quantities["A k_0 [N/m]"]
    assert whole[0] == pytest.approx(-78.0, abs=0.5)
    assert whole[1] < 0.02 * part[1]


def test_determined_agrees_with_the_scatter_of_fits() -> None:
    # standard error of Dahl's inertance against fits to noises drawn anew
    model = MODELS["dahl"]
    told = determined("dahl", FREQUENCIES, NOISY).errors["b"]
    found = []
    for seed in range(24):
        objective = Objective(model, cleaned_tests("dahl", 1000.0, 4.0, 10.0, seed, "none"))
        end = optimise(objective, model.box(), np.array(model.identified), "least_squares")
        found.append(np.log(end.vector[-1]))
    # 24 draws know their scatter to 15 %
    assert np.std(found, ddof=1) == pytest.approx(told, rel=0.45)


def test_at_4_hz_alone_lugre_is_far_from_known() -> None:
    alone = determined("lugre", (4.0,), NOISY)
    every = determined("lugre", FREQUENCIES, NOISY)
    assert alone.errors["F_s"] > 10 * every.errors["F_s"]
    assert {"bristle_stiffness", "coulomb_force"} <= set(alone.groups[0])


@pytest.mark.parametrize("way", WAYS)
def test_ways_take_noise_off_a_sine(way: str) -> None:
    test = virtual_tests("bouc_wen", 1000.0, 4.0)[0]
    noisy = test.truth + 10.0 * np.random.default_rng(0).standard_normal(test.truth.size)
    cleaned = clean(noisy, test.spacing, way)
    off = np.std((cleaned.force - test.truth)[test.settled])
    assert (cleaned.cutoff is not None) == (way == "lowpass_both")
    assert (cleaned.modes is not None) == (way == "emd")
    assert (cleaned.number is not None) == (way == "emd_loudest")
    if way == "none":
        np.testing.assert_array_equal(cleaned.force, noisy)
    else:
        assert off < 5.0


def test_noise_rule_takes_noise_off_where_one_mode_does_not() -> None:
    rows = [row for maker in ("dahl", "bouc_wen") for row in decomposed(maker, Settings())]
    assert all(row.rule < 0.5 * row.before for row in rows)
    assert any(row.single > row.before for row in rows)
    assert all(1 <= row.kept <= row.modes for row in rows)


def test_bias_is_the_mean_error() -> None:
    names = (
        "inertance", "work_1_hz", "work_4_hz", "force_error", "coulomb_force", "bristle_stiffness"
    )  # fmt: skip
    drawn = [
        Drawn("dahl", way, dict.fromkeys(names, value), 3.0)
        for way in WAYS
        for value in (173.0, 177.0)
    ]
    row = summarised(drawn, NOISY)[0]
    assert row.share("inertance") == pytest.approx((1.0 / 174.0, np.sqrt(8.0) / 174.0))
    assert row.left == pytest.approx(3.0)
    assert row.truth["coulomb_force"] == 62.0
