"""Free play in the flywheel's drive, fitted to the force as measured.

Behind a play the flywheel is thrown from side to side. How hard and when it lands is in the force
far above the band of the motion, so the fit needs the force as measured. An impact that is a sample
early or late leaves an error as large as its force, whatever else is right: what is far off counts
little (`BenchRun.far`), or a few impacts would decide. There are many minima, one for each way in
which impacts can be out of step, so the fit starts from many points about what the band tells.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.stats import kurtosis, qmc

from inerter.catalogue.scales import Scales
from inerter.identify.fit import Fit, Problem, rms, typical
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.parallel_steps import parallel

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Ranges = Mapping[str, tuple[float, float]]

# factors between which the starting points lie: in the band contacts look soft and plays small
RANGES: Ranges = MappingProxyType(
    {
        "backlash": (0.8, 1.4),
        "series_frequency": (0.7, 2.5),
        "series_loss": (0.5, 2.0),
        "inertance": (0.97, 1.12),
    }
)
# the same where only the way in which impacts are out of step is uncertain
NEAR: Ranges = MappingProxyType(
    {
        "backlash": (0.985, 1.015),
        "series_frequency": (0.95, 1.05),
        "series_loss": (0.9, 1.1),
        "inertance": (0.99, 1.01),
    }
)
# the same where a fit is found again without knowing it
AROUND: Ranges = MappingProxyType(dict.fromkeys(RANGES, (0.9, 1.1)))
# starting points of a round are two to this power
_POWER = 8
# rounds at most; of those that do not take this share of the error away, so many end it
_ROUNDS = 8
_GAIN = 0.02
_PATIENCE = 2
# the same where nothing is known, and of how many of these the fit begins
_WIDE = 11
_BELIEVED = 2
# share of every run that these are asked on first; of one of how many the whole is asked then
_PART = 0.25
_LEFT = 16
# the same about what is known
_NEAR_LEFT = 6
# points that are followed, and how far
_FOLLOWED = 4
_EVALUATIONS = 20
# evaluations after which these are compared, and how many are followed to the end
_SOON = 5
_TO_THE_END = 2
_TOLERANCE = 1e-4
# share of the rms error beyond which errors count little at first, and of that in the next round
_FAR = 0.5
_NARROWER = 0.3
# blows are errors this many times the noise, in this share of the samples, with this kurtosis (a
# normal distribution has 3)
_LOUD = 5.0
_SOME = 0.02
_PEAKED = 10.0
# share of the error that the best of points anywhere has to take away to be followed
_PROMISE = 0.1
# share of the error that a play sought for on its own has to take away
_WORTH = 0.2
# a delay beside a play is sought within this many periods of the band's end: the band tells others
_LATE = 0.25
# the same where contacts creep, within this share of their period
_SLOW = 0.1
# share of the rms force that tells a contact, and of the longest contact that is long
_CONTACT = 0.2
_LONG = 0.5


def is_felt(model: Model, scales: Scales, spacing: float) -> bool:
    """Whether the flywheel is in flight for as long as a force sample, `spacing` [s], or longer.

    It comes free where the force between it and the terminals changes its sign: they leave it
    behind by jerk t^3 / 6. What takes less time is no more than late.
    """
    jerk = 2.0 * np.pi * scales.frequency * scales.acceleration
    return bool(np.cbrt(6.0 * model.values["backlash"] / jerk) >= spacing)


def from_contact(run: BenchRun) -> BenchRun:
    """A run at the measured rate that is followed from a contact on, where the state is known.

    In free flight nothing tells where the flywheel is and how it turns. In the middle of a contact
    it moves with the terminals, and the force tells how far the contact gives way.
    """
    side = _side(run) * run.inner
    edges = np.flatnonzero(np.diff(side)) + 1
    begins, ends = np.r_[0, edges], np.r_[edges, side.size]
    lengths = np.where(side[begins] != 0, ends - begins, 0)
    if not lengths.any():
        return run
    chosen = int(np.argmax(lengths >= _LONG * lengths.max()))
    first = int(begins[chosen] + lengths[chosen] // 2)
    near = slice(first - lengths[chosen] // 4, first + lengths[chosen] // 4 + 1)
    known = np.arange(side.size) >= first
    return replace(
        run, first=first, first_force=float(np.mean(run.force[near])), inner=run.inner & known
    )


def _side(run: BenchRun) -> np.ndarray:
    """Sign of the force of contacts, 0 in free flight, shape (n,)."""
    return np.sign(run.force) * (np.abs(run.force) > _CONTACT * np.std(run.force))


def comes_in_blows(problem: Problem, model: Model, noise: float) -> bool:
    """Whether what a model misses is far above the noise [N] and lies in some samples.

    Not in single ones: so do errors where friction reverses.
    """
    errors = problem.errors(model)
    flat = np.concatenate([e[m] for e, m in zip(errors, problem.masks, strict=True)])
    loud = np.quantile(np.abs(flat), 1 - _SOME) > _LOUD * noise
    return bool(loud and kurtosis(flat, fisher=False) > _PEAKED)


def forgiving(problem: Problem, model: Model, far: float = 0.0) -> Problem:
    """The problem with errors counting little beyond what is usual with a model, or `far` [N].

    Usual is what contacts leave: in free flight everything is right that says so.
    """
    errors = problem.errors(model)
    pairs = zip(problem.masks, problem.runs, strict=True)
    contacts = [mask & (_side(run) != 0) for mask, run in pairs]
    usual = contacts if any(mask.any() for mask in contacts) else problem.masks
    far = max(far, typical(errors, usual))
    runs = [replace(run, far=far) for run in problem.runs]
    return Problem(runs, problem.masks, problem.scales)


def fit_play(problem: Problem, model: Model, late: float = 0.0) -> Model:
    """The best of many fits about a model with free play, and again about that, while it gains.

    Parameters
    ----------
    problem
        Runs at the measured rate with the force as measured.
    model
        What the band told.
    late
        How far from the model's the delay is sought too [s].
    """
    idle, far = 0, _FAR * rms(problem.errors(model), problem.masks)
    for seed in range(_ROUNDS):
        problem = forgiving(problem, model, far)
        before = rms(problem.residual(model), problem.masks)
        fit = _fit_about(problem, model, seed, late=late)
        gain = 1 - fit.rmse(problem.masks) / before
        model = fit.model if gain > 0 else model
        # while much is wrong most errors are far off, and the impacts tell the way
        settled = problem.runs[0].far > far
        idle = idle + 1 if settled and gain < _GAIN else 0
        far *= _NARROWER
        if idle == _PATIENCE:
            break
    return _fit_about(problem, model, 0, NEAR).model


def play_of(problem: Problem, model: Model, rigid: Sequence[Model], noise: float) -> Model | None:
    """A model with its free play fitted, or with one where it has none and needs one; else None.

    Where what remains comes in blows a play is sought from anywhere on top of the `rigid` models.

    Parameters
    ----------
    problem
        Runs at the measured rate with the force as measured.
    model
        What the band told.
    rigid
        Models without free play or series element.
    noise
        Rms of the force's noise [N].
    """
    has_play = "backlash" in model.free
    best = fit_play(problem, model) if has_play else model
    if comes_in_blows(problem, best, noise):
        plays = [play for start in rigid if (play := find_play(problem, start))]
        if plays:
            same = forgiving(problem, plays[0])
            here, *found = (rms(same.residual(m), same.masks) for m in (best, *plays))
            if min(found) < (1.0 if has_play else 1 - _WORTH) * here:
                best = plays[int(np.argmin(found))]
        if "backlash" in best.free and "delay" not in best.free:
            best = _late(problem, best, _LATE / problem.scales.cutoff) or best
    if _creeps(best) and "delay" not in best.free:
        best = _late(problem, best, _SLOW / best.values["series_frequency"]) or best
    return best if "backlash" in best.free else None


def _creeps(model: Model) -> bool:
    """Whether the contacts of a play are damped beyond the aperiodic limit.

    So they make the force late, and may stand in for a low-pass that does.
    """
    return "backlash" in model.free and model.values.get("series_loss", 0.0) > 1.0


def _late(problem: Problem, model: Model, late: float) -> Model | None:
    """The play fitted with a delay of up to `late` [s]: late impacts are out of step with any play.

    None where one round does not promise, or all of them do not bring, a clearly smaller error.
    """
    problem = forgiving(problem, model, _FAR * rms(problem.errors(model), problem.masks))
    here = rms(problem.residual(model), problem.masks)
    first = _fit_about(problem, model.adding(delay=model.delay), 0, late=late)
    if first.rmse(problem.masks) > (1 - _PROMISE) * here:
        return None
    found = fit_play(problem, first.model, late)
    return found if rms(problem.residual(found), problem.masks) < (1 - _WORTH) * here else None


def find_play(problem: Problem, model: Model) -> Model | None:
    """A free play added to a model, from anywhere: of a large one the band tells nothing.

    None where nothing tried is better than the model.

    Parameters
    ----------
    problem
        Runs at the measured rate with the force as measured.
    model
        One without free play or series element.
    """
    sizes = problem.scales
    inertance = sizes.force / sizes.acceleration
    ranges = {
        "backlash": (0.002 * sizes.displacement, 1.5 * sizes.displacement),
        "series_frequency": (3 * sizes.frequency, 100 * sizes.frequency),
        "series_loss": (0.05, 2.0),
        "inertance": (0.1 * inertance, 3 * inertance),
    }
    start = model.adding(None, **{name: low for name, (low, _) in ranges.items()})
    problem = forgiving(problem, model, _FAR * rms(problem.errors(model), problem.masks))
    points = _points(start, ranges, _WIDE, 0)
    part = problem.head(_PART)
    points = _best(part, [model, *points], len(points) // _LEFT)
    if points[0] is model:
        return None
    best = _best(problem, [each for each in points if each is not model])[:_BELIEVED]
    here, there = (rms(problem.residual(m), problem.masks) for m in (model, best[0]))
    if there > (1 - _PROMISE) * here:
        return None
    fits = [fit_play(problem, start) for start in best]
    return min(fits, key=lambda model: rms(problem.residual(model), problem.masks))


def jackknife(problem: Problem, folds: Sequence[Sequence[Mask]], model: Model) -> Array:
    """Covariance of a model's free coordinates by fits that leave out one fold each, shape (p, p).

    One minimum of many tells by its curvature how sharp it is, not how far the others are. With
    other data the impacts are out of step in another way.

    Parameters
    ----------
    problem
        With errors that count little beyond what is usual.
    folds
        Masks of every run for each fold.
    model
        The fit to all data.
    """
    found = []
    for fold in folds:
        rest = [mask & ~left for mask, left in zip(problem.masks, fold, strict=True)]
        fit = _fit_about(problem.with_masks(rest), model, 0, AROUND, with_it=False)
        found.append([fit.model.values[name] for name in model.free])
    apart = np.array(found) - np.mean(found, axis=0)
    count = len(found)
    return (count - 1) / count * apart.T @ apart


def _fit_about(
    problem: Problem,
    model: Model,
    seed: int,
    near: Ranges = RANGES,
    with_it: bool = True,
    late: float = 0.0,
) -> Fit:
    here = {name: model.values[name] for name in near if name in model.free}
    ranges = {name: (at * near[name][0], at * near[name][1]) for name, at in here.items()}
    if late:
        ranges["delay"] = (model.delay - late, model.delay + late)
    points = _points(model, ranges, _POWER, seed)
    part = problem.head(_PART)
    both = zip(part.masks, problem.masks, strict=True)
    told = all(some.any() == mask.any() for some, mask in both)
    if told:
        points = _best(part, points, len(points) // _NEAR_LEFT)
    best = _best(problem, [model, *points] if with_it else points)

    def fit(start: Model, evaluations: int) -> Fit:
        return problem.fit(start, evaluations, tolerance=_TOLERANCE, rough=True)

    def error(fit: Fit) -> float:
        return fit.rmse(problem.masks)

    soon = sorted(parallel(lambda start: fit(start, _SOON), best), key=error)[:_TO_THE_END]
    fits = parallel(lambda begun: fit(begun.model, _EVALUATIONS), soon)
    return min([*soon, *fits], key=error)


def _points(model: Model, ranges: Ranges, power: int, seed: int) -> list[Model]:
    """The model with its coordinates anywhere within ranges: of sizes, by their logarithm."""
    low, high = np.array(list(ranges.values())).T
    shares = qmc.Sobol(len(ranges), rng=seed).random_base2(power)
    sizes = low > 0
    points = low + (high - low) * shares
    points[:, sizes] = low[sizes] * (high[sizes] / low[sizes]) ** shares[:, sizes]
    moved = [dict(zip(ranges, map(float, point), strict=True)) for point in points]
    return [replace(model, values={**model.values, **values}) for values in moved]


def _best(problem: Problem, models: list[Model], count: int = _FOLLOWED) -> list[Model]:
    errors = parallel(lambda model: rms(problem.residual(model), problem.masks), models)
    return [models[i] for i in np.argsort(errors)[:count]]
