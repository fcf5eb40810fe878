"""Sizes of hidden effects: a share of a force, and numbers that a person could have set."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def size_for_share(share: float, bare: NDArray[np.float64], extra: NDArray[np.float64]) -> float:
    """P such that rms(p extra) = share rms(bare + p extra); forces [N] of shape (n,)."""
    square = share * share
    roots = np.roots(
        [
            np.mean(extra * extra) * (1.0 - square),
            -2.0 * square * np.mean(bare * extra),
            -square * np.mean(bare * bare),
        ]
    )
    return float(np.max(roots.real))


def rms(signal: NDArray[np.float64]) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(signal * signal)))


def rounded(value: float) -> float:
    """Four significant digits: numbers a person could have set."""
    return float(f"{float(value):.4g}")
