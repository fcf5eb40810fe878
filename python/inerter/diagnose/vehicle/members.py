"""Causes that the records of a vehicle cannot tell apart: told as one finding with its members.

A mass and a stiffness under one road, damping of a joint and of the strut beside it: where another
effect in the place of a finding does as well with no more parameters, nothing that was recorded
says which of them it is. Each member stands with the value that it would have.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from inerter.catalogue.vehicle import KNOWN
from inerter.diagnose.decision import does_as_well
from inerter.diagnose.result import Finding, ParameterValue
from inerter.diagnose.statistics import advantage
from inerter.diagnose.vehicle import wording
from inerter.diagnose.vehicle.model import Added
from inerter.diagnose.vehicle.search import VehicleScored
from inerter.diagnose.wording import value_in_words


def exchangeable(
    chosen: VehicleScored, added: Added, others: Sequence[VehicleScored]
) -> list[VehicleScored]:
    """Fits with another effect in the place of one that do as well with no more parameters.

    Parameters
    ----------
    chosen
        The model with the effect.
    added
        The effect.
    others
        Models that differ from it by another effect in its place.
    """
    found = []
    for other in others:
        assert other.candidate is not None
        effect = other.candidate.added
        if effect.effect == added.effect and effect.element == added.element:
            continue
        lost = advantage(other.squares, chosen.squares)
        plain = other.complexity <= chosen.complexity
        if plain and does_as_well(other, chosen, lost):
            found.append(other)
    return found


def with_members(
    finding: Finding, values: Sequence[tuple[Added, dict[str, ParameterValue]]]
) -> Finding:
    """A finding with what would do as well in its place, and the values that it would have."""
    if not values:
        return finding
    names = dict.fromkeys([finding.effect, *(added.effect for added, _ in values)])
    parameters = dict(finding.parameters)
    told = []
    for added, own in values:
        amounts = ", ".join(
            value_in_words(name.replace("_", " "), value) for name, value in own.items()
        )
        kind, _, place = added.element.partition(":")
        where = f" in {place or kind}"
        told.append(f"{wording.in_words(added.effect, added.law)}{where} ({amounts})")
        parameters |= {name: value for name, value in own.items() if name not in parameters}
    first = KNOWN.get(values[0][0].effect) or KNOWN.get(finding.effect)
    advice = f": {first.experiment}" if first is not None else ""
    text = (
        f" {' or '.join(told)} in its place would do as well: these records cannot tell them "
        f"apart{advice}."
    )
    members = tuple(names) if len(names) > 1 else ()
    return replace(
        finding, members=members, parameters=parameters, evidence=finding.evidence + text
    )
