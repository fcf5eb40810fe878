"""What a finding says of a quantity at every place of the stroke, with its band."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from inerter.catalogue.along_stroke import PERIODS, QUANTITIES, Quantity
from inerter.diagnose.result import Diagnosis, Finding
from inerter.motion_units import unit
from inerter.pictures.plotting import band, figure, line
from inerter.report.text import unit as shown

Array = NDArray[np.float64]

# places that are drawn, and per period; standard errors that the band has on either side
_PLACES, _PER_PERIOD = 241, 12
_MOST_PLACES = 2000
BAND = 2.0
# room for the band above and below, per height of the curve
_MOST_ROOM = 1.5


def stroke_plot(finding: Finding, diagnosis: Diagnosis) -> go.Figure | None:
    """A finding's curve or periods over the stroke; None where it has neither."""
    quantity = next((q for q in QUANTITIES if q.effect == finding.effect), None)
    ends = None if quantity is None else _ends(diagnosis)
    if quantity is None or ends is None or finding.law not in ("curve", "flanks", "period"):
        return None
    x = np.linspace(*ends, _places(quantity, finding, ends))
    periods = _periods(quantity, finding, diagnosis, x)
    forth = _curve(f"{quantity.name}_curve", quantity.nodes, finding, diagnosis, x)
    sides = [("after", quantity.words, forth[0] + periods[0], forth[1] + periods[1])]
    if finding.law == "flanks":
        back = _curve(f"{quantity.name}_back_curve", quantity.back_nodes, finding, diagnosis, x)
        sides = [("after", "while x grows", *forth), ("before", "while x shrinks", *back)]
    relative = quantity.unit == "1"
    metre = shown(unit(diagnosis.motion, "m"))
    newton = shown(unit(diagnosis.motion, "N"))
    name = f"change of the {quantity.words} [%]" if relative else f"{quantity.words} [{newton}]"
    scale = 100.0 if relative else 1.0
    plot = figure(f"displacement [{metre}]", name)
    for color, words, values, variance in sides:
        error = BAND * np.sqrt(variance)
        low, high = scale * (values - error), scale * (values + error)
        band(plot, x, low, high, color, "2 standard errors")
        line(plot, x, scale * values, color, words, 1.8)
    # a band that is far wider than the curve goes beyond the picture, and the curve is seen
    drawn = np.concatenate([scale * values for _, _, values, _ in sides])
    wide = max(float(np.max(scale * BAND * np.sqrt(variance))) for *_, variance in sides)
    room = _MOST_ROOM * float(np.ptp(drawn))
    if wide > room > 0.0:
        plot.update_layout(yaxis={"range": [float(drawn.min()) - room, float(drawn.max()) + room]})
    return plot


def _ends(diagnosis: Diagnosis) -> tuple[float, float] | None:
    """The stroke [m] of all records."""
    moved = [run.displacement[run.inner] for run in diagnosis.curves if run.inner.any()]
    if not moved:
        return None
    low, high = min(float(x.min()) for x in moved), max(float(x.max()) for x in moved)
    return (low, high) if high > low else None


def _places(quantity: Quantity, finding: Finding, ends: tuple[float, float]) -> int:
    lengths = [quantity.period(i)[0] for i in range(1, PERIODS + 1)]
    shortest = min((finding.parameters[n].value for n in lengths if n in finding.parameters),
                   default=math.inf)  # fmt: skip
    return int(np.clip(_PER_PERIOD * (ends[1] - ends[0]) / shortest, _PLACES, _MOST_PLACES))


def _curve(
    name: str, coordinates: tuple[str, ...], finding: Finding, diagnosis: Diagnosis, x: Array
) -> tuple[Array, Array]:
    """A smooth curve's values and their variance: nodes count as apart from one another."""
    device: dict[str, Any] = diagnosis.extended.device
    nodes = len(str(device.get(name, "")).split())
    found = {each: finding.parameters.get(each) for each in coordinates[:nodes]}
    if not any(found.values()):
        return np.zeros_like(x), np.zeros_like(x)
    low, high = float(device["curve_lower"]), float(device["curve_upper"])
    spline = make_interp_spline(
        np.linspace(low, high, nodes), np.eye(nodes), k=3, bc_type="clamped"
    )
    basis = spline(np.clip(x, low, high))
    values = np.array([0.0 if node is None else node.value for node in found.values()])
    errors = np.array([0.0 if node is None else node.stderr for node in found.values()])
    return basis @ values, basis**2 @ errors**2


def _periods(
    quantity: Quantity, finding: Finding, diagnosis: Diagnosis, x: Array
) -> tuple[Array, Array]:
    """Values of all periods, and their variance by amplitude and phase."""
    values, variance = np.zeros_like(x), np.zeros_like(x)
    for i in range(1, PERIODS + 1):
        names = [f"{quantity.name}_{word}_{i}" for word in ("period", "amplitude", "phase")]
        if not all(name in finding.parameters for name in names):
            continue
        length, amplitude, phase = (finding.parameters[name] for name in names)
        angle = 2 * np.pi * x / length.value + phase.value
        values += amplitude.value * np.sin(angle)
        variance += (amplitude.stderr * np.sin(angle)) ** 2
        variance += (amplitude.value * phase.stderr * np.cos(angle)) ** 2
    return values, variance
