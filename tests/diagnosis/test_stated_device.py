"""A device that states what the bench's has not: the data contradict every part of it."""

from __future__ import annotations

import numpy as np
import pytest
from bench_runs import measured
from inerter import Device
from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.scales import Scales
from inerter.diagnose import diagnose_bench
from inerter.diagnose.baseline import baseline_of
from inerter.diagnose.result import Diagnosis
from inerter.diagnose.stated import stated_candidates
from inerter.records import Record
from inerter.reference import ReferenceDevice, sum_of_sines

LEVEL = {"coulomb_force": 3.0}
PEAK = {**LEVEL, "static_force": 5.0, "stribeck_velocity": 0.01}
ABSENT = {
    "viscous_friction": {"viscous": 40.0},
    "parallel_stiffness": {"stiffness": 300.0},
    "hardening_stiffness": {"stiffness_cubic": 3e7},
    "quadratic_damping": {"quadratic_damping": 300.0},
    "force_offset": {"force_offset": 3.0},
    "load_dependent_friction": {"load_friction": 0.1},
    "variable_inertance": {"inertance_gradient": 30.0},
    "series_elasticity": {"series_stiffness": 1e5, "series_damping": 50.0},
    "gas_spring": {"gas_pressure": 1e5, "gas_area": 1e-3, "gas_volume": 2e-5},
    "end_stop": {"stop_upper": 2e-3, "stop_stiffness": 1e5},
}
LAWS = {
    "coulomb": LEVEL,
    "stribeck": PEAK,
    "dahl": {**LEVEL, "bristle_stiffness": 2e4},
    "lugre": {**PEAK, "bristle_stiffness": 2e4},
    "bouc_wen": {"bw_stiffness": 2e4, "bw_beta": 5e3, "bw_gamma": 2e3},
    "brown_mcphee": PEAK,
}
NOISE = 0.2


@pytest.fixture(scope="module")
def runs() -> list[Record]:
    """50 kg and nothing else."""
    motions = [sum_of_sines([3e-3, 0.9e-3], [f, 1.6 * f], [0.0, 0.0]) for f in (1.5, 1.8, 2.2)]
    device = ReferenceDevice(inertance=50.0)
    return measured(device, motions, np.arange(0, 8, 4e-3), force_noise=NOISE)


def diagnosed(runs: list[Record], delay: float = 0.0, **stated: float | str) -> Diagnosis:
    diagnosis = diagnose_bench(runs, Device(inertance=50.0, **stated), delay=delay)
    assert diagnosis.baseline.rmse > 1.5 * NOISE
    assert diagnosis.extended.rmse == pytest.approx(NOISE, rel=0.1)
    assert "The data contradict what is stated" in diagnosis.verdict
    return diagnosis


@pytest.mark.long
@pytest.mark.parametrize("effect", ABSENT)
def test_what_is_stated_and_not_there(effect: str, runs: list[Record]) -> None:
    diagnosis = diagnosed(runs, **ABSENT[effect])
    assert [finding.effect for finding in diagnosis.findings] == [effect]


@pytest.mark.long
@pytest.mark.parametrize("law", LAWS)
def test_friction_that_is_stated_and_not_there(law: str, runs: list[Record]) -> None:
    diagnosis = diagnosed(runs, friction=law, **LAWS[law])
    assert len(diagnosis.findings) == 1
    assert "friction" in diagnosis.findings[0].effect


def test_a_delay_that_is_stated_and_not_there(runs: list[Record]) -> None:
    diagnosis = diagnosed(runs, delay=4e-3)
    assert [finding.effect for finding in diagnosis.findings] == ["sensor_delay"]
    assert "(stated 0.004, " in diagnosis.verdict


# what is given beside the level, and what of the law the data can contradict
PARTLY = {
    "dahl": ({}, {"coulomb_force", "presliding"}),
    "lugre": (
        {"bristle_stiffness": 2e4},
        {"coulomb_force", "static_excess", "stribeck_velocity", "presliding", "bristle_damping"},
    ),
    "stribeck": ({}, {"coulomb_force", "static_excess", "stribeck_velocity"}),
    "brown_mcphee": (
        {"static_force": 4.0},
        {"coulomb_force", "static_excess", "stribeck_velocity"},
    ),
}


@pytest.mark.parametrize("law", PARTLY)
def test_what_a_stated_law_leaves_to_its_defaults_is_set_free_too(law: str) -> None:
    given, wanted = PARTLY[law]
    sizes = Scales(force=100.0, displacement=0.01, velocity=0.1, acceleration=1.0, cutoff=30.0)
    device = Device(inertance=50.0, friction=law, coulomb_force=3.0, **given)
    baseline = baseline_of(device, sizes)
    for model in (baseline, baseline.adding(coulomb_force=2.0)):
        (candidate,) = [
            each for each in stated_candidates(model, sizes) if EFFECTS[each.effect].kind == "law"
        ]
        for start in candidate.starts:
            assert wanted <= set(start.free)
            start.device()
    # one that was found by itself is not found again
    free = candidate.starts[0]
    assert not [e for e in stated_candidates(free, sizes) if EFFECTS[e.effect].kind == "law"]


@pytest.mark.long
def test_a_default_stiffness_is_contradicted() -> None:
    """The user states the level of Dahl friction alone; the bench's bristle is much softer."""
    motions = [sum_of_sines([3e-3, 0.9e-3], [f, 1.6 * f], [0.0, 0.0]) for f in (1.5, 1.8, 2.2)]
    truth = {"friction": "dahl", "coulomb_force": 12.0, "bristle_stiffness": 1.2e4}
    device = ReferenceDevice(inertance=50.0, **truth)  # type: ignore[arg-type]
    runs = measured(device, motions, np.arange(0, 8, 4e-3), force_noise=NOISE)
    stated = Device(inertance=50.0, friction="dahl", coulomb_force=12.0)
    diagnosis = diagnose_bench(runs, stated)
    assert [(f.effect, f.law) for f in diagnosis.findings] == [("hysteretic_friction", "dahl")]
    found = diagnosis.findings[0].parameters["bristle_stiffness"]
    assert found.value == pytest.approx(1.2e4, rel=0.1)
    assert "bristle stiffness" in diagnosis.verdict
