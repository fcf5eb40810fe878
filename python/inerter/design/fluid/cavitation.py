"""Where the liquid starts to boil in the chamber that is sucked at.

    p_low = p_0 - s F / A1 > p_v,   so |F| < F_c = (p_0 - p_v) A1 / s

Symbols: F [N] force on the liquid, inertance and losses; p_0 [Pa] absolute pressure at rest, p_v
vapour pressure, A1 [m^2] piston area, s share of the pressure difference that falls to the lower
chamber: 1/2 for two equal closed chambers, 1 if the other one is held at p_0.
Not modelled: dissolved air, which comes out earlier; the jet at the channel's entrance, whose
pressure is that of the high chamber less its own dynamic pressure; tension that clean water bears.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from inerter.design.fluid.losses import Channel

_PHASE = np.linspace(0.0, math.pi, 181)


def force_limit(channel: Channel, static_pressure: float, share: float) -> float:
    """F_c [N]."""
    drop = static_pressure - channel.liquid.vapour_pressure
    return drop * channel.geometry.piston_area / share


def speed_limit(channel: Channel, limit: float) -> float:
    """Constant speed [m/s] at which the losses reach the limit [N]; infinite without losses."""
    return _rising(lambda speed: float(channel.force(speed)[0]), limit)


def frequency_limit(channel: Channel, limit: float, amplitude: float) -> float:
    """Frequency [Hz] at which a motion of this amplitude [m] reaches the limit [N]."""
    return _rising(lambda frequency: peak(channel, frequency, amplitude), limit)


def amplitude_limit(
    channel: Channel, limit: float, frequencies: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Amplitude (n,) [m] at which a motion of each frequency [Hz] reaches the limit [N]."""
    return np.array(
        [_rising(lambda x, f=f: peak(channel, float(f), x), limit) for f in frequencies]
    )


def peak(channel: Channel, frequency: float, amplitude: float) -> float:
    """Largest force [N] on the liquid in a sinusoid of frequency [Hz] and amplitude [m]."""
    rate = 2.0 * math.pi * frequency
    v, a = rate * amplitude * np.sin(_PHASE), rate**2 * amplitude * np.cos(_PHASE)
    return float(np.max(channel.force(v, a)))


def _rising(function, limit: float) -> float:
    """Where a function that rises from 0 reaches the limit."""
    high = 1e-6
    while function(high) < limit:
        high *= 10.0
        if high > 1e9:
            return math.inf

    def excess(log_value: float) -> float:
        return math.log(max(function(math.exp(log_value)), 1e-300) / limit)

    low, top = math.log(high) - 20.0 * math.log(10.0), math.log(high)
    return math.exp(float(brentq(excess, low, top, xtol=1e-12)))  # type: ignore[arg-type]
