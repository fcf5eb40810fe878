"""The result of a validation: rows, and what they come to."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from functools import cached_property
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from inerter.validate.plan import ENGINES, Selection
from inerter.validate.run import QUANTITIES
from inerter.validate.task import ValidationRow

SCHEMA = "inerter.validation/1"


@dataclass(frozen=True)
class Validation:
    """Rows of all cases that were selected, and the wall time [s]."""

    selection: Selection
    all_rows: list[ValidationRow]
    seconds: float

    @property
    def rows(self) -> list[ValidationRow]:
        """The cases at two steps, sorted by what they are."""
        return sorted((row for row in self.all_rows if not row.headline), key=_place)

    @property
    def headline(self) -> list[ValidationRow]:
        """The long runs."""
        return sorted((row for row in self.all_rows if row.headline), key=_place)

    @property
    def missed(self) -> list[ValidationRow]:
        """Rows outside their bounds, or without a result."""
        return [row for row in self.all_rows if not row.within]

    @cached_property
    def summary(self) -> list[dict[str, Any]]:
        """For each engine, integrator and kind of law: largest errors, range of orders."""
        groups: dict[tuple[str, str, str], list[ValidationRow]] = {}
        for row in self.rows:
            kind = "smooth" if row.kind == "smooth" else "not smooth"
            groups.setdefault((row.engine, row.integrator, kind), []).append(row)
        return [_group(*names, rows) for names, rows in groups.items()]

    def json(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "schema": SCHEMA,
            "versions": versions(),
            "selection": asdict(self.selection),
            "seconds": round(self.seconds, 1),
            "within": not self.missed,
            "missed": len(self.missed),
            "summary": self.summary,
            "headline": [row.json() for row in self.headline],
            "rows": [row.json() for row in self.rows],
        }


def versions() -> dict[str, str | None]:
    """Versions of what took part; None for Exudyn where it is not installed."""
    found: dict[str, str | None] = {}
    for name in ("inerter", "mujoco", "exudyn", "scipy"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = None
    return found


def largest(rows: list[ValidationRow], quantity: str) -> float | None:
    """Largest error of some rows; None where none has that quantity."""
    values = [row.errors[quantity] for row in rows]
    return max((value for value in values if value is not None), default=None)


def _group(engine: str, integrator: str, kind: str, rows: list[ValidationRow]) -> dict[str, Any]:
    orders = [row.order for row in rows if row.order is not None]
    return {
        "engine": engine,
        "integrator": integrator,
        "kind": kind,
        "rows": len(rows),
        "missed": sum(not row.within for row in rows),
        "errors": {quantity: largest(rows, quantity) for quantity in QUANTITIES},
        "order": [min(orders), max(orders)] if orders else None,
    }


def _place(row: ValidationRow) -> tuple[int, str, str, str, str]:
    return list(ENGINES).index(row.engine), row.model, row.layout, row.law, row.input
