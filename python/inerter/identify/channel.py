"""What stands between a device's force and the record: a late, drifting, limited force channel.

    delay                    the channel is late by this time                              [s]
    force_filter             cut-off of a low-pass that it went through, with its order
                             and kind, see `channel_filter`                               [Hz]
    displacement_filter      the same of the displacement channel, taken out of the motion [Hz]
    force_drift              force per elapsed time                                        [N/s]
    force_coupling           corner below which the channel lets a force die away           [Hz]
    settling_time            in which an offset of the run's own dies away                   [s]
    force_maximum, _minimum  where the channel clips                                       [N]
    disturbance_amplitude, disturbance_frequency   a tone from outside                     [N], [Hz]
    friction_drift           friction level times 1 + friction_drift (elapsed time)        [1/s]
    viscous_drift            viscous damping times 1 + viscous_drift (elapsed time)        [1/s]
    grip_mass                moves with the terminal, before a shaft or a free play        [kg]

The drifts of friction and damping are the device's own, but change with time as no device of a
simulator does: the level of the friction law, Bouc-Wen's too, and not what friction adds that goes
with the load. So may the mass be, of a nut say: beside the device it is a second inerter. Elapsed
time counts from the beginning of a run, or of the first run where all share one clock. The phase of
a tone and what settles are nobody's to predict, and are read off each run.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from inerter.catalogue.coordinates import CHANNEL_UNITS
from inerter.identify.channel_filter import filter_of, filtered

Array = NDArray[np.float64]

LIMITS = ("force_maximum", "force_minimum")
LINEAR = ("delay", "force_filter", "force_filter_order", "force_filter_bessel", "force_coupling")
"""What of the channel is a linear filter of the force."""


def channel_values(values: Mapping[str, float]) -> dict[str, float]:
    """Those of some coordinates that belong to the channel, where they do anything."""
    return {name: values[name] for name in CHANNEL_UNITS if values.get(name)}


def clips(values: Mapping[str, float]) -> bool:
    """Whether the channel has a limit."""
    return not values.keys().isdisjoint(LIMITS)


def without_limits(values: Mapping[str, float]) -> dict[str, float]:
    """Coordinates of a channel that does not clip."""
    return {name: value for name, value in values.items() if name not in LIMITS}


def through_channel(
    values: Mapping[str, float], force: Array, elapsed: Array, spacing: float
) -> Array:
    """A device's force as the channel shows it, shape (..., n).

    Parameters
    ----------
    values
        Coordinates; those of the channel are read.
    force, elapsed
        Force [N], shape (..., n), and elapsed time [s], shape (n,).
    spacing
        Of the samples [s].
    """
    if drift := values.get("force_drift", 0.0):
        force = force + drift * elapsed
    if corner := values.get("force_coupling", 0.0):
        force = _coupled(force, corner, spacing)
    if (low_pass := filter_of(values, "force")) is not None:
        force = filtered(force, spacing, low_pass)
    force = delayed(force, values.get("delay", 0.0), spacing)
    if clips(values):
        low, high = (values.get(name) for name in reversed(LIMITS))
        force = np.clip(force, low, high)
    return force


def _coupled(force: Array, corner: float, spacing: float) -> Array:
    """A force (..., n) through a high-pass of the first order that was at rest before it."""
    rate = np.pi * corner * spacing
    shares = (np.array([1.0, -1.0]) / (1.0 + rate), np.array([1.0, (rate - 1.0) / (1.0 + rate)]))
    return np.asarray(lfilter(*shares, force), dtype=np.float64)


def delayed(force: Array, delay: float, spacing: float) -> Array:
    """A force (..., n) `delay` seconds later, by four-point Lagrange interpolation; ends held."""
    if delay == 0:
        return force
    n = force.shape[-1]
    shift = delay / spacing
    whole = int(np.floor(shift))
    s = 1 - (shift - whole)  # position after sample i - whole - 1
    weights = np.array(
        (
            -s * (s - 1) * (s - 2) / 6,
            (s + 1) * (s - 1) * (s - 2) / 2,
            -(s + 1) * s * (s - 2) / 2,
            (s + 1) * s * (s - 1) / 6,
        )
    )
    # samples -whole - 2 ... n - whole
    before, after = (min(max(k, 0), n + 3) for k in (whole + 2, 1 - whole))
    held = np.empty((*force.shape[:-1], n + 3))
    held[..., :before] = force[..., :1]
    held[..., n + 3 - after :] = force[..., -1:]
    first = max(-whole - 2, 0)
    held[..., before : n + 3 - after] = force[..., first : first + n + 3 - after - before]
    if held.ndim == 1:
        return np.correlate(held, weights, "valid")
    return np.array([np.correlate(row, weights, "valid") for row in held])


def without_tone(
    residual: Array, elapsed: Array, mask: NDArray[np.bool_], amplitude: float, frequency: float
) -> Array:
    """A residual without a tone, whose phase is the one that fits the masked samples best."""
    angle = 2 * np.pi * frequency * elapsed
    turn = np.exp(-1j * angle[mask]) @ residual[mask]
    return residual - amplitude * np.cos(angle + np.angle(turn))


def tone_follows(
    residual: Array, elapsed: Array, mask: NDArray[np.bool_], amplitude: float, frequency: float
) -> tuple[Array, Array]:
    """How such a tone follows a small change of the residual: its phase is read off that.

    Two arrays (n,): what the residual without the tone gains per radian of the phase, and the
    phase's derivative by every sample.
    """
    angle = 2 * np.pi * frequency * elapsed
    wave = np.where(mask, np.exp(-1j * angle), 0.0)
    turn = wave @ residual
    if not (size := abs(turn)) > 0:
        return np.zeros_like(residual), np.zeros_like(residual)
    return amplitude * np.sin(angle + np.angle(turn)), (wave * turn.conjugate()).imag / size**2
