"""Dynamic stiffness of networks as quotients of polynomials in s, for arrays of designs at once.

A two-terminal element or network has the force D(s) x under the elongation x, tension positive:
spring D = k, damper D = c s, inerter D = b s^2. Side by side stiffnesses add; one after the other
their inverses do. Coefficients stand in ascending powers of s in the last axis; the other axes are
designs. Everything here is analytic in the parameters, so a complex step gives derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Coefficients = NDArray[Any]
"""Real, or complex for a complex step: shape (..., degree + 1), ascending powers of s."""


@dataclass(frozen=True)
class Rational:
    """`numerator(s) / denominator(s)`; the shapes of the designs broadcast."""

    numerator: Coefficients
    denominator: Coefficients

    def __call__(self, s: complex | NDArray[Any]) -> NDArray[Any]:
        """The value at s, which broadcasts against the designs."""
        return evaluate(self.numerator, s) / evaluate(self.denominator, s)


def polynomial(*coefficients: ArrayLike) -> Coefficients:
    """A polynomial from its coefficients in ascending powers, each a number or an array."""
    return np.stack(np.broadcast_arrays(*coefficients), axis=-1)


def evaluate(coefficients: Coefficients, s: complex | NDArray[Any]) -> NDArray[Any]:
    """The polynomial at s (Horner)."""
    value = coefficients[..., -1] + 0.0 * s
    for k in range(coefficients.shape[-1] - 2, -1, -1):
        value = value * s + coefficients[..., k]
    return value


def multiply(p: Coefficients, q: Coefficients) -> Coefficients:
    """Product of two polynomials."""
    if p.shape[-1] < q.shape[-1]:
        p, q = q, p
    shape = np.broadcast_shapes(p.shape[:-1], q.shape[:-1])
    length = p.shape[-1]
    product = np.zeros((*shape, length + q.shape[-1] - 1), dtype=np.result_type(p, q))
    for k in range(q.shape[-1]):
        product[..., k : k + length] += p * q[..., k : k + 1]
    return product


def add(p: Coefficients, q: Coefficients) -> Coefficients:
    """Sum of two polynomials."""
    if p.shape[-1] < q.shape[-1]:
        p, q = q, p
    shape = np.broadcast_shapes(p.shape[:-1], q.shape[:-1])
    total = np.zeros((*shape, p.shape[-1]), dtype=np.result_type(p, q))
    total[...] = p
    total[..., : q.shape[-1]] += q
    return total


def shift(p: Coefficients, power: int) -> Coefficients:
    """The polynomial times s**power."""
    zeros = np.zeros((*p.shape[:-1], power), dtype=p.dtype)
    return np.concatenate([zeros, p], axis=-1)


def spring(stiffness: ArrayLike) -> Rational:
    """D = k [N/m]."""
    return Rational(polynomial(stiffness), np.ones(1))


def damper(damping: ArrayLike) -> Rational:
    """D = c s [N s/m]."""
    return Rational(polynomial(0.0, damping), np.ones(1))


def inerter(inertance: ArrayLike) -> Rational:
    """D = b s^2 [kg]."""
    return Rational(polynomial(0.0, 0.0, inertance), np.ones(1))


def parallel(*networks: Rational) -> Rational:
    """Side by side between the same terminals: stiffnesses add."""
    return reduce(_parallel, networks)


def series(*networks: Rational) -> Rational:
    """One after the other: the inverse stiffnesses add. Common powers of s are cancelled."""
    return reduce(_series, networks)


def _parallel(a: Rational, b: Rational) -> Rational:
    top = add(multiply(a.numerator, b.denominator), multiply(b.numerator, a.denominator))
    return Rational(top, multiply(a.denominator, b.denominator))


def _series(a: Rational, b: Rational) -> Rational:
    top = multiply(a.numerator, b.numerator)
    below = add(multiply(a.numerator, b.denominator), multiply(b.numerator, a.denominator))
    # dampers and inerters yield at s = 0: without this a pole at 0 would appear that is none
    while below.shape[-1] > 1 and not top[..., 0].any() and not below[..., 0].any():
        top, below = top[..., 1:], below[..., 1:]
    return Rational(top, below)
