"""What an identification gives: estimates, what is left open, errors on held-out data."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.core import Device
from inerter.identify.channel_filter import Filter, filters_of
from inerter.identify.identifiability import Combination
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.identify.split import Split
from inerter.motion_units import Kind
from inerter.records import Record
from inerter.records.duplicates import repeats_another, without_copies
from inerter.records.preparation import Preparation

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Estimate:
    """One parameter: `value`, standard error, 95 % interval (None: no end), unit."""

    value: float
    stderr: float
    low: float | None
    high: float | None
    unit: str


@dataclass(frozen=True)
class SimulatedErrors:
    """Of a fit by simulation: rms displacement error [m] on the data fitted and on those held out.

    `relative` is the latter per standard deviation of the displacement.
    """

    fit_rmse: float
    rmse: float
    relative: float


@dataclass(frozen=True, kw_only=True)
class Figures:
    """What is told of a device's parameters on the records.

    Attributes
    ----------
    undetermined
        Parameters that the data do not determine, alone or in groups that they cannot tell apart.
    combinations
        What of them the data do determine.
    fit_rmse, rmse
        Force error [N] on the data fitted and on those held out; `low`, `high` its 95 % interval.
    nrmse
        `rmse` per standard deviation of the held-out force.
    """

    undetermined: tuple[tuple[str, ...], ...]
    combinations: tuple[Combination, ...]
    fit_rmse: float
    rmse: float
    low: float
    high: float
    nrmse: float


@dataclass(frozen=True, kw_only=True)
class Identified(Figures):
    """A law fitted to data, with its figures.

    Attributes
    ----------
    law
        As asked for.
    device
        The device, ready for a simulation.
    delay
        Time by which the force channel is late [s].
    parameters
        What was fitted, by name.
    correlation
        Of the estimates, in the order of `parameters`, shape (p, p).
    ends
        Force errors [N] at which the fits from different starts ended; none of a simulation.
    notes
        Sentences on what a reader should know.
    converged
        Whether the fit ended where no step lowers the error, and not because it took too long.
    seconds
        Time the fit took.
    cutoff
        Below which the motion was used [Hz], chosen for the law.
    runs
        The records at their own rate, smoothed so.
    motion
        Displacement errors, where the law was simulated.
    worse_than
        Simpler laws, within this one or its limit, that explain the data fitted better.
    judge
        Tells what there is to say of other values of the parameters on the same data.
    """

    law: str
    device: Device
    delay: float
    parameters: Mapping[str, Estimate]
    correlation: Array
    ends: tuple[float, ...]
    notes: tuple[str, ...]
    converged: bool
    seconds: float
    model: Model = field(repr=False)
    cutoff: float
    runs: tuple[BenchRun, ...] = field(repr=False)
    judge: Callable[[Model], Figures] = field(repr=False)
    motion: SimulatedErrors | None = None
    worse_than: tuple[str, ...] = ()

    @property
    def filters(self) -> dict[str, Filter]:
        """Low-passes of the record's channels, as they were stated."""
        return filters_of(self.model.values)

    def json(self) -> dict[str, Any]:
        """Plain data."""
        return {
            "law": self.law,
            "device": self.device.given,
            "delay": self.delay,
            "filters": {name: each.text for name, each in self.filters.items()},
            "parameters": {
                name: {
                    "value": each.value,
                    "stderr": each.stderr,
                    "interval": [each.low, each.high],
                    "unit": each.unit,
                }
                for name, each in self.parameters.items()
            },
            "correlation": {
                "names": list(self.parameters),
                "matrix": self.correlation.tolist(),
            },
            "undetermined": [list(group) for group in self.undetermined],
            "combinations": [
                {"expression": c.expression, "value": c.value, "relative_error": c.relative_error}
                for c in self.combinations
            ],
            "fit_rmse": self.fit_rmse,
            "rmse": self.rmse,
            "rmse_interval": [self.low, self.high],
            "nrmse": self.nrmse,
            "starts": list(self.ends),
            "notes": list(self.notes),
            "converged": self.converged,
            "worse_than": list(self.worse_than),
            "seconds": self.seconds,
            "cutoff": self.cutoff,
            "motion": asdict(self.motion) if self.motion else None,
        }


@dataclass(frozen=True)
class Identification:
    """`results` by held-out error, the best first; how the data were prepared and divided.

    `records` are all that were given, `used` those that repeat no other.

    A law that was simulated comes twice, first with the parameters that explain its motion better.
    """

    records: tuple[Record, ...]
    results: tuple[Identified, ...]
    preparation: Preparation
    split: Split

    @property
    def motion(self) -> Kind:
        """What the device does."""
        return self.records[0].motion

    @property
    def used(self) -> list[Record]:
        """The records that were fitted or held out, in the order of `split`."""
        return without_copies(self.records)

    @property
    def best(self) -> Identified:
        """The law with the smallest held-out error, as fitted to what explains it best."""
        return self.results[0]

    def json(self) -> dict[str, Any]:
        """Plain data; schema inerter.identification/1."""
        roles = map(self.split.role, range(len(self.used)))
        return {
            "schema": "inerter.identification/1",
            "motion": self.motion,
            "records": [
                {
                    "name": record.name,
                    "samples": record.samples,
                    "sample_rate": record.sample_rate,
                    "role": "unused" if repeats_another(record) else next(roles),
                    "warnings": [{"code": w.code, "text": w.text} for w in record.warnings],
                }
                for record in self.records
            ],
            "preparation": {
                "cutoff": self.preparation.cutoff,
                "channels": ["displacement", *self.preparation.channels],
                "noise_floor": self.preparation.noise_floor,
            },
            "held_out": self.split.description,
            "results": [result.json() for result in self.results],
        }
