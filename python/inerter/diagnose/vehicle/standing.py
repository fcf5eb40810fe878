"""How surely an effect of a vehicle is what it is said to be, and what else it may be."""

from __future__ import annotations

from collections.abc import Sequence

from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.result import Rival
from inerter.diagnose.statistics import win_shares
from inerter.diagnose.vehicle.model import BENT, Added
from inerter.diagnose.vehicle.search import FALLING, PLAIN, Step, VehicleScored
from inerter.diagnose.vehicle.wording import EQUIVALENT


def step_of(steps: Sequence[Step], added: Added, final: VehicleScored) -> Step | None:
    """The step in which an effect of the final model was added.

    Of friction that took the place of a richer law's at the end, that one's, as a rival; of a bend
    that was drawn more sharply then, the bend's.
    """
    made = [(step, step.chosen.candidate.added) for step in steps if step.chosen.candidate]
    for step, own in made:
        if own == added:
            return step
    for step, own in made:
        if own.effect == added.effect == BENT and own.element == added.element:
            return step
        if (own.effect, added.effect) == (FALLING, PLAIN) and own.element == added.element:
            others = [step.chosen]
            for other in step.others:
                if other.candidate is not None and other.candidate.added.effect != PLAIN:
                    others.append(other)
            rows = [final.squares, step.before.squares, *(s.squares for s in others)]
            return Step(step.before, final, others, win_shares(rows))
    return None


def standing_of(step: Step | None, added: Added) -> tuple[float, list[Rival]]:
    """Confidence and rivals of an effect, from the step in which it was added."""
    if step is None:
        return 0.5, []
    confidence = float(step.shares[0])
    rivals = []
    for other, share in zip(step.others, step.shares[2:], strict=True):
        assert other.candidate is not None
        effect = other.candidate.added
        # another law or start of the same effect is no doubt about the effect
        if effect.effect == added.effect and effect.element == added.element:
            confidence += float(share)
        elif share >= CRITERIA.rival_kept:
            rivals.append(Rival(effect.effect, float(share), effect.law))
    twin = EQUIVALENT.get(added.effect)
    if twin:
        rivals.append(Rival(twin, min(confidence, 1.0)))
    return min(confidence, 1.0), sorted(rivals, key=lambda rival: -rival.confidence)
