"""A plane of motion whose signals go through a filter W(s): states of the filter beside.

Each signal y = C x + c p has a filter of its own, f' = F f + g y; what comes out is h f + d y, with
d = 0 where W is strictly proper, as Wk is.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.h2_norm import companion, scaled
from inerter.suspension.rational import Rational, add
from inerter.suspension.vehicle.state_space import System

Matrix = NDArray[Any]


def weighted(
    plane: System,
    signals: Matrix,
    by_warp: Matrix | None,
    felt: Rational,
    feed: Matrix | None = None,
) -> tuple[System, Matrix, Matrix | None, Matrix | None]:
    """The plane with the filters' states, and the filtered signals: rows, per warp, feed.

    Parameters
    ----------
    plane
        Without the filters.
    signals, by_warp
        Rows (..., 2, n), and per warp (..., 2).
    felt
        W(s), stable and proper.
    feed
        Of the roads' velocities in the signals at once (..., 2, 2), None without.
    """
    through = 0.0
    if felt.numerator.shape[-1] == felt.denominator.shape[-1]:
        through = float(felt.numerator[-1] / felt.denominator[-1])
        rest = add(felt.numerator, -through * felt.denominator)[:-1]
        felt = Rational(rest if len(rest) else np.zeros(1), felt.denominator)
    if felt.denominator.shape[-1] == 1:
        bent = None if by_warp is None else through * by_warp
        return plane, through * signals, bent, None if feed is None else through * feed
    top, below, rate = scaled(felt)
    own, column, row = companion(top, below)
    # in the time of the plane; input and output share the gain of the change of time
    own, column = own * rate, column * rate
    points, count = signals.shape[-2], plane.matrix.shape[-1]
    order = len(own)
    more = points * order
    shape, kind = plane.matrix.shape[:-2], plane.matrix.dtype
    drive = np.kron(np.eye(points), column[:, None])
    matrix = np.zeros((*shape, count + more, count + more), dtype=kind)
    matrix[..., :count, :count] = plane.matrix
    matrix[..., count:, :count] = drive @ signals
    matrix[..., count:, count:] = np.kron(np.eye(points), own)
    rows = np.zeros((*shape, points, count + more), dtype=kind)
    rows[..., :count] = through * signals
    rows[..., count:] = np.kron(np.eye(points), row)
    warp = left = None
    if plane.warp is not None and by_warp is not None:
        driven = (drive @ by_warp[..., None])[..., 0]
        warp = np.concatenate([plane.warp, np.broadcast_to(driven, (*shape, more))], axis=-1)
        left = through * by_warp
    entering = np.zeros((more, 2)) if feed is None else drive @ feed
    front, rear = (
        np.concatenate([own, np.broadcast_to(felt_at_once, (*own.shape[:-1], more))], axis=-1)
        for own, felt_at_once in ((plane.front, entering[..., 0]), (plane.rear, entering[..., 1]))
    )
    whole = replace(
        plane,
        matrix=matrix,
        warp=warp,
        front=front,
        rear=rear,
    )
    return whole, rows, left, None if feed is None or not through else through * feed
