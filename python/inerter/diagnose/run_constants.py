"""What differs from run to run: constants, which are no cause, and runs that contradict the others.

A load cell zeroed anew, or gravity compensated anew, gives each run a constant of its own. It is
read off a regression of the force on the motion with one constant per run, and what differs from
their mean is taken off the run; the mean stays, it may be a cause. A cell that was zeroed anew
begins to drift anew: then its drift counts from the beginning of each run, where that needs the
smaller constants, and not through the pauses between them. A run contradicts the others
where these predict each other, and not it, though it has nothing of its own in its motion, and
where what is found at the end does not explain it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from inerter.identify.information import TOO_MUCH, leverage
from inerter.identify.runs import BenchRun, on_clocks
from inerter.motion_units import TRANSLATION, Kind, words
from inerter.records import Record

Array = NDArray[np.float64]

# a constant counts from so many standard errors, this share of the force and of what the regression
# leaves, rms
SURE = 5.0
FORCE_PART = 0.01
LEFT_PART = 0.5
# share of their spread by which damping that bends and lags may move constants
MOVED = 0.2
# stretches of a run that count as independent
STRETCHES = 12
# places at which a force of the place may bend
BENDS = 9
# speed below which friction may be anything, per rms; width of sign(v)
SLOW, WIDTH = 0.1, 0.02
# distance of first places per travel, and of first forces per that of constants, that are none
SAME_PLACE, SAME_FORCE = 0.01, 0.1
# share of its samples that every run has where all others go too, at least
SHARED = 0.2
# share of its moving samples that a run goes one way, from which on friction is a constant there
ONE_WAY = 0.95
# what a run that contradicts the others is missed by more than by itself, per its force, and how
# many times less the others are
CONTRADICTION = 0.15
TIMES = 4.0
# share of its force, and how many times more than the others, that such a run is missed at the end
SMALL, EXPLAINED = 0.25 * CONTRADICTION, 2.0


@dataclass(frozen=True)
class _Rows:
    """Moving samples of one run: columns (n, m) in its motion's units, force (n,) [N]."""

    columns: Array
    force: Array


@dataclass(frozen=True)
class Zeros:
    """Where the zeros of the force were in some runs.

    Attributes
    ----------
    constants
        Of each run by name [N], about their mean; empty where none is to be seen.
    anew
        Whether the drift of the force began anew in each run.
    """

    constants: Mapping[str, float] = field(default_factory=dict)
    anew: bool = False

    def taken_off(self, records: Sequence[Record]) -> Sequence[Record]:
        """Records without these constants, which know from when on their force drifts."""
        if self.anew:
            records = [replace(record, zeroed=float(record.time[0])) for record in records]
        return without_constants(records, self.constants) if self.constants else records


def zeros_of(runs: Sequence[BenchRun]) -> Zeros:
    """Zeros of some runs, which are not parts of longer ones."""
    runs = on_clocks(runs)
    shared = _constants(runs)
    own = [replace(run, clock=run.start) for run in runs]
    if not shared or all(run.clock == each.clock for run, each in zip(runs, own, strict=True)):
        return Zeros(shared)
    anew = _constants(own)
    if anew and np.ptp([*anew.values()]) > np.ptp([*shared.values()]):
        return Zeros(shared)
    return Zeros(anew, anew=True)


def constants(runs: Sequence[BenchRun]) -> dict[str, float]:
    """Constants of runs [N] about their mean, by name; empty where none is to be seen.

    Those of a long run are read off the whole, not off its parts.
    """
    return dict(zeros_of(runs).constants)


def _constants(runs: Sequence[BenchRun]) -> dict[str, float]:
    """The same of runs whose slow changes count from their clocks."""
    if len(runs) < 2 or any(run.part or not run.inner.any() for run in runs):
        return {}
    if any(_goes_one_way(run) for run in runs) or not _share_places(runs):
        return {}
    rows = [_rows(run, _bends(runs)) for run in runs]
    if min(row.force.size for row in rows) < 10 * STRETCHES:
        return {}
    off, errors, left = _about_mean(rows)
    force = np.concatenate([row.force for row in rows])
    least = max(FORCE_PART * _rms(force), LEFT_PART * left)
    if not np.any((np.abs(off) > SURE * errors) & (np.abs(off) > least)):
        return {}
    richer, *_ = _about_mean([_rows(run, _bends(runs), uneven=True) for run in runs])
    if np.max(np.abs(richer - off)) > MOVED * np.ptp(off) or _begin_alike(runs, off):
        return {}
    return {run.name: float(value) for run, value in zip(runs, off, strict=True)}


def _about_mean(rows: Sequence[_Rows]) -> tuple[Array, Array, float]:
    """Constants of runs about their mean, their standard errors, and what is left, rms [N]."""
    count = len(rows)
    dummies = [np.eye(count)[np.full(row.force.size, i)] for i, row in enumerate(rows)]
    matrix = np.concatenate(
        [np.column_stack([d, row.columns]) for d, row in zip(dummies, rows, strict=True)]
    )
    force = np.concatenate([row.force for row in rows])
    scale = np.sqrt(np.mean(matrix**2, axis=0))
    matrix = matrix / np.where(scale > 0, scale, 1.0)
    solved = np.linalg.lstsq(matrix, force, rcond=1e-9)[0]
    left = force - matrix @ solved
    # neighbouring samples go together: the sandwich over stretches
    bread = np.linalg.pinv(matrix.T @ matrix, rcond=1e-12)
    bounds = np.cumsum([row.force.size for row in rows])[:-1]
    meat = np.zeros_like(bread)
    for part in np.split(np.arange(force.size), bounds):
        for stretch in np.array_split(part, STRETCHES):
            score = matrix[stretch].T @ left[stretch]
            meat += np.outer(score, score)
    about = np.zeros((count, matrix.shape[1]))
    about[:, :count] = (np.eye(count) - 1 / count) / scale[:count]
    off, covariance = about @ solved, about @ bread @ meat @ bread @ about.T
    return off, np.sqrt(np.maximum(np.diag(covariance), 0.0)), _rms(left)


def without_constants(records: Sequence[Record], found: Mapping[str, float]) -> list[Record]:
    """Records with the constants of their runs taken off the force."""
    return [replace(r, force=r.force - found.get(r.name, 0.0)) for r in records]


def constants_in_words(found: Mapping[str, float], motion: Kind = TRANSLATION) -> str:
    """A sentence about the constants of runs; empty where there are none."""
    if not found:
        return ""
    newton, cell = words(motion, "N"), "load" if motion == TRANSLATION else "torque"
    each = ", ".join(f"{name} {value:+.3g} {newton}" for name, value in found.items())
    return (
        f"The runs differ by constants, as of a {cell} cell zeroed anew, which are no cause and "
        f"were taken off: {each} about their mean."
    )


def contradicting(runs: Sequence[BenchRun]) -> dict[str, str]:
    """Runs that contradict the others, by name with what they say; at most one."""
    if len(runs) < 3 or any(run.part for run in runs):
        return {}
    rows = [_rows(run) for run in runs]
    if min(row.force.size for row in rows) < 100:
        return {}
    everything = range(len(rows))
    missed = [_missed(rows, i, [j for j in everything if j != i]) for i in everything]
    worst = int(np.argmax(missed))
    others = [j for j in everything if j != worst]
    rest = [_missed(rows, j, [k for k in others if k != j]) for j in others]
    alone = leverage(runs)[worst] > TOO_MUCH
    if alone or missed[worst] < CONTRADICTION or missed[worst] < TIMES * max(rest):
        return {}
    own, theirs = (_solved([rows[k] for k in chosen])[0] for chosen in ([worst], others))
    kilogram = words(runs[worst].motion, "kg")
    text = (
        f"contradicts the other runs, which agree with each other: by itself its inertance would "
        f"be {own:.4g} {kilogram}, in the others it is {theirs:.4g} {kilogram}; is it a run of the "
        "same device?"
    )
    return {runs[worst].name: text}


def explained(runs: Sequence[BenchRun], errors: Sequence[Array], name: str) -> bool:
    """Whether what was found explains a run that seemed to contradict the others.

    It does where errors (n,) [N] are no larger there than in another run, or per force small or no
    more than some times those of the others.
    """
    sizes = {r.name: _rms(e[r.inner]) for r, e in zip(runs, errors, strict=True)}
    parts = {run.name: sizes[run.name] / (_rms(run.force[run.inner]) or 1.0) for run in runs}
    if sizes.pop(name) <= max(sizes.values(), default=0.0):
        return True
    return parts.pop(name) < max(SMALL, EXPLAINED * max(parts.values(), default=0.0))


def _missed(rows: Sequence[_Rows], i: int, others: Sequence[int]) -> float:
    """What others miss of a run more than it misses itself, per its force."""
    row = rows[i]
    errors = [
        row.force - row.columns @ _solved(parts) for parts in ([rows[j] for j in others], [row])
    ]
    theirs, own = (float(np.var(error)) for error in errors)
    return float(np.sqrt(max(theirs - own, 0.0)) / (_rms(row.force) or 1.0))


def _solved(rows: Sequence[_Rows]) -> Array:
    """Coefficients of the columns, each run with a constant of its own."""
    matrix = np.concatenate([row.columns - row.columns.mean(axis=0) for row in rows])
    force = np.concatenate([row.force - row.force.mean() for row in rows])
    scale = np.sqrt(np.mean(matrix**2, axis=0))
    scale = np.where(scale > 0, scale, 1.0)
    return np.linalg.lstsq(matrix / scale, force, rcond=1e-6)[0] / scale


def _bends(runs: Sequence[BenchRun]) -> Array:
    """Places (m,) between which a force of the place is taken as straight: a stop is only there."""
    x = [run.displacement[run.inner] for run in runs]
    return np.linspace(min(map(np.min, x)), max(map(np.max, x)), BENDS + 2)[1:-1]


def _share_places(runs: Sequence[BenchRun]) -> bool:
    """Whether all runs go through the same places: elsewhere a force of the place is a constant."""
    x = [run.displacement[run.inner] for run in runs]
    low, high = max(map(np.min, x)), min(map(np.max, x))
    return all(float(np.mean((low <= each) & (each <= high))) > SHARED for each in x)


def _begin_alike(runs: Sequence[BenchRun], off: Array) -> bool:
    """Whether all runs begin at one place with one force: no cell was zeroed anew between them.

    They do where their first forces differ by far less than the constants `off` would have it.
    """
    first = np.array([run.displacement[run.first] for run in runs])
    travel = max(float(np.ptp(run.displacement[run.inner])) for run in runs)
    forces = np.array([run.first_force for run in runs])
    return bool(np.ptp(first) < SAME_PLACE * travel and np.ptp(forces) < SAME_FORCE * np.ptp(off))


def _goes_one_way(run: BenchRun) -> bool:
    """Whether a run hardly turns back: what differs with the direction is its constant, too."""
    v = run.velocity[run.inner]
    moving = v[np.abs(v) > SLOW * (_rms(v) or 1.0)]
    share = float(np.mean(moving > 0)) if moving.size else 0.0
    return max(share, 1.0 - share) > ONE_WAY


def _rows(run: BenchRun, bends: Array | None = None, *, uneven: bool = False) -> _Rows:
    """With a force that bends along the stroke, and `uneven` damping that bends sooner and lags."""
    x, v, a = run.displacement, run.velocity, run.acceleration
    size = _rms(v[run.inner]) or 1.0
    moving = run.inner & (np.abs(v) > SLOW * size)
    way = np.tanh(v / (WIDTH * size))
    columns = [a, v, way, x]
    if bends is not None:
        columns += [np.abs(v), v * np.abs(v), np.abs(a) * way, x * x, x**3, x * way, run.elapsed]
        columns += list(np.maximum(x - bends[:, None], 0.0))
        # an inertance along the stroke: b(x) a + b'(x) v^2 / 2
        columns += [0.5 * v * v + x * a, x * v * v + x * x * a]
    if uneven:
        speed = np.abs(v) / size
        columns += [np.sqrt(speed), way * np.sqrt(speed), a * way, a * speed, a * v]
    return _Rows(np.column_stack(columns)[moving], run.force[moving])


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0
