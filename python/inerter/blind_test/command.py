"""`inerter blind-test`: how often the diagnosis finds what was hidden."""

from __future__ import annotations

import os
import secrets
import time
from pathlib import Path
from typing import Annotated

import typer

from inerter.console import AsJson, Folder, Jobs, notes, number, out, progress_bar, refuse, refusing

_AS_COUNT = "default: as --count, none with --effects"


def blind_test_command(
    effects: Annotated[
        str | None,
        typer.Option(
            help="Effects to hide, with commas; default: every one of a bench or a vehicle."
        ),
    ] = None,
    count: Annotated[int, typer.Option(min=0, help="Cases of each effect.")] = 40,
    noise: Annotated[
        float, number("", "White noise per force rms; 1 micrometre goes with 0.01.")
    ] = 0.01,
    clean: Annotated[
        int | None, typer.Option(min=0, help=f"Cases with nothing hidden; {_AS_COUNT}.")
    ] = None,
    pairs: Annotated[
        int | None, typer.Option(min=0, help=f"Cases with two effects; {_AS_COUNT}.")
    ] = None,
    triples: Annotated[
        int | None, typer.Option(min=0, help=f"Cases with three effects; {_AS_COUNT}.")
    ] = None,
    unknown: Annotated[
        int | None, typer.Option(min=0, help=f"Cases with an unnamed effect; {_AS_COUNT}.")
    ] = None,
    bench: Annotated[
        str,
        typer.Option(
            help="ideal: white noise alone; realistic: rate, length, motion, filters, "
            "quantisation, hum, drift, jitter, grip mass and ringing drawn for each case."
        ),
    ] = "ideal",
    vehicle: Annotated[
        bool,
        typer.Option(
            "--vehicle",
            help="In vehicles, not on benches: quarter-, half-, full car or trailing arm, road, "
            "speed, bumps and sensors drawn for each case; noise per channel's spread.",
        ),
    ] = False,
    seed: Annotated[
        int | None,
        typer.Option(min=0, help="Seed; default: $INERTER_SEED, else a new one. It is printed."),
    ] = None,
    jobs: Jobs = None,
    workers: Annotated[int | None, typer.Option("--workers", min=1, hidden=True)] = None,
    folder: Folder = Path("out/blind_test"),
    as_json: AsJson = False,
) -> None:
    """Hide effects in records made by other equations, diagnose them, count what was found.

    Writes blind_test.json, confusion.png and calibration.png. Broken off, the same command with the
    same --seed goes on where it ended: each outcome is kept in the folder "cases".

    \b
    Examples:
      inerter blind-test --count 3 --clean 0
      inerter blind-test --effects viscous_friction,end_stop --jobs 2
      inerter blind-test --bench realistic --count 2
      inerter blind-test --vehicle --count 2
    """
    from inerter.blind_test.output import write_blind_test
    from inerter.blind_test.plan import BENCHES, VEHICLE, Plan
    from inerter.blind_test.run import run_tasks
    from inerter.blind_test.score import score
    from inerter.blind_test.table import print_blind_test
    from inerter.folder import json_text

    usual = count if effects is None else 0
    numbers = {"clean": clean, "pairs": pairs, "triples": triples, "unknown": unknown}
    names = () if effects is None else tuple(n.strip() for n in effects.split(","))
    if vehicle and bench != BENCHES[0]:
        refuse(f"--bench {bench}: a vehicle has no bench; leave --bench or --vehicle out")
    with refusing(folder, "blind_test.json", "confusion.png", "calibration.png"):
        plan = Plan(
            effects=names, count=count, noise=noise, seed=_seed(seed),
            bench=VEHICLE if vehicle else bench,
            **{name: usual if given is None else given for name, given in numbers.items()},
        )  # fmt: skip
        tasks = plan.tasks()
        notes.print(f"blind test: {len(tasks)} cases, --seed {plan.seed}", highlight=False)
        start = time.perf_counter()
        with progress_bar("hiding and diagnosing", as_json) as progress:
            try:
                outcomes = run_tasks(tasks, jobs or workers, progress, folder=folder / "cases")
            except KeyboardInterrupt:
                notes.print(f"broken off; the same command with --seed {plan.seed} goes on")
                raise
        result = score(plan, outcomes, time.perf_counter() - start)
        files = write_blind_test(result, folder)
    if as_json:
        print(json_text(result), end="")
    else:
        print_blind_test(result, out)
        out.print(f"Written to {folder}: {', '.join(files)}")


def _seed(given: int | None) -> int:
    """The seed asked for, of the environment, or a new one."""
    if given is not None:
        return given
    text = os.environ.get("INERTER_SEED") or ""
    if not text or text == "random":
        return secrets.randbelow(2**31)
    if not text.isdecimal():
        refuse(f"INERTER_SEED is {text!r}; give a whole number or 'random'")
    return int(text)
