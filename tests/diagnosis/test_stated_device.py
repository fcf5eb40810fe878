"""A device that states what the bench's has not: the data contradict every part of it."""

from __future__ import annotations

import numpy as np
import pytest
from bench_runs import measured
from inerter import Device
from inerter.diagnose import diagnose_bench
from inerter.diagnose.result import Diagnosis
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


@pytest.mark.parametrize("effect", ABSENT)
def test_what_is_stated_and_not_there(effect: str, runs: list[Record]) -> None:
    diagnosis = diagnosed(runs, **ABSENT[effect])
    assert [finding.effect for finding in diagnosis.findings] == [effect]


@pytest.mark.parametrize("law", LAWS)
def test_friction_that_is_stated_and_not_there(law: str, runs: list[Record]) -> None:
    diagnosis = diagnosed(runs, friction=law, **LAWS[law])
    assert len(diagnosis.findings) == 1
    assert "friction" in diagnosis.findings[0].effect


def test_a_delay_that_is_stated_and_not_there(runs: list[Record]) -> None:
    diagnosis = diagnosed(runs, delay=4e-3)
    assert [finding.effect for finding in diagnosis.findings] == ["sensor_delay"]
    assert "(stated 0.004, " in diagnosis.verdict
