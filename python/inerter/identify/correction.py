"""A fit without the bias that noise gave it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.core import DeviceError
from inerter.identify.fit import Fit, Problem
from inerter.identify.model import Model
from inerter.identify.noise import NoiseEffect

Array = NDArray[np.float64]

# rise of the squared residual, per what the derivatives say it rises by and per the whole of it,
# up to which they are believed
_BELIEVED, _WHOLE = 2.0, 0.01


def allowed_for(
    problem: Problem, fit: Fit, jacobian: Array, noise: NoiseEffect, choices: Array
) -> tuple[Fit, Array]:
    """The fit without the bias of noise, its covariance whole; variance per naive variance.

    choices: what `moved_by_choices` says (p, p).
    """
    units = problem.units(fit.model)
    covariance = noise.covariance * np.outer(units, units)

    # what the residuals show beyond the channels' noise counts too
    shown, drawn = np.diag(fit.covariance), np.maximum(np.diag(covariance), 1e-300)
    more = np.sqrt(np.maximum(1.0, shown / drawn))
    known = (np.diag(noise.bias**2) + choices) * np.outer(units, units)
    covariance = covariance * np.outer(more, more) + known
    flat = problem.masked(fit.residual)
    naive = np.linalg.pinv(jacobian.T @ jacobian) * float(np.mean(flat**2))
    own = np.diag(naive) * units**2
    # a coordinate without effect has no variance of its own to compare with
    inflation = np.where(own > 0, np.diag(covariance) / np.where(own > 0, own, 1.0), 1.0)
    model = _moved(problem, fit, jacobian, -noise.bias)
    return replace(fit, model=model, covariance=covariance), inflation


def _moved(problem: Problem, fit: Fit, jacobian: Array, step: Array) -> Model:
    """The fitted model moved by a step, along those directions in which its derivatives hold.

    A direction that the data hardly determine carries a step without measure, which ends at bounds
    or where nothing is linear any more: with it all that the fit had found would be lost. What is
    known worst is left out first.
    """
    directions = np.linalg.svd(jacobian, full_matrices=False)[2]
    square = float(np.sum(problem.masked(fit.residual) ** 2))
    for count in range(len(directions), 0, -1):
        # all of them are the step itself
        part = directions[:count].T @ (directions[:count] @ step) if count < step.size else step
        said = float(np.sum((jacobian @ part) ** 2))
        try:
            model = problem.moved(fit.model, part)
            model.device()
            found = float(np.sum(problem.masked(problem.residual(model)) ** 2))
        except DeviceError:
            continue
        if found - square <= _BELIEVED * said + _WHOLE * square:
            return model
    return fit.model
