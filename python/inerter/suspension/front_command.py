"""`inerter suspension pareto`: a front of two indices by layouts, as table, CSV and picture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich import box
from rich.table import Table

from inerter.console import AsJson, Folder, number, out, progress_bar, refusing
from inerter.suspension.quarter_car import Road

_ROAD = Road()


def pareto_command(
    layout: Annotated[
        str, typer.Option(help="Layouts S1 ... S6, SW1 ... SW8, with commas.")
    ] = "S1,SW2,S2,S3",
    index: Annotated[
        str, typer.Option(help="Two of J1, J3, Wk, travel, load_ratio, with a comma.")
    ] = "Wk,J3",
    limit: Annotated[
        list[str] | None,
        typer.Option(help="INDEX=VALUE (SI): largest value of an index, as in travel=0.02."),
    ] = None,
    design: Annotated[
        list[str] | None,
        typer.Option(help="NAME=VALUE given, NAME=LOW:HIGH range, as in inertance=10:200."),
    ] = None,
    network: Annotated[
        list[Path] | None, typer.Option(help="FILE.toml of an own network, as a layout.")
    ] = None,
    stiffness: Annotated[
        str | None,
        typer.Option(help="k [N/m].", show_default="120000, or that of the car's file"),
    ] = None,
    car: Annotated[str, typer.Option(help="quarter, or FILE.toml of a quarter-car.")] = "quarter",
    velocity: Annotated[float, number("m/s", "V [m/s].")] = _ROAD.velocity,
    roughness: Annotated[float, number("m^3/cycle", "kappa [m^3/cycle].")] = _ROAD.roughness,
    points: Annotated[int, typer.Option(min=3, max=200, help="Points of each front.")] = 12,
    out_dir: Folder = Path("out/pareto"),
    as_json: AsJson = False,
) -> None:
    """A front of two indices under limits, by layouts: what each gains, and at what price.

    Writes pareto.csv, pareto.json and pareto.png. Layouts whose fronts lie in the folder
    already, of the very same question, are not computed again.
    """
    from inerter.suspension.car_options import chosen_car, chosen_stiffnesses
    from inerter.suspension.design_options import read_allowed, read_layouts_and_networks
    from inerter.suspension.front_files import fronts, json_text, write_front
    from inerter.suspension.problem import SuspensionProblem
    from inerter.suspension.quarter_car import QuarterCar
    from inerter.suspension.study import StudyError, read_indices

    with refusing(out_dir, "pareto.csv", "pareto.json", "pareto.png"):
        which = chosen_car(car, {})
        if not isinstance(which, QuarterCar):
            raise StudyError(
                f"car {car!r}: a front is of a quarter-car; give a file of kind quarter"
            )
        indices = read_indices(index)
        if len(indices) != 2 or "J5" in indices:
            raise StudyError(f"index {index!r}: give two of J1, J3, Wk, travel, load_ratio")
        layouts = read_layouts_and_networks(layout, network or [])
        allowed = read_allowed(design or [], limit or [], layouts.values())
        if allowed.choices:
            raise StudyError("--design with values V/V/V: of `optimize`; give a range LOW:HIGH")
        springs = chosen_stiffnesses(stiffness, which, car)
        if len(springs) != 1 or isinstance(springs[0], tuple):
            raise StudyError(f"stiffness {stiffness!r}: give one number for a front")
        road = Road(velocity=velocity, roughness=roughness)
        problems = [
            SuspensionProblem(
                car=which, road=road, layout=name, index=indices[0], stiffness=float(springs[0]),
                fixed=tuple(x for x in allowed.fixed if x[0] in one.variables),
                ranges=tuple(x for x in allowed.ranges if x[0] in one.variables),
                own=one if network and name not in _known() else None,
            )
            for name, one in layouts.items()
        ]  # fmt: skip
        with progress_bar("fronts", as_json) as progress:
            found = fronts(problems, indices[1], dict(allowed.limits), points, out_dir, progress)
        files = write_front(found, out_dir)
    if as_json:
        print(json_text(found), end="")
        return
    _print(found, indices)
    out.print(f"Written to {out_dir}: {', '.join(files)}")


def _known() -> set[str]:
    from inerter.suspension.layouts import LAYOUTS

    return set(LAYOUTS)


def _print(found: dict, indices: tuple[str, ...]) -> None:
    names = (*indices, *(x for x in ("travel", "load_ratio") if x not in indices))
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False)
    table.add_column("layout")
    for name in (*names, "c [N s/m]", "b [kg]"):
        table.add_column(name, justify="right")
    for row in found["rows"]:
        design = row["design"]
        table.add_row(
            row["layout"],
            *(f"{row['indices'][name]:.4g}" for name in names),
            f"{design['damping']:.4g}" if "damping" in design else "",
            f"{design['inertance']:.4g}" if "inertance" in design else "",
        )
    out.print(table)
    for name in found["empty"]:
        out.print(f"{name}: no design keeps the limits.", markup=False)
