"""What each effect of a vehicle adds to those before it, on samples that no fit has seen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.vehicle import KNOWN
from inerter.diagnose.decision import CRITERIA, visible
from inerter.diagnose.vehicle.judging import block_squares, stacked_blocks, won
from inerter.diagnose.vehicle.model import Added, VehicleModel
from inerter.diagnose.vehicle.problem import DrivenProblem
from inerter.diagnose.vehicle.search import VehicleScored, VehicleSearch

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Link:
    """One effect on top of those before it.

    before, after: errors per spread on held-out samples without and with it; squares: the same,
    squared, over blocks. seen_in_blocks: nothing held out reaches the effect, and these are of
    samples left out of the fitted runs. stands: whether it helps there, and visibly.
    """

    added: Added
    before: float
    after: float
    squares: tuple[Array, Array]
    seen_in_blocks: bool
    stands: bool


def chain_of(
    search: VehicleSearch,
    start: VehicleScored,
    final: VehicleScored,
    progress: Callable[[str], None],
) -> list[VehicleScored]:
    """The user's model, then one effect more at a time, up to the final model."""
    known = {step.chosen.model.effects: step.chosen for step in search.steps}
    known |= {final.model.effects: final, (): start}
    chain = [final]
    while chain[0].model.effects:
        wanted = chain[0].model.effects[:-1]
        before = known.get(wanted)
        if before is None:
            progress("measuring the gain of each effect")
            before = search.refit([search.without(chain[0], len(wanted))])[0]
        chain.insert(0, before)
    return chain


def links_of(
    held: DrivenProblem,
    fitted: DrivenProblem,
    chain: Sequence[VehicleScored],
    step_error: Callable[[VehicleModel], float],
) -> list[Link]:
    """Every effect of a chain on held-out road.

    Parameters
    ----------
    held, fitted
        What is held out, and what was learnt from.
    chain
        As `chain_of` gives it.
    step_error
        Of a model, how much of its error is its timestep's.
    """
    rows = held.stacked([scored.model for scored in chain])
    floor = held.noise(rows[-1])
    found = []
    for i in range(1, len(chain)):
        before, after = rows[i - 1], rows[i]
        effect, problem = chain[i].model.effects[-1].effect, held
        apart, left = held.error(after - before), held.error(after)
        local = effect in KNOWN and KNOWN[effect].local
        silent = local and not visible(float(np.hypot(left, apart)), left, floor, 1.0)
        least = 0.0
        if silent:
            # nothing held out goes there: samples left out of the other runs have to tell
            before, after, problem = chain[i - 1].rest, chain[i].rest, fitted
            least = CRITERIA.local_gain
        errors = problem.error(before), problem.error(after)
        numerical = errors[0] ** 2 - errors[1] ** 2 < (2 * step_error(chain[i - 1].model)) ** 2
        stands = (
            errors[1] < errors[0]
            and won(problem, before, after, effect, least) >= CRITERIA.confirming_advantage
            and visible(*errors, floor, 1.0)
            and not numerical
        )
        blocks = stacked_blocks(problem)
        found.append(
            Link(
                added=chain[i].model.effects[-1],
                before=errors[0],
                after=errors[1],
                squares=(block_squares(before, blocks), block_squares(after, blocks)),
                seen_in_blocks=silent,
                stands=stands,
            )
        )
    return found
