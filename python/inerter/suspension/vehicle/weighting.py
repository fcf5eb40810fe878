"""A plane of motion whose accelerations go through the weighting Wk: states of the filter beside.

Each point of the body has a filter of its own, f' = F f + g a with the acceleration a = C x + c p
of that point; the weighted accelerations are rows over f alone, as Wk is strictly proper.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from inerter.suspension.comfort_weighting import weighting
from inerter.suspension.h2_norm import companion, scaled
from inerter.suspension.vehicle.state_space import System


def weighted(plane: System) -> System:
    """The same plane with weighted accelerations in place of its own."""
    top, below, rate = scaled(weighting())
    own, column, row = companion(top, below)
    # in the time of the plane; input and output share the gain of the change of time
    own, column = own * rate, column * rate
    points, count = plane.acceleration.shape[-2], plane.matrix.shape[-1]
    order = len(own)
    more = points * order
    shape, kind = plane.matrix.shape[:-2], plane.matrix.dtype
    drive = np.kron(np.eye(points), column[:, None])
    matrix = np.zeros((*shape, count + more, count + more), dtype=kind)
    matrix[..., :count, :count] = plane.matrix
    matrix[..., count:, :count] = drive @ plane.acceleration
    matrix[..., count:, count:] = np.kron(np.eye(points), own)
    rows = np.zeros((*shape, points, count + more), dtype=kind)
    rows[..., count:] = np.kron(np.eye(points), row)
    warp = acceleration_warp = None
    if plane.warp is not None and plane.acceleration_warp is not None:
        through = (drive @ plane.acceleration_warp[..., None])[..., 0]
        warp = np.concatenate([plane.warp, through], axis=-1)
        acceleration_warp = np.zeros_like(plane.acceleration_warp)
    still = np.zeros(more)
    return replace(
        plane,
        matrix=matrix,
        warp=warp,
        front=np.append(plane.front, still),
        rear=np.append(plane.rear, still),
        acceleration=rows,
        acceleration_warp=acceleration_warp,
    )
