"""H2 norm of stable, strictly proper rational functions, exactly, by two independent routes.

`||G||_2^2 = (1 / 2 pi) integral |G(i w)|^2 dw`.

- `h2_norm`: the recursion of Astrom, Jury and Agniel (IEEE Trans. Automatic Control 15, 1970; the
  tables of Nekrasov and of Newton, Gould and Kaiser are its closed forms), for arrays of designs.
  Its quotients are Routh's, so it sees instability on the way. It is analytic in the coefficients:
  a complex step gives derivatives.
- `h2_norm_lyapunov`: the controllability Gramian of a state space, for one function.

Frequency is scaled to the geometric mean of the poles first: coefficients of s^0 ... s^6 in SI
units lie twenty decades apart.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matrix_balance, solve_continuous_lyapunov

from inerter.suspension.rational import Coefficients, Rational


def h2_norm(function: Rational) -> NDArray[Any]:
    """H2 norm of each design, shape of the designs; infinite where one is not stable.

    Raises
    ------
    ValueError
        The function is not strictly proper.
    """
    top, below, rate = scaled(function)
    order = below.shape[-1] - 1
    # descending powers; a[0] ... a[order], b[1] ... b[order], as in the source
    a = [below[..., order - i] for i in range(order + 1)]
    b = [np.zeros(()), *(top[..., order - i] for i in range(1, order + 1))]
    total: Any = 0.0
    stable = np.ones(np.broadcast_shapes(top.shape[:-1], below.shape[:-1]), dtype=bool)
    with np.errstate(all="ignore"):
        for degree in range(order, 0, -1):
            alpha, beta = a[0] / a[1], b[1] / a[1]
            stable &= np.real(alpha) > 0.0
            total = total + beta * beta / (2.0 * alpha)
            after = [*a, 0.0]
            a = [after[i + 1] - (alpha * after[i + 2] if i % 2 else 0.0) for i in range(degree)]
            b = [b[0], *(b[i + 1] - (0.0 if i % 2 else beta * after[i + 1])
                         for i in range(1, degree))]  # fmt: skip
        norm = np.sqrt(total * rate)
    return np.where(stable, norm, np.inf)


def h2_norm_lyapunov(function: Rational) -> float:
    """H2 norm of one function from the Gramian of its companion form.

    Raises
    ------
    ValueError
        The function is not strictly proper or not stable.
    """
    top, below, rate = scaled(function)
    matrix, column, row = companion(top, below)
    if np.linalg.eigvals(matrix).real.max() >= 0.0:
        raise ValueError("the function is not stable: it has no H2 norm")
    gramian = solve_continuous_lyapunov(matrix, -np.outer(column, column))
    return float(np.sqrt(row @ gramian @ row * rate))


def companion(
    top: Coefficients, below: Coefficients
) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """State matrix, input column and output row of one function whose denominator is monic.

    The states are scaled so that rows and columns of the matrix are of like size.
    """
    order = below.shape[-1] - 1
    matrix = np.eye(order, k=1)
    matrix[-1] = -below[:-1]
    balanced, (scale, _) = matrix_balance(matrix, permute=False, separate=True)
    column = np.zeros(order)
    column[-1] = 1.0 / scale[-1]
    # input and output share the gain evenly
    row = top * scale
    share = np.sqrt(np.abs(row).max() / column[-1])
    return balanced, column * share, row / share


def scaled(function: Rational) -> tuple[Coefficients, Coefficients, NDArray[np.float64]]:
    """Numerator and monic denominator over p = s / rate, and the rate [rad/s] of each design.

    The numerator has as many coefficients as the degree of the denominator.
    """
    top, below = _trimmed(function.numerator), _trimmed(function.denominator)
    order = below.shape[-1] - 1
    if top.shape[-1] > order:
        raise ValueError("the function is not strictly proper: its norm is infinite")
    with np.errstate(all="ignore"):
        rate = np.abs(np.real(below[..., 0]) / np.real(below[..., -1])) ** (1.0 / order)
        # a pole at 0 is not stable, whatever the scale
        rate = np.where(np.isfinite(rate) & (rate > 0.0), rate, 1.0)
        powers = rate[..., None] ** (np.arange(order + 1) - order)
        lead = below[..., -1:]
        below = below * powers / lead
        top = top * powers[..., : top.shape[-1]] / lead
    missing = [(0, 0)] * (top.ndim - 1) + [(0, order - top.shape[-1])]
    return np.pad(top, missing), below, rate


def _trimmed(p: Coefficients) -> Coefficients:
    """Without highest powers that no design has."""
    while p.shape[-1] > 1 and not p[..., -1].any():
        p = p[..., :-1]
    return p
