"""Stretches of a long record that a search works on: few samples, and everything that happens.

A bench writes a million samples in a quarter of an hour, which tell the same many times over.
Causes are searched for on stretches of the record, each smoothed and followed for itself; what is
found is then fitted to, and judged on, all of it (`everything`). Half of the stretches are spread
evenly in time; the others are those that are least like any taken before, in the size of motion and
force, in place, and in what a plain model leaves: the sweep among the sines, the one blow at an
end. Where samples are far denser than the motion needs, each of a stretch is the mean of several.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.run_constants import contradicting, zeros_of
from inerter.diagnose.start import Given
from inerter.identify.runs import BenchRun, on_clocks, thin
from inerter.identify.split import split
from inerter.records import Record
from inerter.records.duplicates import without_copies
from inerter.records.motion import smooth
from inerter.records.preparation import dominant_frequency, prepare, refuse_unusable
from inerter.records.record import Part

Array = NDArray[np.float64]

SHORTEST, PERIODS = 4000, 20.0
"""Samples and periods of the motion that a stretch has at least."""
FEWEST = 8
"""Stretches at least, however long they have to be."""
PER_PERIOD, LEAST_RATE = 40.0, 1000.0
"""Samples per period of the cut-off, and per second, that stretches have at least."""
HELD = 0.3
"""Share of the stretches that are held out."""
WORTH = 0.6
"""Share of the samples below which stretches save enough."""
MORE = 6
"""Stretches that are added at once."""


@dataclass(frozen=True, kw_only=True)
class Stretch:
    """Samples `begin` to `end` of run number `run`, held out or not, and what tells it apart."""

    run: int
    begin: int
    end: int
    held: bool
    features: Array


@dataclass(frozen=True, kw_only=True)
class Excerpts:
    """Stretches of long records.

    Attributes
    ----------
    whole
        What the diagnosis is asked, of everything.
    records
        Everything, copies left out, constants of runs taken off.
    holdout
        Names of the runs that are held out; empty where blocks of the only one are.
    constants, contradicting
        As in `start.Prepared`.
    clocks
        Of each run [s].
    spacings
        Between samples of each run on a uniform clock [s], on which stretches are counted.
    every
        Samples of each run that one of a stretch is the mean of.
    possible, chosen
        All stretches, and numbers of those that are searched.
    """

    whole: Given
    records: Sequence[Record]
    holdout: Sequence[str]
    constants: Mapping[str, float]
    contradicting: Mapping[str, str]
    clocks: Sequence[float]
    spacings: Sequence[float]
    every: Sequence[int]
    possible: Sequence[Stretch] = ()
    chosen: Sequence[int] = ()

    @property
    def given(self) -> Given:
        """What the diagnosis is asked, of the stretches, or of everything where that is enough."""
        if not self.possible:
            coarse = [_coarse(r, n) for r, n in zip(self.records, self.every, strict=True)]
            return replace(self.whole, records=coarse, holdout=self.holdout)
        chosen = [self.possible[i] for i in sorted(self.chosen)]
        parts = [self._part(stretch) for stretch in chosen]
        held = [part.name for part, each in zip(parts, chosen, strict=True) if each.held]
        return replace(self.whole, records=parts, holdout=held)

    def _part(self, stretch: Stretch) -> Record:
        record = self.records[stretch.run]
        part = Part(record.name, self.clocks[stretch.run])
        rows = self.rows(stretch)
        found = _cut(record, rows.start, rows.stop, part)
        return _coarse(found, self.every[stretch.run])

    def rows(self, stretch: Stretch) -> slice:
        """The rows of its record that a stretch has, which may have gaps."""
        time, spacing = self.records[stretch.run].time, self.spacings[stretch.run]
        ends = time[0] + spacing * (np.array([stretch.begin, stretch.end]) - 0.5)
        begin, end = np.searchsorted(time, ends)
        return slice(int(begin), int(end))

    @property
    def samples(self) -> tuple[int, int]:
        """Samples that are searched, and of everything."""
        some = sum(record.samples for record in self.given.records)
        return some, sum(record.samples for record in self.records)

    def with_missed(self, errors: Sequence[Array]) -> Excerpts | None:
        """With the stretches that are missed as none of those searched; None where there are none.

        errors: measured minus predicted force of every run (n_i,) [N].
        """
        if not self.possible:
            return None
        sizes = np.array([_rms(errors[s.run][s.begin : s.end]) for s in self.possible])
        seen = np.isin(np.arange(sizes.size), self.chosen)
        learnt = np.array([not stretch.held for stretch in self.possible])
        limit = CRITERIA.missed_stretch * sizes[seen & learnt].max()
        missed = np.flatnonzero(~seen & learnt & (sizes > limit))
        if not missed.size:
            return None
        worst = missed[np.argsort(-sizes[missed])][:MORE]
        return replace(self, chosen=[*self.chosen, *worst.tolist()])

    def in_words(self) -> str:
        """A sentence about what was searched."""
        some, everything = self.samples
        means = f", each the mean of {max(self.every)}" if max(self.every) > 1 else ""
        parts = (
            f", in {len(self.chosen)} stretches among which every kind of motion is"
            if self.possible
            else ""
        )
        return (
            f"The causes were searched for on {some} samples{means}{parts}; what was found was "
            f"fitted to all {everything}."
        )


def excerpts(given: Given) -> Excerpts | None:
    """Stretches to search on; None where the records are short.

    Raises
    ------
    ValueError
        Runs that cannot be split or do not move.
    """
    records = without_copies(given.records, given.holdout)
    total = sum(record.samples for record in records)
    if total <= CRITERIA.long_record:
        return None
    refuse_unusable(records)
    given.progress(f"{total} samples: choosing stretches to search on")
    rough = prepare(_evenly(records))
    rate = max(PER_PERIOD * rough.cutoff, LEAST_RATE)
    every = [max(1, int(record.sample_rate / rate)) for record in records]
    sizes = [_size(record, n) for record, n in zip(records, every, strict=True)]
    left = sum(record.samples // n for record, n in zip(records, every, strict=True))
    needed = FEWEST * max(size // n for size, n in zip(sizes, every, strict=True))
    if max(every) == 1 and needed > WORTH * total:
        return None
    runs = [thin(smooth(record, rough.cutoff, rough.channels)) for record in records]
    zeros = zeros_of(runs)
    runs = on_clocks(runs)
    parted = split(runs, given.holdout)
    held = [run.name for i, run in enumerate(runs) if parted.role(i) == "holdout"]
    found = Excerpts(
        whole=given, records=zeros.taken_off(records), holdout=held, constants=zeros.constants,
        contradicting=contradicting(runs), clocks=[run.clock for run in runs], every=every,
        spacings=[run.sample_spacing for run in runs],
    )  # fmt: skip
    if left <= CRITERIA.long_record or needed > WORTH * left:
        return found
    possible = _possible(runs, sizes, parted.holdout)
    count = max(FEWEST, round(FEWEST * CRITERIA.searched_samples / needed))
    chosen: list[int] = []
    for is_held, share in ((False, 1 - HELD), (True, HELD)):
        of_kind = np.array([i for i, s in enumerate(possible) if s.held == is_held])
        features = np.array([possible[i].features for i in of_kind])
        chosen += of_kind[_unlike(features, round(share * count))].tolist()
    return replace(found, possible=possible, chosen=chosen)


def _size(record: Record, every: int) -> int:
    """Samples that a stretch of a record has."""
    periods = int(PERIODS / dominant_frequency(record) * record.sample_rate)
    return min(max(SHORTEST * every, periods), record.samples)


def _evenly(records: Sequence[Record]) -> list[Record]:
    """Stretches spread evenly over all records, which tell a cut-off."""
    total, parts = sum(record.samples for record in records), []
    for record in records:
        size = _size(record, 1)
        count = max(1, round(CRITERIA.searched_samples * record.samples / total / size))
        begins = np.linspace(0, record.samples - size, count + 2).astype(int)[1:-1]
        part = Part(record.name, float(record.time[0]))
        parts += [_cut(record, begin, begin + size, part) for begin in begins]
    return parts


def _cut(record: Record, begin: int, end: int, part: Part) -> Record:
    channels, extra = (
        {name: values[begin:end] for name, values in each.items()}
        for each in (record.channels(), record.extra)
    )
    return replace(
        record, name=f"{record.name} from {record.time[begin]:.6g} s", part=part, extra=extra,
        time=record.time[begin:end], **channels,
    )  # fmt: skip


def _coarse(record: Record, every: int) -> Record:
    """Each sample the mean of several."""
    if every == 1:
        return record
    size = record.samples // every

    def mean(values: Array) -> Array:
        return values[: size * every].reshape(size, every).mean(axis=1)

    channels, extra = (
        {name: mean(values) for name, values in each.items()}
        for each in (record.channels(), record.extra)
    )
    return replace(record, time=mean(record.time), extra=extra, **channels)


def _possible(
    runs: Sequence[BenchRun],
    sizes: Sequence[int],
    held: Sequence[NDArray[np.bool_]],
) -> list[Stretch]:
    """Stretches side by side, none half held out; what the motion is not known of is left out."""
    features = _Features(runs)
    found = []
    for i, (run, size, out) in enumerate(zip(runs, sizes, held, strict=True)):
        step = run.thinned
        changes = np.flatnonzero(np.diff(out)) + 1
        last = out.size
        for first, after in zip([0, *changes], [*changes, last], strict=True):
            count = (after - first) * step // size
            if not count and not (first == 0 and after == last):
                continue
            width = min(size, (after - first) * step) // step
            for begin in np.linspace(first, after - width, max(count, 1)).astype(int):
                inside = slice(begin, begin + width)
                if np.mean(run.inner[inside]) > 0.5:
                    found.append(
                        Stretch(
                            run=i, begin=int(begin) * step, end=int(begin + width) * step,
                            held=bool(out[begin]), features=features.of(i, inside),
                        )
                    )  # fmt: skip
    return found


class _Features:
    """What tells stretches apart, each number of a size of about one."""

    def __init__(self, runs: Sequence[BenchRun]) -> None:
        self.runs = runs
        columns = [_plain(run) for run in runs]
        matrix = np.concatenate([c[run.inner] for c, run in zip(columns, runs, strict=True)])
        force = np.concatenate([run.force[run.inner] for run in runs])
        solved = np.linalg.lstsq(matrix, force, rcond=1e-9)[0]
        self.left = [run.force - c @ solved for run, c in zip(runs, columns, strict=True)]
        self.size = {
            name: _rms(np.concatenate([getattr(run, name)[run.inner] for run in runs])) or 1.0
            for name in ("displacement", "velocity", "acceleration", "force")
        }
        self.left_size = _rms(np.concatenate(self.left)) or 1.0

    def of(self, i: int, inside: slice) -> Array:
        run, found = self.runs[i], []
        known = run.inner[inside]
        x, v, a, force = (
            getattr(run, name)[inside][known] / size for name, size in self.size.items()
        )
        left = self.left[i][inside][known] / self.left_size
        for values in (x - np.mean(x), v, a, left):
            found.append(np.log2(_rms(values) + 1e-2))
        # what happens for a moment, and where
        found += [np.log2(np.max(np.abs(values)) + 1e-2) for values in (force, left)]
        found += [float(np.mean(x)), 0.5 * float(np.max(x)), 0.5 * float(np.min(x))]
        elapsed = run.elapsed[inside]
        return np.array([*found, 2.0 * float(np.mean(elapsed)) / (self._longest or 1.0)])

    @property
    def _longest(self) -> float:
        return max(float(run.elapsed[-1]) for run in self.runs)


def _plain(run: BenchRun) -> Array:
    v, a = run.velocity, run.acceleration
    way = np.tanh(v / (0.02 * _rms(v[run.inner]) or 1.0))
    return np.column_stack([a, v, np.ones_like(v), run.displacement, way])


def _unlike(features: Array, count: int) -> NDArray[np.intp]:
    """Numbers of `count` rows of features (n, m): half evenly, the others far from all before."""
    if len(features) <= count:
        return np.arange(len(features))
    half = (count + 1) // 2
    chosen = np.unique(np.linspace(0, len(features) - 1, half + 2)[1:-1].astype(int)).tolist()
    distance = np.min(
        [np.linalg.norm(features - features[i], axis=1) for i in chosen], axis=0
    )  # fmt: skip
    while len(chosen) < count:
        farthest = int(np.argmax(distance))
        chosen.append(farthest)
        away = np.linalg.norm(features - features[farthest], axis=1)
        distance = np.minimum(distance, away)
    return np.array(chosen)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0
