"""The stages of a diagnosis of bench records, each made of the one before and changed no more.

    Given -> Prepared -> Searched -> Settled -> Confirmed

prepare    smoothing; what is held out; the baseline
search     the effects that predict best, in the band in which the model found predicts best
settle     each effect against what else could explain the data
confirm    each effect on data that no fit has seen
"""

from __future__ import annotations

from inerter.diagnose.stages.confirming import Confirmed, confirmed
from inerter.diagnose.stages.searching import Searched, judge_of, search_in, searched, weighed_runs
from inerter.diagnose.stages.settling import Settled, compared, identified, settled

__all__ = [
    "Confirmed",
    "Searched",
    "Settled",
    "compared",
    "confirmed",
    "identified",
    "judge_of",
    "search_in",
    "searched",
    "settled",
    "weighed_runs",
]
