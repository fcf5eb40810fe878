"""Model-free tests: what the residual goes with, each learnt and judged on different data."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from inerter.identify.runs import BenchRun

from . import columns as c
from .further import columns_of_channels, test_of
from .learning import LearntPart, Samples, predict, share
from .lines import Lines, lines
from .periodic import Period, along_stroke

Array = NDArray[np.float64]

# the tests, the plainest first: of tests that predict nearly as much the first one is named
ORDER = (
    "displacement",
    "velocity",
    "acceleration",
    "displacement (periodic)",
    "displacement and direction",
    "displacement (periodic) and direction",
    "time",
    "amplitude",
    "events",
    "force",
    "history",
    "state",
    "frequency",
)


def in_order(channels: Iterable[str]) -> tuple[str, ...]:
    """Names of all tests, the plainest first, where there are further channels."""
    first = ORDER.index("acceleration") + 1
    return (*ORDER[:first], *map(test_of, channels), *ORDER[first:])


@dataclass(frozen=True)
class Remainder:
    """Runs, what a model leaves of their force, and the samples that count.

    Attributes
    ----------
    residual : sequence of ndarray
        Measured minus predicted force per run [N].
    clock : sequence of ndarray
        Time per run [s], from the beginning of the records where they share a clock.
    channels : mapping
        Further channels by name, of every run.
    """

    runs: Sequence[BenchRun]
    residual: Sequence[Array]
    data: Samples
    sizes: c.Sizes
    clock: Sequence[Array]
    channels: Mapping[str, Sequence[Array]] = field(default_factory=dict)

    def flat(self, make: Callable[[BenchRun], Array]) -> Array:
        """A function of every run on the samples that count, (n,) or (n, m)."""
        return self.data.flat([make(run) for run in self.runs])

    def without(self, predicted: Array) -> Remainder:
        """What is left after a prediction (n,) [N]."""
        residual, begin = [], 0
        for r, mask in zip(self.residual, self.data.chosen, strict=True):
            rest = r.copy()
            count = int(mask.sum())
            rest[mask] -= predicted[begin : begin + count]
            residual.append(rest)
            begin += count
        data = replace(self.data, residual=self.data.residual - predicted)
        return replace(self, residual=residual, data=data)


@dataclass(frozen=True)
class Tested:
    """Every test's prediction, and what some of them found besides."""

    tests: Mapping[str, LearntPart]
    periods: Mapping[str, Period]
    lines: Lines


def columns_of(remainder: Remainder) -> dict[str, Array]:
    """Columns (n, m) of every test that is a regression."""
    sizes, data = remainder.sizes, remainder.data
    x = remainder.flat(lambda run: run.displacement)
    v = remainder.flat(lambda run: run.velocity)
    a = remainder.flat(lambda run: run.acceleration)
    way = remainder.flat(lambda run: c.through_band(run, c.direction(run, sizes)[:, None])[:, 0])
    linear = np.column_stack([x / sizes.x, v / sizes.v, a / sizes.a, way, np.ones(x.size)])
    model = remainder.flat(lambda run: run.force) - data.residual
    along_x, along_v, along_a = (c.spline(q, c.edges_of(q)) for q in (x, v, a))
    along_v = np.column_stack([along_v, way])
    both = np.column_stack([along_x, along_x * way[:, None]])
    time = data.flat(list(remainder.clock))
    late = 2 * (time - time.min()) / (float(np.ptp(time)) or 1.0) - 1
    level = remainder.flat(lambda run: c.amplitude(run, sizes))
    return {
        "displacement": along_x,
        "velocity": along_v,
        "acceleration": along_a,
        "displacement and direction": both,
        "time": np.column_stack([linear * (late**k)[:, None] for k in range(4)]),
        "amplitude": np.column_stack([linear * (level**k)[:, None] for k in range(3)]),
        "events": np.column_stack(
            [linear, remainder.flat(lambda run: c.after_reversals(run, sizes))]
        ),
        "force": np.column_stack([linear, c.spline(model, c.edges_of(model))]),
        "history": np.column_stack([linear, remainder.flat(lambda run: c.past(run, sizes))]),
        "state": np.column_stack(
            [both, along_v, along_a, remainder.flat(lambda run: c.powers(run, sizes))]
        ),
        **columns_of_channels(linear, {n: data.flat(q) for n, q in remainder.channels.items()}),
        "_way": way,
        "_x": x,
    }


def battery(remainder: Remainder, columns: Mapping[str, Array]) -> Tested:
    """Every test on a remainder; `columns` from `columns_of`."""
    data, runs = remainder.data, remainder.runs
    tests = {
        name: predict(data, matrix) for name, matrix in columns.items() if not name.startswith("_")
    }
    x, way = columns["_x"], columns["_way"]
    periods = {
        "displacement (periodic)": along_stroke(data, x, np.ones(x.size)),
        "displacement (periodic) and direction": along_stroke(data, x, way),
    }
    tests |= {name: period.prediction for name, period in periods.items()}
    found = lines(
        remainder.residual,
        [run.force - r for run, r in zip(runs, remainder.residual, strict=True)],
        [run.spacing for run in runs],
        data.chosen,
    )
    flat = data.flat(found.values)
    held = data.fold == 0
    shares = found.share, share(data.residual[held], flat[held])
    tests["frequency"] = LearntPart(flat, *shares, found.p)
    return Tested(tests, periods, found)
