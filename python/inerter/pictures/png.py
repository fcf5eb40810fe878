"""A matplotlib figure as a PNG, whatever the names in it."""

from __future__ import annotations

import warnings
from io import BytesIO

from matplotlib.figure import Figure
from matplotlib.text import Text


def png(figure: Figure) -> bytes:
    """The picture of a figure made with FigureCanvasAgg.

    Names come from files: a $ in them begins no formula, and letters that the font lacks are shown
    as boxes without a word.
    """
    # tick labels are formulas of their own
    ticks = {
        text
        for axes in figure.axes
        for axis in (axes.xaxis, axes.yaxis)
        for text in axis.findobj(Text)
        if text is not axis.label
    }
    for text in set(figure.findobj(Text)) - ticks:
        text.set_parse_math(False)
    target = BytesIO()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from font")
        figure.savefig(target, format="png")
    return target.getvalue()
