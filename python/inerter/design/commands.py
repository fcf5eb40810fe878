"""The commands of `inerter design`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from inerter.console import AsJson, out, refusing
from inerter.design.ball_screw.inputs import INPUTS as BALL_SCREW
from inerter.design.fluid.inputs import INPUTS as FLUID
from inerter.design.options import with_options
from inerter.design.rack_pinion.inputs import INPUTS as RACK_PINION

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Work out inertance, losses and elasticity of a device from its geometry. "
    'Values are plain numbers in SI units or carry a unit: 0.01, "10 mm", "45 deg", "30 degC".',
)

Folder = Annotated[
    Path | None,
    typer.Option(
        "--out", help="Folder for design.json, device.toml, model.xml, design.png, design.html."
    ),
]


@app.command("ball-screw")
@with_options(BALL_SCREW)
def ball_screw_command(
    measured: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="Bench table to which inertia and preload are fitted; 'paper': the shipped one.",
        ),
    ] = None,
    out_dir: Folder = None,
    as_json: AsJson = False,
    **inputs: Any,
) -> None:
    """Design a ball screw: sliding and rolling balls, inertance against load and frequency.

    \b
    Example:
      inerter design ball-screw --lead "20 mm" --out out/screw
    """
    from inerter.design.ball_screw.design import design_ball_screw

    _design(lambda: design_ball_screw(measured=measured, **inputs), out_dir, as_json)


@app.command("rack-pinion")
@with_options(RACK_PINION)
def rack_pinion_command(
    stage: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KEY=VALUE,...",
            help="One gear stage, from the pinion on; may be given again: ratio=4,inertia=1e-4 "
            "and, if wanted, efficiency=0.98, play='0.1 deg', stiffness='900 N*m/rad' of the "
            "shaft that the stage drives.",
        ),
    ] = None,
    out_dir: Folder = None,
    as_json: AsJson = False,
    **inputs: Any,
) -> None:
    """Design a rack and pinion with gears: inertance, play, elastic shafts, mesh losses.

    \b
    Example:
      inerter design rack-pinion --stage ratio=4,inertia=1e-4
    """
    from inerter.design.rack_pinion.design import design_rack_pinion

    _design(lambda: design_rack_pinion(stages=stage or [], **inputs), out_dir, as_json)


@app.command("fluid")
@with_options(FLUID)
def fluid_command(out_dir: Folder = None, as_json: AsJson = False, **inputs: Any) -> None:
    """Design a fluid inerter: inertance, losses, cavitation, compressibility, trapped air.

    \b
    Example:
      inerter design fluid --out out/fluid
    """
    from inerter.design.fluid.design import design_fluid

    _design(lambda: design_fluid(**inputs), out_dir, as_json)


def _design(calculate: Callable[[], Any], folder: Path | None, as_json: bool) -> None:
    from inerter.design.files import design_json, write_design
    from inerter.design.table import print_design

    files: list[str] = []
    with refusing(folder, "design.json", "device.toml", "design.png", "design.html"):
        design = calculate()
        if folder is not None:
            files = write_design(design, folder)
    if as_json:
        print(design_json(design), end="")
        return
    print_design(design, out)
    if folder is not None:
        out.print(f"Written to {folder}: {', '.join(files)}")
