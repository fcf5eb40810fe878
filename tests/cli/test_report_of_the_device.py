"""What was found of the device itself is told beside what its simulation lacks."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
from inerter.diagnose import Diagnosis
from inerter.diagnose.result import ParameterValue
from inerter.report import text
from inerter.report.runs import role
from inerter.report.terminal import print_summary
from made_reports import two_runs
from rich.console import Console


def shown(diagnosis: Diagnosis) -> str:
    seen = io.StringIO()
    print_summary(diagnosis, Console(width=400, file=seen))
    return seen.getvalue()


def test_the_inertance_that_was_found_is_told_and_nothing_twice() -> None:
    made = two_runs()
    told = {name: value for each in made.findings for name, value in each.parameters.items()}
    own = {
        "inertance": ParameterValue(113.04, 0.21, "kg"),
        "transition_velocity": ParameterValue(1e-3, 1e-4, "m/s"),
    }
    text = shown(replace(made, parameters={**told, **own}))
    (line,) = [line for line in text.splitlines() if line.startswith("The device itself")]
    assert "inertance 113.04 ± 0.21 kg" in line
    # how wide sign(v) is says nothing, and what is lacking stands above
    assert "transition_velocity" not in line
    assert not any(name in line for name in told)
    # of a stated device nothing was found
    assert "The device itself" not in shown(replace(made, parameters=told))
    # and where nothing is lacking it is told all the same
    assert "inertance 113.04" in shown(replace(made, findings=[], parameters=own))


def test_a_phase_near_zero_is_known_and_a_size_below_its_error_is_not() -> None:
    own = {
        "inertance": ParameterValue(2.0, 3.0, "kg"),
        "force_phase_1": ParameterValue(-0.0007, 0.0022, "rad"),
        "force_phase_2": ParameterValue(0.5, 1.2, "rad"),
    }
    text = shown(replace(two_runs(), findings=[], parameters=own))
    (line,) = [line for line in text.splitlines() if line.startswith("The device itself")]
    assert "inertance 2 ± 3 kg (not determined)" in line.replace("2.0 ± 3.0", "2 ± 3")
    assert line.count("(not determined)") == 2
    assert "force_phase_1 -0.0007 ± 0.0022 rad," in line.replace("−", "-")


def test_an_error_of_a_phase_counts_against_a_turn() -> None:
    """On the page and in the terminal; of all else against the size."""
    near = ParameterValue(-0.0007, 0.0022, "rad")
    assert text.size_told("force_phase_1", near) > 0.5
    assert text.size_told("stop_upper", near) == 0.0007


def test_a_run_of_which_blocks_are_held_out_is_partly_held_out() -> None:
    """Of a bench the run has one curve, of a vehicle one for each channel."""
    made = two_runs()
    whole = made.curves[0]
    some = np.arange(whole.time.size) % 10 < 3
    blocks = replace(whole, holdout=some)
    record = replace(made.records[0], name=whole.name, role="fit")
    for name in (whole.name, f"{whole.name}: wheel acceleration"):
        told = replace(made, curves=[replace(blocks, name=name)])
        assert role(record, told) == "partly held out"
    # a run whose name begins alike is another
    other = replace(made, curves=[replace(blocks, name=f"{whole.name}2: body")])
    assert role(record, other) == "fitted"
