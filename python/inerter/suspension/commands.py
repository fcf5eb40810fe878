"""The commands of `inerter suspension`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import AsJson, Jobs, number, out, progress_bar, refusing
from inerter.model_parameters import QUARTER_CAR
from inerter.suspension import options
from inerter.suspension.model_command import model_command
from inerter.suspension.network_command import network_command
from inerter.suspension.pareto_command import pareto_command
from inerter.suspension.time_domain.command import evaluate_command

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Find how much an inerter gains in a suspension, and what its nonlinearities take back.",
)

app.command("evaluate")(evaluate_command)
app.command("pareto")(pareto_command)
app.command("model")(model_command)
app.command("network")(network_command)


@app.command("optimize")
def optimize_command(
    layout: options.Layouts = "S1,S2,S3",
    index: Annotated[
        str,
        typer.Option(
            help="J1 comfort, J1w as felt, J3 tyre load, J5 load carrying, travel, pitch, roll, or "
            "your own: file.toml, file.py:FUNCTION; with commas."
        ),
    ] = "J1,J3,J5",
    stiffness: options.Stiffness = None,
    series: options.Series = "none",
    car: options.Car = "quarter",
    limit: options.Limit = None,
    hold: options.Hold = None,
    catalogue: options.Catalogue = None,
    vary: options.Vary = None,
    equal: options.Equal = False,
    correlation: Annotated[
        float | None,
        number("", "Full: of the left and the right road, 0 to 1.", show_default="0.5"),
    ] = None,
    sprung_mass: Annotated[
        float | None,
        number("kilograms", "Quarter: ms [kg].", show_default=f"{QUARTER_CAR.sprung_mass:g}"),
    ] = None,
    unsprung_mass: Annotated[
        float | None,
        number("kilograms", "Quarter: mu [kg].", show_default=f"{QUARTER_CAR.unsprung_mass:g}"),
    ] = None,
    tyre_stiffness: Annotated[
        float | None,
        number("N/m", "Quarter: kt [N/m].", show_default=f"{QUARTER_CAR.tyre_stiffness:g}"),
    ] = None,
    speed: options.Speed = options.ROAD.velocity,
    velocity: options.OldSpeed = None,
    roughness: options.Roughness = options.ROAD.roughness,
    jobs: Jobs = None,
    scheduler: Annotated[
        str | None,
        typer.Option(help="Dask scheduler to work on, tcp://HOST:8786; needs inerter[cluster]."),
    ] = None,
    out_dir: Annotated[
        Path | None,
        typer.Option("--out", help="Folder for optimum.json and, over a range, the figures."),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Find the damping and inertance that minimise an index of a car, globally and exactly.

    \b
    Examples:
      inerter suspension optimize
      inerter suspension optimize --layout S3 --index J3 --stiffness 6e4:15e4:10
      inerter suspension optimize --car half --series soft --json
    """
    from inerter.suspension.car_options import study_asked
    from inerter.suspension.output import rows_json, write_sweep
    from inerter.suspension.study import read_indices
    from inerter.suspension.sweep import Missed, sweep
    from inerter.suspension.table import print_rows

    files: list[str] = []
    missed: list[Missed] = []
    with refusing(out_dir, "optimum.json", "optimum.png", "optimum.html"):
        quarter = {
            "sprung_mass": sprung_mass,
            "unsprung_mass": unsprung_mass,
            "tyre_stiffness": tyre_stiffness,
        }
        study = study_asked(
            car=car,
            layout=layout,
            indices=read_indices(index),
            stiffness=stiffness,
            series=series,
            road=options.road_asked(speed, velocity, roughness),
            equal=equal,
            hold=hold,
            limit=limit,
            catalogue=catalogue,
            vary=vary,
            quarter=quarter,
            correlation=correlation,
        )
        with progress_bar("optimising", as_json) as progress:
            rows = sweep(study, jobs=jobs, scheduler=scheduler, progress=progress, missed=missed)
        if out_dir is not None:
            files = write_sweep(study, rows, out_dir, missed)
    if as_json:
        print(rows_json(rows, missed), end="")
        return
    print_rows(rows, out, missed)
    if out_dir is not None:
        out.print(f"Written to {out_dir}: {', '.join(files)}")
