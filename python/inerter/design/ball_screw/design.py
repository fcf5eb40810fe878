"""A ball-screw inerter from its geometry."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from inerter.core import Device
from inerter.design.ball_screw.inputs import INPUTS, check_geometry, with_fitting_balls
from inerter.design.ball_screw.losses import Losses
from inerter.design.ball_screw.measured import Comparison, compare, read_points
from inerter.design.ball_screw.sliding import consistent
from inerter.design.ball_screw.trends import PAPER_TRENDS, over_frequency, trend
from inerter.design.inputs import DesignError, Values, read_inputs
from inerter.design.result import Curve, Design, Figure, Panel

_DENTING = 4.2e9  # Pa
_LOWEST = 12.0  # highest frequency of the curves per lowest


def design_ball_screw(measured: str | None = None, **inputs: float | str) -> Design:
    """Inertance, friction and efficiencies of a ball screw with a flywheel.

    Parameters
    ----------
    measured : str, optional
        A bench table (columns frequency, force_amplitude, acceleration_amplitude) to which the
        moment of inertia and the preload are fitted, or "paper" for the shipped one.
    **inputs : float or str
        See `inerter.design.ball_screw.inputs.INPUTS`; SI units, or texts with a unit.

    Returns
    -------
    Design
        With a device of inertance, load friction and, with preload, Coulomb friction.

    Raises
    ------
    DesignError
        An input that cannot be, or a screw that its friction locks.
    RecordError
        The measured table cannot be read.

    Source: see `losses`.
    """
    values = with_fitting_balls(read_inputs(INPUTS, inputs))
    check_geometry(values)
    losses = Losses(values)
    comparison = None
    if measured is not None:
        for name in ("inertia", "preload"):
            if name in values.given:
                raise DesignError(f"{name} is given, but measured fits it: leave one of them out")
        comparison = compare(read_points(measured), losses)
        inertia = comparison.inertance * (losses.helix.lead / (2.0 * math.pi)) ** 2
        source = f"fitted to {comparison.points.name}"
        values = values.derived(source, inertia=inertia, preload=comparison.preload)
        losses = Losses(values)
    device, mu, force = _device(losses)
    tables: dict[str, list[dict[str, Any]]] = {}
    if comparison is not None:
        tables["measured"] = comparison.rows()
    highest = values.number("highest_frequency")
    frequency = np.linspace(highest / _LOWEST, highest, 67)
    trends = [trend(values, name, frequency) for name in PAPER_TRENDS]
    tables["trends"] = [found.row() for found in trends]
    panels = (
        _over_frequency(losses, frequency), _over_acceleration(losses, comparison),
        _over_load(losses),
    )  # fmt: skip
    panels += tuple(_trend_panel(found, frequency) for found in trends)
    comments = {
        "inertance": "kg, (2 pi / lead)^2 inertia",
        "load_friction": f"share of the inertance force lost, at {values.number('load'):g} N",
        "coulomb_force": "N, sliding of the preloaded balls",
    }
    figures = _figures(losses, mu, force) + (_fit_figures(comparison) if comparison else ())
    return Design(
        kind="ball-screw",
        inputs=values,
        figures=figures,
        device=device,
        comments=comments,
        panels=panels,
        tables=tables,
        notes=_notes(values, comparison),
    )


def _device(losses: Losses) -> tuple[Device, float, float]:
    """The device, its load friction [-] and Coulomb force [N]."""
    loss = losses.load_loss(losses.values.number("load"))
    if loss >= 0.5:
        raise DesignError(
            f"the screw loses {100 * loss:.0f} % of its load to friction: from 50 % on the inertia "
            "cannot drive it back; give a longer lead or lower friction coefficients"
        )
    mu, force = loss / (1.0 - loss), losses.sliding_force(0.0)
    values: dict[str, float | str] = {"inertance": losses.inertance}
    if mu > 0.0:
        values["load_friction"] = mu
    if force > 0.0:
        values |= {"friction": "coulomb", "coulomb_force": force}
    return Device(**values), mu, force


def _figures(losses: Losses, mu: float, force: float) -> tuple[Figure, ...]:
    values = losses.values
    load, ball = values.number("load"), values.number("ball_radius")
    at = f"at {load:g} N"
    sliding = consistent(losses.helix, ball, values.number("contact_angle"))
    found = [
        Figure("inertance", losses.inertance, "kg", "ideal inertance, (2 pi / P)^2 J"),
        Figure(
            "nonlinear_inertance", losses.inertance * float(losses.efficiency([load])[0]), "kg",
            f"b (eta_2 - eta_1) {at}, in the paper's sense",
        ),
        Figure("lead_angle", losses.helix.angle, "rad", "lead angle"),
        Figure("sliding_loss", losses.sliding_loss(load), "", f"eta_1, share lost to sliding {at}"),
        Figure("rolling_efficiency", losses.rolling_efficiency, "", "efficiency of rolling, eta_2"),
        Figure("load_friction", mu, "", f"friction per inertance force, {at}"),
        Figure("coulomb_force", force, "N", "friction of the preload"),
        Figure("slip", sliding.slip, "m", "slip across the groove per nut angle, each side"),
        Figure("spin", sliding.spin, "", "spin about the normal per nut angle, each side"),
        Figure("ball_load", losses.ball_load(load), "N", f"load of a ball {at}"),
        Figure(
            "contact_stiffness", losses.contact_stiffness(load), "N/m",
            f"axial stiffness of balls and raceways {at}",
        ),
    ]  # fmt: skip
    for side, ellipse in zip(("nut", "screw"), losses.contacts(load), strict=True):
        where = f"of the contact at the {side} {at}"
        found += [
            Figure(f"{side}_major_axis", ellipse.major, "m", f"major semi-axis {where}"),
            Figure(f"{side}_minor_axis", ellipse.minor, "m", f"minor semi-axis {where}"),
            Figure(f"{side}_pressure", ellipse.pressure, "Pa", f"largest pressure {where}"),
            Figure(f"{side}_approach", ellipse.approach, "m", f"approach {where}"),
        ]
    return tuple(found)


def _fit_figures(comparison: Comparison) -> tuple[Figure, ...]:
    def largest(errors: np.ndarray) -> float:
        return float(np.max(np.abs(errors)))

    return (
        Figure("fitted_inertance", comparison.inertance, "kg", "ideal inertance that fits"),
        Figure("fitted_preload", comparison.preload, "N", "preload of a ball that fits"),
        Figure("largest_error", largest(comparison.errors), "", "of the fit, relative"),
        Figure(
            "largest_error_left_out", largest(comparison.left_out), "",
            "of points left out of the fit, relative",
        ),
        Figure("constant_inertance", comparison.constant, "kg", "best constant"),
        Figure(
            "largest_error_of_constant", largest(comparison.constant_errors), "",
            "of the best constant, relative",
        ),
    )  # fmt: skip


def _over_frequency(losses: Losses, frequency: np.ndarray) -> Panel:
    ideal = np.full(len(frequency), losses.inertance)
    return Panel(
        name="inertance", title=f"Inertance at {1e3 * losses.values.number('amplitude'):.3g} mm",
        x_title="frequency [Hz]", y_title="inertance [kg]",
        curves=(
            Curve("ideal, b", frequency.tolist(), ideal.tolist(), dashed=True),
            Curve(
                "b (eta_2 - eta_1)", frequency.tolist(), over_frequency(losses, frequency).tolist()
            ),
        ),
    )  # fmt: skip


def _over_load(losses: Losses) -> Panel:
    highest = losses.values.number("load")
    loads = np.geomspace(highest / 100.0, 10.0 * highest, 49)
    curves = []
    for method in ("corrected", "printed"):
        other = Losses(losses.values.replace(method=method))
        shares = [other.sliding_loss(load) for load in loads]
        chosen = losses.values.word("method") == method
        curves.append(Curve(f"eta_1, {method}", loads.tolist(), shares, dashed=not chosen))
    rolling = [1.0 - losses.rolling_efficiency] * len(loads)
    curves.append(Curve("1 - eta_2", loads.tolist(), rolling))
    return Panel(
        name="losses",
        title="Share of the load that is lost",
        x_title="axial load [N]",
        y_title="share [-]",
        curves=curves,
        log_x=True,
        log_y=True,
    )


def _over_acceleration(losses: Losses, comparison: Comparison | None) -> Panel:
    """Friction depends on the load: here motions of any amplitude fall on one curve.

    With measured points the curve lies at F / b_n, as they do, else at F / b.
    """
    b = losses.inertance
    points = comparison.points if comparison else None
    highest = 10.0 if points is None else 1.3 * float(np.max(points.acceleration))
    a = np.geomspace(highest / 100.0, highest, 61)
    share = losses.efficiency(b * a)
    curves = [
        Curve("ideal, b", a.tolist(), [b] * len(a), dashed=True),
        Curve("b (eta_2 - eta_1)", a.tolist(), (b * share).tolist()),
    ]
    title = "Inertance against acceleration"
    if comparison is not None and points is not None:
        title += ", b and preload fitted"
        loads = np.geomspace(0.8 * np.min(points.force), 1.1 * np.max(points.force), 61)
        fitted = b * losses.efficiency(loads)
        x = points.acceleration.tolist()
        curves = [
            curves[0],
            Curve("b (eta_2 - eta_1)", (loads / fitted).tolist(), fitted.tolist()),
            Curve("best constant", x, [comparison.constant] * len(x), dashed=True),
            Curve("measured", x, points.inertance.tolist(), marks=True),
        ]
    return Panel(
        name="acceleration",
        title=title,
        x_title="acceleration [m/s^2]",
        y_title="inertance [kg]",
        curves=curves,
        log_x=True,
    )


def _trend_panel(found: Any, frequency: np.ndarray) -> Panel:
    unit = {"ball_number": "", "contact_angle": "deg"}.get(found.name, "mm")
    scale = {"": 1.0, "deg": math.degrees(1.0), "mm": 1e3}[unit]
    curves = [
        Curve(f"{scale * value:.3g} {unit}".strip(), frequency.tolist(), curve.tolist())
        for value, curve in zip(found.values, found.curves, strict=True)
    ]
    title = f"{found.name.replace('_', ' ')} ({PAPER_TRENDS[found.name][0]} of the paper)"
    return Panel(
        name=f"trend_{found.name}",
        title=title,
        x_title="frequency [Hz]",
        y_title="inertance [kg]",
        curves=curves,
    )


def _notes(values: Values, comparison: Comparison | None) -> tuple[str, ...]:
    notes = []
    if "ball_radius" in values.sources:
        notes.append(
            f"The paper's balls do not fit: {1e3 * values.number('ball_radius'):.3g} mm are taken "
            "as ball_radius; give your own."
        )
    notes += [
        "The nonlinear inertance is the share of a driving force that reaches the inertia, the "
        "paper's sense. Friction cannot lower the force per acceleration that a bench measures "
        "below b: the device has it as friction beside b."
    ]
    if comparison is not None:
        notes.append(
            "Moment of inertia and preload were fitted to the measured points; only the errors of "
            "points left out are predictions. Inertance and load-proportional losses cannot be "
            "told apart by such a table: another sliding_friction gives another inertance and the "
            "same curve."
        )
    if values.word("method") == "printed":
        notes.append(
            "Equations as printed: the nut's contact loses exactly nothing, and a ball's load is "
            "multiplied by cos(al) sin(be) where contact theory divides."
        )
    contacts = Losses(values).contacts(values.number("load"))
    pressure = max(found.pressure for found in contacts)
    if pressure > _DENTING:
        notes.append(
            f"The largest contact pressure is {1e-9 * pressure:.2g} GPa: above 4.2 GPa balls dent "
            "their raceways (static rating of ball bearings, ISO 76)."
        )
    return tuple(notes)
