"""Measured force per acceleration at several loads against the calculated inertance.

The paper prints neither the moment of inertia nor the preload, so nothing can be predicted: both
are fitted, the ideal inertance b and the preload Q_0 of a ball, by least relative squares of

    F / a = b (eta_2 - eta_1(F; Q_0))

Beside it stand a constant (one parameter, no friction) and the error of each point when it is left
out of the fit: the only figure here that predicts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from inerter.design.ball_screw.losses import Losses
from inerter.design.inputs import DesignError
from inerter.models import data_path
from inerter.records import BenchTable

Array = NDArray[np.float64]
SHIPPED = "paper"


@dataclass(frozen=True)
class Points:
    """Measured `frequency` [Hz], amplitudes `force` [N], `acceleration` [m/s^2], each (n,)."""

    name: str
    frequency: Array
    force: Array
    acceleration: Array

    @property
    def inertance(self) -> Array:
        """Force per acceleration (n,) [kg]."""
        return self.force / self.acceleration


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """Measured points with what was fitted to them; errors are relative, (n,).

    `inertance` b [kg], `preload` Q_0 [N] of a ball; `errors` of the fit, `left_out` of each point
    in a fit to the others, `constant_errors` of the best constant.
    """

    points: Points
    losses: Losses
    inertance: float
    preload: float
    fitted: Array
    errors: Array
    left_out: Array
    constant: float
    constant_errors: Array

    def rows(self) -> list[dict[str, Any]]:
        """One row for each point."""
        return [
            {
                "frequency": float(f), "force": float(force), "acceleration": float(a),
                "measured": float(force / a), "calculated": float(fit), "error": float(error),
                "error_left_out": float(out), "error_of_constant": float(flat),
            }
            for f, force, a, fit, error, out, flat in zip(
                self.points.frequency, self.points.force, self.points.acceleration, self.fitted,
                self.errors, self.left_out, self.constant_errors, strict=True,
            )
        ]  # fmt: skip


def read_points(name: str) -> Points:
    """Points of a bench table: a file, or "paper" for the shipped one.

    Raises
    ------
    DesignError
        Not one table, too few points, or a value that is not above 0.
    RecordError
        The file cannot be read.
    """
    from inerter.records import read_records

    path = data_path("ball_screw_table.csv") if name == SHIPPED else Path(name)
    read = read_records([str(path)], others=False)
    if len(read) != 1 or not isinstance(read[0], BenchTable):
        raise DesignError(
            f"measured is {name!r}, not one bench table: give a file with the columns frequency, "
            f"force_amplitude, acceleration_amplitude, or {SHIPPED!r} for the shipped one"
        )
    table = read[0]
    columns = (table.frequency, table.force_amplitude, table.acceleration_amplitude)
    if len(table.frequency) < 4 or any(np.any(~(column > 0)) for column in columns):
        raise DesignError(f"measured is {name!r}: give at least 4 points, all values above 0")
    return Points(table.name, *columns)


def compare(points: Points, losses: Losses) -> Comparison:
    """Fit inertance and preload; everything else stays as given.

    Raises
    ------
    DesignError
        Friction takes the whole of a measured load.
    """
    fit = _fit(points, losses, np.ones(len(points.force), bool))
    left_out = np.empty(len(points.force))
    for index in range(len(left_out)):
        keep = np.arange(len(left_out)) != index
        b, preload = _fit(points, losses, keep)
        share = _shares(losses, preload, points.force[index : index + 1])[0]
        left_out[index] = b * share / points.inertance[index] - 1.0
    fitted = fit[0] * _shares(losses, fit[1], points.force)
    if not np.all(np.isfinite(fitted)):
        raise DesignError(
            "friction takes the whole of a measured load: lower sliding_friction, or raise lead"
        )
    constant = _scale(points.inertance, np.ones(len(fitted)))
    return Comparison(
        points=points,
        losses=losses,
        inertance=fit[0],
        preload=fit[1],
        fitted=fitted,
        errors=fitted / points.inertance - 1.0,
        left_out=left_out,
        constant=constant,
        constant_errors=constant / points.inertance - 1.0,
    )


def _shares(losses: Losses, preload: float, loads: Sequence[float] | Array) -> Array:
    return Losses(losses.values.replace(preload=preload)).efficiency(loads)


def _scale(measured: Array, shares: Array) -> float:
    """Factor b that minimises the relative squares of b shares against measured."""
    relative = shares / measured
    return float(np.sum(relative) / np.sum(relative**2))


def _fit(points: Points, losses: Losses, keep: NDArray[np.bool_]) -> tuple[float, float]:
    """Inertance [kg] and preload [N] from the points that are kept."""
    loads, measured = points.force[keep], points.inertance[keep]

    def cost(preload: float) -> float:
        shares = _shares(losses, preload, loads)
        if not np.all(np.isfinite(shares)):
            return math.inf
        return float(np.sum((_scale(measured, shares) * shares / measured - 1.0) ** 2))

    # the preload whose friction is the smallest load; none if it does not help
    most = _preload_of(losses, float(np.min(points.force)))
    best = 0.0
    if most > 0.0:
        found = minimize_scalar(cost, bounds=(0.0, most), method="bounded", options={"xatol": 1e-9})
        best = float(found.x) if found.fun < cost(0.0) else 0.0  # type: ignore[attr-defined]
    return _scale(measured, _shares(losses, best, loads)), best


def _preload_of(losses: Losses, force: float) -> float:
    """Preload [N] of a ball whose sliding alone takes the force [N]; 0 without friction."""
    if losses.values.number("sliding_friction") == 0.0:
        return 0.0
    trial = 1.0
    for _ in range(40):
        found = Losses(losses.values.replace(preload=trial)).sliding_force(0.0)
        trial *= (force / found) ** 0.9
    return trial
