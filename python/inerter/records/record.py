"""Records: what a bench or a vehicle measurement is once it has been read.

All arrays are one-dimensional, float64, SI units and read-only. Sign convention: displacement is
positive when the device gets longer, force is positive when it has to be pulled (tension), so an
ideal inerter of inertance b shows ``force = +b * d2(displacement)/dt2``.
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from inerter.motion_units import TRANSLATION, Kind
from inerter.records.even_clock import even_spacing

Array = NDArray[np.float64]

WARNING_CODES = (
    "duplicate_record",
    "nonuniform_sampling",
    "missing_samples",
    "outliers",
    "clipping",
    "sign_flip",
    "unit_suspect",
    "constant_channel",
)


class RecordError(ValueError):
    """A record that cannot be used; one line: file, column or line, what is wrong, what to do."""

    def __init__(self, message: str) -> None:
        super().__init__(" ".join(message.split()))


@dataclass(frozen=True)
class RecordWarning:
    """Something about a usable record that the reader should know.

    code: one of `WARNING_CODES`; text: one sentence.
    """

    code: str
    text: str

    def __post_init__(self) -> None:
        if self.code not in WARNING_CODES:
            raise ValueError(f"unknown warning code {self.code!r}; use one of {WARNING_CODES}")


@dataclass(frozen=True, eq=False, kw_only=True)
class Columns:
    """Columns of equal length with a name and an origin: what all kinds of record share.

    name: file stem, or ``stem:run``. source: the file, None for data made in memory.
    extra: further numeric columns under the header they had, values as written (no conversion).
    motion: what its device does; in rotation read rad for m, N m for N, kg m^2 for kg.
    comments: the lines that stood above the header, without a ``#``.
    reading: how the file was read, where anything of it is out of the ordinary.
    headers: by name, the header of the file's column, or the formula that was stated of it.
    Raises ValueError when columns are not one-dimensional and equally long.
    """

    name: str
    source: Path | None = None
    extra: Mapping[str, Array] = field(default_factory=dict)
    comments: tuple[str, ...] = ()
    reading: str = ""
    headers: Mapping[str, str] = field(default_factory=dict)
    warnings: tuple[RecordWarning, ...] = ()
    motion: Kind = TRANSLATION

    kind: ClassVar[str] = ""
    required: ClassVar[tuple[str, ...]] = ()
    optional: ClassVar[tuple[str, ...]] = ()

    def __post_init__(self) -> None:
        length = np.size(getattr(self, self.required[0]))

        def locked(name: str, values: object) -> Array:
            # arrays that are locked already, as in dataclasses.replace, need no copy
            ready = isinstance(values, np.ndarray) and not values.flags.writeable
            array = np.array(values, dtype=np.float64, copy=None if ready else True)
            if array.shape != (length,):
                raise ValueError(
                    f"record {self.name!r}: {name!r} has shape {array.shape}, "
                    f"{self.required[0]!r} has {length} values; give 1-d arrays of one length"
                )
            array.setflags(write=False)
            return array

        # a frozen dataclass is filled through object.__setattr__
        for name in (*self.required, *self.optional):
            values = getattr(self, name)
            if values is not None:
                object.__setattr__(self, name, locked(name, values))
        extra = {name: locked(name, values) for name, values in self.extra.items()}
        object.__setattr__(self, "extra", MappingProxyType(extra))
        object.__setattr__(self, "comments", tuple(self.comments))
        object.__setattr__(self, "warnings", tuple(self.warnings))

    @property
    def samples(self) -> int:
        """Number of rows."""
        return len(getattr(self, self.required[0]))

    def channels(self) -> dict[str, Array]:
        """The measured columns that are present, without time (or frequency), by name."""
        names = (*self.required[1:], *self.optional)
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}

    def beside(self) -> dict[str, Array]:
        """Further columns, and measured derivatives of the motion, by the header they had.

        What is called an acceleration may be that of something else: of a table, say.
        """
        found = dict(self.extra)
        length = "m" if self.motion == TRANSLATION else "rad"
        for name, unit in (("velocity", f"{length}/s"), ("acceleration", f"{length}/s^2")):
            values = getattr(self, name, None)
            if values is not None:
                plain = self.headers.get(name, name).partition("[")[0].strip()
                found[f"{plain}[{unit}]"] = values
        return found

    def turned_round(self, name: str) -> str:
        """What to type to have a column with the opposite sign."""
        given = self.headers.get(name, name)
        turned = f"{given[1:].lstrip()}" if given.startswith("-") else f"-1 * {given}"
        return f"--column {name}={turned!r}"

    def warn(self, code: str, text: str) -> Self:
        """The same record with one more warning."""
        return dataclasses.replace(self, warnings=(*self.warnings, RecordWarning(code, text)))


@dataclass(frozen=True, eq=False, kw_only=True)
class TimeRecord(Columns):
    """Columns over time (s), strictly increasing; it may start anywhere."""

    time: Array

    @property
    def sample_interval(self) -> float:
        """That of an even clock, else the median, s; NaN for fewer than two samples."""
        if self.samples < 2:
            return float("nan")
        even = even_spacing(self.time)
        return float(np.median(np.diff(self.time))) if even is None else even

    @property
    def sample_rate(self) -> float:
        """One over the interval, Hz."""
        return 1.0 / self.sample_interval

    @property
    def duration(self) -> float:
        """Last time minus first time, s."""
        return float(self.time[-1] - self.time[0])


@dataclass(frozen=True)
class Part:
    """Of which run a record is a part, and the time from which slow changes count there [s]."""

    run: str
    clock: float


@dataclass(frozen=True, eq=False, kw_only=True)
class Record(TimeRecord):
    """One run on a bench: time s, displacement m, force N; velocity m/s, acceleration m/s^2.

    part: where it is a part of a longer one. instants: per sample, at which forces are followed;
    more than one where a low-pass before the converter has smoothed what jumps. slowest: speed
    [m/s] below which rests do not count, for their direction is not told. zeroed: time [s] at which
    the force channel was zeroed anew, from which its drift counts.
    """

    displacement: Array
    force: Array
    velocity: Array | None = None
    acceleration: Array | None = None
    part: Part | None = None
    instants: int = 1
    slowest: float = 0.0
    zeroed: float | None = None

    kind: ClassVar[str] = "bench"
    required: ClassVar[tuple[str, ...]] = ("time", "displacement", "force")
    optional: ClassVar[tuple[str, ...]] = ("velocity", "acceleration")


@dataclass(frozen=True, eq=False, kw_only=True)
class VehicleRecord(TimeRecord):
    """One drive: time s, road m, and any of the vehicle channels (m/s^2, m, N)."""

    road: Array
    body_acceleration: Array | None = None
    wheel_acceleration: Array | None = None
    suspension_travel: Array | None = None
    tyre_force: Array | None = None

    kind: ClassVar[str] = "vehicle"
    required: ClassVar[tuple[str, ...]] = ("time", "road")
    optional: ClassVar[tuple[str, ...]] = (
        "body_acceleration",
        "wheel_acceleration",
        "suspension_travel",
        "tyre_force",
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class BenchTable(Columns):
    """Sine-sweep results: frequency Hz, amplitudes of force N and of acceleration m/s^2."""

    frequency: Array
    force_amplitude: Array
    acceleration_amplitude: Array

    kind: ClassVar[str] = "table"
    required: ClassVar[tuple[str, ...]] = ("frequency", "force_amplitude", "acceleration_amplitude")


AnyRecord = Record | VehicleRecord | BenchTable


def share_one_clock(records: Sequence[TimeRecord]) -> bool:
    """Whether no two runs overlap in time, so that slow changes run through all of them.

    Runs that overlap each have a clock of their own. A run may begin at the very instant at which
    another ends. The order of `records` does not matter; fewer than two share one clock.
    """
    spans = sorted((float(r.time[0]), float(r.time[-1])) for r in records)
    return all(first[1] <= second[0] for first, second in itertools.pairwise(spans))
