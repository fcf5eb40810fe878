"""Mean squares of a simulation's signals through a filter, and indices that are made of them.

Over a period of the road what has settled is periodic, so a filter W(s) acts on its lines alone:

    mean square of W x = sum over lines |W(2 pi i f)|^2 |X(f)|^2                   (Parseval)

X are the lines of the sampled signal; those above half the sampling rate, which the steps cannot
follow, are added by the caller in closed form. Signals are those of `INDICES`: J1, accelerations of
the body's points, J3, tyre forces, travel, of several wheels the mean; pitch and roll, angular
accelerations.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.indices import INDICES
from inerter.suspension.own_index import combined
from inerter.suspension.time_domain.car_model import CarModel

Array = NDArray[np.float64]

SUMMED = ("J1", "J3", "travel")
"""Signals whose mean squares are summed while a simulation runs."""


def parts_of(indices: Iterable[str]) -> tuple[str, ...]:
    """The rms values that indices are made of, each once: of a function those that it combines."""
    return tuple(dict.fromkeys(part for name in indices for part in INDICES[name].parts or (name,)))


def kept_of(indices: Iterable[str]) -> tuple[str, ...]:
    """Those that take the whole signal: filtered ones, pitch and roll."""
    return tuple(part for part in parts_of(indices) if part not in SUMMED)


def index_of(name: str, roots: Mapping[str, Array]) -> Array:
    """An index from the rms values of its parts, arrays of one shape."""
    own = INDICES[name]
    if own.function is None:
        return roots[name]
    return np.asarray(combined(name, own.function, {part: roots[part] for part in own.parts}))


def gain_of(part: str, f: NDArray[Any]) -> Array:
    """|W|^2 at frequencies [Hz]; 1 without a filter."""
    felt = INDICES[part].filter
    return np.ones(f.shape) if felt is None else np.abs(felt(2j * np.pi * f)) ** 2


def signal_of(part: str) -> str:
    """The signal whose rms, filtered or not, a part is."""
    return INDICES[part].signal or part


def of_points(signal: str, car: CarModel) -> Array:
    """Rows that make a signal of the body from the accelerations of its points.

    Shape (rows, points): all of them for J1, one row for pitch or roll.

    Raises
    ------
    ValueError
        The body of the car does not turn like that.
    """
    points = len(car.wheels)
    if signal == "J1":
        return np.identity(points, dtype=np.float64)
    # heave, then roll of a full car, then pitch
    turns: Array = np.linalg.pinv(car.points[:, :-points]).astype(np.float64)
    place = {"pitch": (0, 1, 2), "roll": (0, 0, 1)}[signal][len(turns) - 1]
    if not place:
        raise ValueError(f"{signal}: the body of this car does not turn so")
    return turns[place : place + 1]


class Kept:
    """Signals over one period, as far as `parts` need them; `mean_squares` of each part."""

    def __init__(self, parts: tuple[str, ...], car: CarModel, simulations: int, count: int) -> None:
        """Room for `count` instants of every simulation."""
        self.parts, self.count = parts, count
        self.rows = {
            name: of_points(name, car) for name in {signal_of(p) for p in parts} - {"J3", "travel"}
        }
        widths = {name: len(self.rows.get(name, car.wheels)) for name in map(signal_of, parts)}
        self.series = {name: np.empty((simulations, w, count)) for name, w in widths.items()}

    def add(self, first: int, accelerations: Array, forces: Array, travels: Array) -> None:
        """Instants from `first`, arrays (simulations, n, points or wheels)."""
        for name, series in self.series.items():
            if name in self.rows:
                found = accelerations @ self.rows[name].T
            else:
                found = forces if name == "J3" else travels
            series[:, :, first : first + found.shape[1]] = found.transpose(0, 2, 1)

    def mean_squares(self, step: float) -> Array:
        """Of every part through its filter, means over its rows, (parts, simulations)."""
        f = np.fft.rfftfreq(self.count, step)
        twice = np.full(f.size, 2.0)
        twice[0] = 1.0
        if self.count % 2 == 0:
            twice[-1] = 1.0
        gains = [twice * gain_of(part, f) / self.count**2 for part in self.parts]
        found = np.empty((len(self.parts), len(next(iter(self.series.values())))))
        for name, series in self.series.items():
            for n, one in enumerate(series):
                power = np.mean(np.abs(np.fft.rfft(one, axis=1)) ** 2, axis=0)
                for row, part in enumerate(self.parts):
                    if signal_of(part) == name:
                        found[row, n] = gains[row] @ power
        return found
