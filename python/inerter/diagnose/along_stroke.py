"""What changes along the stroke: where a residual shows it, and the models to try.

Every place of the stroke is asked what the residual is there: a force of its own, one per
acceleration (b(x) a + b'(x) v^2 / 2) or one per direction of motion. Least squares of the residual
over sines of the place tell the likeliest lengths, over a smooth curve how much a curve could take.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from inerter.catalogue.along_stroke import NODES, PERIODS, QUANTITIES, Quantity
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.decision import CRITERIA
from inerter.identify.fit import Fit, Problem
from inerter.identify.model import Model

Array = NDArray[np.float64]
# of a function of the place and its derivative by it: what it adds to the force
Effect = Callable[[Array, Array], Array]

# samples that are asked, at most; lines per stroke; the finest length as a share of the stroke
_SAMPLES = 20_000
_LINES = 4
_FINEST = 1 / 40
# nodes of the curves that are tried, the plainest first
_CURVES = (7, 17, NODES)
# lines that are tried, and how far from a better one
_TRIED = 2
_APART = 1.0


def candidates(problem: Problem, fit: Fit) -> Iterator[Candidate]:
    """Periods and curves that may take a share of what a fitted model leaves."""
    sizes, model = problem.scales, fit.model
    low, high = sizes.travel
    if sizes.one_tone or not np.isfinite([low, high]).all() or high <= low:
        return
    x, v, a, residual = _samples(problem, fit)
    if residual.size < 100:
        return
    worth = 1 - (1 - CRITERIA.likely * CRITERIA.gain) ** 2
    direction = np.tanh(v / (0.02 * sizes.velocity))
    inertance = model.device().inertance
    effects: dict[str, Effect] = {
        "force": lambda f, slope: f,
        "inertance": lambda f, slope: inertance * (f * a + 0.5 * slope * v**2),
        "friction": lambda f, slope: f * direction,
    }
    for quantity in QUANTITIES:
        name = quantity.name
        if f"{name}_curve" in model.texts or f"{name}_periods" in model.texts:
            continue
        if name == "inertance" and inertance == 0.0:
            continue
        effect, level = effects[name], 1.0
        base = model
        if name == "friction":
            if not _has_level(model):
                continue
            level = model.values["coulomb_force"]
        number = next(
            (i for i in range(1, PERIODS + 1) if quantity.period(i)[0] not in model.values), 0
        )
        if number == 0 or (name == "friction" and number > 1):
            lengths = []
        else:
            lengths = _periods(x, residual, effect, (low, high), worth)
        if lengths:
            starts = []
            for length, cosine, sine in lengths:
                names = quantity.period(number)
                bound = 0.9 * quantity.bound(sizes)
                amplitudes = np.clip([cosine / level, sine / level], -bound, bound)
                values = dict(zip(names, (length, *map(float, amplitudes)), strict=True))
                starts.append(base.adding(None, **values))
            yield Candidate(quantity.effect, "period", tuple(starts))
        if any(each.startswith(f"{name}_node") for each in model.values):
            continue
        for nodes in _CURVES:
            if _gain_of_curve(x, residual, effect, (low, high), nodes) > worth:
                yield Candidate(
                    quantity.effect,
                    "curve",
                    (_with_curve(base, quantity, nodes, (low, high)),),
                )


def _has_level(model: Model) -> bool:
    from inerter.catalogue.friction import FRICTION

    return bool(FRICTION[model.friction].varies and model.values.get("coulomb_force"))


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


def _samples(problem: Problem, fit: Fit) -> tuple[Array, Array, Array, Array]:
    """Displacement, velocity, acceleration and residual of samples that count, thinned."""
    errors = problem.errors(fit.model)
    rows = []
    step = max(1, sum(int(mask.sum()) for mask in problem.masks) // _SAMPLES)
    for run, mask, error in zip(problem.runs, problem.masks, errors, strict=True):
        which = np.flatnonzero(mask)[::step]
        channels = (run.displacement, run.velocity, run.acceleration, error)
        rows.append(np.array([channel[which] for channel in channels]))
    x, v, a, residual = np.concatenate(rows, axis=1)
    return x, v, a, residual


def _periods(
    x: Array, residual: Array, effect: Effect, ends: tuple[float, float], worth: float
) -> list[tuple[float, float, float]]:
    """Lengths [m] and amplitudes of the sines of the place that take most, the best first."""
    stroke = ends[1] - ends[0]
    lines = np.arange(0.75 / stroke, 1 / (_FINEST * stroke), 1 / (_LINES * stroke))
    gains, amplitudes = np.zeros(lines.size), np.zeros((lines.size, 2))
    for i, line in enumerate(lines):
        angle, rate = 2 * np.pi * line * x, 2 * np.pi * line
        c, s = np.cos(angle), np.sin(angle)
        columns = np.column_stack([effect(c, -rate * s), effect(s, rate * c)])
        gains[i], amplitudes[i] = _gain(columns, residual)
    found: list[tuple[float, float, float]] = []
    for i in np.argsort(-gains):
        if gains[i] < worth or len(found) == _TRIED:
            break
        if all(abs(lines[i] - 1 / length) > _APART / stroke for length, _, _ in found):
            found.append((float(1 / lines[i]), *map(float, amplitudes[i])))
    return found


def _gain_of_curve(
    x: Array, residual: Array, effect: Effect, ends: tuple[float, float], nodes: int
) -> float:
    """Share of the square of a residual that a smooth curve of the place takes."""
    places = np.linspace(*ends, nodes)
    spline = make_interp_spline(places, np.eye(nodes), k=3, bc_type="clamped")
    inside = np.clip(x, *ends)
    values, slopes = spline(inside), spline(inside, 1)
    columns = np.column_stack([effect(values[:, i], slopes[:, i]) for i in range(nodes)])
    gain, _ = _gain(columns, residual)
    # what as many columns take of noise
    return gain - nodes / residual.size


def _gain(columns: Array, residual: Array) -> tuple[float, Array]:
    """Share of the square of a residual that columns take, and by which amplitudes."""
    amplitudes = np.linalg.lstsq(columns, residual, rcond=1e-10)[0]
    left = residual - columns @ amplitudes
    return 1.0 - float(left @ left) / float(residual @ residual), amplitudes
