"""Sums of samples over many waves of the place at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# shortest wave that is looked for, as a share of the travel: in any motion, and where it is slow
# enough (36 waves a turn, along eleven turns)
_USUAL, _FINEST = 1 / 60, 1 / 400
# samples in which half of a motion that is slow enough goes through one
_THROUGH = 8.0
# places per period of the shortest wave that are told apart
_PLACES = 32


def shortest(travel: float, path: float) -> float:
    """Shortest wave that is looked for along a travel, where half of the samples go no `path` on.

    All in one unit. Samples that step through a wave show another one there, but for where the
    motion turns.
    """
    return travel * min(_USUAL, max(_FINEST, _THROUGH * path / travel))


def wave_sums(x: Array, weights: Array, step: float, count: int) -> NDArray[np.complex128]:
    """Sums of weights (m, n) times exp(2 pi i j step x) for j = 0 ... count - 1, (m, count).

    Places (n,) are rounded so that no phase is off by more than a tenth of a radian.
    """
    size = 1 << int(np.ceil(np.log2(_PLACES * count)))
    begin = float(np.min(x))
    places = np.rint((x - begin) * step * size).astype(np.intp) % size
    binned = np.array([np.bincount(places, each, size) for each in weights])
    numbers = step * np.arange(count)
    return np.fft.rfft(binned)[:, :count].conj() * np.exp(2j * np.pi * begin * numbers)


def shares_taken(
    x: Array, values: Array, level: Array, rise: Array, step: float, count: int
) -> Array:
    """Shares of the square of values (n,) that each wave takes, fitted, shape (count,).

    A wave f of the place adds level f + rise f' to the values: its cosine and sine do, with the
    numbers j step for j = 0 ... count - 1 per unit of the place.
    """
    of_values = wave_sums(x, np.array([level * values, rise * values]), step, count)
    squares = np.array([level**2, rise**2, level * rise])
    whole = squares.sum(axis=1)
    twice = wave_sums(x, squares, step, 2 * count)[:, ::2]
    rate = 2 * np.pi * step * np.arange(count)

    along = of_values[0] + 1j * rate * of_values[1]
    both = whole[0] + rate**2 * whole[1]
    other = twice[0] - rate**2 * twice[1] + 2j * rate * twice[2]
    cosine, sine, mixed = (both + other.real) / 2, (both - other.real) / 2, other.imag / 2
    determinant = np.maximum(cosine * sine - mixed**2, 1e-9 * both**2 + 1e-300)
    taken = sine * along.real**2 - 2 * mixed * along.real * along.imag + cosine * along.imag**2
    return taken / determinant / max(float(values @ values), 1e-300)
