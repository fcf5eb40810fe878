"""What the cases of a blind test say together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from inerter.blind_test.case import Named, Outcome, ParameterError
from inerter.blind_test.plan import VEHICLE, Plan, effects_on
from inerter.reference import HYSTERETIC_LAWS

SCHEMA = "inerter.blind_test/1"

# confidence from which a wrong finding counts as claimed
CLAIMED = 0.9
# edges of the bins in which confidence is held against what was right
BINS = (0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0)


def score(plan: Plan, outcomes: Sequence[Outcome], seconds: float = 0.0) -> dict[str, Any]:
    """The content of blind_test.json.

    Parameters
    ----------
    plan
        What was asked for.
    outcomes
        Every case's outcome.
    seconds
        Wall time of the whole test.
    """
    groups = {
        name: [one for one in outcomes if one.task.group == name]
        for name in ("single", "clean", "pairs", "triples", "unknown")
    }
    known = [one for one in outcomes if one.task.group != "unknown"]
    return {
        "schema": SCHEMA,
        "seed": plan.seed,
        "settings": {
            "effects": list(plan.effects),
            "count": plan.count,
            "clean": plan.clean,
            "pairs": plan.pairs,
            "triples": plan.triples,
            "unknown": plan.unknown,
            "noise": plan.noise,
            "displacement_noise": None if plan.bench == VEHICLE else 1e-4 * plan.noise,
            "bench": plan.bench,
        },
        "confusion": confusion(groups["single"] + groups["clean"]),
        "laws": laws(groups["single"]),
        "effects": {
            effect: single([one for one in groups["single"] if one.task.effects == (effect,)])
            for effect in plan.effects
            if any(one.task.effects == (effect,) for one in groups["single"])
        },
        "single": together(groups["single"]),
        "clean": clean(groups["clean"]),
        "pairs": several(groups["pairs"]),
        "triples": several(groups["triples"]),
        "unknown": unknown(groups["unknown"]),
        "calibration": calibration(known),
        "trust": trust(known),
        "gain_on_truth": gains(known),
        "seconds_per_case": times(outcomes),
        "seconds": seconds,
        "failures": [failure(one) for one in outcomes if is_failure(one)],
    }


def confusion(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Counts of hidden (rows) by first named (columns), "none" in both, "failed" as a column."""
    effects = effects_on(outcomes[0].task.bench) if outcomes else ()
    rows = [name for name in effects if any(name in one.task.effects for one in outcomes)]
    if any(one.task.group == "clean" for one in outcomes):
        rows.append("none")
    first = Counter((_hidden(one), one.first) for one in outcomes)
    others = sorted({name for _, name in first} - {*effects, "none", "failed"})
    columns = [n for n in effects if n in rows or any(c == n for _, c in first)]
    columns += [*others, "none"]
    if any(name == "failed" for _, name in first):
        columns.append("failed")
    return {
        "hidden": rows,
        "named": columns,
        "counts": [[first[row, column] for column in columns] for row in rows],
    }


def laws(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Hidden law of hysteretic friction by the law named, or "other" where it was not first."""
    hysteretic = [one for one in outcomes if one.task.effects == ("hysteretic_friction",)]
    found = Counter()
    for one in hysteretic:
        named = one.named[0].law if one.first == "hysteretic_friction" else None
        found[one.law, named if named in HYSTERETIC_LAWS else "other"] += 1
    columns = [*HYSTERETIC_LAWS, "other"]
    rows = [law for law in HYSTERETIC_LAWS if any(one.law == law for one in hysteretic)]
    counts = [[found[row, column] for column in columns] for row in rows]
    return {"hidden": rows, "named": columns, "counts": counts}


def single(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """One effect's cases."""
    return {**together(outcomes), "parameters": parameters(outcomes)}


def together(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Shares over cases with one effect; `alone`: named, and nothing else."""
    errors = [error for one in outcomes for error in one.parameters]
    return {
        "cases": len(outcomes),
        "named_first": _share([one.first in one.task.effects for one in outcomes]),
        "found": _share([set(one.task.effects) <= set(one.effects) for one in outcomes]),
        "alone": _share([one.effects == one.task.effects for one in outcomes]),
        "parameters_near": _share([error.near for error in errors]),
        "gain_on_truth": gains(outcomes),
        "seconds": times(outcomes),
    }


def parameters(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """For each parameter: relative errors, and the share within 5 % or 3 standard errors."""
    by_name: dict[str, list[ParameterError]] = {}
    for one in outcomes:
        for error in one.parameters:
            by_name.setdefault(error.name, []).append(error)
    result = {}
    for name, errors in by_name.items():
        sizes = [error.relative for error in errors if error.found is not None]
        result[name] = {
            "cases": len(errors),
            "not_reported": sum(error.found is None for error in errors),
            "median_error": _median(sizes),
            "worst_error": max(sizes, default=None),
            "near": _share([error.near for error in errors]),
        }
    return result


def clean(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Cases with nothing hidden."""
    return {
        "cases": len(outcomes),
        "without_findings": _share([one.first == "none" for one in outcomes]),
        "without_unexplained": _share(
            [one.error is None and not one.unexplained for one in outcomes]
        ),
        "invented": dict(Counter(name for one in outcomes for name in one.effects)),
    }


def several(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Cases with two or three effects."""
    hidden = [(set(one.task.effects), set(one.effects)) for one in outcomes]
    missed = Counter(name for these, found in hidden for name in these - found)
    return {
        "cases": len(outcomes),
        "all_found": _share([these <= found for these, found in hidden]),
        "any_found": _share([bool(these & found) for these, found in hidden]),
        "with_extras": _share([bool(found - these) for these, found in hidden]),
        "exact": _share([these == found for these, found in hidden]),
        "missed": dict(missed.most_common()),
        "extras": dict(Counter(n for these, found in hidden for n in found - these).most_common()),
    }


def unknown(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Cases whose effect has no name: every finding in them is wrong."""
    kinds = {}
    for kind in dict.fromkeys(one.task.kind for one in outcomes):
        kinds[kind] = _unknown([one for one in outcomes if one.task.kind == kind])
    return {**_unknown(outcomes), "kinds": kinds}


def _unknown(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    named = Counter(name for one in outcomes for name in one.effects)
    return {
        "cases": len(outcomes),
        "significant": _share([one.unexplained for one in outcomes]),
        "wrong_claim": _share([_claims(one) for one in outcomes]),
        "named": dict(named.most_common()),
    }


def trust(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """How far what is said can be relied on, over all cases with named effects or none.

    found: all that was hidden; nothing_false: every finding right, one that the bench brings and
    one that the data cannot tell from a right one among them; claims: findings with 0.9 or more
    but for those that describe what is there (`looks_like`); wrong_claims: of them; described,
    wrong_described: the same of those; cannot_tell: cases that were not found for what their motion
    cannot tell alone, as was said; covered: share of the true values within 2 standard errors.
    """
    sure = [
        (named.looks_like, one.is_right(named))
        for one in outcomes
        for named in one.named
        if named.confidence >= CLAIMED
    ]
    claims = [right for describes, right in sure if not describes]
    described = [right for describes, right in sure if describes]
    covered = [error.covered for one in outcomes for error in one.parameters]
    wrong = Counter(
        named.effect for one in outcomes for named in one.named if not one.is_right(named)
    )
    missed = Counter(name for one in outcomes for name in one.missed)
    return {
        "cases": len(outcomes),
        "found": _share([one.found for one in outcomes]),
        "cannot_tell": sum(one.is_beyond_the_motion for one in outcomes),
        "nothing_false": _share([one.nothing_false for one in outcomes]),
        "claims": len(claims),
        "wrong_claims": _share([not right for right in claims]),
        "described": len(described),
        "wrong_described": _share([not right for right in described]),
        "covered": _share([bool(each) for each in covered if each is not None]),
        "wrong": dict(wrong.most_common()),
        "missed": dict(missed.most_common()),
    }


def calibration(outcomes: Sequence[Outcome]) -> list[dict[str, Any]]:
    """Findings by confidence: how many there are and the share that was hidden; without unknown."""
    findings = [(named.confidence, one.is_right(named)) for one in outcomes for named in one.named]
    bins = []
    for lower, upper in pairwise(BINS):
        last = upper == BINS[-1]
        inside = [
            pair for pair in findings if lower <= pair[0] < upper or (last and pair[0] >= upper)
        ]
        bins.append(
            {
                "from": lower,
                "to": upper,
                "findings": len(inside),
                "confidence": float(np.mean([c for c, _ in inside])) if inside else None,
                "right": _share([right for _, right in inside]),
            }
        )
    return bins


def gains(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Share of the error against the noise-free held-out force that was taken away."""
    found = [one.gain for one in outcomes if one.gain is not None and one.task.group != "clean"]
    return {"median": _median(found), "worst": min(found, default=None)}


def times(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Seconds of a diagnosis on the wall and of the processor; the seed of the slowest."""
    if not outcomes:
        return dict.fromkeys(("median", "worst", "worst_seed", "processor_median"))
    slowest = max(outcomes, key=lambda one: one.seconds)
    return {
        "median": _median([one.seconds for one in outcomes]),
        "worst": slowest.seconds,
        "worst_seed": slowest.task.seed,
        "processor_median": _median([one.processor_seconds for one in outcomes]),
    }


def is_failure(one: Outcome) -> bool:
    """Not what was hidden: something else or more was named, or a claim made where none holds."""
    if one.error is not None:
        return True
    if one.task.group == "unknown":
        return not one.unexplained or _claims(one)
    return not (one.found and one.nothing_false)


def failure(one: Outcome) -> dict[str, Any]:
    """A case that went wrong, as the file lists it; its seed repeats it."""
    task = one.task
    return {
        "group": task.group,
        "seed": task.seed,
        "hidden": list(task.effects) or [task.kind or "none"],
        "law": one.law,
        "share": one.share,
        "truth": one.truth,
        "named": [_told(named) for named in one.named],
        "unexplained": one.unexplained,
        "error": one.error,
        "verdict": one.verdict,
    }


def _told(named: Named) -> dict[str, Any]:
    """A finding; without members where it has none, and without what it is not."""
    optional = ("members", "looks_like")
    return {name: value for name, value in vars(named).items() if value or name not in optional}


def _claims(one: Outcome) -> bool:
    """Whether a case without a named effect has a finding that claims to be sure of its cause."""
    return any(each.confidence >= CLAIMED and not each.looks_like for each in one.named)


def _hidden(one: Outcome) -> str:
    return one.task.effects[0] if one.task.effects else "none"


def _share(hits: Sequence[bool]) -> float | None:
    return float(np.mean(hits)) if hits else None


def _median(values: Sequence[float]) -> float | None:
    return float(np.median(values)) if len(values) else None
