"""From a measured record to displacement, velocity and acceleration on one uniform clock.

The smoother is the minimiser of

    sum (x - x_measured)^2 / s_x^2 + sum (v - v_measured)^2 / s_v^2 + ... + weight * integral jerk^2

solved in the frequency domain: a zero-phase low-pass with response 1 / (1 + (f / f_c)^6), the
smoothing spline of order five for uniform samples, which also weighs measured velocity and
acceleration in where they are there. It is linear: the same low-pass applied to the force leaves
every linear force law unbiased, however low the cut-off (`lowpass`). Where the motion rests its
noise is taken off besides (`rests.held_still`).

At both ends the record is continued as an odd function about its end point. That is right where the
motion rests; elsewhere the result near the end depends on this guess, and `Motion.inner` leaves
those samples out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.fft import irfft, rfft, rfftfreq
from numpy.typing import NDArray
from scipy.fft import next_fast_len
from scipy.interpolate import make_interp_spline

from inerter.core_library import library
from inerter.motion_units import TRANSLATION, Kind
from inerter.records.even_clock import even_spacing
from inerter.records.record import Part, Record
from inerter.records.rests import LEAKS, at_rest, held_still, long_stretches

Array = NDArray[np.float64]
Shaft = tuple[float, float]

# samples within this many periods of the cut-off from an end are not used
EDGE_PERIODS = 2.5
# damping ratio of a resonance that a weight heeds; one of less would ring for ever
LEAST_LOSS = 0.01
# periods of the cut-off per sample below which the response and its exponentials are the same
_SLOW = 1 / 9
# samples of the segments that white noise is read from
NOISE_SEGMENT = 64
# bins of the upper third below which there is no more than noise, and power of a line per theirs
_QUIET, _LINE = 0.3, 5.0
# samples of shorter ones, and noise of these, per that of such, below which the longer ones have
# something sudden in each
_SHORTER, _CALMER = 16, 0.7
# share of a velocity's power within so much of one frequency, or so many bins of a windowed line,
# from which it has no other; samples below which a run tells nothing of it; periods in it, at least
_ONE_LINE, _WITHIN, _MAIN_LOBE, _FEWEST, _SWINGS = 0.99, 0.1, 2.5, 16, 1.5


@dataclass(frozen=True, kw_only=True)
class Motion:
    """A smoothed motion on a uniform clock, and the force beside it.

    Attributes
    ----------
    start, spacing : float
        Time of the first sample and between samples [s].
    displacement, velocity, acceleration : ndarray (n,)
        Smoothed [m, m/s, m/s^2].
    force : ndarray (n,)
        Measured force on the same clock [N], not smoothed.
    cutoff : float
        Cut-off of the smoother [Hz].
    inner : ndarray of bool (n,)
        False near the ends, where the smoother has to guess.
    velocity_noise, acceleration_noise : float
        Rms noise [m/s, m/s^2] that white noise on the displacement leaves.
    motion : str
        What the device does; in rotation read rad for m and N m for N.
    part : Part, optional
        Of which run it is a part.
    instants, zeroed
        As of a `Record`.
    """

    name: str
    start: float
    spacing: float
    displacement: Array
    velocity: Array
    acceleration: Array
    force: Array
    cutoff: float
    inner: NDArray[np.bool_]
    velocity_noise: float
    acceleration_noise: float
    motion: Kind = TRANSLATION
    part: Part | None = None
    instants: int = 1
    zeroed: float | None = None

    @property
    def clock(self) -> float:
        """Time from which slow changes count [s]."""
        return self.part.clock if self.part else self.start

    @property
    def time(self) -> Array:
        """Times of the samples [s], shape (n,)."""
        return self.start + self.spacing * np.arange(self.force.size, dtype=float)


def uniform(record: Record) -> tuple[float, dict[str, Array]]:
    """The record's channels on a uniform clock: sample spacing [s] and the channels.

    Uniform records are returned as they are; others are interpolated by a cubic spline at the
    median spacing.
    """
    channels = {"displacement": record.displacement, "force": record.force}
    for name in ("velocity", "acceleration"):
        if (values := getattr(record, name)) is not None:
            channels[name] = values
    return uniform_channels(record.time, channels)


def uniform_channels(time: Array, channels: Mapping[str, Array]) -> tuple[float, dict[str, Array]]:
    """Channels (n,) measured at times (n,) [s] on a uniform clock from the first time on.

    Returns the sample spacing [s] and the channels: as they are where the clock is uniform to 2 %
    of an interval or to what its times are rounded by, else interpolated by a cubic spline at the
    median spacing.
    """
    if (even := even_spacing(time)) is not None:
        return even, dict(channels)
    spacing = float(np.median(np.diff(time)))
    count = int((time[-1] - time[0]) / spacing + 1e-9) + 1
    grid = time[0] + spacing * np.arange(count)
    return spacing, {
        name: make_interp_spline(time, values, k=3)(grid) for name, values in channels.items()
    }


def response(frequency: NDArray[np.floating], cutoff: float) -> Array:
    """Amplitude response of the smoother at frequencies [Hz]."""
    return 1 / (1 + (frequency / cutoff) ** 6)


def _continued(values: Array, pivot: float, sign: float, least: int) -> Array:
    """Values and `pivot` plus `sign` times their mirror image at the end.

    2 x(T) and -1 for a displacement, 0 and 1 for its velocity, 0 and -1 for its acceleration. The
    image has `least` samples or some more, for a period that transforms are fast for; so long, the
    smoother forgets that the end was no end.
    """
    more = _fast_half(values.size + least) + 1 - values.size
    end = 0.5 * (pivot + (1 + sign) * values[-1])
    return np.r_[values[:-1], end, pivot + sign * values[-2 : -2 - more : -1]]


def _fast_half(size: int) -> int:
    """Half a period that transforms are fast for, of samples and their mirror image."""
    return int(next_fast_len(size - 1, real=True) or size - 1)


def _odd(values: Array) -> tuple[Array, Array]:
    """The line through both ends, and the odd periodic continuation of what is above it."""
    line = values[0] + (values[-1] - values[0]) * np.linspace(0, 1, values.size)
    rest = values - line
    return line, np.r_[rest, -rest[-2:0:-1]]


def _even(values: Array) -> Array:
    return np.r_[values, values[-2:0:-1]]


def lowpass(values: Array, spacing: float, cutoff: float) -> Array:
    """The smoother's low-pass applied to any channels, shape (..., n) to (..., n)."""
    return filtered(values, band_response(values.shape[-1], spacing, cutoff))


def band_response(size: int, spacing: float, cutoff: float) -> Array:
    """The smoother's response for `filtered`, at a length that transforms are fast for."""
    return response(rfftfreq(2 * _fast_half(size), spacing), cutoff)


def filtered(values: Array, response: Array) -> Array:
    """Channels (..., n) through a real response at the frequencies of their odd continuation.

    Between the channel and its mirror image the line through its ends goes on for as long as the
    response's length asks.
    """
    n, length = values.shape[-1], 2 * response.size - 2
    first, last = values[..., :1], values[..., -1:]
    line = first + (last - first) / (n - 1) * np.arange(n)
    wave = np.zeros((*values.shape[:-1], length))
    np.subtract(values, line, out=wave[..., :n])
    np.negative(wave[..., n - 2 : 0 : -1], out=wave[..., length - n + 2 :])
    return line + irfft(rfft(wave) * response, length)[..., :n]


def is_slow(spacing: float, cutoff: float, step: int) -> bool:
    """Whether a cut-off is so far below the sample rate that `filtered_and_thinned` can be used."""
    return step > 1 or cutoff * spacing < _SLOW


def filtered_and_thinned(values: Array, spacing: float, cutoff: float, step: int) -> Array:
    """Every `step`th sample of `lowpass`, (..., 1 + (n - 1) // step), in a fraction of its time.

    The nearer the cut-off is to the sample rate, the more it would differ: there it is `lowpass`.
    """
    if not is_slow(spacing, cutoff, step):
        return lowpass(values, spacing, cutoff)
    values = np.ascontiguousarray(values, dtype=np.float64)
    channels = values.reshape(-1, values.shape[-1])
    found = np.empty((len(channels), 1 + (values.shape[-1] - 1) // step))
    angle = 2.0 * np.pi * cutoff * spacing
    for channel, low in zip(channels, found, strict=True):
        size, data = channel.size, channel.ctypes.data
        library().inerter_low_pass(size, step, angle, data, low.ctypes.data)
    return found.reshape(*values.shape[:-1], -1)


def weight_above(
    size: int, spacing: float, corner: float, shaft: Shaft | None = None, quiet: float = np.inf
) -> Array:
    """1 / `motion_noise`^(1/2) for channels of a size, see `apply_weight`."""
    slowest = corner if shaft is None else min(corner, shaft[0] * max(shaft[1], LEAST_LOSS))
    least = (size + round(1 / (slowest * spacing)) + 1) // 2
    length = 2 * int(next_fast_len(least, real=True) or least)
    return motion_noise(rfftfreq(length, spacing), corner, shaft, quiet) ** -0.5


def motion_noise(
    frequency: NDArray[np.floating],
    corner: float,
    shaft: Shaft | None = None,
    quiet: float = np.inf,
) -> Array:
    """Power of a force's noise and of what the motion's noise adds, per the former (n,).

    White noise of the displacement becomes one of b a: (f / corner)^4. A shaft amplifies it near
    its resonance; what it takes away above is not counted.

    Parameters
    ----------
    frequency : ndarray (n,)
        In Hz.
    corner : float
        Frequency at which both are alike without a shaft [Hz].
    shaft : (float, float), optional
        Resonance [Hz] and damping ratio of the inertance on its series element.
    quiet : float
        Cut-off of a motion along which a force is compared in a wider band [Hz]: above it the
        motion has no noise any more.
    """
    noise = np.asarray(frequency / corner, dtype=float) ** 4 * response(frequency, quiet) ** 2
    if shaft is not None:
        noise *= np.maximum(through_shaft(frequency, shaft), 1.0)
    return 1 + noise


def through_shaft(frequency: NDArray[np.floating], shaft: Shaft) -> Array:
    """Power of b a behind a shaft, per that without, at frequencies [Hz], shape (n,)."""
    ratio = frequency / shaft[0]
    damping = 2j * max(shaft[1], LEAST_LOSS) * ratio
    return np.asarray(np.abs((1 + damping) / (1 - ratio**2 + damping)) ** 2, dtype=float)


def apply_weight(values: Array, weight: Array) -> Array:
    """Channels (..., n) times a weight at their frequencies, no shift; zero beyond the ends."""
    length = 2 * weight.size - 2
    return irfft(rfft(values, length) * weight, length)[..., : values.shape[-1]]


class Moving(Protocol):
    """What has a velocity (n,) [m/s], its samples `spacing` apart [s], and says which are known."""

    @property
    def spacing(self) -> float: ...
    @property
    def velocity(self) -> Array: ...
    @property
    def inner(self) -> NDArray[np.bool_]: ...


def has_one_line(runs: Sequence[Moving], noises: Sequence[float] = ()) -> bool:
    """Whether all velocities have one frequency, the same one.

    Then displacement and acceleration are proportional, however much noise the latter has. `noises`
    are those of the velocities, rms [m/s].
    """
    spectra, noise = [], 0.0
    for run, rms in zip(runs, noises or [0.0] * len(runs), strict=True):
        known = np.flatnonzero(run.inner)
        if known.size < _FEWEST:
            continue
        part = slice(known[0], known[-1] + 1)
        mask = run.inner[part]
        velocity = np.where(mask, run.velocity[part] - np.mean(run.velocity[known]), 0.0)
        window = np.hanning(mask.size) * mask
        power = np.abs(rfft(velocity * window)) ** 2
        spectra.append((rfftfreq(mask.size, run.spacing), power))
        noise += 0.5 * mask.size * rms**2 * float(window @ window)
    if not any(power.any() for _, power in spectra):
        return False
    frequency, power = max(spectra, key=lambda pair: float(pair[1].max()))
    line = frequency[np.argmax(power)]
    if line < _SWINGS * frequency[1]:
        # a machine that runs up or down swings nowhere
        return False
    near = everything = 0.0
    for frequency, power in spectra:
        width = max(_WITHIN * line, _MAIN_LOBE * frequency[1])
        near += float(power[np.abs(frequency - line) <= width].sum())
        everything += float(power.sum())
    # where more than half is noise, nothing is told
    return noise < 0.5 * everything and near > _ONE_LINE * (everything - noise)


def smooth(record: Record, cutoff: float, use: tuple[str, ...] = ("velocity",)) -> Motion:
    """Smoothed motion of a record.

    Parameters
    ----------
    record : Record
        Bench record.
    cutoff : float
        Cut-off [Hz].
    use : tuple of str
        Measured channels to weigh in beside the displacement, where the record has them:
        "velocity", "acceleration". Their weights come from the noise just above the cut-off.

    Returns
    -------
    Motion
    """
    spacing, channels = uniform(record)
    x = channels["displacement"]
    n = x.size
    edge = int(np.ceil(EDGE_PERIODS / cutoff / spacing))
    line, wave = _odd(_continued(x, 2 * x[-1], -1, edge))
    slope = (line[-1] - line[0]) / (spacing * (line.size - 1))
    period = wave.size
    frequency = rfftfreq(period, spacing)
    s = 2j * np.pi * frequency

    # each channel estimates the displacement's spectrum; weights are inverse noise powers
    measured = [(rfft(wave), np.ones_like(s))]
    if "velocity" in use and "velocity" in channels:
        measured.append((rfft(_even(_continued(channels["velocity"], 0, 1, edge) - slope)), s))
    if "acceleration" in use and "acceleration" in channels:
        measured.append(
            (rfft(_odd_about_zero(_continued(channels["acceleration"], 0, -1, edge))), s * s)
        )
    band = (frequency > 1.5 * cutoff) & (frequency < 4 * cutoff)
    total = np.zeros_like(s)
    weight_sum = np.zeros(s.size)
    for spectrum, operator in measured:
        noise = np.mean(np.abs(spectrum[band]) ** 2) if len(measured) > 1 and band.any() else 1.0
        weight = 1 / max(float(noise), 1e-300)
        total += weight * np.conj(operator) * spectrum
        weight_sum += weight * np.abs(operator) ** 2
    weight_sum[weight_sum == 0] = 1
    estimate = total / weight_sum * response(frequency, cutoff)

    displacement = irfft(estimate, period)[:n] + line[:n]
    velocity = irfft(s * estimate, period)[:n] + slope
    acceleration = irfft(s * s * estimate, period)[:n]
    inner = np.ones(n, bool)
    if not at_rest(velocity, spacing):
        inner[:edge] = False
    if not at_rest(velocity[::-1], spacing):
        inner[n - edge :] = False

    # across a gap the motion is a guess
    steps = np.diff(record.time)
    for i in np.flatnonzero(steps > max(0.5 / cutoff, 3 * np.median(steps))):
        begin, end = (int((t - record.time[0]) / spacing) for t in record.time[i : i + 2])
        inner[max(begin - edge, 0) : end + edge] = False
    if record.slowest:
        inner &= ~long_stretches(np.abs(velocity) < record.slowest, spacing, cutoff, LEAKS)
    velocity_noise, acceleration_noise = _derivative_noise(x, spacing, cutoff)
    motion = displacement, velocity, acceleration
    displacement, velocity, acceleration = held_still(x, motion, spacing, cutoff, velocity_noise)
    return Motion(
        name=record.name, start=float(record.time[0]), spacing=spacing,
        displacement=displacement, velocity=velocity, acceleration=acceleration,
        force=channels["force"], cutoff=cutoff, inner=inner,
        velocity_noise=velocity_noise, acceleration_noise=acceleration_noise,
        motion=record.motion, part=record.part, zeroed=record.zeroed, instants=record.instants,
    )  # fmt: skip


def white_noise(values: Array) -> float:
    """Rms of white noise on a channel, from the upper third of its spectrum.

    A low quantile over short segments, so that the many with something sudden in them, such as a
    reversal of friction, do not count. A channel that was filtered before it was stored has no
    noise there: then this is too low.
    """
    return _in_segments(values, NOISE_SEGMENT)


def force_noise(force: Array) -> float:
    """`white_noise` of a force, over shorter segments where each longer one has a jump in it.

    At a few hundred samples per second friction turns about within every longer one.
    """
    usual, shorter = (_in_segments(force, length) for length in (NOISE_SEGMENT, _SHORTER))
    return shorter if 0.0 < shorter < _CALMER * usual else usual


def _in_segments(values: Array, length: int) -> float:
    """That of segments of a length; 0 of channels that are shorter."""
    quantile = 0.2
    usable = values.size // length * length
    if values.size < NOISE_SEGMENT:
        return 0.0
    segments = values[:usable].reshape(-1, length)
    ends = segments[:, :1] + (segments[:, -1:] - segments[:, :1]) * np.linspace(0, 1, length)
    window = np.hanning(length)
    power = np.abs(rfft((segments - ends) * window, axis=1)) ** 2 / np.sum(window**2)
    upper = np.quantile(power[:, 2 * power.shape[1] // 3 : -1], quantile, axis=0)

    # what stands out of it is a tone: hum, or a drive that rings
    upper = upper[upper <= _LINE * np.quantile(upper, _QUIET)]
    # the power of white noise is distributed exponentially; this is the mean of that quantile
    count = len(segments)
    ordered = np.cumsum(1.0 / (count - np.arange(count)))
    expected = np.interp(quantile * (count - 1), np.arange(count), ordered)
    return float(np.sqrt(np.mean(upper) / expected))


def _derivative_noise(displacement: Array, spacing: float, cutoff: float) -> tuple[float, float]:
    """Rms noise of velocity and acceleration: the smoother's integral over white noise."""
    density = white_noise(displacement) ** 2 * 2 * spacing
    velocity = 2 * np.pi * np.sqrt(density * cutoff**3 * np.pi / 12)
    acceleration = (2 * np.pi) ** 2 * np.sqrt(density * cutoff**5 * np.pi / 18)
    return float(velocity), float(acceleration)


def _odd_about_zero(values: Array) -> Array:
    wave = np.r_[values, -values[-2:0:-1]]
    wave[0] = wave[values.size - 1] = 0
    return wave
