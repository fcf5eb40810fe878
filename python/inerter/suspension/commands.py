"""The commands of `inerter suspension`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import AsJson, Jobs, number, out, progress_bar, refusing
from inerter.model_parameters import QUARTER_CAR
from inerter.suspension.model_command import model_command
from inerter.suspension.network_command import network_command
from inerter.suspension.pareto_command import pareto_command
from inerter.suspension.quarter_car import Road
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

_ROAD = Road()


@app.command("optimize")
def optimize_command(
    layout: Annotated[
        str, typer.Option(help="Layouts S1 ... S6, SR, SW1 ... SW8, with commas between.")
    ] = "S1,S2,S3",
    index: Annotated[
        str,
        typer.Option(
            help="J1 comfort, J1w as felt, J3 tyre load, J5 load carrying, travel, pitch, roll, or "
            "your own: file.toml, file.py:FUNCTION; with commas."
        ),
    ] = "J1,J3,J5",
    stiffness: Annotated[
        str | None,
        typer.Option(
            help="k [N/m]: numbers and ranges FIRST:LAST:COUNT, with commas; of a half- or full "
            "car the front's, or KF/KR.",
            show_default=f"{QUARTER_CAR.stiffness:g}, or the half- and full car's own",
        ),
    ] = None,
    series: Annotated[
        str,
        typer.Option(help="none (ideal), soft, hard or KS/CS [N/m, N s/m]; with commas."),
    ] = "none",
    car: Annotated[
        str,
        typer.Option(
            help="quarter (Wang and Su's), half or full (a published passenger car), or a file "
            "car.toml of your own."
        ),
    ] = "quarter",
    limit: Annotated[
        str | None,
        typer.Option(help="Not above: INDEX=VALUE in SI, as in travel=0.02,J3=900; also J5, J1w."),
    ] = None,
    hold: Annotated[
        str | None,
        typer.Option(help="Not sought: damping=, inertance=, relaxation_stiffness= VALUE in SI."),
    ] = None,
    catalogue: Annotated[
        str | None,
        typer.Option(
            help="One of some values each: NAME=VALUE/VALUE/... in SI, as in "
            "inertance=60/80/113,damping=900/1200; names as for --hold."
        ),
    ] = None,
    vary: Annotated[
        str | None,
        typer.Option(
            help="The best over all combinations of factors: NAME=FACTOR/FACTOR/..., as in "
            "body_mass=1/1.3,speed=0.6/1.4,damping=0.8/1.2; also wheel_mass, tyre_stiffness, "
            "inertance, relaxation_stiffness."
        ),
    ] = None,
    equal: Annotated[
        bool, typer.Option("--equal", help="Half, full: the same c, b, k_b at front and rear.")
    ] = False,
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
    speed: Annotated[float, number("m/s", "Speed of the car [m/s].")] = _ROAD.velocity,
    velocity: Annotated[
        float | None, number("m/s", "The name of --speed before.", hidden=True)
    ] = None,
    roughness: Annotated[
        float, number("m^3/cycle", "Of the road, kappa [m^3/cycle].")
    ] = _ROAD.roughness,
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
    from inerter.suspension.sweep import sweep
    from inerter.suspension.table import print_rows

    files: list[str] = []
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
            road=Road(velocity=speed if velocity is None else velocity, roughness=roughness),
            equal=equal,
            hold=hold,
            limit=limit,
            catalogue=catalogue,
            vary=vary,
            quarter=quarter,
            correlation=correlation,
        )
        with progress_bar("optimising", as_json) as progress:
            rows = sweep(study, jobs=jobs, scheduler=scheduler, progress=progress)
        if out_dir is not None:
            files = write_sweep(study, rows, out_dir)
    if as_json:
        print(rows_json(rows), end="")
        return
    print_rows(rows, out)
    if out_dir is not None:
        out.print(f"Written to {out_dir}: {', '.join(files)}")
