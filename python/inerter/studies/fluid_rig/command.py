"""`inerter study fluid-rig`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import AsJson, Folder, Jobs, number, out, progress_bar, refusing


def fluid_rig_command(
    objective: Annotated[
        str, typer.Option(help="What is fitted: spectra (as the paper), time; with commas.")
    ] = "spectra,time",
    seeds: Annotated[
        int, typer.Option(min=1, help="Draws of noise and starting values, one fit each.")
    ] = 1,
    duration: Annotated[float, number("seconds", "Of every sweep [s]; 60 is the whole.")] = 60.0,
    displacement_noise: Annotated[float, number("metres", "Rms [m].")] = 10e-6,
    force_noise: Annotated[float, number("newtons", "Rms [N].")] = 0.2,
    factor: Annotated[float, number("", "Starting values are off by up to this factor.")] = 2.0,
    jobs: Jobs = None,
    out_dir: Folder = Path("out/fluid_rig"),
    as_json: AsJson = False,
) -> None:
    """Rebuild the fluid inerter's experiment: simulate, disturb, identify and draw its sweeps.

    Writes fluid_rig.json, fluid_rig.html, dry.png, complete.png and levels.png.

    \b
    Example:
      inerter study fluid-rig --duration 20
    """
    from inerter.studies.fluid_rig.output import json_text, write_study
    from inerter.studies.fluid_rig.settings import Settings
    from inerter.studies.fluid_rig.signals import Noise
    from inerter.studies.fluid_rig.study import study
    from inerter.studies.fluid_rig.summary import print_study

    with refusing(out_dir, "fluid_rig.json", "fluid_rig.html"):
        settings = Settings(
            objectives=tuple(name.strip() for name in objective.split(",")),
            seeds=tuple(range(seeds)),
            duration=duration,
            noise=Noise(displacement_noise, force_noise),
            factor=factor,
        )
        with progress_bar("tests by the reference", as_json) as progress:
            result = study(settings, jobs=jobs, progress=progress)
        files = write_study(result, out_dir)
    if as_json:
        print(json_text(result), end="")
    else:
        print_study(result, out)
        out.print(f"Written to {out_dir}: {', '.join(files)}")
