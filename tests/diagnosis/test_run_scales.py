"""One run of which the force has another scale: no cause in the device, and told as what it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.diagnose.run_scales import turned_round
from inerter.records import Record
from inerter.records.quality import check_records
from sines import moved

TIME = np.arange(0, 8, 1 / 250)


def record(draw: np.random.Generator, name: str, inertance: float = 40.0) -> Record:
    """40 kg, if not said otherwise, 25 N of Coulomb friction and 120 N s/m along three sines."""
    x, v, a = moved(draw, TIME, (0.5, 1.3, 2.4), draw.uniform(4e-3, 8e-3, 3))
    force = inertance * a + 25 * np.tanh(v / 1e-3) + 120 * v
    return Record(
        name=name, time=TIME, displacement=x + 1e-6 * draw.standard_normal(TIME.size),
        force=force + 0.4 * draw.standard_normal(TIME.size),
    )  # fmt: skip


@pytest.mark.parametrize("scale", [1.0, 1.04])
def test_a_run_with_another_scale_is_told(scale: float, effects_seed: int) -> None:
    draw = np.random.default_rng([effects_seed, 7])
    runs = [record(draw, f"run {i}") for i in range(4)]
    runs[1] = replace(runs[1], force=scale * runs[1].force)
    found = diagnose_bench(runs)
    told = found.method["run_scales"]
    if scale == 1.0:
        assert not told
        assert "times what the other runs tell" not in found.verdict
        return
    ((name, (value, error)),) = told.items()
    assert name == "run 1"
    # what the fit makes of all runs together lies between them
    assert value == pytest.approx(scale, abs=max(3 * error, 0.004))
    assert "run 1 is 1.0" in found.verdict
    assert {each.effect for each in found.findings} >= {"coulomb_friction", "viscous_friction"}


def test_a_run_with_the_other_sign_is_turned_round(effects_seed: int) -> None:
    draw = np.random.default_rng([effects_seed, 8])
    runs = [record(draw, f"run {i}") for i in range(3)]
    runs[2] = check_records([replace(runs[2], force=-runs[2].force)])[0]
    assert [each.code for each in runs[2].warnings] == ["sign_flip"]
    found = diagnose_bench(runs)
    assert found.method["run_scales"] == {"run 2": (-1.0, 0.0)}
    assert "run 2 has the other sign than that of the other runs" in found.verdict
    assert {each.effect for each in found.findings} == {"coulomb_friction", "viscous_friction"}
    assert found.parameters["inertance"].value == pytest.approx(40, rel=0.01)
    # of most runs, it is the header that is wrong
    many = check_records([replace(each, force=-each.force) for each in runs[:2]])
    assert turned_round([*many, runs[2]])[1] == {}


def test_runs_of_two_flywheels_are_told(effects_seed: int) -> None:
    draw = np.random.default_rng([effects_seed, 9])
    runs = [record(draw, f"run {i}", b) for i, b in enumerate((40.0, 56.0, 40.0))]
    found = diagnose_bench(runs)
    told = found.method["run_inertances"]
    assert told["run 0"][0] == pytest.approx(40, abs=0.5)
    assert told["run 1"][0] == pytest.approx(56, abs=0.7)
    # what differs is one part of the force, no scale of it
    assert not found.method["run_scales"]
    assert "By itself each run has an inertance of its own" in found.verdict
