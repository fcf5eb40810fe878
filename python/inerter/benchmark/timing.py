"""Times of several ways to do a thing, taken in turn.

A machine has slow moments. Every round goes through all variants, the next one through them
backwards, so that a slow moment or a drift meets each of them alike; a ratio of two variants is
taken within each round, and the median of the rounds is told with its quartiles.

`clock=time.process_time` counts what the process computed and not how long it waited for a core:
for work on one thread, on a machine that has other things to do.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Work:
    """One way to do a thing.

    Attributes
    ----------
    run
        What is timed.
    units
        How many steps, samples, fits one call makes.
    prepare
        Called before each `run`, not timed.
    """

    run: Callable[[], object]
    units: float = 1.0
    prepare: Callable[[], object] | None = None


@dataclass(frozen=True)
class Spread:
    """Median and quartiles."""

    median: float
    lower: float
    upper: float

    @classmethod
    def of(cls, values: Any) -> Spread:
        """Spread of one or more numbers."""
        lower, median, upper = np.quantile(np.asarray(values, dtype=np.float64), [0.25, 0.5, 0.75])
        return cls(float(median), float(lower), float(upper))

    def times(self, factor: float) -> Spread:
        """In another unit."""
        return Spread(factor * self.median, factor * self.lower, factor * self.upper)


@dataclass(frozen=True)
class Timing:
    """Seconds per unit, one number for each round."""

    seconds: tuple[float, ...]

    @property
    def spread(self) -> Spread:
        """Of the seconds per unit."""
        return Spread.of(self.seconds)

    def ratio(self, other: Timing) -> Spread:
        """How much longer this one takes than another: ratios within rounds."""
        return Spread.of(np.divide(self.seconds, other.seconds))


def interleaved(
    works: Mapping[str, Work],
    rounds: int,
    *,
    warm_up: bool = True,
    clock: Callable[[], float] = time.perf_counter,
) -> dict[str, Timing]:
    """Time variants in turn.

    Parameters
    ----------
    works
        The variants by name.
    rounds
        How often each of them runs, at least 1.
    warm_up
        Whether a round goes before them that does not count.
    clock
        What is read before and after [s].

    Raises
    ------
    ValueError
        Fewer than one round.
    """
    if rounds < 1:
        raise ValueError(f"rounds is {rounds}; timing needs at least 1")
    seconds: dict[str, list[float]] = {name: [] for name in works}
    for turn in range(-int(warm_up), rounds):
        names = list(works) if turn % 2 == 0 else list(works)[::-1]
        for name in names:
            spent = once(works[name], clock)
            if turn >= 0:
                seconds[name].append(spent)
    return {name: Timing(tuple(values)) for name, values in seconds.items()}


def once(work: Work, clock: Callable[[], float] = time.perf_counter) -> float:
    """Seconds per unit of one run."""
    if work.prepare is not None:
        work.prepare()
    start = clock()
    work.run()
    return (clock() - start) / work.units
