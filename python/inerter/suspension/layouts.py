"""Layouts of a strut: how spring, damper and inerter are put together. A layout is one line here.

S1, S2, S3 are those of Wang and Su, "Inerter nonlinearities and the impact on suspension control",
ACC 2008, Fig. 1. S4 and S5 are two of the richer ones of Smith and Wang, "Performance benefits in
passive vehicle suspensions employing inerters", Vehicle System Dynamics 42(4), 2004: a relaxation
spring k_b holds damper and inerter. Their text was not at hand: names, bounds and all numbers of S4
and S5 are this project's own. S6 hangs the inerter on spring and damper, as a tuned inerter damper.

The inerter I(s) is ideal, b s^2, or stands behind a series spring and damper (k_s, c_s) as Wang and
Su identified on a ball screw.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from numpy.typing import ArrayLike

from inerter.model_parameters import TEST_RIG
from inerter.suspension.rational import Rational, damper, inerter, parallel, series, spring

Build = Callable[[Rational, Rational, Rational, Rational], Rational]


@dataclass(frozen=True)
class SeriesPair:
    """Spring `stiffness` [N/m] and damper `damping` [N s/m] between terminal and inertance."""

    stiffness: float
    damping: float


SOFT = SeriesPair(TEST_RIG.series_stiffness, TEST_RIG.series_damping)
"""The pair that Wang and Su identified."""
HARD = SeriesPair(2.0 * SOFT.stiffness, 2.0 * SOFT.damping)
"""Twice as hard, theirs too."""


@dataclass(frozen=True)
class Layout:
    """A strut layout.

    Attributes
    ----------
    name
        "S1", ...
    build
        The network from spring k, damper c, inerter I and relaxation spring k_b.
    variables
        What an optimum is sought over: "damping", and if there is one "inertance" and
        "relaxation_stiffness".
    meaning
        In words.
    may_vanish
        Without inertance the layout still is a strut: b = 0 is a design.
    """

    name: str
    build: Build
    variables: tuple[str, ...]
    meaning: str
    may_vanish: bool = False

    @property
    def has_inerter(self) -> bool:
        """S1 has none."""
        return "inertance" in self.variables

    def stiffness(
        self,
        stiffness: ArrayLike,
        damping: ArrayLike,
        inertance: ArrayLike = 0.0,
        relaxation_stiffness: ArrayLike = 1.0,
        *,
        pair: SeriesPair | None = None,
    ) -> Rational:
        """Dynamic stiffness D(s) of the strut.

        Parameters
        ----------
        stiffness, damping, inertance, relaxation_stiffness
            k [N/m], c [N s/m], b [kg], k_b [N/m]; numbers or arrays, which broadcast. What the
            layout has not is not used.
        pair
            Spring and damper in series with the inertance; ideal without.
        """
        mass = inerter(inertance)
        if pair is not None:
            shaft = parallel(spring(pair.stiffness), damper(pair.damping))
            mass = series(mass, shaft)
        return self.build(spring(stiffness), damper(damping), mass, spring(relaxation_stiffness))


_TWO = ("damping", "inertance")
_THREE = ("damping", "inertance", "relaxation_stiffness")


def _declared(*layouts: Layout) -> Mapping[str, Layout]:
    return {layout.name: layout for layout in layouts}


def _s1(k: Rational, c: Rational, i: Any, kb: Any) -> Rational:
    return parallel(k, c)


LAYOUTS: Mapping[str, Layout] = _declared(
    Layout("S1", _s1, ("damping",), "spring and damper"),
    Layout(
        "S2", lambda k, c, i, kb: parallel(k, c, i), _TWO,
        "spring, damper and inerter side by side", may_vanish=True,
    ),
    Layout(
        "S3", lambda k, c, i, kb: parallel(k, series(c, i)), _TWO,
        "spring beside damper and inerter in series",
    ),
    Layout(
        "S4", lambda k, c, i, kb: parallel(k, series(kb, parallel(c, i))), _THREE,
        "spring beside (damper and inerter side by side, behind a relaxation spring)",
    ),
    Layout(
        "S5", lambda k, c, i, kb: parallel(k, series(kb, c, i)), _THREE,
        "spring beside damper, inerter and relaxation spring in series",
    ),
    Layout(
        "S6", lambda k, c, i, kb: parallel(k, series(parallel(kb, c), i)), _THREE,
        "spring beside an inerter in series with (spring and damper side by side)",
    ),
)  # fmt: skip
"""Every layout by its name."""
