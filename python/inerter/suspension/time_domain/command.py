"""`inerter suspension evaluate`: indices of nonlinear devices in the time domain."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import AsJson, Folder, number, out, progress_bar, refusing
from inerter.suspension import options


def evaluate_command(
    layout: Annotated[
        str,
        typer.Option(
            help="S1 ... S6, SR, SW1 ... SW8, with commas; or own: the car as its file states it, "
            "with damper tables and stops."
        ),
    ] = "S1,S2,S3",
    car: Annotated[
        str,
        typer.Option(help="quarter, half (heave and pitch, two struts), full, or a file car.toml."),
    ] = "quarter",
    stiffness: Annotated[
        str | None,
        typer.Option(
            help="Spring of the strut [N/m], of a half-car the front one, whose rear one follows; "
            "several with commas. Default: 120e3, of a half-car the published 19960."
        ),
    ] = None,
    case: Annotated[
        str | None,
        typer.Option(
            help="ideal, friction, friction100, elastic, hard, backlash, both, all, dahl, lugre, "
            "bouc_wen, with commas; tables: all of the paper's Tables 2 and 3. Default: ideal, "
            "friction, elastic, both; beside --device only ideal."
        ),
    ] = None,
    device: Annotated[
        Path | None,
        typer.Option(help="device.toml of a measured device: the case named device."),
    ] = None,
    index: Annotated[
        str | None,
        typer.Option(
            help="J1, J1w, J3, J5, pitch, roll; your own: seat.toml, mine.py:NAME; with commas.",
            show_default="J1,J3,J5",
        ),
    ] = None,
    road: Annotated[
        str,
        typer.Option(
            help="paper, or iso:A to iso:H. With --layout own also bump:HEIGHT/LENGTH [m], or a "
            "file road.csv with the columns distance and height (or height_left, height_right) [m]."
        ),
    ] = "paper",
    speed: Annotated[float, number("m/s", "Speed [m/s].")] = 25.0,
    seeds: Annotated[int, typer.Option(help="Number of roads, each with its own phases.")] = 20,
    reoptimise: Annotated[
        bool, typer.Option("--reoptimize", help="Seek c and b anew for every nonlinear case.")
    ] = False,
    reoptimised: Annotated[bool, typer.Option("--reoptimise", hidden=True)] = False,
    search_seeds: Annotated[
        int, typer.Option(help="Roads that the search of --reoptimize uses.")
    ] = 4,
    damping: Annotated[
        str | None,
        typer.Option(
            help="c [N s/m] of one given design in place of an optimum; alone: b is sought. Of a "
            "half-car also FRONT/REAR."
        ),
    ] = None,
    inertance: Annotated[
        str | None,
        typer.Option(
            help="b [kg] of the given design; alone: c is sought. Default: that of --device; best: "
            "the best one, whatever the file of --device says. Of a half-car also FRONT/REAR."
        ),
    ] = None,
    tyre: Annotated[
        str | None,
        typer.Option(
            help="one-sided: leaves the road where it would pull by more than its static load; "
            "pulling: never. Default: one-sided, but on the paper's road pulling, as there."
        ),
    ] = None,
    vary: Annotated[
        str | None,
        typer.Option(
            help="Also the index of each design under all combinations of factors, nominal, mean "
            f"and worst: {options.FACTORS} With --layout own also stiffness, damper_stiffness, "
            "inerter_stiffness."
        ),
    ] = None,
    amplitude: Annotated[
        float | None,
        number(
            "newtons",
            "Sinusoidal load for J5 [N]; default 1000, of a half-car 2000, a full one 4000.",
        ),
    ] = None,
    step: Annotated[float, number("seconds", "Largest time step [s].")] = 1e-3,
    settle: Annotated[
        float | None,
        number(
            "seconds",
            "Seconds before the means begin; default 4, of a half-car 10, longer where the modes "
            "of the car take longer to settle.",
        ),
    ] = None,
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Threads; default: one per processor.")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            help="Dask scheduler to work on, tcp://HOST:8786; needs inerter[cluster]. --jobs are "
            "then the threads of each piece of work, 1 if not given."
        ),
    ] = None,
    out_dir: Folder = Path("out/suspension"),
    as_json: AsJson = False,
) -> None:
    """Work out indices of a car whose inerters have friction, elasticity, play; error bars.

    Runs the MuJoCo models over many random roads. Writes evaluation.json and evaluation.csv.

    \b
    Examples:
      inerter suspension evaluate --layout S2 --case ideal,friction --seeds 10
      inerter suspension evaluate --device device.toml --road iso:C --speed 20
      inerter suspension evaluate --layout own --car car.toml --road bump:0.05/0.5
    """
    from inerter.suspension.study import read_catalogue, read_indices
    from inerter.suspension.time_domain.asked import (
        car_named,
        cases_asked,
        given_struts,
        layouts_asked,
        numbers,
        refuse_ratio,
        tyre_named,
    )
    from inerter.suspension.time_domain.evaluate import evaluate
    from inerter.suspension.time_domain.output import (
        json_text,
        print_evaluation,
        write_evaluation,
    )
    from inerter.suspension.time_domain.own_command import OWN, own_command
    from inerter.suspension.time_domain.plan import Plan
    from inerter.suspension.time_domain.road import road_named
    from inerter.suspension.time_domain.simulate import RunSettings
    from inerter.suspension.variations import OF_CAR, OF_PARTS

    # --reoptimise: the name of --reoptimize before
    reoptimise = reoptimise or reoptimised
    if layout.strip().lower() == OWN:
        others = {
            "--case": case, "--device": device, "--stiffness": stiffness, "--damping": damping,
            "--inertance": inertance, "--amplitude": amplitude, "--scheduler": scheduler,
            "--reoptimize": reoptimise or None,
        }  # fmt: skip
        own_command(
            car=car, road=road, speed=speed, seeds=seeds, tyre=tyre, step=step, settle=settle,
            jobs=jobs or 0, indices=index, vary=vary, others=others, out_dir=out_dir,
            as_json=as_json,
        )  # fmt: skip
        return
    files_of = ("evaluation.json", "evaluation.csv", *(["variations.csv"] if vary else []))
    with refusing(out_dir, *files_of):
        asked = car_named(car)
        refuse_ratio(car, device)
        settings = RunSettings(step=step, settle=settle or asked.settle, jobs=jobs or 0)
        cases, own = cases_asked(case, device, step)
        plan = Plan(
            layouts=layouts_asked(layout),
            cases=cases,
            indices=read_indices("J1,J3,J5" if index is None else index),
            stiffnesses=(
                (asked.stiffness,) if stiffness is None else numbers(stiffness, "stiffness")
            ),
            road=road_named(road, speed),
            seeds=seeds,
            search_seeds=search_seeds,
            reoptimise=reoptimise,
            given=given_struts(damping, inertance, own, getattr(asked.car, "name", "quarter")),
            one_sided=tyre_named(tyre),
            vary=read_catalogue(vary, (*OF_CAR, *OF_PARTS), "vary"),
            keep_settle=settle is not None,
            amplitude=asked.amplitude if amplitude is None else amplitude,
            car=asked.car,
            settings=settings,
        )
        with progress_bar("starting", as_json) as progress:
            rows = evaluate(plan, progress, scheduler=scheduler)
        files = write_evaluation(plan, rows, out_dir)
    if as_json:
        print(json_text(plan, rows), end="")
        return
    print_evaluation(plan, rows, out)
    out.print(f"Written to {out_dir}: {', '.join(files)}")
