"""The JSON and the files of a sweep: all of them or none."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from inerter.folder import write_files
from inerter.suspension.figures import page, picture
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.study import Study
from inerter.suspension.sweep import Missed, SweepRow


def rows_json(rows: list[SweepRow], missed: Sequence[Missed] = ()) -> str:
    """The list that --json prints; what no design keeps comes last."""
    return json.dumps([row.json() for row in (*rows, *missed)], indent=2, allow_nan=False) + "\n"


def write_sweep(
    study: Study, rows: list[SweepRow], folder: Path, missed: Sequence[Missed] = ()
) -> list[str]:
    """Write optimum.json and, where stiffness was varied, optimum.png and .html; their names.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    files = {
        "optimum.json": json.dumps(_full(study, rows, missed), indent=2, allow_nan=False).encode()
    }
    if len(study.stiffnesses) > 1:
        files |= {"optimum.png": picture(rows), "optimum.html": page(rows).encode()}
    return write_files(folder, files)


def _full(study: Study, rows: list[SweepRow], missed: Sequence[Missed]) -> dict[str, Any]:
    equal = {} if isinstance(study.car, QuarterCar) else {"equal": study.equal}
    return {
        "schema": "inerter.suspension/1",
        "car": asdict(study.car),
        **equal,
        "road": asdict(study.road),
        "series": {name: pair and asdict(pair) for name, pair in study.series.items()},
        "rows": [
            row.json()
            | {
                "peaks": [{"frequency": f, "gain": g} for f, g in row.optimum.peaks],
                "notes": list(row.optimum.notes),
            }
            for row in rows
        ],
        **({"missed": [each.json() for each in missed]} if missed else {}),
    }
