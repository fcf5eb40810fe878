"""Parameters of a device from bench records: value, error, interval, and what is left open.

Every law is fitted to the runs that are not held out, from many starts; noise of the motion is
allowed for; laws are compared by their force error on the held-out data.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from threadpoolctl import threadpool_limits

from inerter.core import WORDS, Device, parameters
from inerter.identify.channel_filter import Filter, named
from inerter.identify.instants import at_instants, with_instants
from inerter.identify.law_fit import WORSE, Data, LawFit, prepared
from inerter.identify.laws import LAWS, FittedLaw, law_named
from inerter.identify.nested import contains
from inerter.identify.result import Identification, Identified
from inerter.identify.turns import needs_turns
from inerter.motion_units import one_motion
from inerter.parallel_steps import helped, parallel
from inerter.records import Record
from inerter.records.duplicates import without_copies
from inerter.records.preparation import prepare, refuse_unusable

Progress = Callable[[float, str], None]

LOSSES = ("linear", "soft_l1", "huber", "cauchy")
INTERVALS = ("profile", "normal")


# of what runs away on the way to a fit nothing has to be told
@np.errstate(over="ignore", invalid="ignore")
def identify(
    records: Sequence[Record],
    laws: Sequence[str] = LAWS,
    *,
    fixed: Mapping[str, float | str] | None = None,
    filters: Mapping[str, Filter] | None = None,
    holdout: Sequence[str] = (),
    loss: str = "linear",
    intervals: str = "profile",
    starts: int | None = None,
    progress: Progress = lambda share, text: None,
) -> Identification:
    """Fit laws to bench records.

    Parameters
    ----------
    records
        One or several runs; all of them are fitted together, but for copies of another (those with
        the warning `duplicate_record`), which are left out.
    laws
        What to fit, see `inerter.identify.laws`.
    fixed
        Parameters that are known, SI units.
    filters
        Low-passes that the channels "force" and "displacement" are known to have gone through.
    holdout
        Names of runs to judge on; by default the most typical one, or blocks of a single run.
    loss
        "linear", or one that lets outliers count less: "soft_l1", "huber", "cauchy".
    intervals
        "profile", or "normal" for 1.96 standard errors, which is quicker.
    starts
        Starting points of a search.
    progress
        Told the share that is done, and what is being done.

    Raises
    ------
    DeviceError
        An unknown law or parameter, or values that do not fit together.
    ValueError
        Records that cannot be used, an unknown loss or kind of interval.
    """
    if loss not in LOSSES:
        raise ValueError(f"loss {loss!r}: choose from {', '.join(LOSSES)}")
    if intervals not in INTERVALS:
        raise ValueError(f"intervals {intervals!r}: choose from {', '.join(INTERVALS)}")
    chosen = [law_named(name) for name in laws]
    known = dict(fixed or {})
    for name in known:
        if name not in (*parameters(), *WORDS):
            # says what it may have meant
            Device(**{name: known[name]})
    for channel, low_pass in (filters or {}).items():
        known |= named(channel, low_pass)
    one_motion(records)
    given, records = records, without_copies(records, holdout)
    refuse_unusable(records)
    with threadpool_limits(limits=1, user_api="blas"), helped():
        progress(0.0, "smoothing")
        preparation = prepare(records)
        data = prepared(records, preparation, holdout, known)
        followed = with_instants(records, preparation.motions, data.inerter, data.learnt)
        if followed is not records:
            records, preparation = followed, at_instants(followed, preparation)
            data = prepared(records, preparation, holdout, known)
        bristled = prepared(records, preparation, holdout, known, turns=True)

        def suited(law: FittedLaw) -> Data:
            return bristled if needs_turns(law, known) else data

        def fitted(simpler: Sequence[LawFit], law: FittedLaw) -> LawFit:
            return suited(law).fitted(law, loss, starts, simpler)

        found: list[LawFit] = []
        for now in _in_turn(chosen):
            progress(len(found) / len(chosen) / 2, ", ".join(law.name for law in now))
            found += parallel(partial(fitted, tuple(found)), now, _size)
        progress(0.5, "intervals")
        told = parallel(
            lambda each: suited(each.law).told(each, intervals), found, lambda each: _size(each.law)
        )
        results = [
            suited(each.law).identified(each, what) for each, what in zip(found, told, strict=True)
        ]
        progress(1.0, "done")
    if loss == "linear":
        results = [replace(each, worse_than=_worse_than(each, results)) for each in results]
    results.sort(key=lambda result: result.rmse)
    return Identification(tuple(given), tuple(results), preparation, data.parted)


def _size(law: FittedLaw) -> int:
    return len(law.linear) + len(law.starts)


def _in_turn(laws: Sequence[FittedLaw]) -> Iterator[list[FittedLaw]]:
    """Laws that know nothing of each other; simple ones first, as they give others a start."""
    waiting = sorted(laws, key=_size)
    while waiting:
        now = [
            law
            for i, law in enumerate(waiting)
            if not any(contains(law, each, limits=True) for each in waiting[:i])
        ]
        yield now
        waiting = [law for law in waiting if law not in now]


def _worse_than(told: Identified, others: Sequence[Identified]) -> tuple[str, ...]:
    """Simpler laws that explain the data fitted better."""
    law = law_named(told.law)
    return tuple(
        each.law
        for each in others
        if each.fit_rmse * WORSE < told.fit_rmse and contains(law, law_named(each.law), limits=True)
    )
