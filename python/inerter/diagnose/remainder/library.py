"""Terms that a proposal may consist of, in SI units."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inerter.motion_units import unit, words

from . import columns as c
from .battery import Remainder

Array = NDArray[np.float64]

# low speeds of the logarithm, per rms velocity
SLOW = (0.01, 0.1)
# limits of the clipped force, per rms force
CLIPS = (0.1, 0.2, 0.4, 0.8)


@dataclass(frozen=True)
class Term:
    """A column of the library.

    Attributes
    ----------
    text : str
        As a formula of x, v, a [SI] and t [s].
    unit : str
        Of its coefficient, which makes a force of it.
    values : ndarray (n,)
        On the samples that count.
    partner : ndarray (n,), optional
        The cosine that goes with a sine; both are taken or neither.
    """

    text: str
    unit: str
    values: Array
    partner: Array | None = None

    @property
    def columns(self) -> Array:
        """One or two columns, (n, 1) or (n, 2)."""
        both = [self.values] if self.partner is None else [self.values, self.partner]
        return np.column_stack(both)


def unit_of(x: int = 0, v: int = 0, a: int = 0, t: int = 0) -> str:
    """Unit of the coefficient of x^x v^v a^a t^t that gives newtons."""
    length, time = x + v + a, v + 2 * a - t
    if (length, time) == (1, 2):
        return "kg"
    above = ["N"] + (["s" if time == 1 else f"s^{time}"] if time > 0 else [])
    below = (["m" if length == 1 else f"m^{length}"] if length else []) + (
        ["s" if time == -1 else f"s^{-time}"] if time < 0 else []
    )
    return "*".join(above) + "".join("/" + part for part in below)


def library(remainder: Remainder, periods: dict[str, float]) -> list[Term]:
    """Terms on the samples that count.

    periods: lengths along the stroke [m] of "displacement (periodic)" and "displacement (periodic)
    and direction", those that were found.
    """
    sizes = remainder.sizes
    x = remainder.flat(lambda run: run.displacement)
    v = remainder.flat(lambda run: run.velocity)
    a = remainder.flat(lambda run: run.acceleration)
    time = remainder.data.flat(list(remainder.clock))
    speed = np.abs(v)

    def banded(make) -> Array:
        return remainder.flat(lambda run: c.through_band(run, make(run)[:, None])[:, 0])

    def way(run) -> Array:
        return c.direction(run, sizes)

    sign = banded(way)
    motion = remainder.runs[0].motion
    terms = [
        Term("1", "N", np.ones(x.size)),
        Term("x", unit_of(x=1), x),
        Term("x^2", unit_of(x=2), x**2),
        Term("x^3", unit_of(x=3), x**3),
        Term("v", unit_of(v=1), v),
        Term("abs(v)", unit_of(v=1), speed),
        Term("v abs(v)", unit_of(v=2), v * speed),
        Term("v^2", unit_of(v=2), v**2),
        Term("v^3", unit_of(v=3), v**3),
        Term("sign(v)", "N", sign),
        Term("a", "kg", a),
        Term("a abs(a)", unit_of(a=2), a * np.abs(a)),
        Term("a^3", unit_of(a=3), a**3),
        Term("x v", unit_of(x=1, v=1), x * v),
        Term("x v^2", unit_of(x=1, v=2), x * v**2),
        Term("x^2 v", unit_of(x=2, v=1), x**2 * v),
        Term("x abs(v)", unit_of(x=1, v=1), x * speed),
        Term("x a", unit_of(x=1, a=1), x * a),
        Term("x^2 a", unit_of(x=2, a=1), x**2 * a),
        Term("v a", unit_of(v=1, a=1), v * a),
        Term("abs(v) a", unit_of(v=1, a=1), speed * a),
        Term("v^2 a", unit_of(v=2, a=1), v**2 * a),
        Term("x sign(v)", unit_of(x=1), banded(lambda run: run.displacement * way(run))),
        Term("x^2 sign(v)", unit_of(x=2), banded(lambda run: run.displacement**2 * way(run))),
        Term("a sign(v)", "kg", banded(lambda run: run.acceleration * way(run))),
        Term("abs(a) sign(v)", "kg", banded(lambda run: np.abs(run.acceleration) * way(run))),
        Term("t", unit_of(t=1), time),
        Term("t sign(v)", unit_of(t=1), time * sign),
        Term("t v", unit_of(v=1, t=1), time * v),
        Term("t x", unit_of(x=1, t=1), time * x),
        Term("t a", unit_of(a=1, t=1), time * a),
        Term("t^2 a", unit_of(a=1, t=2), time**2 * a),
        Term("t^2 sign(v)", unit_of(t=2), time**2 * sign),
    ]
    for share in SLOW:
        slow = float(f"{share * sizes.v:.2g}")
        terms.append(
            Term(
                f"sign(v) ln(1 + abs(v)/{slow:g})",
                "N",
                banded(lambda run, s=slow: way(run) * np.log1p(np.abs(run.velocity) / s)),
            )
        )
    terms += _memory(remainder) + _clipped(remainder)
    for name, length in periods.items():
        phase = 2 * np.pi * x / length
        factor = sign if "direction" in name else np.ones(x.size)
        text = ("sign(v) " if "direction" in name else "") + f"sin(2 pi x/{length:.4g})"
        terms.append(Term(text, "N", factor * np.sin(phase), factor * np.cos(phase)))
    return [replace(term, unit=unit(motion, term.unit)) for term in terms]


def _clipped(remainder: Remainder) -> list[Term]:
    """The simulated force within a limit: what a dead band takes away."""
    force = remainder.flat(lambda run: run.force) - remainder.data.residual
    limits = [float(f"{share * remainder.sizes.force:.2g}") for share in CLIPS]
    newton = words(remainder.runs[0].motion, "N")
    return [Term(f"clip(F, +-{d:g} {newton})", "1", np.clip(force, -d, d)) for d in limits]


def _memory(remainder: Remainder) -> list[Term]:
    """Velocity and direction as fading memories hold them."""
    runs, sizes = remainder.runs, remainder.sizes
    longest = max(run.force.size * run.spacing for run in runs)
    terms = []
    for memory in c.memories(min(run.cutoff for run in runs), longest):
        shown = float(f"{memory:.2g}")
        mean = remainder.flat(lambda run, m=shown: c.filtered_past(run.velocity, run.spacing, m))
        terms.append(Term(f"mean of v over the last {shown:g} s", unit_of(v=1), mean))
        sign = remainder.flat(
            lambda run, m=shown: c.filtered_past(c.direction(run, sizes), run.spacing, m)
        )
        terms.append(Term(f"mean of sign(v) over the last {shown:g} s", "N", sign))
    return terms
