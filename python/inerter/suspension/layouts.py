"""Layouts of a strut: how spring, damper and inerter are put together. A layout is one line here.

S1, S2, S3 are those of Wang and Su, "Inerter nonlinearities and the impact on suspension control",
ACC 2008, Fig. 1. In S4 and S5 a relaxation spring k_b holds damper and inerter. S6 hangs the
inerter on spring and damper, as a tuned inerter damper. SR has no inerter: a damper behind a
relaxation spring, what an inerter's gain has to be measured against where a mount yields.

SW1 ... SW8 are S1 ... S8 of Smith and Wang, "Performance benefits in passive vehicle suspensions
employing inerters", Vehicle System Dynamics 42(4), 2004, under a prefix because their numbers are
not those of Wang and Su. SW1, SW3, SW4, SW5, SW6 are S1, S2, S4, S3, S5; SW2 is SR. In SW7 and SW8
springs k_1, k_2 centre damper and inerter. Their text was not at hand: bounds and numbers are this
project's own. The static stiffness of the whole strut is k in every layout: with centring springs
the spring beside is k less what they carry. They are sought as the share of k that they carry in
series, 0 to 1, and the ratio k_1/k_2 of their stiffnesses, so that none becomes negative:
k_1 = k share (1 + ratio), k_2 = k_1 / ratio.

The inerter I(s) is ideal, b s^2, or stands behind a series spring and damper (k_s, c_s) as Wang and
Su identified on a ball screw.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from inerter.model_parameters import TEST_RIG
from inerter.suspension.rational import (
    Rational,
    damper,
    inerter,
    parallel,
    polynomial,
    series,
    spring,
)


class Parts(NamedTuple):
    """Spring k, damper c, inerter I, relaxation spring k_b, centring springs k_1 and k_2."""

    k: Rational
    c: Rational
    i: Rational
    kb: Rational
    k1: Rational
    k2: Rational


Build = Callable[[Parts], Rational]


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
        The network from its parts. Of centred layouts what stands beside the spring k.
    variables
        What an optimum is sought over: "damping", and if there is one "inertance",
        "relaxation_stiffness", "centring_share", "centring_ratio".
    meaning
        In words.
    may_vanish
        Without inertance the layout still is a strut: b = 0 is a design.
    limits
        Other variables that may be 0 or without limit (inf: rigid), with that value.
    inner
        Layouts that it becomes where variables go to 0 or without limit.
    same_as
        The layout whose network it is under another name.
    """

    name: str
    build: Build
    variables: tuple[str, ...]
    meaning: str
    may_vanish: bool = False
    limits: tuple[tuple[str, float], ...] = ()
    inner: tuple[str, ...] = ()
    same_as: str = ""

    @property
    def own(self) -> str:
        """Its name here, where it also has one of the literature's."""
        return self.same_as or self.name

    @property
    def has_inerter(self) -> bool:
        """S1 has none."""
        return "inertance" in self.variables

    @property
    def centred(self) -> bool:
        """Whether springs centre damper and inerter."""
        return "centring_share" in self.variables

    def stiffness(
        self,
        stiffness: ArrayLike,
        damping: ArrayLike,
        inertance: ArrayLike = 0.0,
        relaxation_stiffness: ArrayLike = 1.0,
        *,
        centring_share: ArrayLike = 0.0,
        centring_ratio: ArrayLike = 1.0,
        total_stiffness: ArrayLike | None = None,
        pair: SeriesPair | None = None,
    ) -> Rational:
        """Dynamic stiffness D(s) of the strut.

        Parameters
        ----------
        stiffness, damping, inertance, relaxation_stiffness
            k [N/m], c [N s/m], b [kg], k_b [N/m], inf for a rigid one; numbers or arrays, which
            broadcast. What the layout has not is not used.
        centring_share, centring_ratio
            Of k that the centring springs carry; k_1 / k_2.
        total_stiffness
            What the share is of, where that is not `stiffness` [N/m].
        pair
            Spring and damper in series with the inertance; ideal without.
        """
        mass = inerter(inertance)
        if pair is not None:
            shaft = parallel(spring(pair.stiffness), damper(pair.damping))
            mass = series(mass, shaft)
        whole = stiffness if total_stiffness is None else total_stiffness
        k1, k2 = centring_springs(whole, centring_share, centring_ratio)
        parts = Parts(
            spring(stiffness),
            damper(damping),
            mass,
            _spring_or_rigid(relaxation_stiffness),
            spring(k1),
            spring(k2),
        )
        network = self.build(parts)
        if not self.centred:
            return network
        # the spring beside is what the others leave of k
        below = network.denominator[..., :1]
        with np.errstate(all="ignore"):
            carried = np.where(below == 0.0, 0.0, network.numerator[..., :1] / below)
        return parallel(spring(np.asarray(stiffness) - carried[..., 0]), network)


def _spring_or_rigid(stiffness: ArrayLike) -> Rational:
    """A spring; of infinite stiffness 1/0, which in series leaves the others as they are."""
    if np.isposinf(np.real(stiffness)).all():
        return Rational(polynomial(1.0), polynomial(0.0))
    return spring(stiffness)


def centring_springs(k: ArrayLike, share: ArrayLike, ratio: ArrayLike) -> tuple[Any, Any]:
    """k_1, k_2 [N/m] beside damper and inerter, which carry `share` of k in series."""
    both = np.asarray(k) * np.asarray(share)
    return both * (1.0 + np.asarray(ratio)), both * (1.0 + 1.0 / np.asarray(ratio))


def springs_of(k: float, design: Mapping[str, float]) -> dict[str, float]:
    """The springs [N/m] of a centred design by name; empty of another.

    "damper_stiffness", "inerter_stiffness", and "parallel_stiffness" that is left of `k` beside.
    """
    share, ratio = design.get("centring_share"), design.get("centring_ratio")
    if share is None or ratio is None:
        return {}
    k1, k2 = (float(x) for x in centring_springs(k, share, ratio))
    carried, kb = k * share, design.get("relaxation_stiffness")
    if kb is not None and math.isfinite(kb):
        carried = carried * kb / (carried + kb)
    return {"damper_stiffness": k1, "inerter_stiffness": k2, "parallel_stiffness": k - carried}


_TWO = ("damping", "inertance")
_THREE = (*_TWO, "relaxation_stiffness")
_RIGID = ("relaxation_stiffness", math.inf)
_UNCENTRED = ("centring_share", 0.0)
_CENTRED = ("centring_share", "centring_ratio")


def _declared(*layouts: Layout) -> Mapping[str, Layout]:
    return {layout.name: layout for layout in layouts}


def _centred(p: Parts) -> Rational:
    return series(parallel(p.k1, p.c), parallel(p.k2, p.i))


_OWN = _declared(
    Layout("S1", lambda p: parallel(p.k, p.c), ("damping",), "spring and damper"),
    Layout(
        "S2", lambda p: parallel(p.k, p.c, p.i), _TWO,
        "spring, damper and inerter side by side", may_vanish=True, inner=("S1",),
    ),
    Layout(
        "S3", lambda p: parallel(p.k, series(p.c, p.i)), _TWO,
        "spring beside damper and inerter in series", inner=("S1",),
    ),
    Layout(
        "S4", lambda p: parallel(p.k, series(p.kb, parallel(p.c, p.i))), _THREE,
        "spring beside (damper and inerter side by side, behind a relaxation spring)",
        may_vanish=True, limits=(_RIGID,), inner=("S2", "SR"),
    ),
    Layout(
        "S5", lambda p: parallel(p.k, series(p.kb, p.c, p.i)), _THREE,
        "spring beside damper, inerter and relaxation spring in series", limits=(_RIGID,),
        inner=("S3", "SR"),
    ),
    Layout(
        "S6", lambda p: parallel(p.k, series(parallel(p.kb, p.c), p.i)), _THREE,
        "spring beside an inerter in series with (spring and damper side by side)",
        limits=(("relaxation_stiffness", 0.0),), inner=("S3",),
    ),
    Layout(
        "SR", lambda p: parallel(p.k, series(p.kb, p.c)), ("damping", "relaxation_stiffness"),
        "spring beside a damper behind a relaxation spring", limits=(_RIGID,), inner=("S1",),
    ),
    Layout(
        "SW7", _centred, (*_TWO, *_CENTRED),
        "spring beside damper and inerter in series, each with a centring spring",
        may_vanish=True, limits=(_UNCENTRED,), inner=("S3", "S6", "SR"),
    ),
    Layout(
        "SW8", lambda p: series(p.kb, _centred(p)), (*_THREE, *_CENTRED),
        "as SW7, all of it behind a relaxation spring",
        may_vanish=True, limits=(_RIGID, _UNCENTRED), inner=("SW7", "S5"),
    ),
)  # fmt: skip

_SAME = {"SW1": "S1", "SW2": "SR", "SW3": "S2", "SW4": "S4", "SW5": "S3", "SW6": "S5"}

LAYOUTS: Mapping[str, Layout] = {
    **{name: layout for name, layout in _OWN.items() if not name.startswith("SW")},
    **{name: replace(_OWN[own], name=name, same_as=own) for name, own in _SAME.items()},
    **{name: layout for name, layout in _OWN.items() if name.startswith("SW")},
}
"""Every layout by its name."""
