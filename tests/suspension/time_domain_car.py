"""A quarter-car as a state space, written apart from the product: what the tests compare with."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_continuous_lyapunov

Array = NDArray[np.float64]

MS, MU, KT, V, KAPPA = 181.75, 25.0, 120e3, 25.0, 5e-7
SOFT = (1e6, 3200.0)


def state_space(
    layout: str, k: float, c: float, b: float, pair: tuple[float, float] | None
) -> tuple[Array, Array, Array]:
    """A, and the columns of road height [m] and load on the body [N].

    The state is (zs, zu, zs', zu') and what the strut has of its own: the flywheel's displacement
    against the wheel and its speed.
    """
    x, v = np.zeros(6), np.zeros(6)
    x[[0, 1]], v[[2, 3]] = (1.0, -1.0), (1.0, -1.0)
    y, w = np.eye(6)[4], np.eye(6)[5]
    rates = np.zeros((6, 6))
    rates[0, 2] = rates[1, 3] = rates[4, 5] = 1.0
    road, load = np.zeros(6), np.zeros(6)
    tyre = KT * np.eye(6)[1]

    # force of the strut beside the inertance, and the flywheel
    force, mass = k * x, np.diag([MS, MU])
    if layout in ("S1", "S2"):
        force = force + c * v
    if layout == "S2" and pair is None:
        mass = mass + b * np.array([[1.0, -1.0], [-1.0, 1.0]])
    elif layout == "S2":
        assert pair is not None
        shaft = pair[0] * (x - y) + pair[1] * (v - w)
        force, rates[5] = force + shaft, shaft / b
    elif layout == "S3" and pair is None:
        force = force + c * (v - w)
        rates[5] = c * (v - w) / b
    elif layout == "S3":
        # node n between damper and shaft: c (v - n') = ks (n - y) + cs (n' - w); n is a state
        return _elastic_s3(k, c, b, *(pair or SOFT))
    right = np.array([-force, force - tyre])
    inverse = np.linalg.inv(mass)
    rates[2:4] = inverse @ right
    road[2:4], load[2:4] = inverse @ [0.0, KT], inverse @ [1.0, 0.0]
    used = [0, 1, 2, 3] if layout == "S1" or (layout == "S2" and pair is None) else list(range(6))
    if layout == "S3":
        used = [0, 1, 2, 3, 5]
    return rates[np.ix_(used, used)], road[used], load[used]


def _elastic_s3(k: float, c: float, b: float, ks: float, cs: float) -> tuple[Array, Array, Array]:
    """State (zs, zu, zs', zu', n - y, w), n node, y flywheel, both against the wheel."""
    x, v = np.array([1.0, -1, 0, 0, 0, 0]), np.array([0, 0, 1.0, -1, 0, 0])
    s, w = np.eye(6)[4], np.eye(6)[5]
    node = (c * v + cs * w - ks * s) / (c + cs)
    through = c * (v - node)
    force = k * x + through
    rates = np.zeros((6, 6))
    rates[0, 2] = rates[1, 3] = 1.0
    rates[2], rates[3] = -force / MS, (force - KT * np.eye(6)[1]) / MU
    rates[4], rates[5] = node - w, through / b
    road, load = np.zeros(6), np.zeros(6)
    road[3], load[2] = KT / MU, 1.0 / MS
    return rates, road, load


def norms(layout: str, k: float, c: float, b: float, pair: tuple[float, float] | None) -> Array:
    """J1 and J3 by the Lyapunov equation: the car under white noise as the road's slope.

    With q = (zs - zr, zu - zr, zs', zu', ...) the road enters as zr' alone; its feed-through to
    zs'' (a rigid inertance) has no part in || s T ||, whose output is zs' per zr.
    """
    a, _, _ = state_space(layout, k, c, b, pair)
    n = len(a)
    # a step of the road = the car displaced against it: from rest, zr' = delta
    jump = np.zeros(n)
    jump[:2] = -1.0
    gramian = solve_continuous_lyapunov(a, -np.outer(jump, jump))
    acceleration = a[2]
    tyre = KT * np.eye(n)[1]
    slope = 2.0 * math.pi * math.sqrt(V * KAPPA)
    return slope * np.sqrt([acceleration @ gramian @ acceleration, tyre @ gramian @ tyre])


def body_per_load(
    f: Array, layout: str, k: float, c: float, b: float, pair: tuple[float, float] | None
) -> Array:
    """abs(zs/Fs) [m/N] at frequencies [Hz]."""
    a, _, load = state_space(layout, k, c, b, pair)
    eye = np.eye(len(a))
    return np.array([abs(np.linalg.solve(2j * np.pi * w * eye - a, load)[0]) for w in f])


def road_responses(
    f: Array, layout: str, k: float, c: float, b: float, pair: tuple[float, float] | None
) -> tuple[Array, Array]:
    """abs(zs''/zr) [1/s^2] and abs(Fr/zr) [N/m] at frequencies [Hz]."""
    a, road, _ = state_space(layout, k, c, b, pair)
    s = 2j * np.pi * f
    x = np.linalg.solve(
        s[:, None, None] * np.eye(len(a)) - a, np.tile(road, (f.size, 1))[..., None]
    )
    return np.abs(s**2 * x[:, 0, 0]), np.abs(KT * (x[:, 1, 0] - 1.0))
