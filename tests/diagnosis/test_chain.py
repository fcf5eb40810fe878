"""Which effect of a chain is dropped next."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from inerter.diagnose.chain import (
    Link,
    Parts,
    helping_most,
    weakest,
    with_what_was_dropped,
)
from inerter.diagnose.judge import Judge
from inerter.diagnose.search import Search
from inerter.identify.fit import Fit
from inerter.identify.model import Model

BARE = Model("none", {"inertance": 80.0}, ("inertance",))
WHOLE = BARE.adding(viscous=100.0, backlash=1e-4)


def link(effect: str, stands: bool = True) -> Link:
    fit = Fit(BARE, [], np.zeros((1, 1)), 1)
    return Link(
        effect=effect,
        law=None,
        before=fit,
        after=fit,
        rmse_before=10.0,
        rmse_after=9.0,
        interval=None,
        seen_in_blocks=False,
        stands=stands,
    )


def judge(before: float, after: float) -> Judge:
    """One that finds these errors [N] without and with the effects."""
    return cast(Judge, SimpleNamespace(rmse=lambda m: after if m is WHOLE else before))


def test_the_last_effect_that_does_not_stand_is_dropped() -> None:
    chain = [link("viscous_friction", False), link("force_offset", False), link("backlash")]
    assert weakest(chain, judge(10.0, 5.0), WHOLE) == "force_offset"


@pytest.mark.parametrize(
    ("after", "dropped"), [(9.9, None), (10.0, "backlash"), (12.0, "backlash")]
)
def test_a_play_that_predicts_nothing_better_is_dropped(after: float, dropped: str | None) -> None:
    chain = [link("viscous_friction"), link("backlash")]
    assert weakest(chain, judge(10.0, after), WHOLE) == dropped


def test_a_play_may_stand_and_help_with_another_effect_alone() -> None:
    play = link("backlash")
    assert play.helps
    assert not replace(play, rmse_after=12.0).helps
    assert not link("viscous_friction", stands=False).helps


def test_only_a_play_can_predict_worse_and_stand() -> None:
    assert weakest([link("viscous_friction")], judge(10.0, 12.0), WHOLE) is None
    assert weakest([], judge(10.0, 10.0), WHOLE) is None


def test_errors_hold_what_an_unconfirmed_effect_would_move_a_value_by() -> None:
    model = BARE.adding(None, viscous=100.0, force_node_1=3.0)
    without = Fit(model, [], np.diag([0.1, 2.0, 0.5]) ** 2, 1)
    values = {**model.values, "viscous": 106.0, "force_node_1": 9.0, "force_drift": 0.2}
    before = Fit(Model("none", values, (*model.free, "force_drift")), [], np.zeros((4, 4)), 1)
    held = with_what_was_dropped(without, before)
    inertance, viscous, node = np.sqrt(np.diag(held.covariance))
    assert viscous == pytest.approx(np.hypot(2.0, 6.0))
    assert inertance == pytest.approx(0.1)
    # a node of another curve is another place
    assert node == pytest.approx(0.5)
    other = Fit(before.model.adding("coulomb", coulomb_force=3.0), [], np.zeros((5, 5)), 1)
    assert with_what_was_dropped(without, other) is without


@pytest.mark.parametrize(
    ("fitted", "left_out", "first"),
    [
        # what bends with more coefficients follows the fit data a little closer
        ({"viscoelasticity": 2.20, "hysteretic_friction": 2.25}, (2.6, 2.0), "hysteretic_friction"),
        ({"viscoelasticity": 2.20, "hysteretic_friction": 2.25}, (2.0, 2.6), "viscoelasticity"),
        # much more is not asked about
        ({"viscoelasticity": 1.20, "hysteretic_friction": 2.25}, (2.6, 2.0), "viscoelasticity"),
    ],
)
def test_the_main_cause_is_what_foretells_best(
    fitted: dict[str, float], left_out: tuple[float, float], first: str
) -> None:
    trials = [
        ((effect, None), Fit(BARE, [np.full(4, error)], np.zeros((1, 1)), 1))
        for effect, error in fitted.items()
    ]
    scores = [SimpleNamespace(squares=np.full(3, error**2)) for error in left_out]
    problem = SimpleNamespace(masks=[np.full(4, True)])
    search = cast(Search, SimpleNamespace(problem=problem, scores=lambda _: scores))
    (effect, _), _ = helping_most(search, trials)
    assert effect == first


def test_each_choice_of_effects_is_fitted_and_scored_once() -> None:
    baseline = BARE
    whole = BARE.adding(None, viscous=100.0, force_offset=3.0, stiffness=40.0)
    asked: list[tuple[str, ...]] = []

    def fit(model: Model) -> Fit:
        asked.append(model.free[1:])
        return Fit(model, [np.full(4, 1.0 + len(asked))], np.eye(len(model.free)), 1)

    def scores(fits: list[tuple[str, str | None, Fit]]) -> list[SimpleNamespace]:
        scored.append(len(fits))
        return [SimpleNamespace(effect=effect, fit=fit) for effect, _, fit in fits]

    scored: list[int] = []
    problem = SimpleNamespace(fit=fit, masks=[np.full(4, True)])
    search = cast(Search, SimpleNamespace(problem=problem, baseline=baseline, scores=scores))
    fitted = Fit(whole, [np.ones(4)], np.eye(4), 1)
    parts = Parts(search, fitted)
    # the whole is known
    names = ["viscous_friction", "force_offset", "parallel_stiffness"]
    assert parts.of(whole, [names]) == [fitted]
    assert not asked
    first = parts.of(whole, [names[:1], names[1:2], names[:2]])
    assert asked == [("viscous",), ("force_offset",), ("viscous", "force_offset")]
    again = parts.of(whole, [names[1::-1], names[2:]])
    assert again[0] is first[2]
    assert len(asked) == 4
    told = parts.scores([("a", None, first[0]), ("b", None, first[1])])
    assert [each.fit for each in told] == first[:2]
    more = parts.scores([("c", None, again[1]), ("b", None, first[1])])
    assert [each.fit for each in more] == [again[1], first[1]]
    assert scored == [2, 1]
