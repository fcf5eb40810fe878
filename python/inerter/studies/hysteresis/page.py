"""The study as one HTML page that loads nothing from anywhere."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import plotly.graph_objects as go
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup
from plotly.subplots import make_subplots

from inerter.pictures.palette import LIGHT
from inerter.pictures.plotting import FONT
from inerter.printable import upright
from inerter.studies.hysteresis.figures import published_sets, title_of
from inerter.studies.hysteresis.panels import COLOURS
from inerter.studies.hysteresis.published import FREQUENCIES, MODELS
from inerter.studies.hysteresis.settings import Settings
from inerter.studies.hysteresis.study import Study
from inerter.studies.hysteresis.tables import tables

_CAPTIONS = {
    "forces.png": "Force over time: a virtual test, its EMD, the models of Table 3 "
    "(Figs. 4 to 7 and 9 to 12 of the paper)",
    "emd.png": "The decomposition of the 1 Hz test",
    "held_out.png": "Who made the data, who fits; and what fits at 4 Hz leave open",
    "searches.png": "The optimisers from the start of Table 2 and from random starts",
}


def render(study: Study, pictures: Mapping[str, bytes]) -> str:
    """The page as HTML text; `pictures` as `figures.pictures` makes them."""
    shown = [
        (f"data:image/png;base64,{base64.b64encode(pictures[name]).decode()}", text)
        for name, text in _CAPTIONS.items()
    ]
    return _template().render(
        study=study,
        tables=tables(study),
        mended={m.title: m.box().mended for m in MODELS.values() if m.box().mended},
        loops=Markup(_loops(study.settings)),
        pictures=shown,
        light=LIGHT,
        font=FONT,
    )


def _loops(s: Settings) -> str:
    """Force against displacement and velocity, to zoom in."""
    titles = [f"{f:g} Hz" for f in FREQUENCIES] + [""] * len(FREQUENCIES)
    plot = make_subplots(2, len(FREQUENCIES), subplot_titles=titles, vertical_spacing=0.12)
    for name, sets in published_sets(s).items():
        for column, test in enumerate(sets, start=1):
            # one period at 200 points
            count = round(1 / (test.frequency * test.spacing))
            last = slice(-count - 1, None, max(1, count // 200))
            for row, x in ((1, 1e3 * test.displacement[last]), (2, test.velocity[last])):
                plot.add_trace(
                    go.Scatter(
                        x=x, y=test.truth[last], mode="lines", name=title_of(name),
                        legendgroup=name, showlegend=(row, column) == (1, 1),
                        line={
                            "color": COLOURS[name], "width": 1.6,
                            "dash": "dash" if name == "lugre" else "solid",
                        },
                        hovertemplate="%{x:.4g}, %{y:.4g} N",
                    ),
                    row, column,
                )  # fmt: skip
    plot.update_xaxes(gridcolor=LIGHT["grid"], zerolinecolor=LIGHT["line"])
    plot.update_yaxes(gridcolor=LIGHT["grid"], zerolinecolor=LIGHT["line"])
    plot.update_xaxes(title="displacement [mm]", row=1)
    plot.update_xaxes(title="velocity [m/s]", row=2)
    plot.update_yaxes(title="force [N]", col=1)
    plot.update_layout(
        template=go.layout.Template(), height=720, paper_bgcolor=LIGHT["page"],
        plot_bgcolor=LIGHT["page"], font={"family": FONT, "size": 12, "color": LIGHT["text"]},
        margin={"l": 50, "r": 10, "t": 60, "b": 40},
        legend={"orientation": "h", "y": 1.1, "x": 0},
    )  # fmt: skip
    return plot.to_html(full_html=False, include_plotlyjs=True)


@cache
def _template() -> Any:
    environment = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        finalize=upright,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("hysteresis.html.j2")
