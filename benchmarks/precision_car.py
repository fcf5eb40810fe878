"""The car of the work-precision comparison: equations by hand, and the truth.

    m_s zs'' = -u,   m_u zu'' = u - k_t zu,   u = k x + c x' + b x'' + f,   x = zs - zu

f is 0 (`ideal`: linear) or LuGre friction (`lugre`):

    f = s0 z + s1 z',   z' = x' - s0 |x'| z / g,   g = f_c + (f_s - f_c) exp(-(x' / v_s)^2)

The wheel starts with 4 m/s, and little damping keeps the car swinging over the 10 s. The truth
comes from none of the programs that are compared: of the linear car it is the matrix exponential,
of the other SciPy's DOP853 at 1e-13 with steps of 2 ms at most; `truth_error` says by how much half
the step moves each.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence

import numpy as np
from inerter.benchmark.laws import INERTANCE, LAWS
from inerter.model_parameters import QUARTER_CAR
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.linalg import expm

Array = NDArray[np.float64]

DURATION = 10.0
DAMPING = 100.0
SPEED = 4.0
SPRUNG, UNSPRUNG = QUARTER_CAR.sprung_mass, QUARTER_CAR.unsprung_mass
SPRING, TYRE = QUARTER_CAR.stiffness, QUARTER_CAR.tyre_stiffness

PROBLEMS = {"ideal": "linear, ideal inerter", "lugre": "inerter with LuGre friction"}

# M^-1 of (zs, zu), the inerter in M
_INVERSE = np.linalg.inv([[SPRUNG + INERTANCE, -INERTANCE], [-INERTANCE, UNSPRUNG + INERTANCE]])


def start(problem: str) -> list[float]:
    """(zs, zu, zs', zu') and the bristle's deflection if there is one."""
    return [0.0, 0.0, 0.0, SPEED] + [0.0] * (problem == "lugre")


def rates(problem: str) -> Callable[[float, Sequence[float]], list[float]]:
    """The right-hand side in plain Python numbers, as quick as Python gets it."""
    (a, b), (_, d) = _INVERSE.tolist()
    keys = ("bristle_stiffness", "bristle_damping", "coulomb_force", "static_force")
    s0, s1, coulomb, static = (LAWS["lugre"][key] for key in keys)
    slow = LAWS["lugre"]["stribeck_velocity"]
    lugre, exp = problem == "lugre", math.exp

    def f(t: float, y: Sequence[float]) -> list[float]:
        zs, zu, vs, vu = y[0], y[1], y[2], y[3]
        v = vs - vu
        u = SPRING * (zs - zu) + DAMPING * v
        rate: list[float] = []
        if lugre:
            z = y[4]
            level = coulomb + (static - coulomb) * exp(-((v / slow) ** 2))
            slip = v - s0 * abs(v) * z / level
            u += s0 * z + s1 * slip
            rate = [slip]
        push = u - TYRE * zu
        return [vs, vu, b * push - a * u, d * push - b * u, *rate]

    return f


@functools.cache
def truth(problem: str, step: float = 2e-3) -> tuple[Array, float]:
    """(zs, zu) at the end, and the largest displacement of the run [m].

    Parameters
    ----------
    problem
        One of `PROBLEMS`.
    step
        Step of the matrix exponential, longest step of DOP853 [s].
    """
    if problem == "ideal":
        damping = DAMPING * np.array([[1.0, -1.0], [-1.0, 1.0]])
        stiffness = np.array([[SPRING, -SPRING], [-SPRING, SPRING + TYRE]])
        lower = -_INVERSE @ np.hstack((stiffness, damping))
        part = expm(np.vstack((np.eye(2, 4, 2), lower)) * step)
        path = [np.array(start(problem))]
        for _ in range(round(DURATION / step)):
            path.append(part @ path[-1])
        return path[-1][:2], float(np.abs(np.array(path)[:, :2]).max())
    run = solve_ivp(
        rates(problem), (0.0, DURATION), start(problem), method="DOP853", rtol=1e-13, atol=1e-15,
        max_step=step,
    )  # fmt: skip
    return run.y[:2, -1], float(np.abs(run.y[:2]).max())


def error_of(problem: str, found: Array) -> float:
    """Largest error of (zs, zu) at the end, over the largest displacement of the run."""
    end, size = truth(problem)
    worst = float(np.abs(np.asarray(found) - end).max() / size)
    return worst if math.isfinite(worst) else math.inf


def truth_error(problem: str) -> float:
    """What the truth itself moves by when its steps are halved, relative."""
    return error_of(problem, truth(problem, 1e-3)[0])
