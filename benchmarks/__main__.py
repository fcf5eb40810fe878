"""Run the benchmarks: tables, pictures, and out/bench/bench.json."""

from __future__ import annotations

import argparse
import importlib.util
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from inerter.benchmark.machine import busy, machine
from inerter.benchmark.report import print_machine
from inerter.benchmark.rows import Row, aims, table
from inerter.benchmark.step import tables
from inerter.folder import json_text, write_files
from rich.console import Console

from benchmarks import (
    along_motion,
    diagnosis,
    exudyn_cost,
    exudyn_native,
    growth,
    identification,
    many,
    memory,
    one_step,
    step_instructions,
    work_precision,
)


@dataclass(frozen=True)
class Benchmark:
    """A comparison.

    `run` gives the rows, quickly or not; `summary` the tables that are printed, by title, if not
    all of the rows;
    `picture` writes a PNG; `notes` says what of it cannot run here, and what to install; `needs`
    are optional packages without which all of it is left out.
    """

    title: str
    run: Callable[[bool], list[Row]]
    summary: Callable[[list[Row]], Mapping[str, list[Row]]] | None = None
    picture: Callable[[list[Row], Path], None] | None = None
    notes: Callable[[], list[str]] = list
    needs: tuple[str, ...] = ()


# fmt: off
BENCHMARKS = {
    "one_step": Benchmark(
        "One step of a car, as a multiple of MuJoCo's own armature",
        one_step.run, tables, one_step.picture,
    ),
    "step_instructions": Benchmark(
        "Whose instructions a step of a car is made of",
        step_instructions.run, notes=step_instructions.notes,
    ),
    "work_precision": Benchmark(
        "Time for a given error, 10 s of a quarter-car",
        work_precision.run, work_precision.summary, work_precision.picture, work_precision.notes,
    ),
    "exudyn_cost": Benchmark("One step in Exudyn", exudyn_cost.run, needs=("exudyn",)),
    "exudyn_native": Benchmark(
        "One step in Exudyn beside its own spring-damper", exudyn_native.run, needs=("exudyn",)
    ),
    "along_motion": Benchmark(
        "A sample along a motion, and how much longer others take",
        along_motion.run, picture=along_motion.picture, notes=along_motion.notes,
    ),
    "many": Benchmark("Steps of many simulations", many.run, picture=many.picture),
    "memory": Benchmark("Memory of a simulation", memory.run),
    "growth": Benchmark(
        "How cost grows with size", growth.run, growth.summary, growth.picture,
    ),
    "identification": Benchmark(
        "An identification", identification.run, notes=identification.notes,
    ),
    "diagnosis": Benchmark("A whole diagnosis", diagnosis.run, notes=diagnosis.notes),
}
# fmt: on


def lacking(benchmark: Benchmark) -> str | None:
    """Why a benchmark cannot run here, and what to do."""
    absent = [name for name in benchmark.needs if not _installed(name)]
    return f"is left out: pip install {' '.join(absent)}" if absent else None


def _installed(package: str) -> bool:
    found = importlib.util.find_spec(package)
    return found is not None and found.origin is not None


def run(names: list[str], quick: bool, folder: Path, console: Console) -> dict[str, Any]:
    """Run benchmarks by name; print tables, write pictures and bench.json.

    Every benchmark that is done is written at once: what is broken off keeps what it has.
    """
    folder.mkdir(parents=True, exist_ok=True)
    described = machine()
    result: dict[str, Any] = {
        "schema": "inerter.benchmark/1", "quick": quick, "machine": described, "benchmarks": {},
    }  # fmt: skip
    print_machine(described, console)
    if remark := busy(described):
        console.print(remark)
    done: dict[str, list[Row]] = {}
    for name in names:
        benchmark = BENCHMARKS[name]
        if reason := lacking(benchmark):
            console.print(f"{name} {reason}")
            continue
        start = time.perf_counter()
        done[name] = rows = benchmark.run(quick)
        seconds = time.perf_counter() - start
        console.rule(f"{benchmark.title} ({name}, {seconds:.0f} s)", align="left", style="dim")
        shown = benchmark.summary(rows) if benchmark.summary else {"": rows}
        for title, lines in shown.items():
            if lines:
                console.print(table(title, lines))
        result["benchmarks"][name] = {
            "title": benchmark.title, "seconds": seconds, "rows": rows,
        }  # fmt: skip
        for note in benchmark.notes():
            console.print(note)
        if benchmark.picture is not None:
            benchmark.picture(rows, folder / f"{name}.png")
        write_files(folder, {"bench.json": json_text(result)})
    if met := aims(done):
        console.print(table("Aims", met))
    return result


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer and shorter rounds")
    parser.add_argument(
        "--only", action="append", choices=BENCHMARKS, metavar="NAME",
        help=f"run this one; may be given again: {', '.join(BENCHMARKS)}",
    )  # fmt: skip
    parser.add_argument("--out", type=Path, default=Path("out/bench"), help="folder of the results")
    options = parser.parse_args()
    console = Console()
    if not console.is_terminal:
        # into a file or a log: wide enough for every table
        console = Console(width=160)
    names = [name for name in BENCHMARKS if name in (options.only or BENCHMARKS)]
    run(names, options.quick, options.out, console)
    console.print(f"Written to {options.out}")


if __name__ == "__main__":
    main()
