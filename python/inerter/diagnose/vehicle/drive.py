"""A run of a record as a simulation needs it: inputs on the model's steps, what was measured."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from inerter.diagnose.vehicle.mapping import Channels
from inerter.records.record import RecordError, TimeRecord

Array = NDArray[np.float64]
# a recorded sample this near to a model's step counts as on it [steps]
_ON_STEP = 1e-3


@dataclass(frozen=True, kw_only=True)
class RecordedDrive:
    """One run.

    Attributes
    ----------
    name : str
        Of the run.
    time : ndarray (n,)
        Of the samples, from 0 [s].
    start : float
        Time of the first sample on the record's clock [s].
    measured : ndarray (n, outputs)
        In the order of `Channels.outputs`, SI units.
    step : float
        Of the model [s].
    ahead, now, rate : ndarray (steps, inputs)
        Inputs in the middle of each step, which the step holds; at its beginning, when sensors
        are read; and their rates in the middle.
    rate_now : ndarray (steps, inputs)
        Rates at the beginning.
    stride : int or None
        Steps between samples; None where samples lie between steps.
    """

    name: str
    time: Array
    start: float
    measured: Array
    step: float
    ahead: Array
    now: Array
    rate: Array
    rate_now: Array
    stride: int | None

    @property
    def steps(self) -> int:
        """Number of steps."""
        return self.ahead.shape[0]

    @property
    def spacing(self) -> float:
        """Median time between samples [s]."""
        return float(np.median(np.diff(self.time)))

    def at_samples(self, values: Array) -> Array:
        """Values on the steps, (..., steps, k), at the samples, (..., n, k)."""
        if self.stride is not None:
            return values[..., :: self.stride, :][..., : self.time.size, :]
        grid = self.step * np.arange(values.shape[-2])
        return CubicSpline(grid, values, axis=-2)(self.time)

    def part(self, seconds: float) -> RecordedDrive:
        """The first part of the run."""
        count = int(np.searchsorted(self.time, seconds))
        if count >= self.time.size:
            return self
        steps = min(int(np.ceil(self.time[count - 1] / self.step)) + 3, self.steps)
        return replace(
            self,
            time=self.time[:count],
            measured=self.measured[:count],
            ahead=self.ahead[:steps],
            now=self.now[:steps],
            rate=self.rate[:steps],
            rate_now=self.rate_now[:steps],
        )

    def finer(self, channels: Channels, record: TimeRecord) -> RecordedDrive:
        """The same with steps half as long."""
        return make_drive(record, channels, self.step / 2)


def make_drive(record: TimeRecord, channels: Channels, step: float) -> RecordedDrive:
    """A run on the model's steps; inputs between samples by cubic splines.

    Raises
    ------
    RecordError
        A mapped column is missing in this run.
    """
    columns = {**record.extra, **record.channels()}
    for name in (*channels.inputs, *(output.column for output in channels.outputs)):
        if name not in columns:
            raise RecordError(
                f"{record.name}: no column {name!r}, which other runs have; record it in every run"
            )
    time = record.time - record.time[0]
    spline = CubicSpline(time, np.column_stack([columns[name] for name in channels.inputs]))
    rates = spline.derivative()
    steps = int(np.ceil(time[-1] / step - _ON_STEP)) + 2
    grid = step * np.arange(steps)

    # beyond the last sample the input stays
    begin, middle = np.minimum(grid, time[-1]), np.minimum(grid + step / 2, time[-1])
    ratio = time / step
    spacing = float(np.median(np.diff(ratio)))
    stride = max(round(spacing), 1)
    aligned = bool(np.max(np.abs(ratio - stride * np.arange(time.size))) < _ON_STEP)
    return RecordedDrive(
        name=record.name,
        time=time,
        start=float(record.time[0]),
        measured=np.column_stack([columns[output.column] for output in channels.outputs]),
        step=step,
        ahead=spline(middle),
        now=spline(begin),
        rate=rates(middle),
        rate_now=rates(begin),
        stride=stride if aligned else None,
    )
