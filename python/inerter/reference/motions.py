"""Test motions in closed form: displacement with its exact first and second derivative.

Each builder works on *jets*, triples (value, rate, second derivative), so that products such as
a windowed sine keep exact derivatives: (f g)' = f' g + f g', (f g)'' = f'' g + 2 f' g' + f g''.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .laws import Quantity
from .motion import Motion

Jet = tuple[Quantity, Quantity, Quantity]
JetOfTime = Callable[[Quantity], Jet]


def motion_of(jet: JetOfTime, kinks: Sequence[float] = ()) -> Motion:
    """The motion [m, m/s, m/s^2] of a jet."""
    return Motion(lambda t: jet(t)[0], lambda t: jet(t)[1], lambda t: jet(t)[2], tuple(kinks))


def product(f: Jet, g: Jet) -> Jet:
    """Jet of f g."""
    return f[0] * g[0], f[1] * g[0] + f[0] * g[1], f[2] * g[0] + 2.0 * f[1] * g[1] + f[0] * g[2]


def total(jets: Sequence[Jet]) -> Jet:
    """Jet of a sum."""
    value, rate, second = jets[0]
    for jet in jets[1:]:
        value, rate, second = value + jet[0], rate + jet[1], second + jet[2]
    return value, rate, second


def sine_of(phase: Jet) -> Jet:
    """Jet of sin(phase), phase [rad]."""
    sine, cosine = np.sin(phase[0]), np.cos(phase[0])
    return sine, cosine * phase[1], cosine * phase[2] - sine * phase[1] * phase[1]


def smooth_step(t: Quantity, start: float, length: float) -> Jet:
    """Jet of the minimum-jerk step 10 s^3 - 15 s^4 + 6 s^5 from 0 to 1; s = (t - start)/length.

    Source: Flash and Hogan, J. Neurosci. 5(7), 1985: rate and acceleration vanish at both ends.
    """
    s = (t - start) / length
    # of one time, as a solver asks for, NumPy takes longer
    s = min(1.0, max(0.0, s)) if isinstance(s, float) else np.minimum(1.0, np.maximum(0.0, s))
    value = s**3 * (10.0 - 15.0 * s + 6.0 * s * s)
    rate = 30.0 * (s * (1.0 - s)) ** 2 / length
    second = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / length**2
    return value, rate, second


def window(t: Quantity, start: float, end: float, ramp: float) -> Jet:
    """Jet of a window: rises from 0 over `ramp` after `start`, is back at 0 at `end` (all s)."""
    rise, fall = smooth_step(t, start, ramp), smooth_step(t, end - ramp, ramp)
    return rise[0] - fall[0], rise[1] - fall[1], rise[2] - fall[2]


def sum_of_sines(amplitudes: ArrayLike, frequencies: ArrayLike, phases: ArrayLike) -> Motion:
    """Sum of A_i sin(2 pi f_i t + phase_i); A [m], f [Hz], phase [rad], each of shape (tones,)."""
    amplitude = np.asarray(amplitudes, dtype=np.float64)
    omega = 2.0 * np.pi * np.asarray(frequencies, dtype=np.float64)
    phase = np.asarray(phases, dtype=np.float64)

    def angle(t: Quantity) -> NDArray[np.float64]:
        return np.multiply.outer(t, omega) + phase

    return Motion(
        lambda t: np.sin(angle(t)) @ amplitude,
        lambda t: np.cos(angle(t)) @ (amplitude * omega),
        lambda t: -np.sin(angle(t)) @ (amplitude * omega * omega),
    )


def windowed_sines(
    amplitudes: Sequence[float],
    frequencies: Sequence[float],
    edges: Sequence[float],
    ramp: float,
    phases: Sequence[float] | None = None,
) -> Motion:
    """One sine after another with smooth transitions.

    Sine i, A_i [m] at f_i [Hz], stands between `edges[i]` and `edges[i+1]` [s]; each rises and
    falls over `ramp` [s]. `edges` is one longer than the others.
    """
    offsets = [0.0] * len(amplitudes) if phases is None else phases

    def jet(t: Quantity) -> Jet:
        parts: list[Jet] = []
        for i, amplitude in enumerate(amplitudes):
            if isinstance(t, float) and not edges[i] < t < edges[i + 1]:
                continue
            omega = 2.0 * np.pi * frequencies[i]
            phase: Jet = (omega * (t - edges[i]) + offsets[i], omega, 0.0)
            shape = window(t, edges[i], edges[i + 1], ramp)
            parts.append(scale(product(shape, sine_of(phase)), amplitude))
        return total(parts or [(0.0, 0.0, 0.0)])

    kinks = [k for edge in edges for k in (edge - ramp, edge, edge + ramp)]
    return motion_of(jet, sorted(kinks))


def scale(jet: Jet, factor: float) -> Jet:
    """Jet of factor f."""
    return factor * jet[0], factor * jet[1], factor * jet[2]


def chirp(
    amplitude: float,
    first: float,
    last: float,
    duration: float,
    ramp: float,
    roll_off: float = 1.5,
) -> Motion:
    """A sine whose frequency grows exponentially while its amplitude falls as f^-roll_off.

    Amplitude [m] at `first` [Hz], up to `last` [Hz] at `duration` [s]; starts and ends with a
    smooth window of length `ramp` [s] and rests outside.
    """
    growth = np.log(last / first) / duration

    def jet(t: Quantity) -> Jet:
        # outside the window the exponential would only overflow
        clock = np.minimum(duration, np.maximum(0.0, t))
        frequency = first * np.exp(growth * clock)
        omega = 2.0 * np.pi * frequency
        phase: Jet = (2.0 * np.pi * (frequency - first) / growth, omega, growth * omega)
        decay = -growth * roll_off
        level = amplitude * np.exp(decay * clock)
        envelope: Jet = (level, decay * level, decay * decay * level)
        return product(product(envelope, sine_of(phase)), window(t, 0.0, duration, ramp))

    return motion_of(jet, (0.0, ramp, duration - ramp, duration))


def strokes(
    positions: Sequence[float], starts: Sequence[float], lengths: Sequence[float]
) -> Motion:
    """Minimum-jerk strokes with dwells between them.

    From rest at `positions[0]` [m]; stroke i begins at `starts[i]` [s], takes `lengths[i]` [s]
    and ends at `positions[i + 1]`. Strokes must not overlap.
    """

    def jet(t: Quantity) -> Jet:
        origin: Jet = (positions[0] + 0.0 * t, 0.0 * t, 0.0 * t)
        moves = [
            scale(smooth_step(t, start, length), positions[i + 1] - positions[i])
            for i, (start, length) in enumerate(zip(starts, lengths, strict=True))
        ]
        return total([origin, *moves])

    kinks = sorted({*starts, *(s + n for s, n in zip(starts, lengths, strict=True))})
    return motion_of(jet, kinks)


def scaled(motion: Motion, factor: float) -> Motion:
    """The same motion, every displacement times `factor` [-]."""
    return Motion(
        lambda t: factor * motion.displacement(t),
        lambda t: factor * motion.velocity(t),
        lambda t: factor * motion.acceleration(t),
        motion.kinks,
    )
