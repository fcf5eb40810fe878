"""The commands of `inerter study`: one line for each study."""

from __future__ import annotations

import typer

from inerter.studies.fluid_rig.command import fluid_rig_command
from inerter.studies.hysteresis.command import hysteresis_command

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Rebuild published studies: make data, figures and tables anew, check statements.",
)


app.command("fluid-rig")(fluid_rig_command)
app.command("hysteresis")(hysteresis_command)
