"""Measured records: reading them, what is wrong with them, and the form the rest works on."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .record import (
    WARNING_CODES,
    AnyRecord,
    BenchTable,
    Record,
    RecordError,
    RecordWarning,
    TimeRecord,
    VehicleRecord,
    share_one_clock,
)

if TYPE_CHECKING:
    from .quality import check_records
    from .read import read_records

__all__ = [
    "WARNING_CODES",
    "AnyRecord",
    "BenchTable",
    "Record",
    "RecordError",
    "RecordWarning",
    "TimeRecord",
    "VehicleRecord",
    "check_records",
    "read_records",
    "share_one_clock",
]

# imported when they are asked for, so that the command line starts without Polars and SciPy
_PLACES = {"check_records": "quality", "read_records": "read"}


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_PLACES[name]}"), name)
