"""Doubt of findings that may only stand in for what remains unexplained.

A cause that is on no list is fitted by what comes nearest to it: slowly growing friction by Coulomb
and viscous friction, relaxation by hysteresis. Each of these predicts held-out data surely, and yet
is not there. What gives it away is the rest that stays, of a size like its own.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace

from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.result import Finding
from inerter.diagnose.statistics import taken_away
from inerter.motion_units import words

_LOOP = "hysteretic_friction"
# what the force of one period does not hold
_BESIDE_A_PERIOD = {"force_drift", "force_offset", "periodic_disturbance"}


def trust(finding: Finding, structure: float) -> float:
    """How surely an effect does not stand in for something else, 0 to 1.

    structure: rms of what is surely no noise and stays unexplained, in the unit of the errors.
    """
    square = explained(finding) ** 2
    doubt = (CRITERIA.even_doubt * structure) ** 2
    return square / (square + doubt) if doubt else 1.0


def explained(finding: Finding) -> float:
    """Rms of what an effect takes away from the held-out error, as it counts, in its unit."""
    if finding.takes is not None:
        return finding.takes
    return taken_away(finding.rmse_before, finding.rmse_after)


def _without_blows(finding: Finding) -> Finding:
    """A finding beside a play with what it takes away but for the blows, which hide that."""
    if finding.takes is None or finding.effect == "backlash":
        return finding
    newton = words(finding.motion, "N")
    return finding.remarked(
        f"But for the blows of the play it takes {finding.takes:.3g} {newton} away."
    )


def by_weight(findings: Sequence[Finding]) -> list[Finding]:
    """What explains most first; the share that an effect takes away depends on what went before."""
    return sorted(findings, key=explained, reverse=True)


def looks_like(finding: Finding, structure: float) -> bool:
    """Whether an effect describes what is there, and takes visibly less than all of it."""
    return structure > 0.0 and explained(finding) < CRITERIA.looks_like * structure


def reason(finding: Finding, structure: float) -> str:
    """Why an effect may stand in for something else, in a sentence; empty where it hardly may."""
    if not looks_like(finding, structure):
        return ""
    share = explained(finding) / structure
    return (
        f"It explains {share:.1f} times what stays unexplained, and may stand in for a cause that "
        "is not on the list."
    )


def doubted(finding: Finding, structure: float) -> Finding:
    """A finding with what remains unexplained considered."""
    finding = _without_blows(finding)
    confidence = trust(finding, structure) * finding.confidence
    evidence = f"{finding.evidence} {reason(finding, structure)}".strip()
    describes = looks_like(finding, structure)
    return replace(finding, confidence=confidence, evidence=evidence, looks_like=describes)


def with_own_value(finding: Finding, before: float, is_distinct: bool) -> Finding:
    """A finding, half as sure where its own value may be none.

    before: its confidence before counterparts were asked, which may have told that already;
    is_distinct: whether its value differs from none, as far as other choices of the analysis tell.
    Values of a hysteresis have no normal error: they change together, and its loop stays.
    """
    if is_distinct or finding.confidence < before or finding.effect == _LOOP:
        return finding
    return replace(
        finding,
        confidence=0.5 * finding.confidence,
        evidence=f"{finding.evidence} Its own value may be none.",
    )


def as_sure_as_its_value(finding: Finding, errors: float) -> Finding:
    """A finding, no surer than its own value differs from none by so many standard errors.

    Those hold what other choices of the analysis would change. Of a hysteresis see above.
    """
    most = math.erf(errors / math.sqrt(2.0))
    if finding.effect == _LOOP or errors <= CRITERIA.own_value or most >= finding.confidence:
        return finding
    told = f"Its own value differs from none by {errors:.1f} standard errors."
    return replace(finding, confidence=most, evidence=f"{finding.evidence} {told}")


def about_its_value(finding: Finding) -> str:
    """What its evidence says of how far its own value is from none; empty where nothing."""
    told = re.search(
        r"Its own value (may be none|differs from none by [\d.]+ standard errors)\.",
        finding.evidence,
    )
    return told[0] if told else ""


def of_one_sine(findings: Sequence[Finding]) -> list[Finding]:
    """Findings along one sine, where a few effects draw whatever the force does in a period.

    What goes with time alone, or is none of the motion, is told beside it.
    """
    drawing = [f for f in findings if not {f.effect, *f.members} & _BESIDE_A_PERIOD]
    if len(drawing) <= CRITERIA.effects_of_one_sine:
        return list(findings)
    told = (
        f"Along one sine {len(drawing)} effects can draw the force of a period in more than one "
        "way; a record at a second frequency would tell."
    )
    share = CRITERIA.effects_of_one_sine / len(drawing)
    return [
        replace(f, confidence=share * f.confidence, evidence=f"{f.evidence} {told}")
        if f in drawing
        else f
        for f in findings
    ]


def stand_ins(findings: Sequence[Finding], structure: float) -> list[Finding]:
    """Those that may only stand in for something else."""
    return [finding for finding in findings if trust(finding, structure) < CRITERIA.doubt_told]


def descriptions(findings: Sequence[Finding], structure: float) -> list[Finding]:
    """Those that look like what is there, and leave little of it."""
    doubtful = stand_ins(findings, structure)
    return [each for each in findings if looks_like(each, structure) and each not in doubtful]


def warning(names: Sequence[str]) -> str:
    """A sentence for a verdict about stand-ins; empty without any."""
    if not names:
        return ""
    return (
        f" Beside what {_listed(names)} {'explain' if names[1:] else 'explains'}, what stays "
        f"unexplained is large: {'they' if names[1:] else 'it'} may stand in for a cause that is "
        "not on the list."
    )


def note(names: Sequence[str]) -> str:
    """A sentence for a verdict about descriptions; empty without any."""
    if not names:
        return ""
    take = "they take" if names[1:] else "that takes"
    return (
        f" What is there looks like {_listed(names)}, and {take} less than all of it: another "
        "cause may look the same."
    )


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[:-1]) + (" and " if names[1:] else "") + names[-1]
