"""A formula for what remains, by sparse regression; a proposal and not a cause.

Two paths lead through the library: sequentially thresholded least squares (terms whose share of the
force is below a threshold go, the rest is fitted again: Brunton, Proctor, Kutz 2016, PNAS 113,
3932) and forward selection, which does better where columns are much alike. Of all sets met the
one is taken that predicts the folds left out best, with as few terms as do nearly as well. What it
predicts of the held-out data is said with it.

PySINDy has the first of these; it was looked at, and would bring scikit-learn along for few lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.motion_units import Kind, words

from .battery import Remainder
from .learning import FOLDS, Samples, chance, share
from .library import Term, library

Array = NDArray[np.float64]

NOTE = "a proposal by regression, not a cause"
# shares of the residual's rms below which thresholding drops a term
THRESHOLDS = (0.05, 0.1, 0.2, 0.4)
MOST_TERMS = 5
# error power by which a term more has to lower what is left out
WORTH = 0.06
# what a proposal has to predict of the power of data left out, on all and on held-out data, and how
# surely
REQUIRED_SHARE = 0.2
REQUIRED_CHANCE = 1e-3


class _Regression:
    """Least squares on subsets of a library by its Gram matrices, one per fold."""

    def __init__(self, data: Samples, terms: Sequence[Term]) -> None:
        self.data, self.terms = data, terms
        blocks = [term.columns for term in terms]
        self.owner = np.repeat(np.arange(len(terms)), [block.shape[1] for block in blocks])
        matrix = np.column_stack(blocks)
        self.size = np.sqrt(np.mean(matrix**2, axis=0)) + 1e-300
        self.matrix = matrix / self.size
        self.rms = float(np.sqrt(data.power))
        self.grams, self.rights, self.squares = [], [], []
        for k in range(FOLDS + 1):
            part = data.fold == k
            self.grams.append(self.matrix[part].T @ self.matrix[part])
            self.rights.append(self.matrix[part].T @ data.residual[part])
            self.squares.append(float(data.residual[part] @ data.residual[part]))
        self.known: dict[frozenset[int], float] = {}

    def columns(self, chosen: frozenset[int]) -> NDArray[np.intp]:
        """Indices of the columns of some terms."""
        return np.flatnonzero(np.isin(self.owner, list(chosen)))

    def weights(self, chosen: frozenset[int], folds: Sequence[int]) -> Array:
        """Coefficients of scaled columns learnt on some folds."""
        c = self.columns(chosen)
        gram = np.sum([self.grams[k] for k in folds], axis=0)[np.ix_(c, c)]
        right = np.sum([self.rights[k] for k in folds], axis=0)[c]
        # a term may be 0 all over some folds
        ridge = 1e-9 * np.trace(gram) or 1.0
        return np.linalg.solve(gram + ridge * np.eye(c.size), right)

    def error(self, chosen: frozenset[int]) -> float:
        """Share of the fit data's power that is left when each fold is predicted by the others."""
        if not chosen:
            return 1.0
        if chosen not in self.known:
            c = self.columns(chosen)
            left, folds = 0.0, range(1, FOLDS + 1)
            for k in folds:
                w = self.weights(chosen, [j for j in folds if j != k])
                gram = self.grams[k][np.ix_(c, c)]
                left += self.squares[k] - 2 * w @ self.rights[k][c] + w @ gram @ w
            self.known[chosen] = float(left / max(sum(self.squares[1:]), 1e-300))
        return self.known[chosen]

    def thresholded(self, threshold: float) -> frozenset[int]:
        """Sequentially thresholded least squares."""
        chosen = frozenset(range(len(self.terms)))
        folds = range(1, FOLDS + 1)
        for _ in range(10):
            w, c = self.weights(chosen, folds), self.columns(chosen)
            large = np.abs(w) >= threshold * self.rms
            kept = frozenset(self.owner[c[large]].tolist())
            if kept == chosen or not kept:
                return kept
            chosen = kept
        return chosen

    def forward(self) -> frozenset[int]:
        """One term after another as long as what is left out is predicted better."""
        chosen: frozenset[int] = frozenset()
        while len(chosen) < MOST_TERMS:
            left = [i for i in range(len(self.terms)) if i not in chosen]
            best = min(left, key=lambda i: self.error(chosen | {i}))
            if self.error(chosen | {best}) > (1 - WORTH) * self.error(chosen):
                return chosen
            chosen |= {best}
        return chosen

    def pruned(self, chosen: frozenset[int]) -> frozenset[int]:
        """Without the terms that are hardly missed, and of no more than the most terms."""
        while chosen:
            least = min(chosen, key=lambda i: self.error(chosen - {i}))
            rest = chosen - {least}
            hardly = self.error(rest) * (1 - WORTH) <= self.error(chosen)
            if not hardly and len(chosen) <= MOST_TERMS:
                return chosen
            chosen = rest
        return chosen


def propose(remainder: Remainder, periods: dict[str, float]) -> dict[str, Any] | None:
    """The formula that predicts the residual best, or None where none predicts held-out data.

    Parameters
    ----------
    remainder : Remainder
        What is to be explained.
    periods : dict
        Lengths [m] of the periods found along the stroke, see `library`.

    Returns
    -------
    dict, optional
        "text", "terms" (each with "term", "coefficient", "stderr", "unit"; x, v, a in SI units, t
        in seconds, F the simulated force), "share" of the held-out residual's power, "note".
    """
    data = remainder.data
    regression = _Regression(data, library(remainder, periods))
    starts = [regression.thresholded(threshold) for threshold in THRESHOLDS]
    found = {regression.pruned(start) for start in [*starts, regression.forward()] if start}
    found.discard(frozenset())
    if not found:
        return None
    best = min(regression.error(chosen) for chosen in found)
    near = [chosen for chosen in found if regression.error(chosen) <= best * (1 + 2 * WORTH)]
    chosen = min(near, key=lambda terms: (len(terms), regression.error(terms)))
    return _judged(regression, chosen, remainder.runs[0].motion)


def _judged(regression: _Regression, chosen: frozenset[int], motion: Kind) -> dict[str, Any] | None:
    data = regression.data
    c = regression.columns(chosen)
    matrix = regression.matrix[:, c]
    values = np.zeros(data.residual.size)
    for k in range(FOLDS + 1):
        part = data.fold == k
        learnt = [j for j in range(1, FOLDS + 1) if j != k]
        values[part] = matrix[part] @ regression.weights(chosen, learnt)
    held = data.fold == 0
    shares = share(data.residual, values), share(data.residual[held], values[held])
    p = chance(data.residual, values, data.stretch)
    if min(shares) < REQUIRED_SHARE or p > REQUIRED_CHANCE:
        return None
    weights = regression.weights(chosen, range(1, FOLDS + 1))
    errors = _errors(matrix, data.residual - matrix @ weights, data)
    rows = _rows(regression, c, weights, errors)
    text = "F += " + _joined([_shown(row) for row in rows]) + f" {words(motion, 'N')}"
    return {"text": text, "terms": rows, "share": shares[1], "note": NOTE}


def _errors(matrix: Array, left: Array, data: Samples) -> Array:
    """Standard errors (m,), robust against residuals that are correlated within stretches."""
    learnt = data.fold > 0
    count = int(data.stretch.max()) + 1
    scores = np.column_stack(
        [
            np.bincount(data.stretch[learnt], column[learnt] * left[learnt], count)
            for column in matrix.T
        ]
    )
    bread = np.linalg.pinv(matrix[learnt].T @ matrix[learnt])
    return np.sqrt(np.maximum(np.diag(bread @ (scores.T @ scores) @ bread), 0))


def _rows(
    regression: _Regression, c: NDArray[np.intp], weights: Array, errors: Array
) -> list[dict[str, Any]]:
    """Terms with coefficients in SI units, the largest force first."""
    rows = []
    for i in dict.fromkeys(regression.owner[c].tolist()):
        term = regression.terms[i]
        at = np.flatnonzero(regression.owner[c] == i)
        value, error = weights[at] / regression.size[c[at]], errors[at] / regression.size[c[at]]
        force = float(np.linalg.norm(weights[at]))
        if len(at) == 2:
            amplitude, phase = float(np.hypot(*value)), float(np.arctan2(value[1], value[0]))
            text = term.text[:-1] + f" {'+' if phase >= 0 else '-'} {abs(phase):.2f})"
            spread = float(np.hypot(*(value * error)) / max(amplitude, 1e-300))
            rows.append((force, text, amplitude, spread, term.unit))
        else:
            rows.append((force, term.text, float(value[0]), float(error[0]), term.unit))
    rows.sort(key=lambda row: -row[0])
    return [
        {"term": text, "coefficient": value, "stderr": error, "unit": unit}
        for _, text, value, error, unit in rows
    ]


def _shown(row: dict[str, Any]) -> str:
    return f"{row['coefficient']:.3g}" + ("" if row["term"] == "1" else f" {row['term']}")


def _joined(parts: Sequence[str]) -> str:
    text = parts[0]
    for part in parts[1:]:
        text += f" - {part[1:]}" if part.startswith("-") else f" + {part}"
    return text
