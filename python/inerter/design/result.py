"""What a calculator gives: named figures with units, a device for the simulators, curves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from inerter.core import Device
from inerter.design.inputs import Values

SCHEMA = "inerter.design/1"


@dataclass(frozen=True)
class Figure:
    """One result: its name, value in the unit, what it is."""

    name: str
    value: float
    unit: str
    meaning: str


@dataclass(frozen=True)
class Curve:
    """One line of a panel: its name, x and y; `marks` draws points in place of a line."""

    name: str
    x: Sequence[float]
    y: Sequence[float]
    marks: bool = False
    dashed: bool = False


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One plot: titles of its axes with units, its curves."""

    name: str
    title: str
    x_title: str
    y_title: str
    curves: Sequence[Curve]
    log_x: bool = False
    log_y: bool = False

    def json(self) -> dict[str, Any]:
        """The curves as lists; values that are not finite are null."""
        return {
            "title": self.title,
            "x": self.x_title,
            "y": self.y_title,
            "curves": [
                {"name": curve.name, "x": _finite(curve.x), "y": _finite(curve.y)}
                for curve in self.curves
            ],
        }


@dataclass(frozen=True, kw_only=True)
class Design:
    """A calculated device.

    `comments` explains parameters of the device, `tables` holds rows beside the figures (such as
    the comparison with measured values), `notes` says what the numbers do not cover.
    """

    kind: str
    inputs: Values
    figures: tuple[Figure, ...]
    device: Device
    comments: dict[str, str]
    panels: tuple[Panel, ...] = ()
    tables: dict[str, list[dict[str, Any]]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def value(self, name: str) -> float:
        """A figure by name."""
        return next(figure.value for figure in self.figures if figure.name == name)

    def json(self) -> dict[str, Any]:
        """What design.json holds."""
        return {
            "schema": SCHEMA,
            "kind": self.kind,
            "inputs": self.inputs.json(),
            "results": {
                figure.name: {
                    "value": _number(figure.value),
                    "unit": figure.unit,
                    "meaning": figure.meaning,
                }
                for figure in self.figures
            },
            "device": self.device.given,
            "tables": self.tables,
            "curves": {panel.name: panel.json() for panel in self.panels},
            "notes": list(self.notes),
        }


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _finite(values: Sequence[float]) -> list[float | None]:
    return [_number(value) for value in values]
