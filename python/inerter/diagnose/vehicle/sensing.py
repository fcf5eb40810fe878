"""What stands between a quantity and the column that shows it: angle, gain, delay, mount, filter.

    s'' + 2 D w s' + w^2 s = w^2 y     y the quantity, s what the sensor shows, w = 2 pi f

Symbols: f [Hz] `mount_frequency` and D [-] `mount_loss` of a sensor that swings on its bracket, or
`filter_frequency` of a low-pass of second order with the flat D = 1/sqrt(2) (Butterworth).
An accelerometer that leans by the angle a toward another axis shows s_k cos(a) + s_i sin(a).
Range: a record that begins at rest. Not modelled: filters of other orders, a sensor's own mass.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import cont2discrete, lfilter

from inerter.diagnose.vehicle.inputs import AXES

Array = NDArray[np.float64]
EVERY_CHANNEL = "channel:every channel"
"""Element of what all compared channels have in common: the clock of what drives is another one."""
FLAT = 0.5**0.5
"""Loss of a low-pass of second order without a peak."""
_FINER = 4  # steps of the filter per sample: what a line between samples leaves out


def shown(time: Array, values: Array, channel: Mapping[str, float]) -> Array:
    """A quantity as a channel shows it.

    Parameters
    ----------
    time : ndarray (n,)
        Of the samples [s].
    values : ndarray (n,)
        The quantity, finite.
    channel : mapping
        `gain` [-], `delay` [s], `mount_frequency` [Hz] with `mount_loss` [-], `filter_frequency`
        [Hz]; what is not there does nothing.
    """
    for frequency, loss in (
        (channel.get("mount_frequency", 0.0), channel.get("mount_loss", FLAT)),
        (channel.get("filter_frequency", 0.0), FLAT),
    ):
        if frequency:
            values = second_order(time, values, frequency, loss)
    values = channel.get("gain", 1.0) * values
    delay = channel.get("delay", 0.0)
    if delay:
        values = CubicSpline(time, values)(np.clip(time - delay, time[0], time[-1]))
    return values


def leaning(component: int, channel: Mapping[str, float]) -> Array:
    """What a column of a sensor with three components is made of, a unit vector of shape (3,).

    Parameters
    ----------
    component
        The one that the column is meant to show.
    channel : mapping
        `angle_toward_x`, `_y`, `_z` [rad]: how far the sensor leans toward the other axes.
    """
    found = np.zeros(3)
    found[component] = 1.0
    for i, axis in enumerate(AXES):
        if i != component:
            found[i] = np.tan(channel.get(f"angle_toward_{axis}", 0.0))
    return found / np.linalg.norm(found)


def second_order(time: Array, values: Array, frequency: float, loss: float) -> Array:
    """A quantity behind a second-order element, from where it begins; exact for straight lines."""
    omega = 2 * np.pi * frequency
    count = max(_FINER * (time.size - 1), int(np.ceil(8 * frequency * (time[-1] - time[0])))) + 1
    fine = np.linspace(time[0], time[-1], count)
    step = float(fine[1] - fine[0])
    system = ([omega**2], [1.0, 2 * loss * omega, omega**2])
    sampled: Any = cont2discrete(system, step, method="foh")
    top, bottom = sampled[0], sampled[1]
    before = np.interp(fine, time, values) if time.size < 4 else CubicSpline(time, values)(fine)
    return CubicSpline(fine, lfilter(np.ravel(top), bottom, before - before[0]) + before[0])(time)
