"""What stands in the strut: the cases of Wang and Su's Tables 2 and 3, and laws beyond them.

A `Case` is a device around the inertance; the inertance itself is of the design.

Tables 2 and 3 of Wang and Su, "Inerter nonlinearities and the impact on suspension control", ACC
2008, are lost; their cases stand in the text of sections V.C and V.D. That case 1 is S1, that S2
comes before S3 and that the smaller friction comes first follows from what is said of each case.
The series pair is that of `SOFT`, friction is 10 N (measured on the bench) and 100 N.

Backlash: the paper's device has none. The half gap of 0.05 mm is this project's choice, a total
play of 0.1 mm, the order of the axial clearance of rolled ball screws without preload.
Dahl: identified on a ball-screw inerter ("Modelling and identification of the hysteretic dynamics
of inerters"), sigma0 = 4.29e4 N/m, F_c = 62 N, 10.2 N s/m. That paper's LuGre and Bouc-Wen
parameters are not identifiable and are nearly linear, so here both are derived: the same sliding
level, pre-sliding stiffness and viscous damping as its Dahl, so that only the shape differs.
LuGre: F_s = 1.5 F_c and sigma1 = sqrt(sigma0) as in Canudas de Wit et al. 1995, v_s = 10 mm/s.
Bouc-Wen: A = 0, n = 1, beta = gamma, (beta + gamma) F_c = k0.
Coulomb's sign(v) is tanh(v / width), width 1 mm/s: narrow against the speeds of a strut
(0.1 m/s), wide enough for an explicit step of 1 ms.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from inerter.model_parameters import TEST_RIG
from inerter.suspension.layouts import HARD, SOFT, SeriesPair

TRANSITION_VELOCITY = 1e-3
"""Width of sign(v) = tanh(v / width) [m/s]."""

HALF_GAP = 5e-5
"""Half of the free play [m], see the module."""


@dataclass(frozen=True)
class Case:
    """`friction` law and `parameters` of a device by their key (SI), without the inertance.

    `stiff`: faster than a step of RK4 can follow, so that another integrator steps it.
    """

    name: str
    meaning: str
    friction: str = "none"
    parameters: Mapping[str, Any] = field(default_factory=dict)
    stiff: bool = False

    @property
    def ideal(self) -> bool:
        """Whether there is nothing but the inertance."""
        return self.friction == "none" and not self.parameters

    @property
    def pair(self) -> SeriesPair | None:
        """Spring and damper in series with the inertance, if there are any."""
        if not self.has_series:
            return None
        given = self.parameters
        return SeriesPair(given.get("series_stiffness", 0.0), given.get("series_damping", 0.0))

    @property
    def has_series(self) -> bool:
        """Whether the inertance is behind an elastic shaft."""
        return "series_stiffness" in self.parameters or "series_damping" in self.parameters

    @property
    def linear(self) -> bool:
        """Whether the indices have exact values."""
        return self.friction == "none" and set(self.parameters) <= {
            "series_stiffness",
            "series_damping",
        }


@dataclass(frozen=True)
class NumberedCase:
    """Case `number` of Wang and Su's `table` (2 or 3)."""

    table: int
    number: int
    layout: str
    case: str


def _series(pair: SeriesPair) -> dict[str, float]:
    return {"series_stiffness": pair.stiffness, "series_damping": pair.damping}


def coulomb(force: float, width: float = TRANSITION_VELOCITY) -> dict[str, float]:
    """Parameters of friction of constant level `force` [N], `width` [m/s]."""
    return {"coulomb_force": force, "transition_velocity": width}


_FRICTION = coulomb(TEST_RIG.coulomb_force)
_PLAY = {"backlash": HALF_GAP}
_LEVEL, _BRISTLE, _VISCOUS = 62.0, 4.29e4, 10.2

CASES: Mapping[str, Case] = MappingProxyType(
    {
        case.name: case
        for case in (
            Case("ideal", "ideal inerter"),
            Case("friction", "friction of 10 N", "coulomb", _FRICTION),
            Case("friction100", "friction of 100 N", "coulomb", coulomb(100.0)),
            Case("elastic", "elastic shaft (soft)", "none", _series(SOFT)),
            Case("hard", "elastic shaft (hard)", "none", _series(HARD)),
            Case("backlash", "elastic shaft with free play", "none", _series(SOFT) | _PLAY),
            Case("both", "friction of 10 N, elastic shaft", "coulomb", _FRICTION | _series(SOFT)),
            Case(
                "all", "friction of 10 N, elastic shaft with free play", "coulomb",
                _FRICTION | _series(SOFT) | _PLAY,
            ),
            Case(
                "dahl", "Dahl friction of 62 N", "dahl",
                {"coulomb_force": _LEVEL, "bristle_stiffness": _BRISTLE, "viscous": _VISCOUS},
            ),
            Case(
                "lugre", "LuGre friction of 62 N, 93 N at rest", "lugre",
                {
                    "coulomb_force": _LEVEL, "static_force": 1.5 * _LEVEL,
                    "stribeck_velocity": 0.01, "bristle_stiffness": _BRISTLE,
                    "bristle_damping": math.sqrt(_BRISTLE), "viscous": _VISCOUS,
                },
            ),
            Case(
                "bouc_wen", "Bouc-Wen hysteresis of 62 N", "bouc_wen",
                {
                    "bw_stiffness": _BRISTLE, "bw_beta": 0.5 * _BRISTLE / _LEVEL,
                    "bw_gamma": 0.5 * _BRISTLE / _LEVEL, "viscous": _VISCOUS,
                },
            ),
        )
    }
)  # fmt: skip
"""Every case by its name."""

NUMBERED: tuple[NumberedCase, ...] = (
    NumberedCase(2, 1, "S1", "ideal"),
    NumberedCase(2, 2, "S2", "ideal"),
    NumberedCase(2, 3, "S2", "friction"),
    NumberedCase(2, 4, "S2", "friction100"),
    NumberedCase(2, 5, "S3", "ideal"),
    NumberedCase(2, 6, "S3", "friction"),
    NumberedCase(2, 7, "S3", "friction100"),
    NumberedCase(3, 1, "S1", "ideal"),
    NumberedCase(3, 2, "S2", "ideal"),
    NumberedCase(3, 3, "S2", "elastic"),
    NumberedCase(3, 4, "S2", "friction"),
    NumberedCase(3, 5, "S2", "both"),
    NumberedCase(3, 6, "S3", "ideal"),
    NumberedCase(3, 7, "S3", "elastic"),
    NumberedCase(3, 8, "S3", "friction"),
    NumberedCase(3, 9, "S3", "both"),
)
"""The cases as the paper numbers them."""


def case_named(name: str) -> Case:
    """A case of `CASES`.

    Raises
    ------
    ValueError
        No such case.
    """
    if name not in CASES:
        raise ValueError(f"case {name!r}: there are {', '.join(CASES)}")
    return CASES[name]


def numbers_of(layout: str, case: str) -> str:
    """The paper's numbers, as in "2.3 3.4" for case 3 of Table 2 and case 4 of Table 3."""
    found = [n for n in NUMBERED if (n.layout, n.case) == (layout, case)]
    return " ".join(f"{n.table}.{n.number}" for n in found)
