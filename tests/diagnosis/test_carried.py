"""What has no name is carried as a force over place and velocity, on records made by hand."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inerter.core import Device
from inerter.device_file import read_device
from inerter.diagnose import diagnose_bench
from inerter.diagnose.baseline import baseline_of
from inerter.diagnose.budget.carried import Carried, carried
from inerter.diagnose.budget.words import budget_of
from inerter.diagnose.data import Data, divided
from inerter.identify.fit import Problem, rms
from inerter.identify.model import Model
from inerter.mjcf import device_of_model
from inerter.records.preparation import prepare
from inerter.report.output import write_outputs
from test_budget import NOISE, Law, coulomb, nothing, records

Array = np.ndarray


def surface(t: Array, x: Array, v: Array) -> Array:
    """Both together, and neither a law of its own."""
    return 5 * np.sin(2 * np.pi * x / 0.04) + 6 * np.tanh(v / 0.05) * np.cos(2 * np.pi * x / 0.05)


def giving(t: Array, x: Array, v: Array) -> Array:
    """A machine that drives itself."""
    return -40.0 * v


def fitted(law: Law) -> tuple[Data, Model]:
    """The records of a law, and an inerter with viscous and, but for the surface, dry friction."""
    made = records(law)
    data = divided(made, prepare(made), ())
    start = baseline_of(None, data.band.scales).adding(viscous=0.0)
    if law is not surface:
        start = start.adding("coulomb", coulomb_force=1e-3 * data.band.scales.force)
    return data, Problem(data.runs, data.split.fit, data.band.scales).fit(start).model


def of(law: Law, *, passive: bool = False) -> Carried | None:
    data, model = fitted(law)
    return carried(data, model, NOISE, passive=passive)


def test_a_surface_is_carried_down_to_the_noise_and_is_the_one_that_is_there() -> None:
    data, model = fitted(surface)
    found = carried(data, model, NOISE)
    assert found is not None
    # what a model with the true surface would leave: noise of force and motion
    true = [
        error - surface(run.displacement, run.displacement, run.velocity)
        for error, run in zip(data.raw.errors(model), data.whole, strict=True)
    ]
    floor = rms(true, data.raw.masks)
    assert found.rmse_before > 3 * floor
    assert found.rmse_after > 0.98 * floor
    assert found.rmse_after**2 - floor**2 < 0.04 * (found.rmse_before**2 - floor**2)
    assert found.interval is not None
    assert found.interval[0] < 1 - found.rmse_after / found.rmse_before < found.interval[1]
    # where the motion has been, device and truth are alike: friction and map together
    whole = found.model.device()
    run = data.whole[0]
    x, v = run.displacement[run.inner][::7], run.velocity[run.inner][::7]
    truth = surface(x, x, v)
    error = whole.evaluate(x, v, 0.0, 0.0)["total"] - truth
    assert np.sqrt(np.mean(error**2)) < 0.2 * np.sqrt(np.mean(truth**2))
    # beyond it the map stays what it is at the edge
    edge, far = (
        Device(**found.parameters).evaluate([k * 0.2, 0.0], [0.0, k * 5.0], 0.0, 0.0)["total"]
        for k in (1.0, 50.0)
    )
    np.testing.assert_array_equal(edge, far)


@pytest.mark.parametrize("law", [nothing, coulomb])
def test_beside_a_right_model_nothing_is_carried(law: Law) -> None:
    assert of(law) is None


def test_what_gives_energy_is_not_carried_by_a_passive_device() -> None:
    found = of(giving)
    assert found is not None
    x, v = 0.0, np.array([-0.1, 0.1])
    assert np.all(Device(**found.parameters).evaluate(x, v, 0.0, 0.0)["dissipated_power"] < 0)
    held = of(giving, passive=True)
    if held is not None:
        power = Device(**held.parameters).evaluate(x, v, 0.0, 0.0)["dissipated_power"]
        assert np.all(power >= 0)
        assert held.rmse_after > 1.5 * found.rmse_after


def test_held_out_data_have_no_say_in_the_map() -> None:
    data, model = fitted(surface)
    runs = [
        replace(run, force=run.force + np.where(out, 0.5, 0.0))
        for run, out in zip(data.whole, data.full.holdout, strict=True)
    ]
    changed = replace(data, whole=runs, raw=Problem(runs, data.full.holdout, data.band.scales))
    one, other = carried(data, model, NOISE), carried(changed, model, NOISE)
    assert one is not None
    assert other is not None
    assert one.parameters == other.parameters
    assert other.rmse_after > one.rmse_after


def test_a_device_that_has_a_map_gets_no_second_one() -> None:
    data, model = fitted(surface)
    found = carried(data, model, NOISE)
    assert found is not None
    assert carried(data, found.model, NOISE) is None


def test_the_parts_of_the_budget_are_the_whole() -> None:
    budget = budget_of(10.0, 4.0, 1.0, None, carried=2.5)
    sizes = {key: size for key, _, size in budget.parts()}
    assert sizes == {"named": 6.0, "carried": 1.5, "predictable": 1.5, "rest": 1.0}
    assert "1.5 N is carried" in budget.sentence
    assert "carried" not in dict.fromkeys(key for key, *_ in budget_of(10, 4, 1, None).parts())


def test_rounding_is_no_part_of_the_budget() -> None:
    budget = budget_of(9.95, 0.1 + 0.2, 0.3, None)
    assert budget.predictable == 0.0
    assert budget.named + budget.rest == pytest.approx(9.95)


@pytest.mark.long
def test_a_diagnosis_writes_what_it_carries_and_says_so(tmp_path: Path) -> None:
    diagnosis = diagnose_bench(records(surface))
    kept = diagnosis.unexplained.carried
    assert kept is not None
    assert kept["rmse_before"] == pytest.approx(diagnosis.extended.rmse)
    assert kept["rmse_after"] < 0.6 * kept["rmse_before"]
    assert not any(name.startswith("force_map") for name in diagnosis.extended.device)
    assert "fitted and without a cause" in diagnosis.verdict
    write_outputs(diagnosis, tmp_path)
    told = json.loads((tmp_path / "diagnosis.json").read_text())["unexplained"]["carried"]
    assert told["kind"] == "force_map"
    text = (tmp_path / "device.toml").read_text()
    assert "# fitted, no cause" in text
    device = read_device(tmp_path / "device.toml")
    assert device_of_model(tmp_path / "model.xml").given == device.given
    assert "Carried without a name" in (tmp_path / "report.html").read_text()
    # nothing of it where it is not wanted
    plain = diagnose_bench(records(surface), carry="nothing")
    assert plain.unexplained.carried is None
    assert plain.extended.rmse == pytest.approx(diagnosis.extended.rmse)
