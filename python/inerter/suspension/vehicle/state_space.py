"""A plane of motion as x' = A x + a p + Bf wf' + Br wr', for arrays of designs.

The inputs are the velocities of the road under the two axles. States are velocities of the body and
of the wheels, elongations e of the struts and deflections y of the tyres, which stay bounded on a
road that wanders, and the states of the struts. With the strut force u = k e + m e'' + d e' + r,

    M q'' = -S^T u         mu w'' = u - kt y - ct y'      e' = S q' - w'      y' = w' - road'

A body of two displacements has two elongations and two deflections. One of a single displacement
has e_r = e_f + y_f - y_r - p with the warp p = road_r - road_f, which is no state: it is driven by
the road alone, p' = wr' - wf', and stays where it is. So every state is strictly stable.

A tyre's damper hands the road's velocity on at once: to the wheels (Bf, Br), through an inerter to
the body, and to the tyre force; what a signal has of it at once is its feed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import matrix_balance

from inerter.suspension.vehicle.cars import Plane
from inerter.suspension.vehicle.strut import Branch

Matrix = NDArray[Any]


@dataclass(frozen=True, kw_only=True)
class System:
    """Matrices of arrays of designs; n states.

    Attributes
    ----------
    matrix, warp
        A (..., n, n) and a (..., n); a is None for a body of two displacements.
    front, rear
        Bf, Br, shape (n,), with tyre damping (..., n).
    acceleration, acceleration_warp
        Of the body above the axles [m/s^2]: rows (..., 2, n), per p (..., 2).
    tyre
        Tyre forces [N]: rows (2, n); the warp is not in them but through the states.
    load
        Input column (..., n) of a force on the body's coordinates, for each of them: (..., n, q).
    travel, travel_warp
        Elongations of the struts [m]: rows (2, n), per p (2,).
    turn
        As of the plane.
    height
        Displacement of the body above the axles on a flat road: rows (2, n).
    acceleration_feed, tyre_feed
        Of the road's velocities in these signals at once, (..., 2, 2): signal, axle of the road.
        None without tyre damping.
    """

    matrix: Matrix
    warp: Matrix | None
    front: NDArray[np.float64]
    rear: NDArray[np.float64]
    acceleration: Matrix
    acceleration_warp: Matrix | None
    tyre: NDArray[np.float64]
    load: Matrix
    height: NDArray[np.float64]
    travel: NDArray[np.float64]
    travel_warp: NDArray[np.float64]
    turn: float = 0.0
    acceleration_feed: Matrix | None = None
    tyre_feed: Matrix | None = None


def system(plane: Plane, branches: tuple[Branch, Branch]) -> System:
    """The matrices of a plane with the struts of its two axles."""
    body = len(plane.inertia)
    front_bar, rear_bar = plane.bars
    if front_bar or rear_bar:
        branches = (
            replace(branches[0], stiffness=branches[0].stiffness + front_bar),
            replace(branches[1], stiffness=branches[1].stiffness + rear_bar),
        )
    orders = [branch.order for branch in branches]
    # places of the states: body and wheel velocities, then lengths, then the struts' own
    speeds = body + 2
    lengths = 2 + body
    count = speeds + lengths + sum(orders)
    shape = np.broadcast_shapes(*(np.shape(branch.mass) for branch in branches))
    kind = np.result_type(float, *(branch.mass for branch in branches),
                          *(branch.rest.denominator for branch in branches),
                          *(branch.damping for branch in branches))  # fmt: skip
    elongation, deflection, by_warp = _lengths(body, speeds, count)
    speed = np.zeros((2, count))
    speed[:, :body] = plane.shape
    speed[:, body:speeds] = -np.eye(2)

    # strut forces without their part in the accelerations, as rows over the states
    matrix = np.zeros((*shape, count, count), dtype=kind)
    force = np.zeros((*shape, 2, count), dtype=kind)
    place = speeds + lengths
    for n, branch in enumerate(branches):
        force[..., n, :] = (
            branch.stiffness[..., None] * elongation[n] + branch.damping[..., None] * speed[n]
        )
        if branch.order:
            own, out, rate = _realisation(branch)
            inner = slice(place, place + branch.order)
            matrix[..., inner, inner] = own
            matrix[..., place + branch.order - 1, :] += rate[..., None] * speed[n]
            force[..., n, inner] = out
            place += branch.order

    # both inertances couple body and wheels
    pull = np.concatenate([-plane.shape.T, np.eye(2)])
    across = np.concatenate([plane.shape, -np.eye(2)], axis=1)
    inertances = np.stack([np.broadcast_to(branch.mass, shape) for branch in branches], axis=-1)
    inertia = np.zeros((speeds, speeds))
    inertia[:body, :body] = plane.inertia
    inertia[body:, body:] = np.diag(plane.wheel_masses)
    total = inertia + (across.T * inertances[..., None, :]) @ across
    inverse = np.linalg.inv(total)
    tyre = np.array(plane.tyre_stiffnesses)[:, None] * deflection
    push = np.zeros((speeds, count))
    dampers = np.array(plane.tyre_dampings)
    tyre[:, body:speeds] += np.diag(dampers)
    push[body:] = -tyre
    matrix[..., :speeds, :] = inverse @ (pull @ force + push)

    # lengths follow from velocities
    first = speeds
    for n in range(body):
        matrix[..., first + n, :] = speed[n]
    for n in range(2):
        matrix[..., first + body + n, body + n] = 1.0
    front, rear = np.zeros(count), np.zeros(count)
    front[first + body] = rear[first + body + 1] = -1.0

    warp = acceleration_warp = acceleration_feed = tyre_feed = None
    if dampers.any():
        at_once = inverse[..., :, body:] * dampers
        still = np.zeros((*shape, count - speeds))
        front = np.concatenate([at_once[..., 0], still], axis=-1) + front
        rear = np.concatenate([at_once[..., 1], still], axis=-1) + rear
        acceleration_feed, tyre_feed = plane.shape @ at_once[..., :body, :], -np.diag(dampers)
    if body == 1:
        springs = np.stack([branch.stiffness * by_warp[n] for n, branch in enumerate(branches)], -1)
        warp = np.zeros((*shape, count), dtype=kind)
        warp[..., :speeds] = (inverse @ (pull @ springs[..., None]))[..., 0]
        acceleration_warp = warp[..., :body] @ plane.shape.T
    load = np.zeros((*shape, count, body), dtype=kind)
    load[..., :speeds, :] = inverse[..., :, :body]
    return System(
        matrix=matrix,
        warp=warp,
        front=front,
        rear=rear,
        acceleration=plane.shape @ matrix[..., :body, :],
        acceleration_warp=acceleration_warp,
        tyre=tyre,
        load=load,
        height=elongation + deflection,
        travel=elongation,
        travel_warp=by_warp,
        turn=plane.turn,
        acceleration_feed=acceleration_feed,
        tyre_feed=tyre_feed,
    )


def balanced(matrix: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A matrix over states of like size, each the old one over its scale, and those scales."""
    answer: Any = matrix_balance(matrix, permute=False, separate=True)
    return answer[0], answer[1][0]


def _lengths(body: int, first: int, count: int) -> tuple[Matrix, Matrix, Matrix]:
    """Rows of the elongations and the deflections (2, n), and elongations per warp (2,)."""
    elongation, deflection = np.zeros((2, count)), np.zeros((2, count))
    for n in range(2):
        deflection[n, first + body + n] = 1.0
    elongation[0, first] = 1.0
    if body == 2:
        elongation[1, first + 1] = 1.0
        return elongation, deflection, np.zeros(2)
    elongation[1] = elongation[0] + deflection[0] - deflection[1]
    return elongation, deflection, np.array([0.0, -1.0])


def _realisation(branch: Branch) -> tuple[Matrix, Matrix, Matrix]:
    """State matrix, output row and input rate of R, in the time of its own mean pole."""
    order, below = branch.order, branch.rest.denominator
    rate = np.abs(np.real(below[..., 0])) ** (1.0 / order)
    powers = rate[..., None] ** (np.arange(order) - order)
    own = np.zeros((*below.shape[:-1], order, order), dtype=below.dtype)
    own[..., np.arange(order - 1), np.arange(1, order)] = rate[..., None]
    own[..., -1, :] = -rate[..., None] * below[..., :order] * powers
    return own, branch.rest.numerator * powers, rate
