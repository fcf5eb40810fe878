"""A fit is followed as long as it may come down to what would be checked."""

from __future__ import annotations

import numpy as np
from inerter.diagnose.trials import MOST, STEPS, Pace


def ends(errors: np.ndarray, limit: float) -> int | None:
    """After how many evaluations a fit with these errors is given up, if it is."""
    pace = Pace(limit)
    given_up = (done for done, error in enumerate(errors, 1) if pace.hopeless(done, float(error)))
    return next(given_up, None)


def test_what_stands_still_above_the_limit_is_given_up_at_once() -> None:
    assert ends(np.full(MOST, 2.0), 1.0) == STEPS + 1
    assert ends(np.full(MOST, 0.9), 1.0) is None


def test_what_comes_down_is_followed(effects_seed: int) -> None:
    draw = np.random.default_rng(effects_seed)
    for _ in range(50):
        # to within the limit at half the evaluations there are, at a pace that slows down
        half, limit = MOST // 2, draw.uniform(0.5, 2.0)
        rate = draw.uniform(0.05, 0.3)
        errors = limit * (0.99 + 3 * np.exp(-rate * np.arange(MOST)))
        reached = np.flatnonzero(errors < limit)
        if reached.size and reached[0] < half:
            assert ends(errors, limit) is None
        slow = limit * (3 - 0.2 * np.arange(MOST) / MOST)
        assert ends(slow, limit) == STEPS + 1
