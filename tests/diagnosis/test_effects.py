"""The catalogue of effects, its table in the docs, and where an effect is judged."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.statistics import advantage, block_squares, where_apart, win_shares
from inerter.identify.split import blocks

DOCS = Path(__file__).parents[2] / "docs" / "diagnosis.md"


def rows() -> dict[str, list[str]]:
    """Rows of the table of effects: name to cells."""
    found = re.findall(r"^\| `(\w+)` \|(.*)\|$", DOCS.read_text(), re.MULTILINE)
    return {name: [cell.strip() for cell in rest.split("|")] for name, rest in found}


@pytest.mark.parametrize("name", EFFECTS)
def test_docs_say_what_the_catalogue_says(name: str) -> None:
    assert name in rows(), f"{name}: no row in the table of docs/diagnosis.md"
    effect, row = EFFECTS[name], rows()[name]
    assert effect.cause in row
    assert f"{effect.taken_for}: {effect.experiment}" in row
    assert set(effect.rivals) <= EFFECTS.keys() - {name}


def test_an_effect_in_one_place_is_judged_there() -> None:
    random = np.random.default_rng(3)
    masks = [np.ones(5000, bool), np.ones(4000, bool)]
    right = [random.standard_normal(mask.size) for mask in masks]
    wrong = [values.copy() for values in right]
    wrong[1][2000:2200] += 6.0
    stretches = where_apart(wrong, right, masks)
    places = np.concatenate([index for _, index in stretches])
    assert {run for run, _ in stretches} == {1}
    assert places.min() >= 2000
    assert places.max() < 2200
    everywhere = blocks(masks)

    def gain(over: list) -> float:
        return advantage(block_squares(wrong, over), block_squares(right, over))

    assert gain(stretches) > 3 * gain(everywhere)


def test_a_handicap_is_counted_in_standard_errors() -> None:
    """A model that is better by two standard errors wins, with a handicap of four it does not."""
    random = np.random.default_rng(4)
    first = 10 + random.standard_normal(48)
    spread = random.standard_normal(48)
    other = first - 2 * np.std(spread, ddof=1) / np.sqrt(48) + spread - spread.mean()
    assert win_shares([first, other])[1] > 0.9
    assert win_shares([first, other], [0.0, 4.0])[1] < 0.1


def test_a_model_whose_error_has_no_end_wins_nothing() -> None:
    first = np.random.default_rng(1).chisquare(5, 48)
    for end in (np.inf, np.nan):
        away = first.copy()
        away[7] = end
        assert win_shares([first, 4 * first, away]).tolist() == [1, 0, 0]
        assert win_shares([away, 4 * first, first], [0.0, 0.0, 4.0]).tolist() == [0, 0, 1]
        assert win_shares([away, away]).tolist() == [0, 0]
