"""Frequency weighting Wk of ISO 2631-1:1997 for vertical vibration of a seated person.

    Wk = Hh Hl Ht Hs
    Hh = s^2 / (s^2 + (w1/Q1) s + w1^2)         Hl = w2^2 / (s^2 + (w2/Q2) s + w2^2)
    Ht = (1 + s/w3) / (1 + s/(Q4 w4) + (s/w4)^2)
    Hs = (1 + s/(Q5 w5) + (s/w5)^2) / (1 + s/(Q6 w6) + (s/w6)^2) (w5/w6)^2

Symbols: w = 2 pi f; f1 = 0.4 Hz, f2 = 100 Hz, f3 = f4 = 12.5 Hz, f5 = 2.37 Hz, f6 = 3.35 Hz;
Q1 = Q2 = 1/sqrt(2), Q4 = 0.63, Q5 = Q6 = 0.91. Source: ISO 2631-1:1997, Annex A, Table A.1.
Not modelled: the seat. The weighted acceleration is that of the body under the seat.
"""

from __future__ import annotations

import math
from functools import reduce

import numpy as np

from inerter.suspension.rational import Coefficients, Rational, multiply, polynomial

_W1, _W2, _W3, _W5, _W6 = (2.0 * math.pi * f for f in (0.4, 100.0, 12.5, 2.37, 3.35))
_Q, _Q4, _Q5 = math.sqrt(0.5), 0.63, 0.91


def _square(w: float, q: float) -> Coefficients:
    """1 + s/(q w) + (s/w)^2."""
    return polynomial(1.0, 1.0 / (q * w), 1.0 / w**2)


WK = Rational(
    reduce(
        multiply,
        [
            polynomial(0.0, 0.0, 1.0 / _W1**2),
            polynomial(1.0, 1.0 / _W3),
            _square(_W5, _Q5) * (_W5 / _W6) ** 2,
        ],
    ),
    reduce(multiply, [_square(_W1, _Q), _square(_W2, _Q), _square(_W3, _Q4), _square(_W6, _Q5)]),
)
"""The weighting as a quotient of polynomials in s."""


def weighting(frequency: np.ndarray | float) -> np.ndarray:
    """|Wk| at frequencies [Hz]."""
    return np.abs(WK(2j * math.pi * np.asarray(frequency, dtype=float)))
