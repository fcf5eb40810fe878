"""Each effect on data that no fit has seen."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from inerter.diagnose.chain import Link, Parts, chain_of, tone_link, weakest, with_what_was_dropped
from inerter.diagnose.composition import (
    DRIVE,
    effects_of,
)
from inerter.diagnose.data import Data
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.judge import Judge
from inerter.diagnose.play import jackknife
from inerter.diagnose.rivals import Standing
from inerter.diagnose.search import Scored
from inerter.diagnose.stages.searching import Searched
from inerter.diagnose.stages.settling import Settled, compared, identified, run_beyond_motion
from inerter.diagnose.tone import with_tone_above, with_tone_from_raw
from inerter.identify.fit import Fit


@dataclass(frozen=True, kw_only=True)
class Confirmed:
    """What stands on data that no fit has seen: the extended model, its effects one by one.

    `data` and `judge` are what its figures are of: more than was searched, where a record is long.
    """

    searched: Searched
    data: Data
    judge: Judge
    before: Fit
    fit: Fit
    chain: tuple[Link, ...]
    standings: Mapping[str, Standing]


def confirmed(start: Settled) -> Confirmed:
    """What helps on data that no fit has seen; the rest is dropped."""
    found, final = start.searched, start.final
    search, judge = found.search, found.judge
    progress = found.prepared.given.progress
    progress("measuring the gain of each effect")
    before_held_out = final.fit
    final, chain, dropped = _standing_on_held_out(found, final)
    standings = dict(start.standings)
    further = _searched_on(found, final, dropped, standings) if dropped and chain else None
    if further:
        progress("measuring the gain of each effect")
        more, links, _ = _standing_on_held_out(found, further[0])
        new = {link.effect for link in links} - {link.effect for link in chain}
        new -= {effect for effect in new if stands_in(further[1].get(effect), dropped)}
        if new and judge.rmse(more.model) < judge.rmse(final.model):
            final, chain, standings = more, links, further[1]
    # where nothing stands the baseline is left, fitted as it was
    fit, tone = _with_tone(found, final.fit if chain else start.before)
    if tone:
        link, confidence = tone
        chain.append(link)
        standings[link.effect] = Standing(confidence, [], None)
    if "backlash" in fit.model.free:
        progress("free play: how far other data would lead")
        spread = jackknife(search.problem, found.data.full.folds, fit.model)
        fit = replace(fit, covariance=fit.covariance + spread)
    else:
        progress("asking how far other choices of the analysis would lead")
        fit = with_what_was_dropped(found.covered(fit), before_held_out)
    return Confirmed(
        searched=found, data=found.data, judge=found.judge, before=start.before, fit=fit,
        chain=tuple(chain), standings=standings,
    )  # fmt: skip


def stands_in(standing: Standing | None, dropped: Collection[str]) -> bool:
    """Whether one of the effects dropped is likelier than the one that took its place."""
    return standing is not None and any(
        rival.effect in dropped and rival.confidence > standing.confidence
        for rival in standing.rivals
    )


def _standing_on_held_out(found: Searched, final: Scored) -> tuple[Scored, list[Link], set[str]]:
    """A model without the effects that the held-out data do not confirm; their chain; the others.

    What is left is fitted anew each time that one is dropped.
    """
    search, judge, baseline = found.search, found.judge, found.prepared.baseline
    parts = Parts(search, final.fit)
    chain = chain_of(search, judge, final.model, parts)
    dropped: set[str] = set()
    while weak := weakest(chain, judge, final.model):
        search.progress(f"{weak} is not confirmed on held-out data: dropped")
        dropped.add(weak)
        rest = [name for name, _ in effects_of(final.model, baseline) if name != weak]
        (fit,) = parts.of(final.model, [rest])
        final = search.score("", None, fit)
        chain = chain_of(search, judge, final.model, parts)
    return final, chain, dropped


def _searched_on(
    found: Searched, final: Scored, dropped: set[str], standings: Mapping[str, Standing]
) -> tuple[Scored, dict[str, Standing]] | None:
    """A model with further effects in the place of those dropped, which are compared with rivals.

    None where there are none, or the time is over. What has a shaft or a play was searched for with
    weights and data of its own, and is not taken further.
    """
    baseline = found.prepared.baseline
    if final.model.has_series or found.prepared.given.time.is_over():
        return None
    left = frozenset(name for name, _ in effects_of(final.model, baseline))
    search = replace(found.search, found=[], excluded=frozenset({*dropped, *DRIVE}))
    search.progress(f"searching on without {', '.join(sorted(dropped))}")
    known: Mapping[str, Standing] = {}
    if found.band.force_band and not search.problem.scales.one_tone:
        more, known = run_beyond_motion(search, final.model, len(dropped)), standings
    else:
        more = search.run(final.model, most=len(dropped))
    more = identified(search, baseline, more)
    search.kept = frozenset()
    if not dict(effects_of(more.model, baseline)).keys() - left:
        return None
    return compared(search, baseline, more, known=known)


def _with_tone(found: Searched, fit: Fit) -> tuple[Fit, tuple[Link, float] | None]:
    """The fit with its tone as the raw force has it, and one that the low-pass hides, if any."""
    learnt = found.data.learnt
    fit = with_tone_from_raw(learnt, fit)
    lowest = CRITERIA.tones_from * found.data.preparation.cutoff
    after = with_tone_above(found.data.witness, fit, lowest)
    if after is None:
        return fit, None
    link, confidence = tone_link(found.judge, fit, after)
    return (after, (link, confidence)) if link.stands else (fit, None)
