"""`inerter study hysteresis`: the hysteresis paper rebuilt."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inerter.console import AsJson, Folder, Jobs, number, out, progress_bar, refusing


def hysteresis_command(
    noise: Annotated[float, number("newtons", "White noise on the force [N, rms].")] = 10.0,
    rate: Annotated[
        float, number("samples per second", "Samples per second of the tests.")
    ] = 1000.0,
    duration: Annotated[float, number("seconds", "Length of a test [s].")] = 6.0,
    denoise: Annotated[
        str,
        typer.Option(
            help="How the force is cleaned before fits: none, emd, emd_loudest (one mode, as in "
            "the paper), lowpass, lowpass_both."
        ),
    ] = "emd",
    draws: Annotated[int, typer.Option(help="Noises for the bias of estimates.")] = 10,
    random_starts: Annotated[int, typer.Option(help="Random starts of each optimiser.")] = 20,
    seed: Annotated[int, typer.Option(help="Of the noise and of the random starts.")] = 1,
    quick: Annotated[
        bool,
        typer.Option(
            "--quick", help="Fewer cases: 3 draws and 4 random starts, to look at, not to quote."
        ),
    ] = False,
    jobs: Jobs = None,
    out_dir: Folder = Path("out/hysteresis"),
    as_json: AsJson = False,
) -> None:
    """Rebuild the virtual bench tests of a ball-screw inerter with Dahl, LuGre and Bouc-Wen.

    Takes about a quarter of an hour on two processors, --quick some minutes. Writes
    hysteresis.json, hysteresis.html and pictures.

    \b
    Example:
      inerter study hysteresis --quick --jobs 2
    """
    from inerter.studies.hysteresis.output import json_text, print_study, write_study
    from inerter.studies.hysteresis.settings import Settings
    from inerter.studies.hysteresis.study import study

    with refusing(out_dir, "hysteresis.json", "hysteresis.html"):
        settings = Settings(
            noise=noise, rate=rate, duration=duration, denoise=denoise, draws=draws,
            random_starts=random_starts, seed=seed,
        )  # fmt: skip
        with progress_bar("rebuilding the hysteresis paper", as_json) as progress:
            result = study(settings.quick() if quick else settings, jobs=jobs, progress=progress)
        files = write_study(result, out_dir)
    if as_json:
        print(json_text(result), end="")
        return
    print_study(result, out)
    out.print(f"Written to {out_dir}: {', '.join(files)}")
