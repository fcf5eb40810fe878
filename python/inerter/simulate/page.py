"""A run as one HTML file with everything in it, which loads nothing from anywhere."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

import inerter.report
from inerter.models import title_of
from inerter.pictures.palette import DARK, LIGHT
from inerter.pictures.plotting import figure, to_script
from inerter.printable import upright
from inerter.report import page as report_page
from inerter.report import text
from inerter.simulate.plots import (
    MOST_JOINTS,
    device_plots,
    has_friction,
    model_plots,
    parameter_rows,
)
from inerter.simulate.run import SimulatedRun
from inerter.simulate.summary import in_units, summary


def render_page(run: SimulatedRun) -> str:
    """The page of a run as HTML text."""
    # devices take the place of the report's runs; all of them have the same places for plots
    states = list(dict.fromkeys(name for device in run.devices for name in device.place.act))
    empty = {f"state-{name}": figure("time [s]", "no such state") for name in states}
    devices = [empty | device_plots(run, device) for device in run.devices]
    plots = {"runs": devices, "single": model_plots(run)}
    return _template().render(
        s=summary(run),
        title=title_of(run.path),
        newton=in_units(run, "N"),
        metre=in_units(run, "m"),
        speed=in_units(run, "m/s"),
        states=states,
        vehicle=[name for name in run.vehicle if name != "time"],
        joints=len(run.joints),
        most=MOST_JOINTS,
        friction=any(has_friction(device) for device in run.devices),
        parameters=[(device.place.name, parameter_rows(run, device)) for device in run.devices],
        light=LIGHT,
        dark=DARK,
        palette=Markup(to_script({"light": LIGHT, "dark": DARK})),
        plots=Markup(to_script(plots)),
        plotly=Markup(report_page.plotly_script()),
        number=text.number,
    )


@cache
def _template() -> Any:
    # style and script are the report's
    folders = [Path(__file__).parent, Path(inerter.report.__file__).parent]
    environment = Environment(
        loader=FileSystemLoader(folders),
        autoescape=True,
        finalize=upright,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("simulation.html.j2")
