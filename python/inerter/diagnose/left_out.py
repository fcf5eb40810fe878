"""Errors of fitted models on folds of the data that their refits have not seen."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.statistics import Array
from inerter.diagnose.trials import ROUGH
from inerter.identify.fit import Fit, Limits, Near, Problem
from inerter.identify.split import Mask
from inerter.parallel_steps import parallel

Folds = Sequence[tuple[Problem, list[Mask]]]
"""The data without a fold, and the fold; of each."""

# coordinates of what shows in few places
_LOCAL = {
    name
    for effect in EFFECTS.values()
    if effect.local and effect.kind != "play"
    for name in effect.coordinates
}
# evaluations of a refit at most
_EVALUATIONS = 12


def left_out_errors(
    problem: Problem, folds: Folds, fits: Sequence[Fit]
) -> list[tuple[Fit, list[Array]]]:
    """Of every fit its errors on the folds [N], each of a refit without it; 0 elsewhere.

    Of one with nothing to refit its errors everywhere. A rough fit is told its covariance.
    """
    ready = parallel(lambda fit: _with_derivatives(problem, fit), fits)
    # one after another, so that none waits for a slow one
    tasks = [(*pair, k) for pair in ready for k in range(len(folds)) if pair[0].model.free]

    def errors(task: tuple[Fit, Array, int]) -> list[Array]:
        fit, derivatives, k = task
        without = folds[k][0]
        refit = without.fit(
            fit.model, _EVALUATIONS, tolerance=ROUGH, rough=True, near=Near(derivatives, ()),
            within=_around(problem, fit),
        )  # fmt: skip
        return without.errors(refit.model)

    found = iter(parallel(errors, tasks))
    results = []
    for fit, _ in ready:
        if not fit.model.free:
            results.append((fit, problem.errors(fit.model)))
            continue
        left_out = [np.zeros(run.force.size) for run in problem.runs]
        for _, fold in folds:
            for target, values, mask in zip(left_out, next(found), fold, strict=True):
                target[mask] = values[mask]
        results.append((fit, left_out))
    return results


def _with_derivatives(problem: Problem, fit: Fit) -> tuple[Fit, Array]:
    """A fit with its covariance, and the derivatives at its end."""
    if not fit.model.free:
        return fit, np.empty((0, 0))
    derivatives = problem.derivatives(fit.model)
    return problem.told(fit, derivatives) if fit.rough else fit, derivatives


def _around(problem: Problem, fit: Fit) -> Limits | None:
    """Limits of a refit's search variables, about a fit to everything.

    What shows in few places is not known where a fold leaves these out, and what it touches besides
    would lead it anywhere. None where there is nothing of the kind.
    """
    local = [name in _LOCAL for name in fit.model.free]
    if not any(local):
        return None
    errors = np.sqrt(np.maximum(np.diag(fit.covariance), 0.0)) / problem.units(fit.model)
    reach = np.where(local, CRITERIA.refit_reach * errors, np.inf)
    here = problem.variables(fit.model).encode(fit.model.values)
    return here - reach, here + reach
