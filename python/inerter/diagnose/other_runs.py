"""What the choice of the held-out runs hides: fitted runs that are missed, other splits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.composition import effects_of
from inerter.diagnose.data import Data
from inerter.diagnose.excerpts import Excerpts
from inerter.diagnose.search import Search
from inerter.identify.fit import rms
from inerter.identify.information import TOO_MUCH, leverage
from inerter.identify.model import Model
from inerter.identify.split import may_be_held, split
from inerter.motion_units import TRANSLATION, Kind, words

Array = NDArray[np.float64]

# a fitted run is badly missed from so many times the error of the held-out data and the noise, and
# from this share of its own force on
TIMES = 2.0
SHARE = 0.1
# the share of a stretch of a long record, and how many are told
SHARE_OF_STRETCH, WORST = 0.05, 3
# parts of a run, of which one is missed so many times as much as what is held out: a blow, say
PARTS, TIMES_OF_PART = 10, 3.0


def badly_missed(data: Data, errors: Sequence[Array], noise: float) -> dict[str, float]:
    """Fitted runs that the extended model misses much more than what is held out: error [N].

    errors: measured minus predicted force of every run at the measured rate [N]; noise: rms [N].
    """
    held = rms(errors, data.raw.masks)
    found = {}
    for i, (run, error) in enumerate(zip(data.whole, errors, strict=True)):
        if data.split.role(i) == "holdout" or not run.inner.any() or len(data.whole) < 2:
            continue
        missed = rms([error], [run.inner])
        spread = float(np.std(run.force[run.inner]))
        if missed > TIMES * max(held, noise) and missed > SHARE * spread:
            found[run.name] = missed
    return found


def badly_missed_parts(data: Data, errors: Sequence[Array], noise: float) -> dict[str, float]:
    """The same of tenths of runs of which something is fitted, the worst ones.

    What happens once is in no other part, so that no cause of it can be confirmed.
    """
    held = rms(errors, data.raw.masks)
    found = {}
    for i, (run, error) in enumerate(zip(data.whole, errors, strict=True)):
        seen = np.flatnonzero(run.inner & ~data.full.holdout[i])
        if seen.size < PARTS:
            continue
        least = max(TIMES_OF_PART * max(held, noise), SHARE * float(np.std(run.force[seen])))
        for part in np.array_split(seen, PARTS):
            missed = float(np.sqrt(np.mean(error[part] ** 2)))
            if missed > least:
                worst = part[np.argmax(np.abs(error[part]))]
                found[f"{run.name} about {run.time[worst]:.4g} s"] = missed
    return dict(sorted(found.items(), key=lambda each: -each[1])[:WORST])


def badly_missed_stretches(
    long: Excerpts, errors: Sequence[Array], held: float, noise: float
) -> dict[str, float]:
    """The same of fitted stretches of long records, the worst ones: something happened there.

    held: error of what is held out [N].
    """
    found = {}
    for stretch in long.possible:
        rows, record = long.rows(stretch), long.records[stretch.run]
        missed = float(np.sqrt(np.mean(errors[stretch.run][stretch.begin : stretch.end] ** 2)))
        if (
            not stretch.held
            and missed > TIMES * max(held, noise)
            and missed > SHARE_OF_STRETCH * float(np.std(record.force[rows]))
        ):
            first, last = record.time[rows][[0, -1]]
            found[f"{record.name} from {first:.4g} to {last:.4g} s"] = missed
    return dict(sorted(found.items(), key=lambda each: -each[1])[:WORST])


def missed_in_words(found: dict[str, float], held: float, motion: Kind = TRANSLATION) -> str:
    """A sentence about runs that are badly missed; empty where there are none."""
    if not found:
        return ""
    newton = words(motion, "N")
    runs = " and ".join(f"{name} by {error:.3g} {newton} rms" for name, error in found.items())
    return (
        f"Held-out data are met to {held:.3g} {newton} rms, but not all that was fitted: the "
        f"extended model misses {runs}."
    )


def tells_alone(data: Data) -> float:
    """Largest share that the held-out runs have in what all runs tell of any combination."""
    if len(data.runs) < 2 or data.split.in_blocks:
        return 0.0
    known = leverage(data.runs)
    return float(max(known[i] for i in range(len(known)) if data.split.role(i) == "holdout"))


def other_split(search: Search, data: Data, final: Model, doubt: bool) -> tuple[str, str] | None:
    """Another run to hold out, and the effect that would be found then besides; None: neither.

    One more step of the search is made, where `doubt` says that a fitted run is badly missed, or
    where what is held out alone tells something.
    """
    held = [i for i in range(len(data.runs)) if data.split.role(i) == "holdout"]
    if len(data.runs) < 2 or data.split.in_blocks or not (doubt or tells_alone(data) > TOO_MUCH):
        return None
    known = leverage(data.runs)
    sizes = [int(run.inner.sum()) for run in data.runs]
    others = [int(i) for i in may_be_held(sizes) if i not in held]
    if not others:
        return None
    name = data.runs[min(others, key=lambda i: known[i])].name
    again = Search(
        search.runs, split(search.runs, [name]), search.baseline, search.progress,
        witness=search.witness, one_tone=search.one_tone, never=search.never,
    )  # fmt: skip
    effect = again.next_effect(final)
    present = [found for found, _ in effects_of(final, search.baseline)]
    return (name, effect) if effect and effect not in present else None


def split_in_words(data: Data, other: tuple[str, str] | None) -> str:
    """A sentence about another split; empty where that would change nothing."""
    if other is None:
        return ""
    name, effect = other
    held = " and ".join(data.held)
    return (
        f"Held out is {held}: with {name} held out instead, {EFFECTS[effect].plain} would be "
        f"added. Try --holdout {name}."
    )


def swapped_in_words(data: Data, name: str, effect: str) -> str:
    """A sentence about a run that is held out in the place of the usual one."""
    usual = " and ".join(data.held)
    return (
        f"{usual} would be held out by default, and would take {EFFECTS[effect].plain} away with "
        f"it: {name} is held out instead."
    )
