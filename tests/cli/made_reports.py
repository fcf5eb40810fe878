"""Made-up diagnoses for the report: usual ones, odd ones, hostile ones."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from inerter.diagnose.result import (
    Accuracy,
    Diagnosis,
    Finding,
    ParameterValue,
    RecordSummary,
    Rival,
    RunCurves,
    TablePoints,
    Unexplained,
)

HOSTILE = "<script>alert(1)</script>.csv"
TOML = '[device]\ninertance = 100.0\nfriction = "coulomb"\n'
XML = '<mujoco model="a"><worldbody/></mujoco>'
RUN_PLOTS = 7


def run(name: str, samples: int = 900, held: bool = False, part: bool = False) -> RunCurves:
    """An inerter of 100 kg with 40 N of Coulomb friction, moved as a sine."""
    time = np.arange(samples) / 300
    turn = 2 * np.pi * 1.5
    x = 0.02 * np.sin(turn * time)
    v = 0.02 * turn * np.cos(turn * time)
    a = -(turn**2) * x
    noise = np.random.default_rng(0).normal(0, 1, samples)
    holdout = np.full(samples, held)
    if part:
        holdout[samples // 3 : samples // 2] = True
    return RunCurves(
        name=name,
        role="holdout" if held else "fit",
        time=time,
        displacement=x,
        velocity=v,
        acceleration=a,
        force=100 * a + 40 * np.sign(v) + noise,
        baseline=95 * a,
        extended=100 * a + 40 * np.tanh(v / 0.002),
        holdout=holdout,
        inner=np.ones(samples, bool),
    )


def diagnosis(*curves: RunCurves, **changes: Any) -> Diagnosis:
    """A diagnosis by hand: Coulomb friction found."""
    warnings = [{"code": "outliers", "text": "3 samples <b>stand out</b> & more"}]
    finding = Finding(
        effect="coulomb_friction",
        law=None,
        confidence=0.998,
        parameters={"coulomb_force": ParameterValue(40.0, 0.4, "N")},
        rmse_before=40.0,
        rmse_after=1.1,
        evidence="f_c = 40 N",
        rivals=[Rival("hysteretic_friction", 0.06, "dahl")],
    )
    parameters = {"inertance": ParameterValue(100.0, 0.5, "kg"), **finding.parameters}
    made = Diagnosis(
        records=[RecordSummary(c.name, len(c.time), 300.0, c.role, warnings) for c in curves],
        baseline=Accuracy({"friction": "none", "inertance": 95.0}, 40.0, 0.3),
        findings=[finding],
        extended=Accuracy(
            {"friction": "coulomb", "inertance": 100.0, "coulomb_force": 40.0}, 1.1, 0.01
        ),
        noise_floor=0.9,
        unexplained=Unexplained(
            significant=False, fraction=0.1, depends_on=[], summary="What remains is noise."
        ),
        engines={"mujoco": 1.1, "exudyn": None, "reference": None},
        verdict="The simulation misses the measured force by 40 N rms.",
        parameters=parameters,
        method={
            "cutoff": 20.0,
            "cutoffs_tried": [5.0, 10.0, 20.0, 40.0],
            "force_error_at_cutoffs": [9.0, 4.0, 2.0, 6.0],
            "split": "held out: b",
            "channels": ["displacement"],
            "held_out_samples": 900,
        },
        curves=list(curves),
    )
    return replace(made, **changes)


def table() -> TablePoints:
    """A bench table with a point without motion, whose ratio is not finite."""
    frequency = np.array([0.5, 1.0, 2.0, 4.0, 8.0])
    acceleration = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    held = np.array([False, True, False, True, False])
    force = 100 * acceleration
    return TablePoints(
        frequency=frequency,
        acceleration=acceleration,
        force=force + 40,
        baseline=force,
        extended=force + 39,
        holdout=held,
    )


def two_runs() -> Diagnosis:
    """The usual case."""
    return diagnosis(run("a"), run("b", held=True))


def table_only() -> Diagnosis:
    """A diagnosis of a bench table."""
    return diagnosis(points=table(), method={"split": "every second frequency"})


CASES = {
    "two runs": two_runs,
    "one run": lambda: diagnosis(run("only", part=True)),
    "many runs": lambda: diagnosis(*(run(f"run {i}", 4000, held=i == 29) for i in range(30))),
    "long run": lambda: diagnosis(run("long", 300_000, part=True)),
    "no findings": lambda: replace(two_runs(), findings=[], verdict="The simulation is right."),
    "table": table_only,
    "nothing to draw": lambda: diagnosis(method={}),
    "hostile name": lambda: diagnosis(run(HOSTILE, held=True)),
    "few samples": lambda: diagnosis(run("short", 5, held=True)),
    "nothing moves": lambda: diagnosis(
        replace(run("still", held=True), displacement=np.zeros(900), velocity=np.zeros(900))
    ),
    "not finite": lambda: diagnosis(
        replace(run("gap", held=True), extended=np.full(900, np.nan)),
        replace(run("wild"), force=np.where(np.arange(900) % 7 == 0, np.inf, 1.0)),
        extended=Accuracy({"friction": "none"}, float("nan"), float("nan")),
        noise_floor=float("nan"),
    ),
    "effect without words": lambda: replace(
        two_runs(),
        findings=[
            Finding(
                effect="backlash",
                law=None,
                confidence=0.9,
                parameters={},
                rmse_before=40.0,
                rmse_after=2.0,
                evidence="a gap.",
                rivals=[],
            )
        ],
    ),
}
