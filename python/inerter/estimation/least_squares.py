"""Bounded least squares: one problem, or several that go in step so that they share batches.

`minimise` is a trust region for one problem whose residual is asked for point by point. `in_step`
takes several at once: all derivatives of all of them are one call, all their trial points another,
for simulations that run in batches. `polish` ends a search that is near, with the Jacobian held.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import OptimizeResult, least_squares, lsq_linear

from inerter.estimation.covariance import usual_size
from inerter.estimation.secants import Secants
from inerter.estimation.solution import Bounds, Solution, Tolerances
from inerter.estimation.trust_region import trust_region

Array = NDArray[np.float64]

# search variables, which are of the order of 1, below this are none
_NOTHING = 1e-50
# what ends a search, and evaluations at most per variable, where nobody says
_USUAL = Tolerances()
_MOST = 100

Residuals = Callable[[Array], Array]
"""Points (sets, p) to residuals (sets, n)."""
GiveUp = Callable[[int, float], bool]


def inside(point: Array, bounds: Bounds, margin: float = 1e-9) -> Array:
    """A point strictly within its bounds, as a trust region needs."""
    lower, upper = bounds
    return np.clip(
        point,
        np.where(np.isfinite(lower), lower + margin, lower),
        np.where(np.isfinite(upper), upper - margin, upper),
    )


def minimise(
    residual: Callable[[Array], Array],
    start: Array,
    bounds: Bounds,
    jacobian: Callable[[Array], Array] | None = None,
    *,
    tolerances: Tolerances = _USUAL,
    evaluations: int | None = None,
    loss: str = "linear",
    scaled: bool = False,
    give_up: GiveUp | None = None,
    secants: Secants | None = None,
) -> Solution:
    """A search from a point on a trust region; with a robust loss or scaled it is SciPy's.

    Parameters
    ----------
    residual, jacobian
        Of a point (p,): residual (n,) and derivatives (n, p), by differences if not given.
    start, bounds
        (p,) each; the start is put inside the bounds.
    tolerances, evaluations
        What ends it.
    loss
        "linear", or robust: then what is farther off than is usual counts less.
    scaled
        Whether the variables are scaled by the Jacobian's columns.
    give_up
        Told the evaluations so far and the rms of the residual after every step.
    secants
        Takes the Jacobian's place between the points at which it is worked out.
    """
    begin = inside(start, bounds)
    # the first region is as wide as the start is far from 0: of next to nothing powers overflow
    begin[np.abs(begin) < _NOTHING] = 0.0
    derivatives = secants or jacobian
    if derivatives is None or loss != "linear" or scaled:
        return _by_scipy(
            residual, derivatives, begin, bounds, tolerances, evaluations, loss, scaled, give_up
        )
    before, cost, most = 0, np.inf, evaluations or _MOST * begin.size

    def watch(done: int, here: Array) -> bool:
        return bool(give_up and give_up(before + done, float(np.sqrt(np.mean(here**2)))))

    while True:
        found = trust_region(residual, derivatives, begin, bounds, tolerances, most - before, watch)
        before += found.evaluations
        spent = before >= most
        if secants is None or secants.rough or not secants.stale or not found.ended or spent:
            break
        if found.cost > (1 - tolerances.cost) * cost:
            break
        # no step that these derivatives tell lowers the cost: what do true ones tell?
        secants.forget()
        begin, cost = inside(found.variables, bounds), found.cost
    return replace(found, evaluations=before)


def _by_scipy(
    residual: Callable[[Array], Array],
    jacobian: Callable[[Array], Array] | None,
    begin: Array,
    bounds: Bounds,
    tolerances: Tolerances,
    evaluations: int | None,
    loss: str,
    scaled: bool,
    give_up: GiveUp | None,
) -> Solution:
    """A search with a robust loss, scaled, or with derivatives by differences."""

    def watch(intermediate_result: OptimizeResult) -> None:
        error = float(np.sqrt(np.mean(intermediate_result.fun**2)))
        if give_up and give_up(intermediate_result.nfev, error):
            raise StopIteration

    found = least_squares(
        residual, begin,
        jac=jacobian or "2-point",  # pyright: ignore[reportArgumentType]
        bounds=bounds, loss=loss, x_scale="jac" if scaled else 1.0,
        f_scale=usual_size(residual(begin)) if loss != "linear" else 1.0,
        xtol=tolerances.point, ftol=tolerances.cost, gtol=tolerances.gradient,
        max_nfev=evaluations, callback=watch if give_up else None,
    )  # fmt: skip
    return Solution(
        variables=found.x, residual=found.fun, jacobian=np.asarray(found.jac),
        cost=float(found.cost), evaluations=int(found.nfev), ended=found.status > 0,
    )  # fmt: skip


def differences(residuals: Residuals, at: Array, here: Array, bounds: Bounds, step: float) -> Array:
    """Forward differences, inward at an upper bound, (n, p); all points in one call."""
    steps = np.where(at + step > bounds[1], -step, step)
    return ((residuals(at + np.diag(steps)) - here) / steps[:, None]).T


# --- several at once -----------------------------------------------------------------------------

_RADIUS, _WIDEST, _NARROWEST = 1.0, 2.0, 1e-4
_STEP = 1e-3

Jobs = Sequence[tuple[int, Array]]
"""Points, each with the number of the problem that it is of."""


@dataclass(kw_only=True)
class _Descent:
    """One of several searches."""

    number: int
    bounds: Bounds
    point: Array
    residual: Array
    jacobian: Array = field(default_factory=lambda: np.empty((0, 0)))
    radius: float = _RADIUS
    done: bool = False
    moved: bool = True

    def step(self) -> Array:
        """Least-squares step within bounds and a box, from the linearised residual."""
        lower, upper = self.bounds
        low = np.maximum(lower - self.point, -self.radius)
        high = np.minimum(upper - self.point, self.radius)
        q, r = np.linalg.qr(self.jacobian)
        # a coordinate that does nothing stays where it is
        ridge = 1e-6 * np.max(np.abs(np.diag(r)), initial=1e-12) * np.eye(self.point.size)
        target = np.concatenate([-(q.T @ self.residual), np.zeros(self.point.size)])
        limits = (low - 1e-12, np.maximum(high, low) + 1e-12)
        return lsq_linear(np.vstack([r, ridge]), target, limits).x


def in_step(
    residuals: Callable[[Jobs], Array],
    starts: Sequence[tuple[Array, Bounds]],
    iterations: int = 6,
    enough: float = 1e-3,
    last: bool = True,
) -> list[Solution]:
    """Several searches at once; every derivative's points are in one call.

    Parameters
    ----------
    residuals
        Of points (jobs), shape (jobs, n); a row that is not finite ends a step there.
    starts
        First point and bounds of every problem; one without variables is left as it is.
    iterations
        Most steps of each.
    enough
        Relative fall of the error below which a search ends.
    last
        Whether the Jacobian is worked out at the end again; else it is that of the last step.
    """
    rows = residuals([(i, point) for i, (point, _) in enumerate(starts)])
    searches = [
        _Descent(
            number=i, bounds=bounds, point=point, residual=row, jacobian=np.empty((row.size, 0))
        )
        for i, ((point, bounds), row) in enumerate(zip(starts, rows, strict=True))
    ]
    for each in searches:
        each.done = not (each.point.size and np.isfinite(each.residual).all())
    for _ in range(iterations):
        active = [each for each in searches if not each.done]
        if not active:
            break
        _derive(residuals, [each for each in active if each.moved])
        _advance(residuals, active, enough)
    if last:
        _derive(residuals, [s for s in searches if s.moved and np.isfinite(s.residual).all()])
    return [
        Solution(
            variables=each.point, residual=each.residual, jacobian=each.jacobian,
            cost=0.5 * float(np.sum(each.residual**2)), evaluations=0, ended=each.done,
        )
        for each in searches
    ]  # fmt: skip


def _derive(residuals: Callable[[Jobs], Array], searches: Sequence[_Descent]) -> None:
    jobs: list[tuple[int, Array]] = []
    widths = []
    searches = [each for each in searches if each.point.size]
    for each in searches:
        steps = np.where(each.point + _STEP <= each.bounds[1], _STEP, -_STEP)
        jobs += [(each.number, each.point + move) for move in np.diag(steps)]
        widths.append(steps)
    rows = residuals(jobs) if jobs else np.empty((0, 0))
    at = 0
    for each, steps in zip(searches, widths, strict=True):
        here = rows[at : at + steps.size]
        each.jacobian = np.nan_to_num((here - each.residual) / steps[:, None]).T
        each.moved = False
        at += steps.size


def _advance(
    residuals: Callable[[Jobs], Array], searches: Sequence[_Descent], enough: float
) -> None:
    """One step of each, taken where it helps; else the next one is shorter."""
    points = [each.point + each.step() for each in searches]
    rows = residuals([(s.number, p) for s, p in zip(searches, points, strict=True)])
    for each, point, row in zip(searches, points, rows, strict=True):
        before = float(np.sum(each.residual**2))
        cost = float(np.sum(row**2)) if np.isfinite(row).all() else np.inf
        if cost >= before:
            length = float(np.max(np.abs(point - each.point)))
            each.radius = min(each.radius, length) / 4
            each.done = each.radius < _NARROWEST
            continue
        each.radius = min(2 * each.radius, _WIDEST)
        each.point, each.residual, each.moved = point, row, True
        each.done = cost > before * (1 - enough) ** 2


# --- the end of a search -------------------------------------------------------------------------

_ROUNDS, _CHORDS = 3, 4
_PARTS = (0.5, 0.2, 0.05)


def polish(
    residuals: Residuals, start: Array, bounds: Bounds, tolerance: float = 5e-2, step: float = 2e-3
) -> Solution:
    """From near: Gauss-Newton steps with the Jacobian held, a new one where they do not help.

    Ends where a step is smaller than `tolerance` standard errors, for residuals of variance 1.

    Raises
    ------
    ValueError
        The residual is not finite at the start.
    """
    lower, upper = bounds
    here, runs = np.clip(start, lower, upper), 0
    jacobian = np.empty((0, here.size))

    def run(sets: Array) -> Array:
        nonlocal runs
        runs += len(sets)
        return residuals(sets)

    def solution() -> Solution:
        return Solution(
            variables=here, residual=best, jacobian=jacobian, cost=0.5 * float(np.sum(best**2)),
            evaluations=runs, ended=True,
        )  # fmt: skip

    best = run(here[None])[0]
    if not np.isfinite(best).all():
        raise ValueError("the simulation does not reach its end where the search ended")
    for _ in range(_ROUNDS):
        jacobian = differences(run, here, best, bounds, step)
        inverse = np.linalg.pinv(jacobian)
        errors = np.sqrt(np.diag(inverse @ inverse.T))
        for chord in range(_CHORDS):
            there = np.clip(here - inverse @ best, lower, upper)
            small = np.all(np.abs(there - here) < tolerance * errors)
            trial = run(there[None])[0]
            if not np.sum(trial**2) < np.sum(best**2) and not small:
                # along a curved valley a part of the way may help
                parts = here + np.outer(_PARTS, there - here)
                trials = run(parts)
                lowest = int(np.argmin(np.sum(trials**2, axis=1)))
                there, trial = parts[lowest], trials[lowest]
            if not np.sum(trial**2) < np.sum(best**2):
                # noise of the simulation is all that is left, or the Jacobian is out of date
                if small or chord == 0:
                    return solution()
                break
            here, best = there, trial
            if small:
                return solution()
    return solution()


def search_in_batches(
    residuals: Residuals,
    start: Array,
    bounds: Bounds,
    tolerances: Tolerances,
    evaluations: int,
    step: float = 2e-3,
    failed: float = 1e3,
) -> Solution:
    """From far: `minimise` of a simulation that runs in batches; a point that fails is very bad."""
    known: dict[bytes, Array] = {}
    runs = 0

    def run(sets: Array) -> Array:
        nonlocal runs
        runs += len(sets)
        found = residuals(sets)
        return np.where(np.isfinite(found), found, failed)

    def value(at: Array) -> Array:
        if at.tobytes() not in known:
            known[at.tobytes()] = run(at[None])[0]
        return known[at.tobytes()]

    def jacobian(at: Array) -> Array:
        return differences(run, at, value(at), bounds, step)

    begin = inside(start, bounds, 1e-6)
    found = minimise(
        value, begin, bounds, jacobian, tolerances=tolerances, evaluations=evaluations
    )  # fmt: skip
    return replace(found, evaluations=runs)
