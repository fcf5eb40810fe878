"""The search once more from a delay on, where a shaft was found that may stand in for one.

A shaft with much damping makes a force late and does little else. With a delay known from the first
step on the search goes another way: a damper beside such a shaft stands in for one with elasticity
behind a low-pass.
"""

from __future__ import annotations

from dataclasses import replace

from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import DRIVE, PLAYS
from inerter.diagnose.decision import as_good, better
from inerter.diagnose.search import Scored, Search
from inerter.identify.channel_filter import filters_of

# damping ratio from which a shaft hardly swings; 1 is the aperiodic limit
_DAMPED = 0.3


def from_delay_on(search: Search, final: Scored) -> Scored | None:
    """What the search finds from a delay on, where that says as much as what it found.

    Without a shaft or a play. None where no damped shaft was found, or where what is found from
    there says less.
    """
    if not _has_damped_shaft(final) or filters_of(search.baseline.values):
        return None
    sizes = search.problem.scales
    delays = [c for c in candidates(search.baseline, sizes) if c.effect == "sensor_delay"]
    if sizes.one_tone or not delays:
        return None
    search.progress("searching once more, from a delay on")
    excluded = frozenset({*search.excluded, *DRIVE})
    runs = [replace(run, shaft=None) for run in search.runs]
    again = replace(search, found=["sensor_delay"], excluded=excluded, runs=runs)
    found = again.run(again.trials.fit(delays[0]).model)
    other = search.score("exchange", None, search.problem.fit(found.model))
    if as_good(other, final, search.advantage(other, final, "sensor_delay")):
        return other
    won = search.advantage(final, other, "sensor_delay")
    if other.complexity <= final.complexity:
        return other if won > 0.0 and other.squares.sum() < final.squares.sum() else None
    return other if better(final, other, won) else None


def _has_damped_shaft(scored: Scored) -> bool:
    """Whether a shaft without play was found that hardly swings."""
    values = scored.model.values
    shaft = "series_frequency" in scored.model.free and PLAYS.isdisjoint(values)
    return shaft and values["series_loss"] > _DAMPED
