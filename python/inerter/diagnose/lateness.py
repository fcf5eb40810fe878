"""The search once more from a delay on, where what was found may stand in for one.

A force that is late looks like many other things until that is known: a shaft with much damping is
late and little else, and friction, curves and play take what a delay leaves at each reversal. With
the delay known from the first step on the search goes another way.
"""

from __future__ import annotations

from dataclasses import replace

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.candidates import candidates
from inerter.diagnose.decision import as_good, better
from inerter.diagnose.search import Scored, Search
from inerter.identify.channel_filter import filters_of

# damping ratio from which a shaft hardly swings; 1 is the aperiodic limit
_DAMPED = 0.3
# effects that were found before a delay, from which on they may be what it leaves
_BEFORE = 2
_LATE = ("sensor_delay", "sensor_filter")
# effects that take away the rigid drive of the flywheel
DRIVE = tuple(name for name, effect in EFFECTS.items() if effect.kind in ("play", "shaft"))


def from_delay_on(search: Search, final: Scored) -> Scored | None:
    """What the search finds from a delay on, where that says as much as what it found.

    Without a shaft or a play, where a damped shaft was found. None where nothing asks for it, or
    where what is found from there says less.
    """
    damped = _has_damped_shaft(final)
    late = min((search.found.index(each) for each in _LATE if each in search.found), default=0)
    if not (damped or late >= _BEFORE) or filters_of(search.baseline.values):
        return None
    sizes = search.problem.scales
    delays = [c for c in candidates(search.baseline, sizes) if c.effect == "sensor_delay"]
    if sizes.one_tone or not delays:
        return None
    search.progress("searching once more, from a delay on")
    excluded = frozenset({*search.excluded, *DRIVE}) if damped else search.excluded
    runs = [replace(run, shaft=None) for run in search.runs]
    again = replace(search, found=["sensor_delay"], excluded=excluded, runs=runs)
    found = again.run(again.trials.fit(delays[0]).model, until="backlash")
    other = search.score("exchange", None, search.problem.fit(found.model))
    if as_good(other, final, search.advantage(other, final, _LATE[0])):
        return other
    won = search.advantage(final, other, _LATE[0])
    if other.complexity <= final.complexity:
        return other if won > 0.0 and other.squares.sum() < final.squares.sum() else None
    return other if better(final, other, won) else None


def _has_damped_shaft(scored: Scored) -> bool:
    """Whether a shaft without play was found that hardly swings."""
    values = scored.model.values
    shaft = "series_frequency" in scored.model.free and "backlash" not in values
    return shaft and values["series_loss"] > _DAMPED
