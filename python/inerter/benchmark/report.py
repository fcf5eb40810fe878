"""What `inerter benchmark` measures and prints."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rich.console import Console

from inerter.benchmark.cars import CARS, INTEGRATORS
from inerter.benchmark.machine import machine
from inerter.benchmark.motion import along_costs
from inerter.benchmark.rows import aims, table
from inerter.benchmark.step import step_costs, tables

STEP = "One step of a car, as a multiple of MuJoCo's own armature"
ALONG = "A sample along a motion in the core; the reference over it"


def measure(quick: bool, progress: Callable[..., None] = lambda share: None) -> dict[str, Any]:
    """Run the essential comparisons.

    Parameters
    ----------
    quick
        The quarter-car under three integrators with few rounds, rather than all of them.
    progress
        Called with the share that is done.

    Returns
    -------
    dict
        As bench.json: schema, quick, machine, benchmarks by name with title and rows.
    """
    described = machine()
    cars, integrators = tuple(CARS), INTEGRATORS
    rounds, steps, count = 25, 500, 20_000
    if quick:
        cars, integrators = cars[:1], ("Euler", "implicitfast", "RK4")
        rounds, steps, count = 11, 200, 5000
    step = step_costs(cars, integrators, rounds, steps, lambda share: progress(0.8 * share))
    along = along_costs(rounds, count, lambda share: progress(0.8 + 0.2 * share))
    return {
        "schema": "inerter.benchmark/1",
        "quick": quick,
        "machine": described,
        "benchmarks": {
            "one_step": {"title": STEP, "rows": step},
            "along_motion": {"title": ALONG, "rows": along},
        },
    }


def print_machine(described: dict[str, Any], console: Console) -> None:
    """One line about the machine."""
    parts = [f"{key} {value}" for key, value in described.items() if value and key != "load"]
    console.print(", ".join(parts), highlight=False)


def print_bench(result: dict[str, Any], console: Console) -> None:
    """Tables, and the aims beside what was measured."""
    print_machine(result["machine"], console)
    rows = {name: part["rows"] for name, part in result["benchmarks"].items()}
    for title, lines in tables(rows["one_step"]).items():
        console.print(table(title, lines))
    console.print(table(ALONG, rows["along_motion"]))
    console.print(table("Aims", aims(rows)))
