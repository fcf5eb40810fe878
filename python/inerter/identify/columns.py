"""Derivatives of a problem's residual by the search variables of its model, one column each.

Most are differences. A coordinate that enters the force in proportion to a function of the motion
has that function as its column (`in_proportion`), which the model does not change: it is weighted
once. A node of an inertance that changes with the speed has a mean of two such columns. Where the
device has a state, this begins where the first force puts it; a coordinate acts on that through the
share of the first force that it takes, so that one difference by the first force serves all. Beside
a tone, whose phase is read off the residual, a column has what this phase does too.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import COORDINATES, search_range
from inerter.identify import along_friction
from inerter.identify.apart import Apart, Basis
from inerter.identify.channel import LINEAR, clips, tone_follows
from inerter.identify.channel_filter import Filter, slow_start, without_start
from inerter.identify.force_parts import RUNAWAY
from inerter.identify.forgetting import Forgetting
from inerter.identify.in_proportion import (
    BY_SPEED,
    PLACES,
    Rows,
    at_speeds,
    clipped,
    column_keys,
    curve_of,
    entangling,
    factor_of,
    first_shares,
    shown_by,
    through,
    times_inertance,
)
from inerter.identify.kept import Kept
from inerter.identify.model import Model
from inerter.identify.prediction import before_filter, beyond_limits, moves_late
from inerter.identify.runs import BenchRun
from inerter.identify.smoothness import smoothness
from inerter.identify.transient import (
    RELAXING,
    SETTLING,
    bending,
    relaxing,
    swings_freely,
    without_bending,
    without_relaxing,
)

if TYPE_CHECKING:
    from inerter.identify.fit import Problem

Array = NDArray[np.float64]


class ResidualAt(Protocol):
    """The residual of every run at a point, with its first force `pressed` [N] more."""

    def __call__(self, point: Array, pressed: float = 0.0, /) -> list[Array]: ...


# of every run how a tone follows what is left, see `tone_follows`
Tones = Sequence[tuple[Array, Array] | None]
# of every run where its channel shows a limit, see `beyond_limits`
Beyond = Sequence[NDArray[np.bool_]]

# difference of a search variable, and of the first force per its size
_STEP = 1e-4
# columns [bytes] that are kept of a problem
_MOST = 2**25
# coordinates that are solved for apart, at least; bases of such that are kept of a problem
_WORTH_WHILE, _MOST_BASES = 5, 4
# a filter that is taken out of the motion that the columns are of
_FILTER = ("displacement_filter", "displacement_filter_order", "displacement_filter_bessel")
# what holds no bristle
_NEVER = Forgetting(0.0)
# what is a linear filter of the force, and what says how long the time before the record shows
_CHANNEL = (*LINEAR, *RELAXING, *SETTLING, *_FILTER)
# share of an inertance that it may lose with the speed at most; its floor is 0.01
_NEAR_FLOOR = 0.98


class Columns:
    """Columns of one problem; what no model changes is kept."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._kept: Kept[np.float64] = Kept(_MOST)
        self._bases: dict[Hashable, Basis] = {}
        self._last_bent: tuple[Forgetting, list[tuple[Array, Array]]] = (_NEVER, [])

    def __getstate__(self) -> Mapping[str, Any]:
        """What another process is told: what is kept is soon worked out again."""
        return {**self.__dict__, "_kept": Kept(_MOST), "_bases": {}, "_last_bent": (_NEVER, [])}

    def of(
        self,
        model: Model,
        point: Array,
        names: Sequence[str],
        residual: ResidualAt,
    ) -> list[Array]:
        """Derivative of the residual by each named variable, over all samples of all runs, (n,).

        `point` has the variables of the model's free coordinates.
        """
        tones = self._tones(model)
        known = self._of_friction(names, model, tones)
        others = [name for name in names if name not in known]
        base = functools.cache(lambda: residual(point))
        known |= self._proportional(others, model, point, base, residual, tones)
        return [
            known[name] * search_range(name, self.problem.scales).size
            if name in known
            else self._difference(name, model, point, base(), residual)
            for name in names
        ]

    def _proportional(
        self,
        names: Sequence[str],
        model: Model,
        point: Array,
        base: Callable[[], list[Array]],
        residual: ResidualAt,
        tones: Tones,
    ) -> dict[str, Array]:
        """Derivatives by those of some coordinates that the force is in proportion to."""
        names = self._in_proportion(names, model)
        if not names:
            return {}
        speeds = at_speeds(model)
        alike = [
            (name, *each)
            for name in names
            for each in (speeds if times_inertance(name) else [(1.0, model)])
        ]
        rows = [(name, each) for name, _, each in alike]
        beyond = None
        if clips(model.values):
            beyond = [beyond_limits(model, run) for run in self.problem.runs]
        columns = self._weighted(rows, _Unknown.of(model), tones, beyond)
        if model.device().nstate:
            taken = [
                first_shares(rows, before_filter(run, model.values)) for run in self.problem.runs
            ]
            if np.any(taken):
                changes, begin = self._by_first_force(point, base(), residual), 0
                for shares, change in zip(taken, changes, strict=True):
                    columns[:, begin : begin + change.size] -= np.outer(shares, change)
                    begin += change.size
        found: dict[str, Array] = {}
        for (name, share, _), column in zip(alike, columns, strict=True):
            part = share * factor_of(name, model) * column
            found[name] = found[name] + part if name in found else part
        return found

    def apart(self, model: Model) -> Apart | None:
        """What the residual is linear in, where that is so much that it is worth while."""
        names = self._in_proportion(model.free, model)
        if BY_SPEED in model.free or not model.values.get("inertance"):
            # what an inertance gains along the stroke is then no column that stays as it is; one of
            # nothing gains nothing
            names = [name for name in names if not times_inertance(name)]
        moving = not set(model.free).isdisjoint((*PLACES, *_CHANNEL))
        if len(names) < _WORTH_WHILE or moving or clips(model.values):
            return None
        which = [model.free.index(name) for name in names]
        smooth = smoothness(model)[:, which]
        key = (*column_keys([(name, model) for name in names], _CHANNEL), len(smooth))
        basis = self._bases.get(key)
        if basis is None:
            if len(self._bases) == _MOST_BASES:
                self._bases.clear()
            unknown = _Unknown.of(model)
            weighted = self._weighted([(name, model) for name in names], unknown).T
            sizes = self.problem.scales
            # by one of each, as the columns; of an inertance that of the first model
            units = [search_range(name, sizes).size * factor_of(name, model) for name in names]
            rows = weighted[np.concatenate(self.problem.masks)]
            basis = Basis.of(np.concatenate([rows, sizes.force * smooth / units]))
            self._bases[key] = basis
        return Apart(names, basis, [times_inertance(name) for name in names])

    def _in_proportion(self, names: Sequence[str], model: Model) -> list[str]:
        """Those of some coordinates that enter the force times their columns."""
        device, values = model.device(), model.values
        # a flywheel on its spring is set going by whatever acts
        swings = swings_freely(device)
        far = not all(np.isinf(run.far) for run in self.problem.runs)
        late = any(moves_late(values, run) for run in self.problem.runs)
        if swings or far or late:
            return []
        floored = self._is_floored(values.get(BY_SPEED, 0.0))
        return [
            name
            for name in names
            if (COORDINATES[name].column or curve_of(name))
            and values.keys().isdisjoint(entangling(name))
            and not (floored and times_inertance(name))
        ]

    def _is_floored(self, by_speed: float) -> bool:
        """Whether an inertance that falls with the speed would reach its floor, or come near it."""
        return bool(by_speed < 0 and by_speed * self._fastest < -_NEAR_FLOOR)

    @functools.cached_property
    def _fastest(self) -> float:
        """Largest speed of all runs [m/s]."""
        runs = self.problem.runs
        channels = [r.velocity if r.measured is None else r.measured[1] for r in runs]
        return max(float(np.max(np.abs(velocity))) for velocity in channels)

    def _tones(self, model: Model) -> Tones:
        """How the tone of every run follows what is left; None where there is none."""
        amplitude = model.values.get("disturbance_amplitude", 0.0)
        if not amplitude:
            return [None] * len(self.problem.runs)
        frequency = model.values["disturbance_frequency"]
        left = self.problem.errors(model.holding(disturbance_amplitude=0.0))
        return [
            tone_follows(
                each, run.elapsed, mask if mask.any() else run.inner,
                amplitude * run.gain(frequency), frequency,
            )
            for run, each, mask in zip(self.problem.runs, left, self.problem.masks, strict=True)
        ]  # fmt: skip

    def _of_friction(self, names: Sequence[str], model: Model, tones: Tones) -> dict[str, Array]:
        """Derivatives by nodes of a friction curve, where there are enough of them."""
        nodes = along_friction.nodes_of(names, model)
        if len(nodes) < _WORTH_WHILE:
            return {}
        channel = {each: model.values[each] for each in LINEAR if each in model.values}
        unknown = _Unknown.of(model)
        columns = []
        every = zip(self.problem.runs, self.problem.masks, tones, strict=True)
        for run, mask, tone in every:
            if np.isfinite(run.corner) and not mask.any():
                columns.append(np.zeros((len(nodes), run.force.size)))
                continue
            response = along_friction.Response(model, run)
            forces = np.array([response.of(name) for name in nodes])
            columns.append(-_settled(through(channel, forces, run), run, mask, tone, unknown))
        weighted = np.concatenate(self.problem.weighted(columns), axis=1)
        return dict(zip(nodes, weighted, strict=True))

    def _difference(
        self,
        name: str,
        model: Model,
        point: Array,
        base: Sequence[Array],
        residual: ResidualAt,
    ) -> Array:
        index, (lower, upper) = (
            model.free.index(name),
            search_range(name, self.problem.scales).bounds,
        )
        here = np.concatenate(base)
        for step in (_STEP, -_STEP):
            if not lower <= point[index] + step <= upper:
                continue
            moved = point.copy()
            moved[index] += step
            change = np.concatenate(residual(moved)) - here
            if np.all(np.abs(change) < RUNAWAY, where=np.isfinite(here)):
                return change / step
        # beyond lies on both sides what no force can be: the variable stays where it is
        return np.zeros(here.size)

    def _weighted(
        self,
        rows: Rows,
        unknown: _Unknown,
        tones: Tones | None = None,
        beyond: Beyond | None = None,
    ) -> Array:
        """Minus coordinates' columns as they count, (m, n); tones held where none are given."""
        tones = tones or [None] * len(self.problem.runs)
        apart = replace(unknown, forgets=_NEVER)
        # what a tone does changes with the model, and what a bristle or a limit does
        if beyond or any(tones) or (unknown.forgets.reach and apart != _NOTHING):
            return self._worked_out(rows, unknown, tones, beyond)
        found = self._kept.all_found(
            column_keys(rows, _CHANNEL),
            lambda missing: self._worked_out([rows[i] for i in missing], apart, tones),
        )
        if not unknown.forgets.reach:
            return found
        # but for one form in every run
        begin = 0
        for run, (share, form) in zip(self.problem.runs, self._bent(unknown.forgets), strict=True):
            if share.size:
                shown = _shown(rows, run)[:, : share.size]
                found[:, begin : begin + form.size] += np.outer(shown @ share, form)
            begin += run.force.size
        return found

    def _worked_out(
        self, rows: Rows, unknown: _Unknown, tones: Tones, beyond: Beyond | None = None
    ) -> Array:
        """The same, whatever is kept."""
        limits = beyond or [None] * len(self.problem.runs)
        every = zip(self.problem.runs, self.problem.masks, tones, limits, strict=True)
        columns = [
            -_settled(_shown(rows, run, limit), run, mask, tone, unknown)
            for run, mask, tone, limit in every
        ]
        return np.concatenate(self.problem.weighted(columns), axis=1)

    def _bent(self, forgets: Forgetting) -> list[tuple[Array, Array]]:
        """What tells of every run how a bristle was bent, and what that leaves as it counts."""
        known, found = self._last_bent
        if known == forgets:
            return found
        forms, shares = [], []
        for run, mask in zip(self.problem.runs, self.problem.masks, strict=True):
            seen, path = mask if mask.any() else run.inner, forgets.path(run)
            decay, share = bending(path, forgets.reach, seen, run.first)
            form = np.zeros(run.force.size)
            form[: decay.size] = decay
            forms.append(form)
            shares.append(share)
        found = list(zip(shares, self.problem.weighted(forms), strict=True))
        self._last_bent = forgets, found
        return found

    def _by_first_force(
        self, point: Array, base: Sequence[Array], residual: ResidualAt
    ) -> list[Array]:
        """Derivative of the residual by the first force, of every run."""
        step = _STEP * self.problem.scales.force
        there = residual(point, step)
        return [(each - here) / step for each, here in zip(there, base, strict=True)]


def _shown(rows: Rows, run: BenchRun, beyond: NDArray[np.bool_] | None = None) -> Array:
    """What a run's channel shows of one of each coordinate, (m, n); nothing `beyond` a limit."""
    if rows:
        run = before_filter(run, rows[0][1].values)
    shown = shown_by(rows, run)
    if beyond is not None and beyond.any():
        shown = shown - clipped(rows, run, beyond)
    return shown


@dataclass(frozen=True)
class _Unknown:
    """What holds forces of the time before the record.

    That is a low-pass, branches that relax [s] and a bristle that forgets.
    """

    low_pass: Filter | None
    times: tuple[float, ...]
    forgets: Forgetting

    @classmethod
    def of(cls, model: Model) -> _Unknown:
        forgets = Forgetting.of(model.device())
        return cls(slow_start(model.values), relaxing(model.values), forgets)


_NOTHING = _Unknown(None, (), _NEVER)


def _settled(
    shown: Array,
    run: BenchRun,
    mask: NDArray[np.bool_],
    tone: tuple[Array, Array] | None,
    unknown: _Unknown,
) -> Array:
    """Columns (m, n) without what is read off the record, as a residual is there (`settled`)."""
    seen = mask if mask.any() else run.inner
    path, reach = unknown.forgets.path(run), unknown.forgets.reach
    shown = without_bending(path, reach, shown, seen, run.first)
    shown = without_relaxing(unknown.times, shown, run.spacing, seen, run.first, run.cutoff)
    if unknown.low_pass is not None:
        shown = without_start(shown, run.spacing, seen & run.inner, unknown.low_pass, run.first)
    if tone is not None:
        per_radian, phase = tone
        shown = shown + np.outer(shown @ phase, per_radian)
    return shown
