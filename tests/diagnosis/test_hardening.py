"""Hysteresis that hardens, which no friction law with a largest force can follow."""

from __future__ import annotations

import numpy as np
import pytest
from bench_runs import measured
from inerter.catalogue.scales import Scales
from inerter.diagnose import Diagnosis, diagnose_bench
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import simpler_laws
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.reference import ReferenceDevice, sum_of_sines

# alpha is the spring of the hysteresis, beta + gamma < 0: it hardens away from rest
TRUE = {"friction": "bouc_wen", "inertance": 20.0, "stiffness": 5e4, "bw_stiffness": 5e4,
        "bw_beta": 800.0, "bw_gamma": -1100.0, "bw_exponent": 1.0, "bw_ratio": 0.0}  # fmt: skip


@pytest.fixture(scope="module")
def diagnosis() -> Diagnosis:
    random = np.random.default_rng(11)
    device = ReferenceDevice(**TRUE)  # type: ignore[arg-type]
    rates, phases = random.uniform(1.0, 12.0, (2, 6)), random.uniform(0, 6.28, (2, 6))
    motions = [sum_of_sines(1e-3 / (1 + r / 5), r, p) for r, p in zip(rates, phases, strict=True)]
    runs = measured(device, motions, np.arange(0, 3, 2e-3), displacement_noise=1e-7)
    return diagnose_bench(runs)


@pytest.mark.long
def test_it_is_one_cause(diagnosis: Diagnosis) -> None:
    named = [(finding.effect, finding.law) for finding in diagnosis.findings]
    assert ("hysteretic_friction", "bouc_wen") in named, diagnosis.verdict
    assert {effect for effect, _ in named} <= {"hysteretic_friction", "parallel_stiffness"}
    assert diagnosis.extended.rmse < 0.1 * diagnosis.baseline.rmse


@pytest.mark.long
def test_its_parameters_are_near(diagnosis: Diagnosis) -> None:
    values = {name: found.value for name, found in diagnosis.parameters.items()}
    assert values["inertance"] == pytest.approx(20.0, rel=0.01)
    # the spring is seen beside the hysteresis or as its share
    stiffness = values["bw_stiffness"] + values.get("stiffness", 0.0)
    assert stiffness == pytest.approx(1e5, rel=0.02)
    assert values["bw_beta"] + values["bw_gamma"] < 0


def test_a_state_that_runs_away_has_no_force_and_no_warning() -> None:
    time = np.arange(0, 2, 1e-3)
    x, v, a = 0.01 * np.sin(9 * time), 0.09 * np.cos(9 * time), -0.81 * np.sin(9 * time)
    run = BenchRun(
        name="a",
        start=0.0,
        spacing=1e-3,
        displacement=x,
        velocity=v,
        acceleration=a,
        force=2 * a,
        inner=np.ones(time.size, bool),
        first_force=0.0,
        cutoff=40.0,
        measured=(x, v, a),
        corner=10.0,
    )
    model = Model("bouc_wen", {"inertance": 2.0, "bw_stiffness": 1e4, "bw_beta": 0.0,
                               "bw_gamma": -1e9, "bw_exponent": 3.0}, ("bw_gamma",))  # fmt: skip
    problem = Problem([run], [np.ones(time.size, bool)])
    (residual,) = problem.residual(model)
    assert not np.isfinite(residual).any()
    assert problem.fit(model.adding(None, bw_gamma=1.0)).rmse(problem.masks) < 1e9


def test_what_hardens_can_be_replaced_by_simpler_laws() -> None:
    sizes = Scales(force=50.0, displacement=1e-3, velocity=0.1, acceleration=10.0, cutoff=40.0)
    bare = Model("none", {"inertance": 2.0, "transition_velocity": 1e-3}, ("inertance",))
    (found,) = [c for c in candidates(bare, sizes) if c.law == "bouc_wen"]
    hardening = next(start for start in found.starts if "bw_beta" in start.free)
    assert hardening.values["bw_beta"] + hardening.values["bw_gamma"] < 0
    dahl = next(model for model in simpler_laws(hardening) if model.friction == "dahl")
    assert dahl.values["coulomb_force"] > 0
    assert dahl.values["presliding"] > 0
