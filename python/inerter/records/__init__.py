"""Measured records: reading them, what is wrong with them, and the form the rest works on."""

from .quality import check_records
from .read import read_records
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
