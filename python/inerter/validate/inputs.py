"""The four inputs: a road of bumps, a step, a sine, a sweep; each a smooth function of time.

    road   a bump, a hollow and a ripple under a window
    step   1 from the first moment on: the model is at rest and the input is not 0
    sine   sin(2 pi f t)
    sweep  sin(phase), the frequency rising linearly from f / 4 to 3 f over the run

An input is of size 1; models multiply it. The step stands at time 0 because a jump elsewhere has
two values at one instant, and a Runge-Kutta step that ends there would want the other one.
"""

from __future__ import annotations

import math
from collections.abc import Callable

Signal = Callable[[float], float]

INPUTS = ("road", "step", "sine", "sweep")


def signal(kind: str, frequency: float, duration: float, delay: float = 0.0) -> Signal:
    """An input of size 1.

    Parameters
    ----------
    kind : str
        One of `INPUTS`.
    frequency : float
        Of the sine [Hz]; bumps and ripple are as quick.
    duration : float
        Of the sweep [s].
    delay : float
        The road comes so much later [s] (rear wheels); the others do not.

    Raises
    ------
    ValueError
        An unknown kind.
    """
    turn = 2.0 * math.pi * frequency
    if kind == "road":
        return _road(frequency, delay)
    if kind == "step":
        return lambda t: 1.0
    if kind == "sine":
        return lambda t: math.sin(turn * t)
    if kind == "sweep":
        rise = 2.75 * turn / duration
        return lambda t: math.sin((0.25 * turn + 0.5 * rise * t) * t)
    raise ValueError(f"input: '{kind}' is not one of {', '.join(INPUTS)}")


def _road(frequency: float, delay: float) -> Signal:
    width = 0.4 / frequency
    period = 8.0 / frequency
    ripple = 6.0 * math.pi * frequency

    def road(t: float) -> float:
        t = t - delay
        # the pattern comes again; bumps are far narrower than its period
        phase = t - period * math.floor(t / period)
        bump = math.exp(-(((phase - 0.3 * period) / width) ** 2))
        hollow = math.exp(-(((phase - 0.65 * period) / (0.7 * width)) ** 2))
        window = math.exp(-(((phase - 0.5 * period) / (2.0 * width)) ** 2))
        return bump - 0.6 * hollow + 0.1 * window * math.sin(ripple * t)

    return road
