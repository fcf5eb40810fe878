"""`inerter suspension evaluate`: indices of nonlinear devices in the time domain."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import out, progress_bar, refuse


def evaluate_command(
    layout: Annotated[str, typer.Option(help="S1, S2, S3, with commas.")] = "S1,S2,S3",
    stiffness: Annotated[
        str, typer.Option(help="Spring of the strut [N/m]; several with commas.")
    ] = "120e3",
    case: Annotated[
        str,
        typer.Option(
            help="ideal, friction, friction100, elastic, hard, backlash, both, all, dahl, lugre, "
            "bouc_wen, with commas; tables: all of the paper's Tables 2 and 3."
        ),
    ] = "ideal,friction,elastic,both",
    index: Annotated[str, typer.Option(help="J1, J3, J5, with commas.")] = "J1,J3,J5",
    road: Annotated[str, typer.Option(help="paper, or iso:A to iso:E.")] = "paper",
    speed: Annotated[float, typer.Option(help="Speed [m/s].")] = 25.0,
    seeds: Annotated[int, typer.Option(help="Number of roads, each with its own phases.")] = 20,
    reoptimise: Annotated[
        bool,
        typer.Option(
            "--reoptimise", help="Seek c and b anew for every nonlinear case (minutes each)."
        ),
    ] = False,
    search_seeds: Annotated[
        int, typer.Option(help="Roads that the search of --reoptimise uses.")
    ] = 4,
    amplitude: Annotated[float, typer.Option(help="Sinusoidal load for J5 [N].")] = 1000.0,
    step: Annotated[float, typer.Option(help="Largest time step [s].")] = 1e-3,
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Threads; default: one per processor.")
    ] = None,
    out_dir: Annotated[Path, typer.Option("--out", help="Folder for the results.")] = Path(
        "out/suspension"
    ),
    as_json: Annotated[
        bool, typer.Option("--json", help="Print evaluation.json alone on stdout.")
    ] = False,
) -> None:
    """Indices of a quarter-car whose inerter has friction, elasticity, play, with error bars.

    Runs the MuJoCo models over many random roads. Writes evaluation.json and evaluation.csv.
    """
    from inerter.diagnose.output import refuse_folder
    from inerter.suspension.time_domain.cases import CASES, NUMBERED, case_named
    from inerter.suspension.time_domain.evaluate import Plan, evaluate
    from inerter.suspension.time_domain.output import (
        json_text,
        print_evaluation,
        write_evaluation,
    )
    from inerter.suspension.time_domain.road import road_named
    from inerter.suspension.time_domain.simulate import RunSettings

    try:
        refuse_folder(out_dir)
        wanted = _names(case, "case")
        if wanted == ("tables",):
            numbered = {each.case for each in NUMBERED}
            wanted = tuple(name for name in CASES if name in numbered)
        plan = Plan(
            layouts=_names(layout, "layout"),
            cases=tuple(case_named(name) for name in wanted),
            indices=_names(index, "index"),
            stiffnesses=_numbers(stiffness, "stiffness"),
            road=road_named(road, speed),
            seeds=seeds,
            search_seeds=search_seeds,
            reoptimise=reoptimise,
            amplitude=amplitude,
            settings=RunSettings(step=step, jobs=jobs or 0),
        )
        with progress_bar("starting", as_json) as progress:
            rows = evaluate(plan, progress)
        files = write_evaluation(plan, rows, out_dir)
    except ValueError as error:
        refuse(str(error))
    except OSError as error:
        refuse(f"{error.filename or out_dir}: cannot be written ({error.strerror}); choose --out")
    if as_json:
        print(json_text(plan, rows), end="")
        return
    print_evaluation(plan, rows, out)
    out.print(f"Written to {out_dir}: {', '.join(files)}")


def _names(text: str, option: str) -> tuple[str, ...]:
    """Names separated by commas, each once."""
    found = tuple(dict.fromkeys(part.strip() for part in text.split(",") if part.strip()))
    if not found:
        raise ValueError(f"--{option} is empty; see --help")
    return found


def _numbers(text: str, option: str) -> tuple[float, ...]:
    try:
        return tuple(float(name) for name in _names(text, option))
    except ValueError:
        raise ValueError(
            f"--{option} is {text!r}: give numbers, such as 120e3, with commas between them"
        ) from None
