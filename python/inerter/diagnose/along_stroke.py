"""What changes along the stroke: where a residual shows it, and the models to try.

Every place of the stroke is asked what the residual is there: a force of its own, one per
acceleration (b(x) a + b'(x) v^2 / 2) or one per direction of motion. Least squares of the residual
over sines of the place tell the likeliest lengths, over a smooth curve how much a curve could take.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.along_stroke import (
    NODES,
    PERIODS,
    QUANTITIES,
    TURN,
    Quantity,
    curves_of_nodes,
)
from inerter.catalogue.friction import FRICTION
from inerter.catalogue.scales import Scales
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.waves import shares_taken, shortest
from inerter.identify.fit import Fit, Problem
from inerter.identify.model import Model
from inerter.motion_units import ROTATION

Array = NDArray[np.float64]
# of a function of the place and its derivative by it: what it adds to the force
Effect = Callable[[Array, Array], Array]

# samples that are asked, at least and at most; lines per stroke
_FEWEST, _SAMPLES = 100, 20_000
_LINES = 4
# periods that one sine goes through at least, and share of the square of a residual that they take,
# to be told from all else that has harmonics: fitted, four true ones take 0.96 to 1, a tone's 0.35
_OF_ONE_SINE, _MOST_OF_IT = 3.0, 0.5
# nodes of the curves that are tried, the plainest first
_CURVES = (7, 17, NODES)
# lines that are tried, and how far from a better one
_TRIED = 2
_APART = 1.0
# samples that half of a motion goes through a period in, at least
_STEPPED = 2.0
# share of the rms speed within which a direction is not sure
_BLUR = 0.02
# share of the square of a residual from which on a fit is worth while
_WORTH = 1 - (1 - CRITERIA.likely * CRITERIA.gain) ** 2


def candidates(problem: Problem, fit: Fit, curves: bool = True) -> Iterator[Candidate]:
    """Periods, and curves if asked for, that may take a share of what a fitted model leaves.

    Along one sine a curve draws what any other effect does, and so does a long period.
    """
    low, high = ends = problem.scales.travel
    if not np.isfinite([low, high]).all() or high <= low:
        return
    one_tone = problem.scales.one_tone
    fewest, least = (_OF_ONE_SINE, _MOST_OF_IT) if one_tone else (1.0, _WORTH)
    (x, v, a, residual), apart = _samples(problem, fit)
    if residual.size < _FEWEST:
        return
    finest = shortest(high - low, apart * float(np.median(np.abs(v))))
    for quantity in QUANTITIES:
        effect = _effect(quantity, fit.model, v, a, _BLUR * problem.scales.velocity)
        if effect is not None:
            shown = _Shown(x, a, v > 0, residual, effect, ends, fewest, least, finest)
            yield from _periodic(quantity, fit.model, shown, problem.scales)
            if quantity.name == "force" and problem.runs[0].motion == ROTATION:
                yield from _weight(quantity, fit.model, shown, one_tone)
            if curves and not one_tone:
                yield from _curved(quantity, fit.model, shown)


def is_drawn(model: Model) -> bool:
    """Whether a curve along the stroke is searched for."""
    nodes = (name for each in QUANTITIES for name in (*each.nodes, *each.back_nodes))
    return not set(model.free).isdisjoint(nodes)


def repeats(model: Model, sizes: Scales) -> bool:
    """Whether every period that is fitted lies within the travel; a longer one is a curve."""
    travel = sizes.travel[1] - sizes.travel[0]
    return all(length <= travel for length in _fitted_lengths(model))


def is_sampled(model: Model, problem: Problem) -> bool:
    """Whether samples show every period that is fitted; one that they step over is another one."""
    lengths = _fitted_lengths(model)
    if not lengths:
        return True
    pairs = zip(problem.runs, problem.masks, strict=True)
    paths = [np.abs(run.velocity[mask]) * run.sample_spacing for run, mask in pairs]
    return min(lengths) >= _STEPPED * float(np.median(np.concatenate(paths)))


def is_there(model: Model, problem: Problem) -> bool:
    """Whether every period that is fitted may be one of the device."""
    return repeats(model, problem.scales) and is_sampled(model, problem)


def _fitted_lengths(model: Model) -> list[float]:
    names = {each.period(i)[0] for each in QUANTITIES for i in range(1, PERIODS + 1)}
    return [model.values[name] for name in names.intersection(model.free)]


def _effect(quantity: Quantity, model: Model, v: Array, a: Array, slow: float) -> Effect | None:
    """What a relative change of a quantity adds to the force; None where it cannot be asked for."""
    if any(f"{quantity.name}_{kind}" in model.texts for kind in ("curve", "periods")):
        return None
    if quantity.name == "force":
        return lambda f, slope: f
    if quantity.name == "inertance":
        inertance = model.device().inertance
        return (lambda f, slope: inertance * (f * a + 0.5 * slope * v**2)) if inertance else None
    level = model.values.get("coulomb_force", 0.0) if FRICTION[model.friction].varies else 0.0
    direction = level * np.tanh(v / slow)
    return (lambda f, slope: f * direction) if level else None


@dataclass(frozen=True)
class _Shown:
    """Where samples are, which way they go, what is left there, and what it is asked for.

    Of a period the travel has at least the `fewest`, it takes at `least` that share of the square,
    and it is no shorter than the `finest` [m].
    """

    x: Array
    a: Array
    forward: NDArray[np.bool_]
    residual: Array
    effect: Effect
    ends: tuple[float, float]
    fewest: float
    least: float
    finest: float


def _periodic(
    quantity: Quantity, model: Model, shown: _Shown, sizes: Scales
) -> Iterator[Candidate]:
    """One more period, from each of the likeliest lengths."""
    most = 1 if quantity.name == "friction" else PERIODS
    free = [i for i in range(1, most + 1) if quantity.period(i)[0] not in model.values]
    # a level with a curve and a period might not stay above 0
    if not free or (quantity.name == "friction" and _has_curve(quantity, model)):
        return
    # periods of one direction alone
    if _has_flanks(quantity, model):
        return
    bound = 0.9 * quantity.bound(sizes)
    starts = [
        model.adding(
            None,
            **dict(
                zip(
                    quantity.period(free[0]), (length, *amplitudes.clip(-bound, bound)), strict=True
                )
            ),
        )
        for length, amplitudes in _lengths(shown)
    ]
    if starts:
        yield Candidate(quantity.effect, "period", tuple(starts))


def _weight(quantity: Quantity, model: Model, shown: _Shown, one_tone: bool) -> Iterator[Candidate]:
    """One period a turn, as of a weight out of balance, however little of a turn is moved.

    Along one sine a constant is one of a load cell, and what goes with the angle is inertance:
    there what is bent has to take some.
    """
    names = quantity.period_of_a_turn(model.values)
    if names is None:
        return
    length, *amplitudes = names
    columns = np.column_stack([np.cos(shown.x), np.sin(shown.x)])
    gain, found = _gain(columns, shown.residual)
    begin = dict[str, float]()
    if one_tone:
        straight = np.linalg.qr(np.column_stack([np.ones_like(shown.x), shown.x]))[0]
        bent, left = (each - straight @ (straight.T @ each) for each in (columns, shown.residual))
        gain, _ = _gain(bent, left)
    elif "inertance" in model.free:
        # a weight that swings freely takes what its inertance adds: neither helps alone
        alone, _ = _gain(shown.a[:, None], shown.residual)
        both, together = _gain(np.column_stack([columns, shown.a]), shown.residual)
        inertance = model.values["inertance"] + float(together[2])
        if inertance > 0 and both - alone > gain:
            gain, found, begin = both - alone, together[:2], {"inertance": inertance}
    if gain > _WORTH:
        begin |= dict(zip(amplitudes, map(float, found), strict=True))
        start = model.holding(**{length: TURN}).adding(None, **begin)
        yield Candidate(quantity.effect, "period", (start,))


def _curved(quantity: Quantity, model: Model, shown: _Shown) -> Iterator[Candidate]:
    """A curve of few nodes, of more; one for each direction where that takes more."""
    periods = quantity.period(1)[0] in model.values
    known = sum(name in model.values for name in quantity.nodes)
    for nodes in (known,) if known else _CURVES:
        gain = 0.0
        if not known and not (periods and quantity.name == "friction"):
            gain = _gain_of_curve(shown, nodes)
            if gain > _WORTH:
                start = _with_curve(model, quantity, nodes, shown.ends)
                yield Candidate(quantity.effect, "curve", (start,))
        if not quantity.flanks or periods or _has_flanks(quantity, model):
            continue
        if _gain_of_curve(shown, nodes, flanks=True) > gain + _WORTH:
            start = _with_flanks(model, quantity, nodes, shown.ends)
            yield Candidate(quantity.effect, "flanks", (start,))


def _has_curve(quantity: Quantity, model: Model) -> bool:
    return not model.values.keys().isdisjoint(quantity.nodes)


def _has_flanks(quantity: Quantity, model: Model) -> bool:
    return not model.values.keys().isdisjoint(quantity.back_nodes)


def _with_flanks(model: Model, quantity: Quantity, nodes: int, ends: tuple[float, float]) -> Model:
    """The model with a curve for each direction; that for v < 0 begins as the other one."""
    forth = model if _has_curve(quantity, model) else _with_curve(model, quantity, nodes, ends)
    names = zip(quantity.back_nodes[:nodes], quantity.nodes, strict=False)
    return forth.adding(None, **{back: forth.values[name] for back, name in names})


def _with_curve(model: Model, quantity: Quantity, nodes: int, ends: tuple[float, float]) -> Model:
    """The model with a curve that is 0 at the nodes that other coordinates stand for already."""
    held = {
        place
        for name, place in zip(quantity.nodes_zero, (nodes // 2 + 1, nodes), strict=False)
        if name in model.values
    }
    ends = model.values.get("curve_lower", ends[0]), model.values.get("curve_upper", ends[1])
    bare = model.without([name for name in quantity.stands_for if name in model.free])
    curve = {quantity.node(i): 0.0 for i in range(1, nodes + 1) if i not in held}
    zeros = {quantity.node(i): 0.0 for i in held}
    return bare.holding(curve_lower=ends[0], curve_upper=ends[1], **zeros).adding(None, **curve)


def _samples(problem: Problem, fit: Fit) -> tuple[Array, float]:
    """Displacement, velocity, acceleration and residual of samples that count, thinned (4, n).

    And how far they are apart [s].
    """
    errors = problem.errors(fit.model)
    rows = []
    step = max(1, sum(int(mask.sum()) for mask in problem.masks) // _SAMPLES)
    for run, mask, error in zip(problem.runs, problem.masks, errors, strict=True):
        which = np.flatnonzero(mask)[::step]
        channels = (run.displacement, run.velocity, run.acceleration, error)
        rows.append(np.array([channel[which] for channel in channels]))
    return np.concatenate(rows, axis=1), step * max(run.spacing for run in problem.runs)


def _lengths(shown: _Shown) -> list[tuple[float, Array]]:
    """Lengths [m] and amplitudes (2,) of the sines of the place that take most, the best first."""
    stroke, x = shown.ends[1] - shown.ends[0], shown.x
    step = 1 / (_LINES * stroke)
    lines = step * np.arange(int(1 / (shown.finest * step)))
    one, none = np.ones(x.size), np.zeros(x.size)
    level = np.asarray(none + shown.effect(one, none), dtype=np.float64)
    rise = np.asarray(none + shown.effect(none, one), dtype=np.float64)
    gains = shares_taken(x, shown.residual, level, rise, step, lines.size)
    gains[lines < (1 - 1e-9) * shown.fewest / stroke] = 0.0
    found: list[tuple[float, Array]] = []
    for i in np.argsort(-gains):
        if gains[i] < shown.least or len(found) == _TRIED:
            break
        if all(abs(lines[i] - 1 / length) > _APART / stroke for length, _ in found):
            rate = 2 * np.pi * float(lines[i])
            angle = rate * x
            c, s = np.cos(angle), np.sin(angle)
            columns = np.column_stack([shown.effect(c, -rate * s), shown.effect(s, rate * c)])
            found.append((float(1 / lines[i]), _gain(columns, shown.residual)[1]))
    return found


def _gain_of_curve(shown: _Shown, nodes: int, flanks: bool = False) -> float:
    """Share of the square of a residual that a smooth curve of the place takes, or two."""
    spline = curves_of_nodes(*shown.ends, nodes)
    inside = np.clip(shown.x, *shown.ends)
    values, slopes = spline(inside), spline(inside, 1)
    columns = np.column_stack([shown.effect(values[:, i], slopes[:, i]) for i in range(nodes)])
    if flanks:
        ways = shown.forward[:, None], ~shown.forward[:, None]
        columns = np.concatenate([np.where(way, columns, 0.0) for way in ways], axis=1)
    gain, _ = _gain(columns, shown.residual)
    # what as many columns take of noise
    return gain - columns.shape[1] / shown.residual.size


def _gain(columns: Array, residual: Array) -> tuple[float, Array]:
    """Share of the square of a residual that columns take, and by which amplitudes."""
    amplitudes = np.linalg.lstsq(columns, residual, rcond=1e-10)[0]
    left = residual - columns @ amplitudes
    taken = 1.0 - float(left @ left) / float(residual @ residual)
    return taken, np.asarray(amplitudes, dtype=np.float64)
