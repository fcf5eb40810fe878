"""What the user's model lacks: one effect at a time, judged on samples that were not fitted.

As in `inerter.diagnose.search`, with a simulation of the whole model for every trial. Every
candidate is looked at first on a part of the runs, by the share of the residual that has the shape
of its effect (`_screen`); the best are fitted. Leaving samples out costs no simulation: a fit to
the rest is one linear step from the fit to all.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.scales import Range
from inerter.diagnose.decision import (
    CRITERIA,
    as_good,
    better,
    not_needed,
    plainest,
)
from inerter.diagnose.statistics import advantage, win_shares
from inerter.diagnose.vehicle.candidate import VehicleCandidate
from inerter.diagnose.vehicle.effects import Effects
from inerter.diagnose.vehicle.judging import block_squares, left_out, stacked_blocks, won
from inerter.diagnose.vehicle.model import BENT, Added, VehicleModel
from inerter.diagnose.vehicle.problem import DrivenProblem, VehicleFit, fit_all
from inerter.estimation.covariance import sandwich

Array = NDArray[np.float64]
Progress = Callable[[str], None]

# fourth moment beyond that of noise at which a residual comes in bursts
BURSTS = 2.0
# the part of every run on which candidates are screened [s], at most
SCREENED = 3.0
# the part of every run on which fits of long runs begin [s]; from there few steps are left
BEGUN = 8.0
# predicted share of the error below which nothing is worth a fit
WORTH = 0.005
# candidates further behind the best after two steps than this are not fitted to the end
NEAR = 1.5
# steps of a fit that goes along a narrow valley
TO_THE_END = 16
PLAIN, FALLING = EFFECTS["coulomb_friction"].name, EFFECTS["stribeck_friction"].name
# steps of a start's own size that its effect may be scaled by
_LARGEST_SCALE = 30.0


@dataclass(frozen=True)
class VehicleScored:
    """A fit and its squared errors on samples left out, per block; candidate: None at the start.

    rest: the residual on samples left out, as `DrivenProblem.stacked` has it.
    """

    fit: VehicleFit
    squares: Array
    candidate: VehicleCandidate | None = None
    rest: Array = field(default_factory=lambda: np.empty(0), repr=False)

    @property
    def model(self) -> VehicleModel:
        """The fitted model."""
        return self.fit.model

    @property
    def complexity(self) -> int:
        """Number of free coordinates that say something."""
        return self.model.complexity


@dataclass(frozen=True)
class Step:
    """One effect added: what it was added to, and the others that were fitted in its place."""

    before: VehicleScored
    chosen: VehicleScored
    others: list[VehicleScored]
    shares: Array


@dataclass
class VehicleSearch:
    """A search on the fit samples of a problem.

    step_error: of a model, how much of its error is its timestep's, as `DrivenProblem.error`
    counts.
    """

    problem: DrivenProblem
    effects: Effects
    step_error: Callable[[VehicleModel], float] = lambda model: 0.0
    progress: Progress = lambda text: None
    steps: list[Step] = field(default_factory=list)

    def __post_init__(self) -> None:
        runs = len(self.problem.drives)
        self.part = self.problem.part(max(SCREENED * min(1.0, 2 / runs), 1.5))
        begun = self.problem.part(BEGUN)
        self.begun = begun if begun.count < 0.6 * self.problem.count else None
        self.blocks = stacked_blocks(self.problem)

    def run(self) -> VehicleScored:
        """From the user's model to the one that predicts best."""
        current = self._score(fit_all(self.problem, [(VehicleModel(), {})])[0])
        while True:
            current = self._added(current)
            pruned = self._prune(current)
            if len(pruned.model.effects) == len(current.model.effects):
                return pruned
            # what has gone may have stood in the way of what was not there yet
            current = pruned

    def _added(self, current: VehicleScored) -> VehicleScored:
        """Effects added one after another, so many at most in all rounds."""
        while len(self.steps) < CRITERIA.most_in_vehicles:
            if self._is_noise(current):
                break
            step = self._best_step(current)
            if step is None:
                break
            self.steps.append(step)
            current = step.chosen
        return current

    def _is_noise(self, current: VehicleScored) -> bool:
        """Whether nothing is left but white noise and what the model's step does."""
        floor = self.problem.noise(current.fit.residual)
        table = current.fit.residual.reshape(-1, len(self.problem.channels))
        table = table[np.concatenate(self.problem.masks)]
        # jerks look like noise from sample to sample, but come in bursts
        bursts = np.mean(table**4, axis=0) > (3 + BURSTS) * np.mean(table**2, axis=0) ** 2
        if current.fit.error * (1 - CRITERIA.gain) < floor and not bursts.any():
            return True
        return np.hypot(floor, 2 * self.step_error(current.model)) > current.fit.error

    def refit(
        self, models: Sequence[tuple[VehicleModel, Mapping[str, Range]]], iterations: int = 6
    ) -> list[VehicleScored]:
        """Fit models again and score them."""
        near = self._begin(models, iterations)
        return [self._score(fit) for fit in fit_all(self.problem, near, iterations)]

    def _begin(
        self, models: Sequence[tuple[VehicleModel, Mapping[str, Range]]], iterations: int
    ) -> Sequence[tuple[VehicleModel, Mapping[str, Range]]]:
        """Models at values that fit the first part of long runs; of short ones as they are."""
        if self.begun is None:
            return models
        found = fit_all(self.begun, models, iterations=iterations, last=False)
        return [
            (fit.model, fit.sizes) if np.isfinite(fit.error) else given
            for fit, given in zip(found, models, strict=True)
        ]

    def without(
        self, scored: VehicleScored, index: int
    ) -> tuple[VehicleModel, Mapping[str, Range]]:
        """A model without one of its effects, the others at their values."""
        return scored.model.without(index), scored.fit.sizes

    def _score(self, fit: VehicleFit, candidate: VehicleCandidate | None = None) -> VehicleScored:
        rest = left_out(fit, self.blocks)
        return VehicleScored(fit, block_squares(rest, self.blocks), candidate, rest)

    def _best_step(self, current: VehicleScored) -> Step | None:
        number = len(self.steps) + 1
        self.progress(f"effect {number}: simulating every candidate")
        worthy = self._screen(current)
        if not worthy:
            return None
        names = ", ".join(dict.fromkeys(candidate.added.effect for candidate, _ in worthy))
        self.progress(f"effect {number}: fitting {names}")
        trials = [
            (candidate.model(current.model, start), {**current.fit.sizes, **candidate.sizes})
            for candidate, start in worthy
        ]
        scored = self._fit_trials([c for c, _ in worthy], trials)
        good = [s for s in scored if self._better(current, s) and self._is_distinct(s, current)]
        if not good:
            return None
        best = min(good, key=lambda s: s.squares.sum())
        equal = [s for s in good if s is best or _as_good(s, best)]
        chosen = plainest(equal)

        # to the end, the one that was chosen
        last = fit_all(self.problem, [(chosen.model, chosen.fit.sizes)], enough=1e-5)[0]
        chosen = self._score(last, chosen.candidate)
        others: list[VehicleScored] = []
        for each in sorted(scored, key=lambda s: s.squares.sum()):
            if each.candidate not in (chosen.candidate, *(o.candidate for o in others)):
                others.append(each)
        shares = win_shares([chosen.squares, current.squares, *(s.squares for s in others)])
        return Step(current, chosen, others, shares)

    def _fit_trials(
        self,
        candidates: Sequence[VehicleCandidate],
        trials: Sequence[tuple[VehicleModel, Mapping[str, Range]]],
    ) -> list[VehicleScored]:
        """Fits of candidates, in two rounds: those that are far behind after one are left there."""
        steps, more, far = 2, 4, NEAR
        if self.begun is not None:
            # all but the last step on a part of the runs; what is far behind then stays so
            trials, steps, more, far = self._begin(trials, 5), 0, 1, CRITERIA.beaten
        early = fit_all(self.problem, trials, iterations=steps, last=False)
        reached = min((f.error for f in early if np.isfinite(f.error)), default=0.0)
        near = [i for i, f in enumerate(early) if f.error < far * reached]
        if not steps:
            # what is left behind is judged on samples left out, too, which wants its Jacobian
            behind = [i for i, f in enumerate(early) if i not in near and np.isfinite(f.error)]
            judged = fit_all(self.problem, [trials[i] for i in behind], iterations=0)
            for i, fit in zip(behind, judged, strict=True):
                early[i] = fit
        again = [(early[i].model, early[i].sizes) for i in near]
        later = dict(zip(near, fit_all(self.problem, again, iterations=more), strict=True))
        return [
            self._score(later.get(i, fit), candidate)
            for i, (fit, candidate) in enumerate(zip(early, candidates, strict=True))
            if np.isfinite(fit.error)
        ]

    def standing(
        self, final: VehicleScored, index: int, step: Step
    ) -> tuple[VehicleScored, list[VehicleScored]]:
        """A final model without one of its effects, and with each likely rival in its place."""
        model, sizes = self.without(final, index)
        rivals = []
        for other, share in zip(step.others, step.shares[2:], strict=True):
            assert other.candidate is not None
            added = other.candidate.added
            if share < 0.01 or any(e.effect == added.effect for e in model.effects):
                continue
            own = {n: other.model.values[n] for n in other.candidate.starts[0]}
            rivals.append((other.candidate, own))
        trials = [
            (candidate.model(model, start), {**sizes, **candidate.sizes})
            for candidate, start in rivals[:3]
        ]
        without = self.refit([(model, sizes)])[0]
        return without, self._fit_trials([c for c, _ in rivals[:3]], trials) if trials else []

    def _screen(self, current: VehicleScored) -> list[tuple[VehicleCandidate, Mapping[str, float]]]:
        """Candidates whose effect has the shape of the residual, with starts of the right size."""
        candidates = list(self.effects.candidates(current.model))
        base = current.model
        pairs = [(c, start) for c in candidates for start in c.starts]
        moved = []
        widths = []
        for name in base.free:
            size = current.fit.sizes[name]
            point, width = size.encode(base.values[name]), 1e-3
            if size.decode(point + width) >= size.upper:
                width = -width
            moved.append(base.at({name: size.decode(point + width)}))
            widths.append(width)
        rows = self.part.stacked([base, *moved, *(c.model(base, s) for c, s in pairs)])
        residual, rows = rows[0], rows[1:]
        known = np.nan_to_num(rows[: len(moved)] - residual) / np.array([*widths, 1.0])[:-1, None]
        basis = np.linalg.qr(known.T)[0] if len(moved) else np.empty((residual.size, 0))

        def rest(row: Array) -> Array:
            return row - basis @ (basis.T @ row)

        free = rest(residual)
        cost = float(free @ free)
        found: list[tuple[float, VehicleCandidate, Mapping[str, float]]] = []
        for (candidate, start), row in zip(pairs, rows[len(moved) :], strict=True):
            if not np.isfinite(row).all():
                continue
            shape = rest(row - residual)
            power = float(shape @ shape)
            if power < 1e-12 * cost:
                continue
            scale = -float(shape @ free) / power
            scale = float(np.clip(scale, *self._range(candidate, base)))
            left = cost + 2 * scale * float(shape @ free) + scale**2 * power
            error = np.sqrt(max(left, 0.0) / cost)
            if error < 1 - WORTH:
                found.append((error, candidate, self._scaled(candidate, base, start, scale)))
        return _shortlist(found)

    def _range(self, candidate: VehicleCandidate, base: VehicleModel) -> tuple[float, float]:
        if not candidate.amplitudes:
            return 0.0, 1.5
        one_sided = all(
            candidate.sizes[name].lower >= 0 and self._before(candidate, name, base) == 0
            for name in candidate.amplitudes
        )
        return (0.0 if one_sided else -_LARGEST_SCALE), _LARGEST_SCALE

    def _scaled(
        self,
        candidate: VehicleCandidate,
        base: VehicleModel,
        start: Mapping[str, float],
        scale: float,
    ) -> Mapping[str, float]:
        """A start with its amplitudes scaled from where the model stands."""
        values = dict(start)
        for name in candidate.amplitudes:
            now = self._before(candidate, name, base)
            size = candidate.sizes[name]
            # off the bound, where a search would be stuck
            low = max(size.lower, 1e-3 * size.size) if size.lower >= 0 else size.lower
            values[name] = float(np.clip(now + scale * (start[name] - now), low, size.upper))
        return values

    def _is_distinct(self, scored: VehicleScored, before: VehicleScored) -> bool:
        """Whether an amplitude of the effect differs from before by some standard errors."""
        candidate = scored.candidate
        if candidate is None or not candidate.telling:
            return True
        spread, values = errors(scored.fit), scored.model.values
        if candidate.added.effect == "damper_asymmetry":
            # alike in both directions it is a damping other than stated, however far off
            one, other = candidate.telling
            apart = abs(values[one] - values[other])
            return apart > CRITERIA.distinction * float(np.hypot(spread[one], spread[other]))
        return any(
            abs(values[name] - self._before(candidate, name, before.model))
            > CRITERIA.distinction * spread[name]
            for name in candidate.telling
        )

    def _before(self, candidate: VehicleCandidate, name: str, model: VehicleModel) -> float:
        if candidate.added.effect == "damper_asymmetry":
            # none: the same in the other direction
            return model.values.get(name, self.effects.damping(candidate.added.element, model))
        return self.effects.stated(name, model)

    def _better(self, simple: VehicleScored, rich: VehicleScored) -> bool:
        assert rich.candidate is not None
        effect = rich.candidate.added.effect
        return better(simple, rich, won(self.problem, simple.rest, rich.rest, effect))

    def _plainer_friction(
        self,
        without: tuple[VehicleModel, Mapping[str, Range]],
        current: VehicleScored,
        added: Added,
    ) -> list[VehicleScored]:
        """Fits with friction that does not fall with the speed in the place of one that does.

        What falls beside a bend that is rounded may be its corner, which is sharper.
        """
        level = f"{added.element}.coulomb_force"
        if added.effect != FALLING or level not in current.model.values:
            return []
        model, sizes = without
        trials = [
            (each.model(model, {**start, level: current.model.values[level]}),
             {**sizes, **each.sizes})
            for each in self.effects.candidates(model)
            if each.added.effect == PLAIN and each.added.element == added.element
            and each.amplitudes
            for start in each.starts
        ]  # fmt: skip
        # where plain friction ended when it was tried beside it
        tried = [
            other.model.values
            for step in self.steps
            if step.chosen.candidate is not None and step.chosen.candidate.added == added
            for other in step.others
            if other.candidate is not None
            and (other.candidate.added.effect, other.candidate.added.element)
            == (PLAIN, added.element)
        ]
        trials += [
            (base.at({n: values[n] for n in base.free if n in values}), own)
            for base, own in trials
            for values in tried
        ]
        plain = self.refit(trials)
        sharpness = f"{added.element}.damping_sharpness"
        sharper = [
            (each.model(fit.model, each.starts[-1]), {**fit.fit.sizes, **each.sizes})
            for fit in plain
            for each in self.effects.candidates(fit.model)
            if each.added.effect == BENT and sharpness in each.added.coordinates
        ]
        return plain + self.refit(sharper, TO_THE_END)

    def _prune(self, current: VehicleScored) -> VehicleScored:
        """Take away what the others have made unnecessary."""
        while len(current.model.effects) > 1:
            self.progress("checking that every effect is still needed")
            effects = current.model.effects
            trials = [self.without(current, i) for i in range(len(effects))]
            fits, told = self.refit(trials), [*effects]
            for trial, added in zip(trials, effects, strict=True):
                plainer = self._plainer_friction(trial, current, added)
                fits += plainer
                told += [added] * len(plainer)
            simpler = [
                scored
                for scored, added in zip(fits, told, strict=True)
                if not_needed(
                    scored, current, won(self.problem, scored.rest, current.rest, added.effect, 0.0)
                )
            ]
            if not simpler:
                return current
            current = min(simpler, key=lambda scored: scored.squares.sum())
            last = fit_all(self.problem, [(current.model, current.fit.sizes)], TO_THE_END, 1e-4)[0]
            current = self._score(last, current.candidate)
        return current


def _shortlist(
    found: list[tuple[float, VehicleCandidate, Mapping[str, float]]],
) -> list[tuple[VehicleCandidate, Mapping[str, float]]]:
    """The best candidates, each with its best start, or two where a start is a guess of shape."""
    found.sort(key=lambda each: each[0])
    chosen: list[tuple[VehicleCandidate, Mapping[str, float]]] = []
    count: dict[int, int] = {}

    # what looks like play of a shaft may be its gap, which no small step leads to
    effects = [candidate.added.effect for _, candidate, _ in found]
    gap = "series_elasticity" in effects[: CRITERIA.shortlist]
    for _, candidate, start in found:
        seen = count.get(id(candidate), 0)
        room = (
            len(count) < CRITERIA.shortlist
            or seen
            or (gap and candidate.added.effect == "backlash")
        )
        if room and seen < (1 if candidate.amplitudes else 2):
            count[id(candidate)] = seen + 1
            chosen.append((candidate, start))
    return chosen


def errors(fit: VehicleFit) -> dict[str, float]:
    """Standard errors of the free coordinates."""
    used = np.abs(fit.residual) > 0
    if not fit.model.free:
        return {}
    spread = sandwich(fit.jacobian[used], fit.residual[used], np.ones(int(used.sum())))
    widths = np.sqrt(np.maximum(np.diag(spread), 0)) * fit.units()
    return dict(zip(fit.model.free, map(float, widths), strict=True))


def _as_good(simple: VehicleScored, best: VehicleScored) -> bool:
    return as_good(simple, best, advantage(simple.squares, best.squares))
