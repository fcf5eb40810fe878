"""What a diagnosis is asked, and what it starts from: records smoothed and divided, a baseline."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from inerter.core import Device
from inerter.diagnose.baseline import baseline_of
from inerter.diagnose.budget.carried import Carrying
from inerter.diagnose.clipping import apart_from, limits_of
from inerter.diagnose.clock_rate import ClockRate
from inerter.diagnose.data import Data, divided
from inerter.diagnose.run_constants import contradicting, zeros_of
from inerter.diagnose.time_limit import TimeLimit
from inerter.identify.instants import at_instants, with_instants
from inerter.identify.model import Model
from inerter.identify.runs import thin
from inerter.records import Record
from inerter.records.duplicates import without_copies
from inerter.records.preparation import Preparation, prepare, refuse_unusable, weighed

Progress = Callable[[str], None]


@dataclass(frozen=True, kw_only=True)
class Given:
    """What a diagnosis is asked.

    Attributes
    ----------
    records
        All runs, copies of others among them.
    device
        The user's own; None: the ideal inerter with unknown inertance.
    holdout
        Names of runs to hold out.
    progress
        Told what is being done, a line each.
    channel
        What is known of the force channel, as coordinates: its `delay` [s], low-passes (see
        `identify.channel_filter`).
    carry
        What the extended device may carry without a name.
    left_out
        What of the records was left out before, in a sentence.
    time
        How long to search.
    scales
        Scales that were taken off the forces of runs, and their standard errors.
    clock
        How fast the clock of the force was, which it is on no more.
    """

    records: Sequence[Record]
    device: Device | None = None
    holdout: Sequence[str] = ()
    progress: Progress = lambda text: None
    channel: Mapping[str, float] = field(default_factory=dict)
    carry: Carrying = "any"
    left_out: str = ""
    time: TimeLimit = field(default_factory=TimeLimit)
    scales: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    clock: ClockRate | None = None


@dataclass(frozen=True, kw_only=True)
class Prepared:
    """Records divided, and where the search starts.

    Attributes
    ----------
    data
        In the band in which a broad linear model predicts all the data best.
    plain, weighed
        In that in which it predicts the fit data best; the same where errors count by the motion's
        noise.
    baseline
        The ideal inerter, or what the user states.
    constants
        Of each run, taken off its force [N]; empty where the runs have none of their own.
    contradicting
        Runs that contradict the others, with what they say.
    """

    given: Given
    data: Data
    plain: Preparation
    weighed: Preparation
    baseline: Model
    constants: Mapping[str, float] = field(default_factory=dict)
    contradicting: Mapping[str, str] = field(default_factory=dict)


def prepared(given: Given) -> Prepared:
    """Smoothed and divided records, and the baseline.

    Raises
    ------
    ValueError
        Runs that cannot be split or do not move.
    """
    parts = any(record.part for record in given.records)
    records = given.records if parts else without_copies(given.records, given.holdout)
    refuse_unusable(records)
    given.progress("smoothing: choosing the cut-off")
    smoothed = prepare(records)
    runs = apart_from(limits_of(records), [thin(motion) for motion in smoothed.motions])
    zeros = zeros_of(runs)
    taken = zeros.taken_off(records)
    if taken is not records:
        records, smoothed = taken, prepare(taken)
    data = divided(records, smoothed, given.holdout)
    # what is held out has no say in the smoothing of what is fitted: its own motion may be faster,
    # and is smoothed as the force that it makes tells
    plain = prepare(records, data.full.fit)
    baseline = baseline_of(given.device, data.band.scales)
    baseline = baseline.holding(**{name: v for name, v in given.channel.items() if v})
    followed = with_instants(records, plain.motions, baseline, data.full.fit)
    if followed is not records:
        records, plain = followed, at_instants(followed, plain)
        in_blocks = data.split.in_blocks
        data = divided(records, at_instants(followed, smoothed), given.holdout, in_blocks)
    return Prepared(
        given=given, data=data, plain=plain, baseline=baseline,
        weighed=weighed(records, plain, data.full.fit),
        constants=zeros.constants, contradicting=contradicting(runs),
    )  # fmt: skip
