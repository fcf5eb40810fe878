"""The study as one HTML file that works offline: parameters, statements, panels that zoom."""

from __future__ import annotations

import html

import plotly.graph_objects as go
from plotly.subplots import make_subplots

from inerter.pictures.palette import LIGHT
from inerter.pictures.plotting import FONT
from inerter.report.page import plotly_script
from inerter.studies.fluid_rig.figures import COLOURS
from inerter.studies.fluid_rig.panels import Picture, pictures
from inerter.studies.fluid_rig.study import Study
from inerter.studies.fluid_rig.summary import rows

_STYLE = f"""
body {{ font: 15px/1.5 {FONT}; color: {LIGHT["text"]}; background: {LIGHT["page"]};
       max-width: 1200px; margin: 2rem auto; padding: 0 1rem; }}
table {{ border-collapse: collapse; margin: 1rem 0; }}
td, th {{ padding: 0.25rem 0.9rem 0.25rem 0; text-align: right; white-space: nowrap;
         border-bottom: 1px solid {LIGHT["line"]}; }}
td:first-child, th:first-child {{ text-align: left; }}
""".strip()


def page(study: Study) -> str:
    """The whole page."""
    body = [
        "<h1>The fluid inerter's rig, identified</h1>",
        "<p>Tests by the reference equations with noise; fits by MuJoCo simulations of the rig. "
        f"Pictures: noise of seed {study.shown.seed}, fitted to the "
        f"{html.escape(study.shown.objective)}.</p>",
        _parameters(study),
        _statements(study),
        *(_picture(each) for each in pictures(study)),
    ]
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        "<title>Fluid inerter rig</title>"
        f"<style>{_STYLE}</style><script>{plotly_script()}</script></head>"
        f"<body>{''.join(body)}</body></html>"
    )


def _parameters(study: Study) -> str:
    head = ("parameter", "true", "found", "95 % interval", "error", "objective", "seed")
    lines = [
        (
            row.label,
            f"{row.true:.5g} {row.unit}",
            f"{row.value:.5g}",
            f"{row.low:.5g} ... {row.high:.5g}",
            f"{100 * row.error:+.2f} %",
            row.objective,
            str(row.seed),
        )
        for row in rows(study)
    ]
    return "<h2>Parameters</h2>" + _table(head, lines)


def _statements(study: Study) -> str:
    lines = [(each.text, "holds" if each.holds else "does not hold") for each in study.statements]
    return "<h2>What the paper states</h2>" + _table(("statement", "here"), lines)


def _table(head: tuple[str, ...], lines: list[tuple[str, ...]]) -> str:
    top = "".join(f"<th>{html.escape(text)}</th>" for text in head)
    rest = "".join(
        "<tr>" + "".join(f"<td>{html.escape(text)}</td>" for text in line) + "</tr>"
        for line in lines
    )
    return f"<table><tr>{top}</tr>{rest}</table>"


def _picture(of: Picture) -> str:
    count, columns = len(of.rows), len(of.rows[0])
    plot = make_subplots(
        count, columns, subplot_titles=[html.escape(p.title) for row in of.rows for p in row],
        vertical_spacing=0.3 / (count + 1), horizontal_spacing=0.05,
    )  # fmt: skip
    for i, row in enumerate(of.rows, 1):
        for j, panel in enumerate(row, 1):
            # one entry for all panels of a configuration, one for each line of the levels
            own = of.name == "levels"
            for line in panel.lines:
                plot.add_trace(
                    go.Scatter(
                        x=line.x, y=line.y, mode="lines",
                        name=html.escape(f"{panel.group}: {line.label}" if own else line.label),
                        legendgroup=f"{panel.group} {line.label}",
                        showlegend=j == 1 and (i == 1 or own),
                        line={
                            "color": COLOURS[line.kind],
                            "width": 3.0 if line.kind == "measured" else 1.4,
                            "dash": "dash" if line.dashed else "solid",
                        },
                    ),
                    i, j,
                )  # fmt: skip
            plot.update_xaxes(title=panel.abscissa, row=i, col=j)
            if panel.logarithmic:
                plot.update_yaxes(type="log", row=i, col=j)
    plot.update_layout(
        template=go.layout.Template(), height=260 * count + 120, paper_bgcolor=LIGHT["page"],
        plot_bgcolor=LIGHT["page"], font={"family": FONT, "size": 11, "color": LIGHT["text"]},
        margin={"l": 50, "r": 20, "t": 50, "b": 40}, legend={"orientation": "h", "y": -0.1},
    )  # fmt: skip
    plot.update_annotations(font={"size": 12})
    plot.update_xaxes(gridcolor=LIGHT["grid"], title_standoff=4)
    plot.update_yaxes(gridcolor=LIGHT["grid"], zerolinecolor=LIGHT["line"])
    return f"<h2>{html.escape(of.title)}</h2>" + plot.to_html(
        include_plotlyjs=False, full_html=False
    )
