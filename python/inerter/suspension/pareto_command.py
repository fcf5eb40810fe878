"""`inerter suspension pareto`: the front of two indices, by layouts."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import AsJson, Folder, out, progress_bar, refusing
from inerter.suspension import options


def pareto_command(
    layout: options.Layouts = "S1,S2,S3",
    index: Annotated[
        str,
        typer.Option(
            help="FIRST,SECOND: two of J1, J1w, J3, J5, travel, pitch, roll, file.toml, "
            "file.py:FUNCTION."
        ),
    ] = "J1w,J3",
    stiffness: options.Stiffness = None,
    series: options.Series = "none",
    car: options.Car = "quarter",
    limit: options.Limit = None,
    hold: options.Hold = None,
    catalogue: options.Catalogue = None,
    vary: options.Vary = None,
    equal: options.Equal = False,
    points: Annotated[int, typer.Option(min=2, help="Designs of each layout.")] = 9,
    speed: options.Speed = options.ROAD.velocity,
    velocity: options.OldSpeed = None,
    roughness: options.Roughness = options.ROAD.roughness,
    out_dir: Folder = Path("out/suspension"),
    as_json: AsJson = False,
) -> None:
    """Find the compromises of two indices: designs of which none is better in both.

    Writes pareto.json, pareto.csv and pareto.png. Run again with the same words and --out, it goes
    on where it was interrupted.

    \b
    Examples:
      inerter suspension pareto --layout S1,S3 --points 7
      inerter suspension pareto --index J1,J3 --limit travel=0.02 --out out/front
    """
    from rich.table import Table

    from inerter.folder import json_text, write_files
    from inerter.suspension.car_options import study_asked
    from inerter.suspension.pareto import front, front_csv
    from inerter.suspension.pareto_picture import front_picture
    from inerter.suspension.study import StudyError, read_indices

    with refusing(out_dir, "pareto.json", "pareto.csv", "pareto.png"):
        indices = read_indices(index)
        if len(indices) != 2:
            raise StudyError(f"index {index!r}: a front is of two, as in J1w,J3")
        study = study_asked(
            car=car,
            layout=layout,
            indices=indices[:1],
            stiffness=stiffness,
            series=series,
            road=options.road_asked(speed, velocity, roughness),
            equal=equal,
            hold=hold,
            limit=limit,
            catalogue=catalogue,
            vary=vary,
        )
        with progress_bar("front", as_json) as progress:
            found = front(study, indices[1], points, out_dir, progress)
        title = f"{Path(car).stem}, {indices[0]} against {indices[1]}" + (
            f", {limit}" if limit else ""
        )
        files = write_files(
            out_dir,
            {
                "pareto.csv": front_csv(found, study.layouts),
                "pareto.png": front_picture(found, study.layouts, title),
            },
        )
    rows = [row for name in study.layouts for row in found.of(name)]
    if as_json:
        print(json_text([row.json() for row in rows]), end="")
        return
    table = Table(box=None, padding=(0, 1, 0, 0), header_style="dim")
    names = list(dict.fromkeys(name for row in rows for name in row.values))
    for name in ("layout", *names):
        table.add_column(name, justify="left" if name == "layout" else "right", no_wrap=True)
    for row in rows:
        table.add_row(row.layout, *(f"{row.values[name]:.5g}" for name in names))
    out.print(table)
    for told in found.told:
        out.print(told, markup=False)
    out.print(f"Written to {out_dir}: pareto.json, {', '.join(files)}")
