"""How surely one model is better than another, by their errors on data left out."""

from __future__ import annotations

from collections.abc import Sequence

from numpy.typing import NDArray

from inerter.diagnose.composition import is_local
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.statistics import Array, advantage, block_squares, where_apart
from inerter.identify.split import Mask


def advantage_of(
    simple: Sequence[Array],
    rich: Sequence[Array],
    masks: Sequence[Mask],
    stretches: Sequence[tuple[int, NDArray]],
    effect: str,
    least: float = CRITERIA.local_gain,
) -> float:
    """`statistics.advantage` of residuals, over the stretches where the effect may show.

    What shows in few places has to take away at least a share of what is missed there.
    """
    if is_local(effect):
        stretches = where_apart(simple, rich, masks)
    before, after = block_squares(simple, stretches), block_squares(rich, stretches)
    if is_local(effect) and after.sum() > (1 - least) ** 2 * before.sum():
        return 0.0
    return advantage(before, after)
