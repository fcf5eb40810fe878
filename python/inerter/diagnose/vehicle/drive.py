"""A run of a record as a simulation needs it: inputs on the model's steps, what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from inerter.diagnose.vehicle.mapping import Channels
from inerter.records.record import RecordError, TimeRecord

Array = NDArray[np.float64]
# a recorded sample this near to a model's step counts as on it [steps]
_ON_STEP = 1e-3
_SLOWEST = 0.1  # below this no road is averaged over a patch [m/s]


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
    spline : CubicSpline
        The inputs over the time.
    speed : CubicSpline or None
        Of the vehicle [m/s], where the record has it.
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
    spline: CubicSpline
    speed: CubicSpline | None = None

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

    def scaled(self, gains: Array) -> RecordedDrive:
        """The drive with every input times a gain of its own."""
        return replace(
            self,
            ahead=self.ahead * gains,
            now=self.now * gains,
            rate=self.rate * gains,
            rate_now=self.rate_now * gains,
            spline=CubicSpline(self.spline.x, self.spline(self.spline.x) * gains),
        )

    def averaged(
        self, columns: Sequence[int], patch_length: float = 0.0, patch_time: float = 0.0
    ) -> RecordedDrive:
        """The drive with some inputs averaged over what a tyre covers at once.

        Parameters
        ----------
        columns : sequence of int
            Of the inputs.
        patch_length : float
            Covered [m]; wants `speed`.
        patch_time : float
            In place of it the time in which a point passes under the tyre [s].
        """
        now = self.step * np.arange(self.steps, dtype=np.float64)
        values = [self.now.copy(), self.rate_now.copy(), self.ahead.copy(), self.rate.copy()]
        for place, later in enumerate((0.0, self.step / 2)):
            times: Array = now + later
            half = np.full(times.size, 0.5 * patch_time)
            if self.speed is not None and patch_length:
                inside = np.clip(times, 0.0, self.speed.x[-1])
                half = 0.5 * patch_length / np.maximum(self.speed(inside), _SLOWEST)
            half = np.maximum(half, 1e-9)
            height, rate = _window(self.spline, times, half)
            values[2 * place][:, columns] = height[:, columns]
            values[2 * place + 1][:, columns] = rate[:, columns]
        now_, rate_now, ahead, rate = values
        return replace(self, now=now_, rate_now=rate_now, ahead=ahead, rate=rate)


def _window(spline: CubicSpline, times: Array, half: Array) -> tuple[Array, Array]:
    """Mean over `half` before and behind each time, and its rate; held beyond the ends."""
    total, last = spline.antiderivative(), float(spline.x[-1])

    def whole(t: Array) -> Array:
        inside = np.clip(t, 0.0, last)
        return total(inside) + (t - inside)[:, None] * spline(inside)

    late, early, width = times + half, times - half, (2 * half)[:, None]
    mean = (whole(late) - whole(early)) / width
    return mean, (spline(np.clip(late, 0, last)) - spline(np.clip(early, 0, last))) / width


def make_drive(record: TimeRecord, channels: Channels, step: float) -> RecordedDrive:
    """A run on the model's steps; inputs between samples by cubic splines.

    Raises
    ------
    RecordError
        A mapped column is missing in this run.
    """
    columns = {**record.extra, **record.channels()}
    for name in channels.used:
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
        spline=spline,
        speed=CubicSpline(time, columns[channels.speed]) if channels.speed else None,
    )
