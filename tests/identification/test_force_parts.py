"""A force in parts that are kept is the force of the whole; the low-pass that both take."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.identify import prediction
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.records.motion import EDGE_PERIODS, filtered_and_thinned, is_slow, lowpass
from three_sines import H, N, motion, run_of

LAWS = {
    "none": {},
    "coulomb": {"coulomb_force": 12.0, "transition_velocity": 1e-3},
    "dahl": {"coulomb_force": 12.0, "presliding": 2e-3, "friction_gradient": 5.0},
    "bouc_wen": {"bw_level": 12.0, "presliding": 2e-3, "bw_shape": 0.6, "bw_exponent": 1.3},
}
ENDS = {"curve_lower": -0.05, "curve_upper": 0.05}
BESIDE = {
    "nothing": {},
    "late": {"delay": 1.3 * H, "friction_drift": 0.02, "viscous_drift": 0.01, "force_drift": 0.5},
    "shaft": {"series_frequency": 15.0, "series_loss": 0.3},
    "branch": {"branch_stiffness_1": 2e3, "branch_time_1": 0.1},
    "play": {"series_frequency": 15.0, "series_loss": 0.3, "backlash": 1e-3},
    "stops": {
        "stop_lower": -0.01, "stop_upper": 0.01, "stop_stiffness": 1e4, "stop_damping": 1.0,
        "rest_length": 2e-3, "friction_drift": 0.02,
    },
    "force curve": {**ENDS, **{f"force_node_{i}": 3.0 * (-1) ** i for i in range(1, 8)}},
    "inertance curve": {**ENDS, **{f"inertance_node_{i}": 0.05 * (-1) ** i for i in range(1, 8)}},
    "filters": {
        "force_filter": 40.0, "force_filter_order": 3.0, "force_filter_bessel": 1.0,
        "displacement_filter": 60.0, "displacement_filter_order": 2.0, "stop_lower": -0.01,
        "stop_stiffness": 1e4, "stop_damping": 1.0,
    },
}  # fmt: skip


def thinned_run() -> BenchRun:
    along = motion()
    run = run_of(60.0 * along[2], along)
    x, v, a = run.displacement, run.velocity, run.acceleration
    arrays = {
        name: np.ascontiguousarray(getattr(run, name)[::3])
        for name in ("displacement", "velocity", "acceleration", "force", "inner")
    }
    return replace(run, **arrays, spacing=3 * H, thinned=3, cutoff=20.0, measured=(x, v, a))


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("beside", BESIDE)
def test_a_sum_of_parts_is_the_whole(
    law: str, beside: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    values = {"inertance": 40.0, "viscous": 90.0, **LAWS[law], **BESIDE[beside]}
    if law == "none":
        values.pop("friction_drift", None)
    run, model = thinned_run(), Model(law, values, ("inertance",))
    found = prediction.force_along(model, run)
    # worked out, and kept
    np.testing.assert_array_equal(prediction.force_along(model, run), found)
    moved = replace(model, values={**values, "viscous": 91.0})
    other = prediction.force_along(moved, run)
    monkeypatch.setattr(prediction, "is_sum", lambda model: False)
    size = np.max(np.abs(found))
    for each, parts in ((model, found), (moved, other)):
        whole = prediction.force_along(each, run)
        np.testing.assert_allclose(parts, whole, rtol=0, atol=1e-12 * float(size))
    assert np.max(np.abs(other - found)) > 1e-4 * size


@pytest.mark.parametrize(("size", "step"), [(N, 2), (N - 1, 7), (30000, 100), (700, 3)])
def test_the_low_pass_of_a_fit_is_that_of_records(size: int, step: int) -> None:
    cutoff = 1 / (16 * step * H)
    random = np.random.default_rng(5)
    values = 3.0 + np.cumsum(random.normal(size=size))
    found = filtered_and_thinned(values, H, cutoff, step)
    known = lowpass(values, H, cutoff)[::step]
    assert found.shape == known.shape
    edge = int(1.5 * EDGE_PERIODS / (cutoff * H * step)) + 1
    inner = slice(edge, -edge)
    assert known[inner].size > 10
    np.testing.assert_allclose(
        found[inner], known[inner], rtol=0, atol=1e-5 * float(np.std(values))
    )


def test_no_sample_is_left_out_and_the_cut_off_is_slow() -> None:
    """Below a ninth of the rate exponentials serve there too; above it is the records' own."""
    values = np.cumsum(np.random.default_rng(5).normal(size=4000))
    for share in (0.01, 0.07, 0.11):
        assert is_slow(H, share / H, 1)
        found, known = (each(values, H, share / H, *more) for each, more in
                        ((filtered_and_thinned, (1,)), (lowpass, ())))  # fmt: skip
        edge = int(1.5 * EDGE_PERIODS / share) + 1
        difference = np.abs(found - known)[edge:-edge]
        assert difference.max() < 1e-5 * float(np.std(values))
    assert not is_slow(H, 0.112 / H, 1)
    found = filtered_and_thinned(values, H, 0.112 / H, 1)
    np.testing.assert_array_equal(found, lowpass(values, H, 0.112 / H))


def test_a_line_passes_the_low_pass_as_it_is() -> None:
    line = 2.0 - 0.3 * np.arange(500, dtype=np.float64)
    for step in (2, 9, 600):
        found = filtered_and_thinned(line, 1e-3, 20.0, step)
        np.testing.assert_allclose(found, line[::step], rtol=0, atol=1e-10)
    assert filtered_and_thinned(np.array([4.0]), 1e-3, 20.0, 3).tolist() == [4.0]
