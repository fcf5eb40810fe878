"""The commands of `inerter`."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

import inerter
from inerter.benchmark.command import benchmark_command
from inerter.blind_test.command import blind_test_command
from inerter.console import (
    AsJson,
    Commands,
    Filters,
    Folder,
    Jobs,
    number,
    out,
    parts_of,
    progress_bar,
    refusing,
    status,
)
from inerter.design.commands import app as design_app
from inerter.folder import json_text
from inerter.identify.command import identify_command
from inerter.inspection.command import inspect_command
from inerter.plugin import plugin_path, supported_text
from inerter.records.convert import convert_command
from inerter.records.options import told_reading, with_reading
from inerter.records.prepare.command import prepare_command
from inerter.studies.commands import app as study_app
from inerter.suspension.commands import app as suspension_app
from inerter.view.command import view_command

if TYPE_CHECKING:
    from inerter.diagnose import Diagnosis
    from inerter.records import AnyRecord

SHOWN = 6  # records of which a diagnosis says first what they hold

# what a command needs is imported in it: a design is not to wait for what a diagnosis loads
app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


def run() -> None:
    """Run the command line."""
    app()


def _version(asked: bool) -> None:
    if asked:
        print(f"inerter {inerter.__version__} for {supported_text()}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_version, is_eager=True, help="Print the version and end."
        ),
    ] = False,
) -> None:
    """Inerters for MuJoCo and Exudyn, and a lab that finds what a simulation of one gets wrong."""


@app.command("diagnose")
@with_reading
def diagnose_command(
    record: Annotated[
        list[str],
        typer.Argument(
            metavar="RECORD", help="Records: files, folders or globs; several are several runs."
        ),
    ],
    device: Annotated[
        Path | None,
        typer.Option(help="Your own device (device.toml): held until the data contradict it."),
    ] = None,
    model: Annotated[
        Path | None,
        typer.Option(
            help="A MuJoCo model or a car.toml: bench records take its inerter.device as "
            "baseline, vehicle records (time, road, ...) drive it."
        ),
    ] = None,
    inputs: Annotated[
        list[str] | None,
        typer.Option("--input", help="COLUMN=ACTUATOR that it drives in --model; repeatable."),
    ] = None,
    sensors: Annotated[
        list[str] | None,
        typer.Option("--sensor", help="COLUMN=SENSOR of --model to compare with; repeatable."),
    ] = None,
    holdout: Annotated[
        list[str] | None, typer.Option(help="Name of a run to hold out; may be given again.")
    ] = None,
    filters: Filters = None,
    carry: Annotated[
        Literal["any", "passive", "nothing"],
        typer.Option(
            help="What device.toml may carry of what can be predicted but has no name, as a force "
            "over displacement and velocity: any, passive (nothing that gives energy), nothing."
        ),
    ] = "any",
    time_limit: Annotated[
        float | None,
        typer.Option(
            metavar="SECONDS",
            help="Search no longer than this; what was found is judged and reported then.",
        ),
    ] = None,
    out_dir: Folder = Path("out/diagnosis"),
    as_json: AsJson = False,
    dry_run: Annotated[
        bool,
        typer.Option("--dry-run", help="Print the summary in the terminal and write nothing."),
    ] = False,
    quick: Annotated[bool, typer.Option("--quick", hidden=True)] = False,
    stated: Any = None,
) -> None:
    """Say what the simulation of a device gets wrong, by what cause, and how much that is.

    Writes diagnosis.json, report.html, device.toml and model.xml.

    \b
    Examples:
      inerter diagnose runs/*.csv --device device.toml
      inerter diagnose card.csv --with servo.csv --column force='-200 N/V * u'
      inerter diagnose drive.csv --model car.xml
    """
    mapping = (inputs or [], sensors or [])
    # --quick: the name of --dry-run before
    folder = None if dry_run or quick else out_dir
    how = (filters or [], carry, math.inf if time_limit is None else time_limit)
    _diagnose(record, device, model, holdout or [], folder, as_json, mapping, stated, how)


def _diagnose(
    record: list[str],
    device: Path | None,
    model: Path | None,
    holdout: list[str],
    folder: Path | None,
    as_json: bool,
    mapping: tuple[list[str], list[str]] = ([], []),
    stated: dict[str, Any] | None = None,
    how: tuple[Sequence[str], Literal["any", "passive", "nothing"], float] = ((), "any", math.inf),
) -> Diagnosis:
    """Without a folder nothing is written."""
    from warnings import catch_warnings, simplefilter

    import numpy as np

    from inerter.diagnose import diagnose
    from inerter.records.stated import heard
    from inerter.report.output import write_outputs
    from inerter.report.terminal import print_summary

    # a user's data that overflow are judged by what comes out, not by numpy's warnings
    names = ("diagnosis.json", "report.html", "device.toml", "model.xml")
    with refusing(folder, *names), np.errstate(all="ignore"), catch_warnings():
        simplefilter("ignore", RuntimeWarning)
        with status(as_json) as progress, told_reading(**(stated or {})) as tell:
            with heard(lambda records: _first_look(records, as_json, tell)):
                result = diagnose(record, device, model, holdout, progress, *mapping, *how)
            tell()
        if folder:
            write_outputs(result, folder)
    if as_json:
        print(json_text(result.json()), end="")
    else:
        print_summary(result, out)
        if folder:
            out.print(f"Written to {folder}: report.html, diagnosis.json, device.toml, model.xml")
    return result


def _first_look(records: Sequence[AnyRecord], quiet: bool, tell: Callable[[], None]) -> None:
    """How records were read, and in a few lines what they hold."""
    from inerter.inspection.facts import facts_of, short

    tell()
    if quiet:
        return
    for record in records[:SHOWN]:
        for line in short(facts_of(record)):
            out.print(line, highlight=False, soft_wrap=True)
    if len(records) > SHOWN:
        out.print(f"and {len(records) - SHOWN} more; `inerter inspect` shows them")


@app.command("simulate")
def simulate_command(
    model: Annotated[
        Path,
        typer.Argument(
            help="A MuJoCo model, .xml or compiled .mjb, a car.toml, or the name of a shipped one, "
            "see `inerter models`."
        ),
    ],
    duration: Annotated[
        float | None, number("seconds", "Seconds; default: the control's length, else 10.")
    ] = None,
    out_dir: Folder = Path("out/simulation"),
    timestep: Annotated[
        float | None, number("seconds", "Time step [s] in place of the model's.")
    ] = None,
    integrator: Annotated[
        str | None,
        typer.Option(help="Euler, RK4, implicit, implicitfast or discrete; default: the model's."),
    ] = None,
    keyframe: Annotated[
        str | None, typer.Option(help="Name or index of the keyframe to start from.")
    ] = None,
    control: Annotated[
        Path | None,
        typer.Option(help="Table with time and columns named after actuators, joints or BODY.x."),
    ] = None,
    rate: Annotated[
        float | None,
        number("samples per second", "Samples per second of the records; default: at most 1000."),
    ] = None,
    video: Annotated[Path | None, typer.Option(help="Also write a video: .gif or .mp4.")] = None,
    as_json: AsJson = False,
) -> None:
    """Run a model; write what each inerter.device did as a record, and a page of pictures.

    Writes DEVICE.csv per device (`inerter diagnose` reads it), simulation.html, simulation.json.

    \b
    Examples:
      inerter simulate half_car --keyframe kerb --duration 2
      inerter simulate car.xml --control road.csv --rate 500 --out out/car
    """
    import mujoco

    from inerter.engine_errors import SimulationError, engine_text
    from inerter.models import model_file
    from inerter.simulate.output import write_run
    from inerter.simulate.run import run_model
    from inerter.simulate.summary import at_rest, print_run, summary
    from inerter.simulate.video import FRAME_RATE, refuse_video, write_video

    with refusing(out_dir, "simulation.json", "simulation.html"):
        model = model_file(model)
        if video is not None:
            refuse_video(video)
        try:
            with progress_bar("simulating", as_json) as progress:
                run = run_model(
                    model, duration, timestep=timestep, integrator=integrator, keyframe=keyframe,
                    control=control, rate=rate, frame_rate=FRAME_RATE if video else 0.0,
                    progress=progress,
                )  # fmt: skip
        except mujoco.FatalError as error:
            raise SimulationError(f"{model}: {engine_text(error)}") from None
        files = write_run(run, out_dir)
        if video is not None:
            with progress_bar("rendering", as_json) as progress:
                write_video(run.model, run.frames, video, progress)
    if as_json:
        print(json_text(summary(run)), end="")
    else:
        print_run(run, out)
        if hint := at_rest(run, keyframe):
            out.print(hint, highlight=False)
        out.print(f"Written to {out_dir}: {', '.join(files)}")
        if video is not None:
            out.print(f"Video: {video}")


@app.command("validate")
def validate_command(
    model: Annotated[
        list[str] | None,
        typer.Option(help="Models, or a layout as in quarter_car/S2; with commas, or given again."),
    ] = None,
    law: Annotated[
        list[str] | None, typer.Option(help="Laws; with commas, or given again.")
    ] = None,
    engine: Annotated[
        list[str] | None, typer.Option(help="mujoco, exudyn; with commas, or given again.")
    ] = None,
    integrator: Annotated[
        list[str] | None, typer.Option(help="Integrators; with commas, or given again.")
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Fewer cases, in a minute.")] = False,
    jobs: Jobs = None,
    out_dir: Folder = Path("out/validate"),
    as_json: AsJson = False,
) -> None:
    """Run models, laws and inputs in every engine and integrator, against the reference equations.

    Writes validation.json and validation.png. Exit status 1 if something misses its bound.

    \b
    Examples:
      inerter validate --quick
      inerter validate --model quarter_car/S2,half_car --engine mujoco
    """
    from inerter.validate import Selection, validate
    from inerter.validate.output import json_text as validation_text
    from inerter.validate.output import write_validation
    from inerter.validate.table import print_validation

    with refusing(out_dir, "validation.json", "validation.png"):
        names = (parts_of(given) for given in (model, law, engine, integrator))
        with progress_bar("validating", as_json) as progress:
            result = validate(Selection(*names, quick=quick), jobs=jobs, progress=progress)
        files = write_validation(result, out_dir)
    if as_json:
        print(validation_text(result), end="")
    else:
        print_validation(result, out)
        out.print(f"Written to {out_dir}: {', '.join(files)}")
    if result.missed:
        raise typer.Exit(1)


@app.command()
def demo(
    out_dir: Folder = Path("out/demo"),
) -> None:
    """Diagnose the two shipped records: a time record and a table of amplitudes.

    \b
    Example:
      inerter demo --out out/demo
    """
    from inerter.models import data_path
    from inerter.report.figures import loop_figure

    out.print("A table measured on a ball-screw inerter at 12 frequencies:\n", style="bold")
    _diagnose([str(data_path("ball_screw_table.csv"))], None, None, [], out_dir / "table", False)
    out.print(
        "\nA bench record (synthetic; its hidden effect is not named in the file):\n", style="bold"
    )
    record = str(data_path("bench_record.csv"))
    result = _diagnose([record], None, None, [], out_dir, False)
    loop_figure(result, out_dir / "loops.png")


@app.command("plugin-path")
def plugin_path_command(
    engine: Annotated[
        str | None,
        typer.Option(
            "--mujoco",
            metavar="VERSION",
            help="For this version of MuJoCo; default: the installed one.",
        ),
    ] = None,
) -> None:
    """Print the path of the MuJoCo plugin library, for C programs and MuJoCo's `simulate`.

    \b
    Examples:
      inerter plugin-path
      inerter plugin-path --mujoco 3.16.0
    """
    print(plugin_path(engine))


@app.command("parameters")
def parameters_command(
    part: Annotated[
        str | None,
        typer.Argument(
            metavar="[PART]", help="Only those with this in their name, meaning or friction law."
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """List every parameter of a device: name, unit, default, range, friction laws, meaning.

    Into a pipe each is one line, its columns apart by tabs.

    \b
    Examples:
      inerter parameters
      inerter parameters series
      inerter parameters --json
    """
    from inerter.parameter_list import chosen, rows, text

    with refusing(None):
        found = chosen(part)
    if as_json:
        print(json_text(rows(found)), end="")
    else:
        print(text(found, out.width if out.is_terminal else None))


@app.command("models")
def models_command(as_json: AsJson = False) -> None:
    """List the shipped models, which `simulate` and `view` take by name, with their keyframes.

    \b
    Examples:
      inerter models
      inerter simulate half_car --keyframe kerb
    """
    from inerter.models import model_list

    with refusing(None):
        found = model_list()
    if as_json:
        print(json_text(found), end="")
        return
    for model in found:
        keys = ", ".join(model["keyframes"]) or "none"
        print(f"{model['name']}\n    devices: {', '.join(model['devices'])}\n    keyframes: {keys}")


# in the order in which the help lists them: after those above, groups last
app.command("inspect")(inspect_command)
app.command("convert")(convert_command)
app.command("identify")(identify_command)
app.command("prepare")(prepare_command)
app.command("blind-test")(blind_test_command)
app.command("view")(view_command)
app.command("benchmark")(benchmark_command)
# its name before
app.command("bench", hidden=True)(benchmark_command)
app.add_typer(suspension_app, name="suspension", cls=Commands)
app.add_typer(design_app, name="design", cls=Commands)
app.add_typer(study_app, name="study", cls=Commands)
