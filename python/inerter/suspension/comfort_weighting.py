"""How a vertical vibration is felt by a seated person: the weighting Wk of ISO 2631-1.

    Wk(s) = band(s) transition(s) step(s)
    band       = s^2 / (s^2 + w1 s / Q1 + w1^2) . w2^2 / (s^2 + w2 s / Q2 + w2^2)
    transition = (1 + s / w3) / (1 + s / (Q4 w4) + (s / w4)^2)
    step       = (1 + s / (Q5 w5) + (s / w5)^2) / (1 + s / (Q6 w6) + (s / w6)^2) (w5 / w6)^2

Symbols: w = 2 pi f, f1 = 0.4, f2 = 100, f3 = f4 = 12.5, f5 = 2.37, f6 = 3.35 Hz, Q1 = Q2 =
1/sqrt(2), Q4 = 0.63, Q5 = Q6 = 0.91.
Range: 0.4 to 100 Hz, vertical, through the seat. Source: ISO 2631-1:1997, Annex A. Not modelled:
the seat itself, other axes, what lies below 0.4 Hz (motion sickness, Wf).
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from inerter.suspension.rational import Rational, multiply, polynomial

_F = {1: 0.4, 2: 100.0, 3: 12.5, 4: 12.5, 5: 2.37, 6: 3.35}
_Q = {1: math.sqrt(0.5), 2: math.sqrt(0.5), 4: 0.63, 5: 0.91, 6: 0.91}


@cache
def weighting() -> Rational:
    """Wk(s), acceleration felt per acceleration."""
    w = {n: 2.0 * math.pi * f for n, f in _F.items()}

    def second(n: int) -> np.ndarray:
        return polynomial(1.0, 1.0 / (_Q[n] * w[n]), 1.0 / w[n] ** 2)

    # the high-pass is divided by w1^2 above and below
    top = multiply(polynomial(0.0, 0.0, 1.0 / w[1] ** 2), polynomial(1.0, 1.0 / w[3]))
    top = multiply(top, second(5)) * (w[5] / w[6]) ** 2
    below = multiply(multiply(second(1), second(2)), multiply(second(4), second(6)))
    return Rational(top, below)
