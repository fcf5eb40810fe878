"""A low-pass in one of the record's channels: the force's, or the displacement's.

    H(s) = 1 / D(s / w),  w = 2 pi f_c,  |H| = 1 / sqrt(2) at the cut-off f_c

D is the polynomial of Butterworth (no ripple) or of Bessel (all that passes is equally late), of
order one to four. Well below f_c a filter is a delay, and nothing else; what tells it from one is
the amplitude that it takes away nearer to f_c.

A filter of the force channel acts on the force that a model predicts. One of the displacement
channel is taken out of the motion, as far as that is known: where the filter leaves less than
`LEAST` of an amplitude, no more than that is put back.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.fft import irfft, rfft, rfftfreq
from numpy.typing import NDArray
from scipy.fft import next_fast_len
from scipy.signal import bessel, butter

from inerter.identify.kept import Kept

Array = NDArray[np.float64]

CHANNELS = ("force", "displacement")
KINDS = ("butterworth", "bessel")
ORDERS = (1, 2, 3, 4)
USUAL_ORDER = 4
START = 8.0
"""Time constants of a filter's slowest response for which it remembers."""
LEAST = 0.1
"""Share of an amplitude that a filter leaves, below which it is not put back."""


@dataclass(frozen=True)
class Filter:
    """A low-pass: kind, order and cut-off [Hz] (-3 dB)."""

    kind: str
    order: int
    cutoff: float

    @classmethod
    def as_late_as(cls, delay: float, kind: str = KINDS[0], order: int = USUAL_ORDER) -> Filter:
        """The one of a kind and order that makes what is slow late by a delay > 0 [s]."""
        unit = cls(kind, order, 1.0)
        return replace(unit, cutoff=unit.lateness / delay)

    @property
    def text(self) -> str:
        """As it is stated: "bessel:50:4"."""
        return f"{self.kind}:{self.cutoff!r}:{self.order}"

    @property
    def words(self) -> str:
        """Such as "Bessel, order 4"; of order 1 they are all alike."""
        kind = f"{self.kind.capitalize()}, " if self.order > 1 else ""
        return f"{kind}order {self.order}"

    @property
    def lateness(self) -> float:
        """Time by which it makes what is slow late [s]."""
        d = denominator(self.kind, self.order)
        return d[-2] / d[-1] / (2 * math.pi * self.cutoff)

    def response(self, frequency: NDArray[np.floating]) -> NDArray[np.complex128]:
        """H at frequencies [Hz]."""
        d = denominator(self.kind, self.order)
        angle = frequency / self.cutoff
        square = -(angle**2)
        # even and odd powers of i angle
        even, odd = np.polyval(d[-1::-2][::-1], square), np.polyval(d[-2::-2][::-1], square)
        odd = odd * angle
        return (d[-1] / (even**2 + odd**2)) * (even - 1j * odd)


@functools.cache
def denominator(kind: str, order: int) -> tuple[float, ...]:
    """Coefficients of D, the highest power first, for a cut-off of 1 rad/s."""
    found: Any = bessel(order, 1.0, analog=True, norm="mag") if kind == "bessel" else None
    found = found or butter(order, 1.0, analog=True)
    return tuple(float(value) for value in found[1])


def named(channel: str, found: Filter) -> dict[str, float]:
    """A filter as coordinates: its cut-off [Hz], order, and 1 for Bessel."""
    return {
        f"{channel}_filter": found.cutoff,
        f"{channel}_filter_order": float(found.order),
        f"{channel}_filter_bessel": float(found.kind == "bessel"),
    }


def filter_of(values: Mapping[str, float], channel: str) -> Filter | None:
    """The filter of a channel that some coordinates have, if any."""
    cutoff = values.get(f"{channel}_filter")
    if not cutoff:
        return None
    kind = "bessel" if values.get(f"{channel}_filter_bessel") else "butterworth"
    return Filter(kind, int(values.get(f"{channel}_filter_order", USUAL_ORDER)), float(cutoff))


def slow_start(values: Mapping[str, float]) -> Filter | None:
    """What decides how long a force shows what came before the record: its filter, if any.

    Else of a force that is late a filter of the usual order which is as late: nobody has measured
    what it shows first either, and the two have to be judged alike.
    """
    delay = values.get("delay", 0.0)
    if (low_pass := filter_of(values, "force")) is not None or not delay > 0.0:
        return low_pass
    return Filter.as_late_as(delay)


def filters_of(values: Mapping[str, float]) -> dict[str, Filter]:
    """The filters that some coordinates have, by channel."""
    found = {channel: filter_of(values, channel) for channel in CHANNELS}
    return {channel: each for channel, each in found.items() if each is not None}


def read_filter(text: str, where: str) -> Filter:
    """A filter as it is stated: "bessel:50", "butterworth:60 Hz:2".

    Raises
    ------
    ValueError
        It cannot be read; the message says what is allowed.
    """
    kind, _, rest = text.strip().partition(":")
    cutoff, _, order = rest.partition(":")
    names = [
        name
        for name in KINDS
        if kind.strip().casefold() and name.startswith(kind.strip().casefold())
    ]
    try:
        value = float(cutoff.strip().removesuffix("Hz").strip())
        degree = int(order) if order.strip() else USUAL_ORDER
    except ValueError:
        value, degree = math.nan, 0
    if len(names) != 1 or not 0 < value < math.inf or degree not in ORDERS:
        raise ValueError(
            f"{where} is {text[:60]!r}; give the kind ({' or '.join(KINDS)}), the cut-off in Hz at "
            f"-3 dB and the order (1 to 4, {USUAL_ORDER} where it is left out), such as bessel:50 "
            "or butterworth:60:2"
        )
    return Filter(names[0], degree, value)


def stated_filters(given: Iterable[str]) -> dict[str, Filter]:
    """Filters by channel, as options state them: "force=bessel:50".

    Raises
    ------
    ValueError
        No channel, or a filter that cannot be read.
    """
    found = {}
    for text in given:
        channel, sign, stated = text.partition("=")
        if not sign or channel.strip() not in CHANNELS:
            raise ValueError(
                f"--filter {text[:60]!r}: give CHANNEL=KIND:CUTOFF of the channel "
                f"{' or '.join(CHANNELS)}, such as --filter force=bessel:50"
            )
        found[channel.strip()] = read_filter(stated, f"--filter {channel.strip()}")
    return found


# responses [bytes] that are kept in a process: a fit asks for that of one filter for many forces
_RESPONSES: Kept[np.complex128] = Kept(2**23)


def _response(by: Filter, half: int, spacing: float, inverse: bool) -> NDArray[np.complex128]:
    """Of a filter, or of what takes it back, at the frequencies of 2 `half` samples."""
    response = by.response(rfftfreq(2 * half, spacing))
    return _inverted(response) if inverse else response


def filtered(values: Array, spacing: float, by: Filter, inverse: bool = False) -> Array:
    """Channels (..., n) through a filter, or before it; samples `spacing` apart [s].

    Before its first sample the channel is taken to have been odd about it.
    """
    n = values.shape[-1]
    half = int(next_fast_len(n - 1, real=True) or n - 1)
    key = by, half, spacing, inverse
    response = _RESPONSES.found(key, lambda: _response(by, half, spacing, inverse))
    lateness = -by.lateness if inverse else by.lateness
    # the line through both ends passes as it is, only later
    first, last = values[..., :1], values[..., -1:]
    slope = (last - first) / (n - 1)
    line = first + slope * np.arange(n)
    wave = np.zeros((*values.shape[:-1], 2 * half))
    np.subtract(values, line, out=wave[..., :n])
    np.negative(wave[..., n - 2 : 0 : -1], out=wave[..., 2 * half - n + 2 :])
    return line - slope * lateness / spacing + irfft(rfft(wave) * response, 2 * half)[..., :n]


# share of a free response that has to be seen to tell its size
_SEEN = 0.5


def without_start(
    residual: Array, spacing: float, mask: NDArray[np.bool_], by: Filter, first: int
) -> Array:
    """A residual (..., n) without what a filter still holds of the time before the sample `first`.

    That is a sum of the filter's free responses, read off the masked samples that follow; where
    these have less than half of one of them (a fold without the beginning), off all samples, for
    nothing else tells it: what is left of a response later on tells next to nothing of its size.
    """
    poles = _poles(by.kind, by.order) * by.cutoff
    slowest = abs(float(np.max(poles.real)))
    count = min(int(START / slowest / spacing) + 1, residual.shape[-1] - first)
    part = slice(first, first + count)
    if count < 2 * by.order:
        return residual
    responses, sizes = _free_responses(by, spacing, count, mask[part].tobytes())
    left = residual.copy()
    left[..., part] -= (residual[..., part] @ sizes) @ responses
    return left


@functools.cache
def _poles(kind: str, order: int) -> NDArray[np.complex128]:
    """Of a filter with a cut-off of 1 Hz [1/s]."""
    return np.asarray(np.roots(denominator(kind, order)) * 2 * math.pi, dtype=np.complex128)


# asked for once for each column of a fit, with the same filter
@functools.lru_cache(maxsize=16)
def _free_responses(by: Filter, spacing: float, count: int, masked: bytes) -> tuple[Array, Array]:
    """Free responses (q, n), and what tells their sizes of the n samples they are in, (n, q)."""
    known = np.frombuffer(masked, dtype=np.bool_)
    poles, times = _poles(by.kind, by.order) * by.cutoff, spacing * np.arange(count)
    waves = [np.exp(pole * times) for pole in poles if pole.imag > -1e-9 * abs(pole)]
    # of a pair of poles the real and the imaginary part, of a real one the real part alone
    columns = np.array([each for wave in waves for each in (wave.real, wave.imag) if each.any()]).T
    seen = np.sum(columns[known] ** 2, axis=0) / np.sum(columns**2, axis=0)
    if np.min(seen) < _SEEN or np.sum(known) < 2 * by.order:
        known = np.ones(count, bool)
    sizes = np.zeros_like(columns)
    sizes[known] = np.linalg.pinv(columns[known], rcond=1e-6).T
    return columns.T, sizes


def _inverted(response: NDArray[np.complex128]) -> NDArray[np.complex128]:
    size = np.abs(response)
    return np.asarray(np.conj(response) / (size * np.maximum(size, LEAST)), dtype=np.complex128)
