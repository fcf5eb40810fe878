"""A fit is followed as long as it may come down to what would be checked."""

from __future__ import annotations

import numpy as np
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.trials import MOST, PLAIN, STEPS, Pace, plain_beside, shortlist_of
from inerter.identify.fit import Fit
from inerter.identify.model import Model


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


def fitted(effect: str, added: int, error: float) -> tuple[Candidate, Fit]:
    """A candidate with so many coordinates more than one, and an rms error."""
    free = tuple(f"c{i}" for i in range(1 + added))
    model = Model("none", dict.fromkeys(free, 1.0), free)
    residual = [np.full(50, error)]
    return Candidate(effect, None, (model,)), Fit(model, residual, np.eye(len(free)), 1)


def test_plain_effects_are_asked_beside_curves_that_are_not_there() -> None:
    masks = [np.ones(50, dtype=bool)]
    curves = [fitted("position_force", 17, 1.0 + 0.001 * i) for i in range(9)]
    plain = [fitted(name, 1, 2.0 + i) for i, name in enumerate(("a", "b", "c", "d"))]
    level = fitted("coulomb_friction", 1, 9.0)
    worthy = [*curves, *plain, level]
    shortlist = shortlist_of(worthy, 1.0, masks)
    assert [c.effect for c, _ in shortlist] == ["position_force"] * 9
    first, then = plain_beside(shortlist, worthy, complexity=1)
    assert [c.effect for c, _ in first] == ["coulomb_friction"]
    assert [c.effect for c, _ in then] == ["a", "b", "c"][:PLAIN]
    # what was asked is not asked again
    assert plain_beside(worthy, worthy, complexity=1) == ([], [])
