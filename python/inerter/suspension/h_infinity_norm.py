"""H-infinity norm (largest gain over frequency) of stable rational functions, by two exact routes.

- `largest_gain`, `peaks`: |G|^2 is a quotient of polynomials in x = w^2, and its peaks are among
  the roots of one polynomial, found as eigenvalues. For arrays of designs.
- `h_infinity_norm`: a level g is above every peak exactly if the Hamiltonian matrix of g has no
  eigenvalue on the imaginary axis; those that it has are where the gain crosses g, and the gain
  between two crossings gives the next level. No peak can be missed. Boyd, Balakrishnan and Kabamba
  (1989); Bruinsma and Steinbuch, Systems & Control Letters 14, 1990. For one function.

The gain itself is computed from even and odd parts, |A(i w)|^2 = E(x)^2 + x O(x)^2, a sum of
squares: no cancellation at a sharp peak, and analytic in the coefficients.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.h2_norm import companion, scaled
from inerter.suspension.rational import Coefficients, Rational, add, evaluate, multiply, shift

_STEP = 1e-11


def gain_squared(function: Rational, x: NDArray[Any] | float) -> NDArray[Any]:
    """|G(i sqrt(x))|^2 at squared frequencies x >= 0 [rad^2/s^2], which broadcast against designs.

    Analytic in the coefficients: with complex ones it continues the value for real ones.
    """
    return _square(function.numerator, x) / _square(function.denominator, x)


def peaks(
    function: Rational, *, refine: bool = True
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Candidates of the largest gain, for each design.

    Parameters
    ----------
    function
        Stable designs; stability is not checked.
    refine
        Look twice, let the poles help and climb from each candidate: needed only where
        frequencies lie so far apart (a factor of 1e4 and more) that roots in w^2 are inexact.

    Returns
    -------
    x, gain
        Squared frequencies [rad^2/s^2] and gains there, shape (..., candidates), not sorted. Every
        local maximum is among them, w = 0 too; the others are just points of the curve.
    """
    top, below, rate = scaled(function)
    up, down = _squared_polynomial(top), _squared_polynomial(below)
    slope = add(multiply(_derivative(up), down), -multiply(up, _derivative(down)))
    # any x is a point of the curve, so a root's real part is never above the peak
    places = np.maximum(_roots(slope).real, 0.0)
    one = Rational(top[..., None, :], below[..., None, :])
    if refine:
        with np.errstate(all="ignore"):
            # the roots of the reversed polynomial: there the small ones are the exact ones
            small = np.maximum((1.0 / _roots(slope[..., ::-1])).real, 0.0)
        # the large ones it has nothing to say about
        small = np.where(small < 1e6, small, 0.0)
        places = np.concatenate([places, small, np.abs(_roots(below)) ** 2], axis=-1)
        places = _climbed(one, _climbed(one, places))
    places = np.concatenate([np.zeros((*places.shape[:-1], 1)), places], axis=-1)
    gain = np.sqrt(gain_squared(one, places))
    return places * (rate * rate)[..., None], gain


def squared_polynomials(function: Rational) -> tuple[Coefficients, Coefficients]:
    """|numerator(i w)|^2 and |denominator(i w)|^2 as polynomials in w^2."""
    return _squared_polynomial(function.numerator), _squared_polynomial(function.denominator)


def largest_gain(function: Rational) -> NDArray[np.float64]:
    """H-infinity norm of each stable design; stability is not checked."""
    return peaks(function)[1].max(axis=-1)


def h_infinity_norm(function: Rational) -> float:
    """H-infinity norm of one strictly proper function; infinite if it is not stable."""
    top, below, _ = scaled(function)
    matrix, column, row = companion(top, below)
    poles = np.linalg.eigvals(matrix)
    if poles.real.max() >= 0.0:
        return float("inf")
    unit = Rational(top, below)
    # resonances give the first level
    level = _highest(unit, np.append(np.abs(poles), 0.0))
    while True:
        above = level * (1.0 + 2.0 * _STEP)
        hamiltonian = np.block(
            [
                [matrix, np.outer(column, column) / above],
                [-np.outer(row, row) / above, -matrix.T],
            ]
        )
        values = np.linalg.eigvals(hamiltonian)
        # whether one is on the axis rounding cannot tell; one that is not costs an evaluation
        crossings = np.unique(np.abs(values.imag))
        between = 0.5 * (crossings[:-1] + crossings[1:])
        found = _highest(unit, np.concatenate([[0.0], crossings, between]))
        if found <= above:
            return max(found, level)
        level = found


def _climbed(function: Rational, x: NDArray[np.float64]) -> NDArray[np.float64]:
    """One Newton step in log x towards the maximum of the gain, where that raises the gain."""
    with np.errstate(all="ignore"):
        first, second = (
            a - b
            for a, b in zip(
                _log_slopes(function.numerator, x),
                _log_slopes(function.denominator, x),
                strict=True,
            )
        )
        step = np.where(second < 0.0, np.clip(-first / second, -0.5, 0.5), 0.0)
        moved = np.where(np.isfinite(step), x * np.exp(step), x)
        higher = gain_squared(function, moved) > gain_squared(function, x)
    return np.where(higher, moved, x)


def _log_slopes(p: Coefficients, x: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """First and second derivative of log |p|^2 with respect to log x."""
    even, odd = _signed(p[..., 0::2]), _signed(p[..., 1::2])
    e, f, g = (evaluate(q, x) for q in (even, _slope(even), _slope(_slope(even))))
    o, h, i = (evaluate(q, x) for q in (odd, _slope(odd), _slope(_slope(odd))))
    value = e * e + x * o * o
    first = 2.0 * e * f + x * o * (o + 2.0 * h)
    second = 2.0 * (f * f + e * g) + x * (o * (o + 4.0 * h + 2.0 * i) + 2.0 * h * h)
    ratio = first / value
    return ratio, second / value - ratio * ratio


def _slope(p: Coefficients) -> Coefficients:
    """Coefficients of x dp/dx."""
    return p * np.arange(p.shape[-1])


def _highest(function: Rational, frequency: NDArray[np.float64]) -> float:
    return float(np.sqrt(gain_squared(function, frequency**2).max()))


def _square(p: Coefficients, x: NDArray[Any] | float) -> NDArray[Any]:
    even, odd = evaluate(_signed(p[..., 0::2]), x), 0.0
    if p.shape[-1] > 1:
        odd = evaluate(_signed(p[..., 1::2]), x)
    return even * even + x * odd * odd


def _squared_polynomial(p: Coefficients) -> Coefficients:
    """Coefficients of |p(i w)|^2 in x = w^2."""
    even, odd = _signed(p[..., 0::2]), _signed(p[..., 1::2])
    return add(multiply(even, even), shift(multiply(odd, odd), 1))


def _signed(p: Coefficients) -> Coefficients:
    """Powers of s^2 = -x as powers of x."""
    return p * (-1.0) ** np.arange(p.shape[-1])


def _derivative(p: Coefficients) -> Coefficients:
    return p[..., 1:] * np.arange(1, p.shape[-1])


def _roots(p: Coefficients) -> NDArray[np.complex128]:
    """Roots of each polynomial, shape (..., degree); missing ones of lower degrees are 0."""
    flat = p.reshape(-1, p.shape[-1])
    used = flat != 0.0
    degrees = np.where(used.any(axis=1), p.shape[-1] - 1 - used[:, ::-1].argmax(axis=1), 0)
    roots = np.zeros((len(flat), p.shape[-1] - 1), dtype=np.complex128)
    # designs of one degree together: their companion matrices have one shape
    for degree in np.unique(degrees):
        if degree == 0:
            continue
        rows = np.flatnonzero(degrees == degree)
        matrix = np.zeros((len(rows), degree, degree))
        matrix[:, np.arange(degree - 1), np.arange(1, degree)] = 1.0
        matrix[:, -1, :] = -flat[rows, :degree] / flat[rows, degree : degree + 1]
        roots[rows[:, None], np.arange(degree)] = np.linalg.eigvals(matrix)
    return roots.reshape(*p.shape[:-1], p.shape[-1] - 1)
