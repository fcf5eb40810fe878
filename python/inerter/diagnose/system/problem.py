"""What is minimised: measured less simulated channels, each per its spread, nuisances taken out.

Nuisances are linear in the residual and say nothing about physics: the zero of an accelerometer or
a length and the static part of a tyre's force (a constant per run), and the state in which a run
begins (what a small change of it does, worked out once at the user's model).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from inerter.diagnose.system.drive import Drive
from inerter.diagnose.system.effects import Size
from inerter.diagnose.system.model import SystemModel
from inerter.diagnose.system.simulate import Simulator, Start

Array = NDArray[np.float64]
# the first part of a run in which what came before it decays is not used
_DECAYED = 0.03
_LONGEST_SETTLING = 0.2
# beyond this many degrees of freedom the initial state is not fitted, only faded out
_MOST_DOFS = 8
_DERIVATIVE = 1e-3
_RADIUS = 1.0


@dataclass(frozen=True)
class Channel:
    """An output's name, unit and noise-free spread over the runs (SI units)."""

    name: str
    unit: str
    spread: float


@dataclass
class Problem:
    """Runs with what was measured and how it is compared.

    Attributes
    ----------
    drives : list of Drive
        The runs.
    masks : list of ndarray (n,)
        Samples that are compared.
    nuisance : list of ndarray (n * outputs, q)
        Orthonormal on the masked samples, zero elsewhere; rows by sample, then output.
    """

    simulator: Simulator
    drives: list[Drive]
    channels: list[Channel]
    masks: list[NDArray[np.bool_]] = field(default_factory=list)
    nuisance: list[Array] = field(default_factory=list)
    waves: list[Array] = field(default_factory=list, repr=False)

    def __post_init__(self) -> None:
        self.spreads = np.array([channel.spread for channel in self.channels])
        if not self.masks:
            self._settle()

    def _settle(self) -> None:
        """Masks and nuisance columns of every run."""
        for drive in self.drives:
            waves = self._initial_state(drive)
            settled = _settling_samples(waves, drive)
            mask = np.arange(drive.time.size) >= settled
            self.masks.append(mask)
            self.waves.append(waves)
            self.nuisance.append(self._columns(waves, mask))

    def restricted(self, masks: Sequence[NDArray[np.bool_]]) -> Problem:
        """The runs and samples that are in masks too; runs without any are left out."""
        both = [own & wanted for own, wanted in zip(self.masks, masks, strict=True)]
        used = [i for i, mask in enumerate(both) if mask.any()]
        return Problem(
            self.simulator,
            [self.drives[i] for i in used],
            self.channels,
            [both[i] for i in used],
            [self._columns(self.waves[i], both[i]) for i in used],
            [self.waves[i] for i in used],
        )

    def _initial_state(self, drive: Drive) -> Array:
        """What small changes of the initial state do, (count, n, outputs), per spread."""
        base = SystemModel()
        model = self.simulator.user.model
        if model.nv > _MOST_DOFS or model.nq != model.nv:
            return np.empty((0, drive.time.size, len(self.channels)))
        start = self.simulator.start(model, drive)
        moves = []
        for i in range(model.nv):
            for velocity in (False, True):
                move = np.zeros(model.nv)
                move[i] = 1e-2 if velocity else 1e-4
                moves.append((move * (not velocity), move * velocity))
        starts = [start, *(Start(start.qpos + q, v) for q, v in moves)]
        run = self.simulator.outputs([base] * len(starts), drive, starts)
        waves = (run[1:] - run[0]) / self.spreads
        return waves[np.isfinite(waves).all(axis=(1, 2))]

    def _columns(self, waves: Array, mask: NDArray[np.bool_]) -> Array:
        outputs = self.simulator.channels.outputs
        rows = np.repeat(mask, len(outputs))
        columns = [wave.ravel() * rows for wave in waves]
        for i, output in enumerate(outputs):
            if output.floating or output.load:
                constant = np.zeros((mask.size, len(outputs)))
                constant[mask, i] = 1.0
                columns.append(constant.ravel())
        if not columns:
            return np.empty((rows.size, 0))
        table = np.column_stack(columns)
        size = np.linalg.norm(table, axis=0)

        # what has died away by now is no nuisance any more
        table = table[:, size > 1e-6 * np.sqrt(mask.sum())]
        u, s, _ = np.linalg.svd(table / np.linalg.norm(table, axis=0), full_matrices=False)
        return u[:, s > 1e-6 * s[0]] if s.size else np.empty((rows.size, 0))

    def residuals(self, models: Sequence[SystemModel]) -> list[list[Array]]:
        """Per model and run: measured less simulated per spread, (n, outputs), 0 where unmasked."""
        found: list[list[Array]] = [[] for _ in models]
        for drive, mask, basis in zip(self.drives, self.masks, self.nuisance, strict=True):
            simulated = self.simulator.outputs(models, drive)
            for k in range(len(models)):
                rest = (drive.measured - simulated[k]) / self.spreads
                rest[~mask] = 0.0
                flat = rest.ravel()
                found[k].append((flat - basis @ (basis.T @ flat)).reshape(rest.shape))
        return found

    def stacked(self, models: Sequence[SystemModel]) -> Array:
        """The residuals of every run in one row per model, (models, samples * outputs)."""
        rows = self.residuals(models)
        return np.array([np.concatenate([r.ravel() for r in row]) for row in rows])

    @property
    def count(self) -> int:
        """Samples that are compared."""
        return int(sum(mask.sum() for mask in self.masks))

    def error(self, residual: Array) -> float:
        """Root of the mean over channels of the squared error per spread."""
        return float(np.sqrt(np.sum(residual**2) / (self.count * len(self.channels))))

    def noise(self, residual: Array) -> float:
        """White noise in a stacked residual, as `error` counts it: from its third differences.

        Structure that is smooth over a few samples does not count.
        """
        square, at = 0.0, 0
        for mask in self.masks:
            size = mask.size * len(self.channels)
            rest = residual[at : at + size].reshape(mask.size, -1)[mask]
            at += size
            if len(rest) > 8:
                square += len(rest) * float(np.sum(np.mean(np.diff(rest, 3, axis=0) ** 2, 0) / 20))
        return float(np.sqrt(square / (self.count * len(self.channels))))

    def part(self, seconds: float) -> Problem:
        """The first seconds of every run, after settling."""
        drives: list[Drive] = []
        masks: list[NDArray[np.bool_]] = []
        columns: list[Array] = []
        for drive, mask, basis in zip(self.drives, self.masks, self.nuisance, strict=True):
            first = float(drive.time[int(np.argmax(mask))])
            drives.append(drive.part(first + seconds))
            size = drives[-1].time.size
            masks.append(mask[:size])
            cut = basis[: size * len(self.channels)]
            columns.append(np.linalg.qr(cut)[0] if cut.size else cut)
        return Problem(self.simulator, drives, self.channels, masks, columns)


def _settling_samples(waves: Array, drive: Drive) -> int:
    """Samples until the initial state is all but forgotten, at most a share of the run."""
    most = int(_LONGEST_SETTLING * drive.time.size)
    if not len(waves):
        return most // 2
    size = np.linalg.norm(waves, axis=2)
    late = np.maximum.accumulate(size[:, ::-1], axis=1)[:, ::-1]
    gone = np.all(late < _DECAYED * size.max(axis=1, keepdims=True), axis=0)
    return min(int(np.argmax(gone)), most) if gone.any() else most


# --- least squares -----------------------------------------------------------------------------


@dataclass(frozen=True)
class SystemFit:
    """A fitted model: residual (m,), Jacobian (m, p) in search variables, error per spread."""

    model: SystemModel
    residual: Array
    jacobian: Array
    error: float
    sizes: Mapping[str, Size]

    def units(self) -> Array:
        """Coordinate per search variable, (p,)."""
        return np.array(
            [
                self.model.values[n] if self.sizes[n].logarithmic else self.sizes[n].size
                for n in self.model.free
            ]
        )


def encode(value: float, size: Size) -> float:
    """Coordinate to search variable."""
    value = float(np.clip(value, size.lower, size.upper))
    return float(np.log(value)) if size.logarithmic else value / size.size


def decode(variable: float, size: Size) -> float:
    """Search variable to coordinate."""
    value = float(np.exp(variable)) if size.logarithmic else variable * size.size
    return float(np.clip(value, size.lower, size.upper))


@dataclass
class _Search:
    """One of several searches that go in step, so that their simulations share batches."""

    model: SystemModel
    sizes: Mapping[str, Size]
    point: Array
    residual: Array
    jacobian: Array
    radius: float = _RADIUS
    done: bool = False
    moved: bool = True

    def at(self, point: Array) -> SystemModel:
        return self.model.at(
            {n: decode(x, self.sizes[n]) for n, x in zip(self.model.free, point, strict=True)}
        )

    @property
    def bounds(self) -> tuple[Array, Array]:
        pairs = []
        for name in self.model.free:
            size = self.sizes[name]
            low, high = size.lower, size.upper
            if size.logarithmic:
                pairs.append((np.log(low), np.log(high)))
            else:
                pairs.append((low / size.size, high / size.size))
        lower, upper = np.array(pairs).T
        return lower, upper

    def step(self, radius: float) -> Array:
        """Least-squares step within bounds and a box, from the linearised residual."""
        lower, upper = self.bounds
        low = np.maximum(lower - self.point, -radius)
        high = np.minimum(upper - self.point, radius)
        q, r = np.linalg.qr(self.jacobian)
        # a coordinate that does nothing stays where it is
        ridge = 1e-6 * np.max(np.abs(np.diag(r)), initial=1e-12) * np.eye(self.point.size)
        target = np.concatenate([-(q.T @ self.residual), np.zeros(self.point.size)])
        found = lsq_linear(
            np.vstack([r, ridge]), target, (low - 1e-12, np.maximum(high, low) + 1e-12)
        )
        return found.x


def fit_all(
    problem: Problem,
    models: Sequence[tuple[SystemModel, Mapping[str, Size]]],
    iterations: int = 6,
    enough: float = 1e-3,
    last: bool = True,
) -> list[SystemFit]:
    """Fit several models at once; every derivative's simulations are in one batch.

    Parameters
    ----------
    problem : Problem
        Runs and masks.
    models : sequence of (SystemModel, sizes)
        With starting values, and how each free coordinate is searched.
    iterations : int
        Most steps of each.
    enough : float
        Relative fall of the error below which a search stops.
    last : bool
        Whether the Jacobian is worked out at the end again; else it is that of the last step.
    """
    first = problem.stacked([model for model, _ in models])
    searches = []
    for (model, sizes), residual in zip(models, first, strict=True):
        point = np.array([encode(model.values[n], sizes[n]) for n in model.free])
        searches.append(_Search(model, sizes, point, residual, np.empty((residual.size, 0))))
        searches[-1].done = not (point.size and np.isfinite(residual).all())
    for _ in range(iterations):
        active = [search for search in searches if not search.done]
        if not active:
            break
        _derive(problem, [search for search in active if search.moved])
        _advance(problem, active, enough)
    if last:
        _derive(problem, [s for s in searches if s.moved and np.isfinite(s.residual).all()])
    return [
        SystemFit(s.at(s.point), s.residual, s.jacobian, problem.error(s.residual), s.sizes)
        for s in searches
    ]


def _derive(problem: Problem, searches: Sequence[_Search]) -> None:
    searches = [search for search in searches if search.point.size]
    jobs, moves = [], []
    for search in searches:
        upper = search.bounds[1]
        for i in range(search.point.size):
            width = _DERIVATIVE if search.point[i] + _DERIVATIVE <= upper[i] else -_DERIVATIVE
            moved = search.point.copy()
            moved[i] += width
            jobs.append(search.at(moved))
            moves.append(width)
    rows = problem.stacked(jobs) if jobs else np.empty((0, 0))
    at = 0
    for search in searches:
        count = search.point.size
        widths = np.array(moves[at : at + count])[:, None]
        search.jacobian = np.nan_to_num((rows[at : at + count] - search.residual) / widths).T
        search.moved = False
        at += count


def _advance(problem: Problem, searches: Sequence[_Search], enough: float) -> None:
    """One step of each, taken where it helps; else the next one is shorter."""
    points = [search.point + search.step(search.radius) for search in searches]
    rows = problem.stacked([s.at(p) for s, p in zip(searches, points, strict=True)])
    for search, point, row in zip(searches, points, rows, strict=True):
        before = float(np.sum(search.residual**2))
        cost = float(np.sum(row**2)) if np.isfinite(row).all() else np.inf
        if cost >= before:
            length = float(np.max(np.abs(point - search.point)))
            search.radius = min(search.radius, length) / 4
            search.done = search.radius < 1e-4
            continue
        search.radius = min(2 * search.radius, 2.0)
        search.point, search.residual, search.moved = point, row, True
        search.done = cost > before * (1 - enough) ** 2
