"""`inerter benchmark`: what inerters cost on the user's own machine."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import AsJson, notes, out, progress_bar, refusing
from inerter.folder import json_text, write_files


def benchmark_command(
    quick: Annotated[
        bool, typer.Option("--quick", help="Fewer cases: one car, three integrators; seconds.")
    ] = False,
    out_dir: Annotated[
        Path | None, typer.Option("--out", help="Folder for bench.json; default: nothing written.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Measure what a step with devices costs in MuJoCo, and a sample in the core.

    Plugin against MuJoCo's own elements, Python and no device: ratios, taken in turn.

    \b
    Example:
      inerter benchmark --quick
    """
    from inerter.benchmark.machine import busy
    from inerter.benchmark.report import measure, print_bench

    with refusing(out_dir, "bench.json"):
        with progress_bar("measuring", as_json) as progress:
            result = measure(quick, progress)
        if remark := busy(result["machine"]):
            notes.print(remark)
        if out_dir is not None:
            write_files(out_dir, {"bench.json": json_text(result)})
    if as_json:
        print(json_text(result), end="")
        return
    print_bench(result, out)
    if out_dir is not None:
        out.print(f"Written to {out_dir}: bench.json")
