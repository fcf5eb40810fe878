"""Layouts of a strut: how spring, damper and inerter are put together. A layout is one line here.

S1, S2, S3 are those of Wang and Su, "Inerter nonlinearities and the impact on suspension control",
ACC 2008, Fig. 1. S4, S5, S6 are richer ones under this project's own numbers: a relaxation spring
k_b holds damper and inerter of S2 and S3; S6 hangs the inerter on spring and damper.

SW1 ... SW8 are S1 ... S8 of Smith and Wang, "Performance benefits in passive vehicle suspensions
employing inerters", Vehicle System Dynamics 42(4), 2004, whose numbers differ: SW1 = S1, SW3 = S2,
SW5 = S3, SW4 = S4, SW6 = S5. SW2 is a damper behind a relaxation spring, the fair baseline without
an inerter. SW7 and SW8 have centring springs across damper and inerter, which carry a part of the
static load: their `stiffness` is that of the whole strut at rest, and the spring beside has what is
left of it. The text of that paper was not at hand; the topologies are as later papers give them.

The inerter is ideal, b s^2, or stands behind a series spring and damper (k_s, c_s) as Wang and
Su identified on a ball screw.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Any

from numpy.typing import ArrayLike

from inerter.model_parameters import TEST_RIG
from inerter.suspension.network import Network, joined
from inerter.suspension.rational import Rational


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
    elements
        The netlist; its spring of parameter "stiffness" is the one that is given.
    variables
        What an optimum is sought over: names of parameters of the netlist.
    meaning
        In words.
    may_vanish
        Without inertance the layout still is a strut: b = 0 is a design.
    limits
        Layouts that this one becomes as variables go to an end of their range, without a jump:
        name and {variable: 0 for absent, 1 for rigid}. It is never worse than any of them.
    """

    name: str
    elements: Network
    variables: tuple[str, ...]
    meaning: str
    may_vanish: bool = False
    limits: Mapping[str, Mapping[str, int]] = field(default_factory=dict, compare=False)

    @property
    def has_inerter(self) -> bool:
        """S1 has none."""
        return any(one.kind == "inerter" for one in self.elements.elements)

    @property
    def kinds(self) -> Mapping[str, str]:
        """Kind of element of each variable."""
        return self.elements.parameters

    @cached_property
    def centring(self) -> tuple[str, ...]:
        """Springs that carry a part of the static load beside the one that is given."""
        rest = self.elements.without("stiffness")
        if rest.stiffness(dict.fromkeys(rest.parameters, 1.0)).numerator[0] == 0.0:
            return ()
        springs = [name for name in self.variables if self.kinds[name] == "spring"]
        return tuple(name for name in springs if self._carries(name))

    def _carries(self, name: str) -> bool:
        rest = self.elements.without("stiffness")
        values = dict.fromkeys(rest.parameters, 1.0)
        soft = rest.stiffness(values | {name: 0.5})
        hard = rest.stiffness(values)
        here, there = (x.numerator[0] / x.denominator[0] for x in (soft, hard))
        return bool(abs(here - there) > 1e-12)

    def values(self, stiffness: ArrayLike, sought: Mapping[str, Any]) -> dict[str, Any]:
        """Parameters of the netlist from what is sought, `stiffness` at rest being that given.

        Where centring springs carry a part, what is sought are their values before all are
        scaled by K / (K + K_r), K_r their stiffness at rest: any positive values are then a
        design whose spring beside is positive.
        """
        values: dict[str, Any] = dict(sought)
        if not self.centring:
            return values | {"stiffness": stiffness}
        share = stiffness / (stiffness + self.at_rest(values))
        values |= {name: values[name] * share for name in self.centring}
        return values | {"stiffness": stiffness - self.at_rest(values)}

    def at_rest(self, values: Mapping[str, Any]) -> Any:
        """Stiffness of what stands beside the given spring at rest [N/m]."""
        rest = self.elements.without("stiffness").stiffness(values)
        return rest.numerator[..., 0] / rest.denominator[..., 0]

    def stiffness(
        self,
        stiffness: ArrayLike,
        damping: ArrayLike = 1.0,
        inertance: ArrayLike = 0.0,
        relaxation_stiffness: ArrayLike = 1.0,
        *,
        pair: SeriesPair | None = None,
        **others: ArrayLike,
    ) -> Rational:
        """Dynamic stiffness D(s) of the strut.

        Parameters
        ----------
        stiffness, damping, inertance, relaxation_stiffness
            k [N/m], c [N s/m], b [kg], k_b [N/m]; numbers or arrays, which broadcast. What the
            layout has not is not used.
        pair
            Spring and damper in series with the inertance; ideal without.
        others
            Further parameters of the netlist.
        """
        values = {
            "stiffness": stiffness,
            "damping": damping,
            "inertance": inertance,
            "relaxation_stiffness": relaxation_stiffness,
            **others,
        }
        network = self.elements
        if pair is not None:
            network = _behind(network, pair.stiffness, pair.damping)
        return network.stiffness(values)


@cache
def _behind(network: Network, stiffness: float, damping: float) -> Network:
    return network.behind({"spring": stiffness, "damper": damping})


_K, _C, _B, _KB = "stiffness", "damping", "inertance", "relaxation_stiffness"
_K1, _K2 = "damper_centring_stiffness", "inerter_centring_stiffness"


def _layout(
    name: str, meaning: str, *stages: str | tuple[str, ...], may_vanish: bool = False, **limits: Any
) -> Layout:
    flat = [x for stage in stages for x in ((stage,) if isinstance(stage, str) else stage)]
    order = (_C, _B, _KB, _K1, _K2)
    variables = tuple(x for x in order if x in flat)
    return Layout(name, joined(_K, *stages), variables, meaning, may_vanish, limits)


def _declared(*layouts: Layout) -> Mapping[str, Layout]:
    return {layout.name: layout for layout in layouts}


LAYOUTS: Mapping[str, Layout] = _declared(
    _layout("S1", "spring and damper", _C),
    _layout("S2", "spring, damper and inerter side by side", (_C, _B), may_vanish=True),
    _layout("S3", "spring beside damper and inerter in series", _C, _B),
    _layout(
        "S4", "spring beside (damper and inerter side by side, behind a relaxation spring)",
        _KB, (_C, _B), SW2={_B: 0},
    ),
    _layout(
        "S5", "spring beside damper, inerter and relaxation spring in series", _KB, _C, _B,
        S3={_KB: 1}, SW2={_B: 1},
    ),
    _layout(
        "S6", "spring beside an inerter in series with (spring and damper side by side)",
        (_KB, _C), _B, S3={_KB: 0},
    ),
    _layout("SW1", "Smith and Wang's S1: spring and damper", _C),
    _layout("SW2", "Smith and Wang's S2: spring beside a damper behind a relaxation spring",
            _KB, _C, SW1={_KB: 1}),
    _layout("SW3", "Smith and Wang's S3: spring, damper and inerter side by side", (_C, _B),
            may_vanish=True),
    _layout("SW4", "Smith and Wang's S4: damper and inerter side by side, behind a spring",
            _KB, (_C, _B), SW2={_B: 0}),
    _layout("SW5", "Smith and Wang's S5: spring beside damper and inerter in series", _C, _B),
    _layout("SW6", "Smith and Wang's S6: damper, inerter and relaxation spring in series",
            _KB, _C, _B, SW5={_KB: 1}, SW2={_B: 1}),
    _layout("SW7", "Smith and Wang's S7: SW5 with centring springs across damper and inerter",
            (_C, _K1), (_B, _K2), SW5={_K1: 0, _K2: 0}),
    _layout("SW8", "Smith and Wang's S8: SW7 behind a relaxation spring",
            _KB, (_C, _K1), (_B, _K2), SW7={_KB: 1}, SW6={_K1: 0, _K2: 0}),
)  # fmt: skip
"""Every layout by its name."""
