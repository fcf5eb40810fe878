"""A trust region for least squares within bounds, for residuals that take long and are long.

Variables are scaled by the root of their room, the distance to the bound that the gradient points
at, so that steps bend away from bounds before they meet them. One that does meet a bound is
compared with its reflection there and with steepest descent (Branch, Coleman, Li 1999). Within the
radius the step is that of a damping on which the radius is met (More 1978). Of derivatives (n, p)
all of this needs no more than the triangle (p, p) that they are, but for a rotation.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

from inerter.estimation.solution import Bounds, NotFiniteError, Solution, Tolerances

Array = NDArray[np.float64]

# gain per what was foretold from which on the radius is kept, and grows; of a step that is poor the
# next radius
_POOR, _GOOD = 0.25, 0.75
_SHORTER = 0.25
# how exactly a step meets the radius, and how often that is tried
_MET, _TRIES = 0.01, 10
# share of the way to a bound that is gone at least
_NEARLY = 0.995
# distance of a start from 0 that is none
_NOT_FAR = 1e-7
# share of a column that is none of the others' from which on their products tell it: by more than
# half the digits
_APART = 1e-4
_EPSILON = float(np.finfo(np.float64).eps)


def trust_region(
    residual: Callable[[Array], Array],
    jacobian: Callable[[Array], Array],
    start: Array,
    bounds: Bounds,
    tolerances: Tolerances,
    evaluations: int,
    watch: Callable[[int, Array], bool] | None = None,
) -> Solution:
    """The point (p,) within bounds from `start` at which a residual's square is least.

    Parameters
    ----------
    residual, jacobian
        Of a point (p,): residual (n,) and derivatives (n, p).
    start, bounds
        (p,) each, the start strictly within the bounds.
    tolerances, evaluations
        What ends it.
    watch
        Told the evaluations so far and the residual after every step; whether to stop there.

    Raises
    ------
    NotFiniteError
        The residual is not finite at the start.
    """
    point, here = start.copy(), residual(start)
    if not np.isfinite(here).all():
        raise NotFiniteError("the residual is not finite where the search starts")
    cost, done, ended = 0.5 * float(here @ here), 1, False
    columns = jacobian(point)
    radius, damping = -1.0, 0.0
    while True:
        gradient = columns.T @ here
        room, slope = _room(point, gradient, bounds)
        if radius < 0:
            # as wide as the start is far from 0; what is beside a bound at 0 tells nothing
            away = np.where(np.abs(point) > _NOT_FAR, point, 0.0)
            radius = float(np.linalg.norm(away / np.sqrt(room))) or 1.0
        steepest = float(np.max(np.abs(gradient * room), initial=0.0))
        ended = ended or steepest < tolerances.gradient
        if ended or done >= evaluations:
            return Solution(
                variables=point, residual=here, jacobian=columns, cost=cost, evaluations=done,
                ended=ended,
            )  # fmt: skip
        local = _Local(columns, here, gradient, room, slope)
        gain = -1.0
        while gain <= 0 and done < evaluations:
            whole, damping = local.step(radius, damping)
            step, foretold = local.inside(point, whole, radius, bounds, max(_NEARLY, 1 - steepest))
            there = _strictly_inside(point + local.scale * step, bounds)
            residual_there = residual(there)
            done += 1
            length = float(np.linalg.norm(step))
            if not np.isfinite(residual_there).all():
                radius = _SHORTER * length
                continue
            cost_there = 0.5 * float(residual_there @ residual_there)
            gain = cost - cost_there
            share = gain / foretold if foretold > 0 else float(gain == foretold == 0)
            way = float(np.linalg.norm(local.scale * step))
            little = gain < tolerances.cost * cost and share > _POOR
            if little or way < tolerances.point * (tolerances.point + float(np.linalg.norm(point))):
                ended = True
                break
            before = radius
            if share < _POOR:
                radius = _SHORTER * length
            elif share > _GOOD and length > 0.95 * radius:
                radius *= 2.0
            damping *= before / radius
        if gain > 0:
            point, here, cost = there, residual_there, cost_there
            columns = jacobian(point)
        if watch and watch(done, here):
            return Solution(
                variables=point, residual=here, jacobian=columns, cost=cost, evaluations=done,
                ended=False,
            )  # fmt: skip


class _Local:
    """The least-squares problem about a point, in variables per root of their room."""

    def __init__(
        self, columns: Array, residual: Array, gradient: Array, room: Array, slope: Array
    ) -> None:
        count = columns.shape[1]
        triangle, turned = _triangle(columns, residual, gradient)
        self.scale = np.sqrt(room)
        self.triangle = triangle * self.scale
        # what the scale itself changes along the way
        self.bend = gradient * slope
        self.gradient = gradient * self.scale
        rows = np.concatenate([self.triangle, np.diag(np.sqrt(self.bend))])
        left, sizes, right = np.linalg.svd(rows, full_matrices=False)
        # a variable that does nothing stays where it is
        told = sizes > _EPSILON * (columns.shape[0] + count) * sizes[0]
        self.sizes, self.right = sizes[told], right[told]
        self.along = left[: len(triangle), told].T @ turned

    def cost(self, step: Array) -> float:
        """By how much the linearised cost changes."""
        turned = self.triangle @ step
        return float(0.5 * (turned @ turned + self.bend @ step**2) + self.gradient @ step)

    def step(self, radius: float, damping: float) -> tuple[Array, float]:
        """The step that is best within a radius, and its damping, of which a guess is given."""
        step = -(self.along / self.sizes) @ self.right
        if np.linalg.norm(step) <= radius:
            return step, 0.0
        scaled = self.sizes * self.along

        def excess(damping: float) -> tuple[float, float]:
            """Length of a step beyond the radius, and its slope over the damping."""
            divided = scaled / (self.sizes**2 + damping)
            length = float(np.linalg.norm(divided))
            if not length:
                # below the smallest number there is
                return -radius, -math.inf
            return length - radius, -float(np.sum(divided**2 / (self.sizes**2 + damping))) / length

        value, slope = excess(0.0)
        low, high, guess = -value / slope, float(np.linalg.norm(scaled)) / radius, damping
        for _ in range(_TRIES):
            if not low <= guess <= high:
                guess = max(1e-3 * high, math.sqrt(low * high))
            value, slope = excess(guess)
            if value < 0:
                high = guess
            low = max(low, guess - value / slope)
            guess = max(guess - (value + radius) / radius * value / slope, 0.0)
            if abs(value) < _MET * radius:
                break
        step = -(scaled / (self.sizes**2 + guess)) @ self.right
        length = float(np.linalg.norm(step))
        return (step * (radius / length) if length else step), guess

    def inside(
        self, point: Array, step: Array, radius: float, bounds: Bounds, nearly: float
    ) -> tuple[Array, float]:
        """The best of a step within bounds, and the fall of the cost that is foretold for it."""
        end = point + self.scale * step
        if np.all(end >= bounds[0]) and np.all(end <= bounds[1]):
            return step, -self.cost(step)
        share, hit = _to_bound(point, self.scale * step, bounds)
        at_bound = share * step
        tried = [nearly * at_bound]
        turned = np.where(hit, -step, step)
        if (
            reflected := self._reflected(point, at_bound, turned, share, radius, bounds, nearly)
        ) is not None:
            tried.append(reflected)
        down = -self.gradient
        most = radius / float(np.linalg.norm(down))
        free, _ = _to_bound(point, self.scale * down, bounds)
        tried.append(down * self._best(np.zeros_like(down), down, 0.0, min(nearly * free, most)))
        best = min(tried, key=self.cost)
        return best, -self.cost(best)

    def _reflected(
        self, point: Array, at_bound: Array, turned: Array, share: float, radius: float,
        bounds: Bounds, nearly: float,
    ) -> Array | None:  # fmt: skip
        """A step that goes on from a bound with the sign of what met it turned, if it can."""
        square, middle = float(turned @ turned), float(at_bound @ turned)
        rest = radius**2 - float(at_bound @ at_bound)
        to_radius = (math.sqrt(max(middle**2 + square * rest, 0.0)) - middle) / square
        to_bound, _ = _to_bound(point + self.scale * at_bound, self.scale * turned, bounds)
        far = min(to_bound, to_radius)
        if far <= 0:
            return None
        least, most = (1 - nearly) * share / far, nearly * far if to_bound <= to_radius else far
        if least > most:
            return None
        return at_bound + turned * self._best(at_bound, turned, least, most)

    def _best(self, begin: Array, way: Array, least: float, most: float) -> float:
        """How far along a way from a step the linearised cost is least."""
        first, turned = self.triangle @ begin, self.triangle @ way
        curved = float(turned @ turned + self.bend @ way**2)
        slope = float(self.gradient @ way + first @ turned + self.bend @ (begin * way))
        if curved <= 0:
            return most if slope < 0 else least
        return min(max(-slope / curved, least), most)


def _triangle(columns: Array, residual: Array, gradient: Array) -> tuple[Array, Array]:
    """The triangle R (p, p) of derivatives Q R, and Q^T residual (p,).

    From the products of the columns (Cholesky), which takes a tenth of the time; by rotations where
    columns are so much alike that their products no longer tell them apart.
    """
    products = columns.T @ columns
    sizes = np.sqrt(np.diag(products))
    per_size = np.divide(1.0, sizes, out=np.zeros_like(sizes), where=sizes > 0)
    scaled = products * np.outer(per_size, per_size)
    # a column that is 0 stays one
    np.fill_diagonal(scaled, 1.0)
    with suppress(np.linalg.LinAlgError):
        lower = np.asarray(np.linalg.cholesky(scaled), dtype=np.float64)
        if np.min(np.diag(lower), initial=1.0) > _APART:
            turned = np.linalg.solve(lower, gradient * per_size)
            return lower.T * sizes, np.asarray(turned, dtype=np.float64)
    both: Array = np.asarray(np.linalg.qr(np.column_stack([columns, residual]), mode="r"))
    count = columns.shape[1]
    return both[:count, :count], both[:count, count]


def _room(point: Array, gradient: Array, bounds: Bounds) -> tuple[Array, Array]:
    """Distance to the bound that a step downhill goes to, 1 without one, and its slope."""
    lower, upper = bounds
    up, down = (gradient < 0) & np.isfinite(upper), (gradient > 0) & np.isfinite(lower)
    room = np.where(up, upper - point, np.where(down, point - lower, 1.0))
    return room, np.where(up, -1.0, np.where(down, 1.0, 0.0))


def _to_bound(point: Array, way: Array, bounds: Bounds) -> tuple[float, NDArray[np.bool_]]:
    """How far along a way the first bound is, and which variables meet it."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        shares = np.maximum((bounds[0] - point) / way, (bounds[1] - point) / way)
    shares = np.where(way != 0, shares, np.inf)
    least = float(np.min(shares))
    return least, shares == least


def _strictly_inside(point: Array, bounds: Bounds) -> Array:
    """The nearest point that is on no bound."""
    lower, upper = bounds
    point = np.where(point <= lower, np.nextafter(lower, upper), point)
    point = np.where(point >= upper, np.nextafter(upper, lower), point)
    narrow = (point < lower) | (point > upper)
    if narrow.any():
        # only between bounds that are the same
        point = np.where(narrow, 0.5 * (lower + upper), point)
    return point
