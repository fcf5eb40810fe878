"""Run every benchmark, print tables, write out/bench/bench.json."""

from __future__ import annotations

import argparse
import json
import platform
from pathlib import Path
from typing import Any

from inerter.exudyn.engine import installed
from rich.console import Console
from rich.progress import track
from rich.table import Table

from benchmarks import along_motion, exudyn_cost, step_cost

BENCHMARKS = {
    "step_cost": ("What one step of a quarter-car costs", step_cost.run),
    "exudyn_cost": ("What one step costs in Exudyn", exudyn_cost.run),
    "along_motion": ("What a sample along a measured motion costs", along_motion.run),
}


def show(title: str, rows: list[dict[str, Any]], console: Console) -> None:
    """Print rows as a table."""
    table = Table(*rows[0], title=title)
    for row in rows:
        table.add_row(*(f"{v:.3g}" if isinstance(v, float) else str(v) for v in row.values()))
    console.print(table)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    parser.add_argument("--out", type=Path, default=Path("out/bench"))
    options = parser.parse_args()
    console = Console()
    results: dict[str, Any] = {"machine": platform.processor() or platform.machine()}
    for name in track(BENCHMARKS, description="benchmarks", console=console):
        title, run = BENCHMARKS[name]
        if name == "exudyn_cost" and not installed():
            console.print('exudyn_cost is left out: `pip install "inerter[exudyn]"`')
            continue
        results[name] = run(options.quick)
        show(title, results[name], console)
    options.out.mkdir(parents=True, exist_ok=True)
    path = options.out / "bench.json"
    path.write_text(json.dumps(results, indent=2) + "\n", encoding="utf-8")
    console.print(f"Written to {path}")


if __name__ == "__main__":
    main()
