"""Which parameters the data cannot tell apart, and which combinations of them they can.

The information that the data hold on the logarithms of the parameters has directions in which next
to nothing changes: along them parameters make up for each other. What is determined is a product of
powers, such as coulomb_force^1 bristle_stiffness^-1, or locally a sum. Directions are taken as not
determined where moving along them by a factor of about e^(1/2) costs no more than noise does.

Source: profile of the Fisher information in logarithms; the basis of the determined combinations is
the reduced row echelon form, which keeps them short.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import NOT_OF_DEVICE, NUISANCES
from inerter.core import DeviceError, parameters
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.prediction import force_along

Array = NDArray[np.float64]

_STEP = 1e-4
# a direction known worse than this (logarithm) is not determined
UNKNOWN = 0.5
# largest error (logarithm) that is told from a larger one
_WORST = 10.0


@dataclass(frozen=True)
class Combination:
    """What the data do determine of parameters that they cannot tell apart.

    `expression` in the parameters' names; its `value` (SI units) and relative standard error.
    """

    expression: str
    value: float
    relative_error: float


@dataclass(frozen=True)
class Identifiability:
    """`groups` of parameters that cannot be told apart, and the `combinations` that are known."""

    groups: tuple[tuple[str, ...], ...]
    combinations: tuple[Combination, ...]


def identifiability(
    problem: Problem, model: Model, inflation: float, fixed: Sequence[str] = ()
) -> Identifiability:
    """What the data tell of the parameters of a fitted device.

    Parameters
    ----------
    problem, model
        The data and the fit.
    inflation
        True variance per variance of independent residuals, for these are correlated.
    fixed
        Parameters that are known.
    """
    names = _names(model, fixed)
    if not names:
        return Identifiability((), ())
    jacobian = np.column_stack([_column(problem, model, name) for name in names])
    residual = problem.residual(model)
    flat = problem.masked(residual)
    variance = float(np.mean(flat**2)) * max(inflation, 1e-12) + 1e-300
    eigenvalues, vectors = np.linalg.eigh(jacobian.T @ jacobian / variance)
    errors = 1 / np.sqrt(np.maximum(eigenvalues, 1e-300))
    weak = errors > UNKNOWN
    if not weak.any():
        return Identifiability((), ())
    # one direction that is not felt at all must not hide how badly others are known
    groups = _groups(names, vectors[:, weak] * np.minimum(errors[weak], _WORST))
    values = np.array([_value(model, name) for name in names])
    known = [
        combination
        for group in groups
        for combination in _known(group, names, values, vectors[:, ~weak], errors[~weak])
    ]
    return Identifiability(groups, tuple(known))


def _names(model: Model, fixed: Sequence[str]) -> list[str]:
    device, known = model.device(), parameters()
    names = [
        name
        for name, value in device.given.items()
        if name in known
        and isinstance(value, float)
        and value != 0
        and name not in (*fixed, *NUISANCES, "rest_length")
        and (not known[name].laws or device.friction in known[name].laws)
    ]
    # a factor that fits set to 1
    if device.friction == "bouc_wen" and "bw_alpha" not in (*names, *fixed):
        names.append("bw_alpha")
    return names


def _value(model: Model, name: str) -> float:
    return float(getattr(model.device(), name))


def _column(problem: Problem, model: Model, name: str) -> Array:
    """Derivative of the force by the logarithm of a device's parameter, on what counts."""
    device = model.device()
    value = _value(model, name)
    parts = []
    for step in (_STEP, -_STEP):
        try:
            changed = {**device.given, name: value * (1 + step)}
            parts.append((_forces(problem, model, changed), step))
        except DeviceError:
            # at the edge of what can be, such as static_force at coulomb_force
            continue
    if not parts:
        return np.zeros(sum(int(m.sum()) for m in problem.masks))
    if len(parts) == 1:
        parts.append((_forces(problem, model, device.given), 0.0))
    (there, up), (back, down) = parts
    return (there - back) / (up - down)


def _forces(problem: Problem, model: Model, given: dict[str, float | str]) -> Array:
    values = {name: v for name, v in given.items() if not isinstance(v, str)}
    values |= {name: model.values[name] for name in NOT_OF_DEVICE if name in model.values}
    changed = Model(model.friction, values, (), model.texts)
    return problem.masked([force_along(changed, run) for run in problem.runs])


def _groups(names: Sequence[str], weak: Array) -> tuple[tuple[str, ...], ...]:
    """Parameters whose own error is large, together where they make up for each other.

    `weak` are the undetermined directions times their errors, shape (parameters, directions).
    """
    size = np.sqrt(np.sum(weak**2, axis=1))
    member = size > UNKNOWN
    # those whose errors go together belong together
    overlap = np.abs(weak @ weak.T) / np.maximum(np.outer(size, size), 1e-300) > 0.2
    left = [i for i in range(len(names)) if member[i]]
    groups = []
    while left:
        group, todo = [], [left[0]]
        while todo:
            i = todo.pop()
            if i in left:
                left.remove(i)
                group.append(i)
                todo += [j for j in left if overlap[i, j]]
        groups.append(tuple(names[i] for i in sorted(group)))
    return tuple(groups)


def _known(
    group: tuple[str, ...], names: Sequence[str], values: Array, strong: Array, errors: Array
) -> list[Combination]:
    """Short products of powers within a group that the data determine."""
    at = [names.index(name) for name in group]
    # weigh what is known well most, and keep what lies within the group
    rows = (strong / errors).T[:, at]
    _, sizes, right = np.linalg.svd(rows, full_matrices=False)
    count = int(np.sum(1 / np.maximum(sizes, 1e-300) < UNKNOWN))
    if count == 0:
        return []
    basis = _echelon(right[: min(count, len(group) - 1)])
    found = []
    for row in basis:
        powers = np.zeros(len(names))
        powers[at] = row
        error = float(np.sqrt(np.sum((strong.T @ powers * errors) ** 2)))
        used = [(group[i], float(row[i])) for i in range(len(group)) if abs(row[i]) > 0.02]
        expression, value = _expression(used, dict(zip(names, values, strict=True)))
        found.append(Combination(expression, value, error))
    return found


def _echelon(rows: Array) -> Array:
    """Reduced row echelon form, by the largest pivots."""
    matrix = rows.copy()
    free = list(range(matrix.shape[1]))
    for i in range(len(matrix)):
        pivot = max(free, key=lambda j: abs(matrix[i, j]))
        free.remove(pivot)
        matrix[i] /= matrix[i, pivot]
        for k in range(len(matrix)):
            if k != i:
                matrix[k] -= matrix[k, pivot] * matrix[i]
    return matrix


def _expression(used: Sequence[tuple[str, float]], values: dict[str, float]) -> tuple[str, float]:
    """The combination in words: a sum where the powers are the shares of one, else a product."""
    powers = np.array([power for _, power in used])
    terms = np.array([values[name] for name, _ in used])
    # a sum is known where each power is as large as its term, sign and all
    close = np.allclose(powers / np.abs(powers).max(), terms / np.abs(terms).max(), atol=0.08)
    if len(used) > 1 and (close or np.allclose(powers / powers[0], terms / terms[0], rtol=0.1)):
        return " + ".join(name for name, _ in used), float(terms.sum())
    value, words = 1.0, []
    for name, power in used:
        nice = _nice(power)
        value *= abs(values[name]) ** nice
        words.append(name if nice == 1 else f"{name}^{nice:g}")
    return " ".join(words), value


def _nice(power: float) -> float:
    """The nearest simple number, where it is near."""
    simple = round(power * 2) / 2
    return simple if simple != 0 and abs(power - simple) < 0.06 else round(power, 2)
