"""How a parameter is declared, and those of the friction laws: unit, default and bounds."""

from __future__ import annotations

import difflib
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from .stroke import Quantity as Quantity
from .stroke import StrokeParameters

UNSET = float("nan")
"""Default of a parameter that has no harmless number: not given."""

FRICTION_LAWS = (
    "none",
    "coulomb",
    "stribeck",
    "dahl",
    "lugre",
    "bouc_wen",
    "brown_mcphee",
    "maxwell_slip",
    "rate_state",
)


def parameter(
    default: float,
    unit: str,
    meaning: str,
    *,
    at_least: float | None = None,
    above: float | None = None,
    at_most: float | None = None,
) -> Any:
    """Declare a dataclass field that carries unit, meaning and bounds as metadata."""
    metadata = {
        "unit": unit,
        "meaning": meaning,
        "at_least": at_least,
        "above": above,
        "at_most": at_most,
    }
    return field(default=default, metadata=metadata)


@dataclass(frozen=True, kw_only=True)
class FrictionParameters(StrokeParameters):
    """Parameters of every friction law; a law reads the ones its docstring names.

    Raises
    ------
    ValueError
        A parameter is not finite or lies outside its bounds, the friction law is unknown,
        or a law with a state lacks the level it divides by.
    """

    friction: str = "none"

    load_level = 0.0
    """What a load adds to the level of a bristle now [N], see `load.py`; no parameter."""

    slip_knee = 0.0
    """Share of its limit over which an element of maxwell_slip begins to slip; no parameter."""

    coulomb_force: float = parameter(0.0, "N", "friction force at speed, f_c", at_least=0.0)
    static_force: float = parameter(
        UNSET, "N", "friction force at break-away, f_s >= f_c; not given: f_c", at_least=0.0
    )
    stribeck_velocity: float = parameter(1e-2, "m/s", "speed scale of the fall", above=0.0)
    stribeck_exponent: float = parameter(2.0, "-", "shape of the fall", above=0.0, at_most=10.0)
    transition_velocity: float = parameter(1e-4, "m/s", "width of the smoothed sign", above=0.0)

    bristle_stiffness: float = parameter(1e5, "N/m", "pre-sliding stiffness sigma0", above=0.0)
    bristle_damping: float = parameter(0.0, "N s/m", "pre-sliding damping sigma1", at_least=0.0)
    dahl_exponent: float = parameter(1.0, "-", "shape of the Dahl loop", at_least=0.0, at_most=10.0)

    bw_alpha: float = parameter(1.0, "-", "initial slope dz/dx", above=0.0)
    bw_beta: float = parameter(0.5, "m^-n", "loop width")
    bw_gamma: float = parameter(0.5, "m^-n", "loop shape")
    bw_exponent: float = parameter(1.0, "-", "sharpness n of the yield", at_least=1.0, at_most=20.0)
    bw_stiffness: float = parameter(0.0, "N/m", "stiffness k0", at_least=0.0)
    bw_ratio: float = parameter(0.0, "-", "share A of the elastic branch")

    slip_stiffness_1: float = parameter(0.0, "N/m", "stiffness of element 1", at_least=0.0)
    slip_force_1: float = parameter(0.0, "N", "force at which element 1 slips", at_least=0.0)
    slip_stiffness_2: float = parameter(0.0, "N/m", "stiffness of element 2", at_least=0.0)
    slip_force_2: float = parameter(0.0, "N", "force at which element 2 slips", at_least=0.0)
    slip_stiffness_3: float = parameter(0.0, "N/m", "stiffness of element 3", at_least=0.0)
    slip_force_3: float = parameter(0.0, "N", "force at which element 3 slips", at_least=0.0)
    slip_stiffness_4: float = parameter(0.0, "N/m", "stiffness of element 4", at_least=0.0)
    slip_force_4: float = parameter(0.0, "N", "force at which element 4 slips", at_least=0.0)
    slip_stiffness_5: float = parameter(0.0, "N/m", "stiffness of element 5", at_least=0.0)
    slip_force_5: float = parameter(0.0, "N", "force at which element 5 slips", at_least=0.0)
    slip_stiffness_6: float = parameter(0.0, "N/m", "stiffness of element 6", at_least=0.0)
    slip_force_6: float = parameter(0.0, "N", "force at which element 6 slips", at_least=0.0)
    slip_stiffness_7: float = parameter(0.0, "N/m", "stiffness of element 7", at_least=0.0)
    slip_force_7: float = parameter(0.0, "N", "force at which element 7 slips", at_least=0.0)
    slip_stiffness_8: float = parameter(0.0, "N/m", "stiffness of element 8", at_least=0.0)
    slip_force_8: float = parameter(0.0, "N", "force at which element 8 slips", at_least=0.0)

    rate_effect: float = parameter(0.02, "-", "rise of the level per ln(v), A", at_least=0.0)
    age_effect: float = parameter(0.03, "-", "rise of the level per ln(age), B", at_least=0.0)
    rate_velocity: float = parameter(1e-3, "m/s", "speed of the level f_c, v_0", above=0.0)
    age_distance: float = parameter(1e-5, "m", "way that renews the contacts, L", above=0.0)

    friction_backlash: float = parameter(
        0.0, "m", "half of the free play before a bristle", at_least=0.0
    )

    # at 1 the level of one direction would be zero
    friction_asymmetry: float = parameter(
        0.0, "-", "level: difference between the directions", at_least=-0.999, at_most=0.999
    )
    friction_gradient: float = parameter(0.0, "1/m", "level: slope along the stroke")
    friction_curvature: float = parameter(0.0, "1/m^2", "level: curvature along the stroke")

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        # the law's name first: every other message builds on it
        if self.friction not in FRICTION_LAWS:
            close = difflib.get_close_matches(str(self.friction), FRICTION_LAWS, n=1)
            hint = f"; did you mean '{close[0]}'?" if close else ""
            raise ValueError(
                f"friction: '{self.friction}' is not one of {', '.join(FRICTION_LAWS)}{hint}"
            )

        # bounds, as declared
        for declared in fields(self):
            if not declared.metadata:
                continue
            value = getattr(self, declared.name)
            unit = declared.metadata["unit"]
            if declared.default is UNSET and np.isnan(value):
                continue
            if not np.isfinite(value):
                raise ValueError(f"{declared.name}: {value} {unit} is not finite; give a number")
            at_least, above = declared.metadata["at_least"], declared.metadata["above"]
            if at_least is not None and value < at_least:
                raise ValueError(
                    f"{declared.name}: {value} {unit} is below {at_least}; give at least that"
                )
            if above is not None and value <= above:
                raise ValueError(
                    f"{declared.name}: {value} {unit} must be above {above}; give a larger value"
                )
            at_most = declared.metadata["at_most"]
            if at_most is not None and value > at_most:
                raise ValueError(
                    f"{declared.name}: {value} {unit} is above {at_most}; give at most that"
                )

        self._check_levels()
        self._check_lists()

    @property
    def breakaway_force(self) -> float:
        """f_s [N]: `static_force`, or `coulomb_force` where that is not given."""
        return self.coulomb_force if np.all(np.isnan(self.static_force)) else self.static_force

    @property
    def sign_width(self) -> float:
        """Width [m/s] of sign(v) = tanh(v / width) in a law without states."""
        if self.friction == "brown_mcphee":
            return self.stribeck_velocity / 4.0
        return self.transition_velocity

    def _check_levels(self) -> None:
        """A law slides at a level above zero, and breaks away at no less."""
        if self.breakaway_force < self.coulomb_force:
            raise ValueError(
                f"static_force: {self.static_force} N is below coulomb_force "
                f"{self.coulomb_force} N; give static_force >= coulomb_force"
            )
        if self.friction == "bouc_wen" and self.bw_stiffness == 0.0:
            raise ValueError(
                "bw_stiffness: 0 N/m leaves friction='bouc_wen' without a force; give "
                "bw_stiffness > 0, or friction='none'"
            )
        if self.friction == "maxwell_slip":
            self._check_elements()
            return
        # a law with a bristle divides by its friction level
        bristle = self.friction in ("dahl", "lugre")
        level = self.coulomb_force if bristle else self.breakaway_force
        open_clutch = getattr(self, "control", "force") in ("coulomb_force", "static_force")
        if self.friction not in ("none", "bouc_wen") and level == 0.0 and not open_clutch:
            raise ValueError(
                f"coulomb_force: {self.coulomb_force} N leaves friction='{self.friction}' without "
                "a level to slide at; give coulomb_force > 0, or friction='none'"
            )

    def _check_elements(self) -> None:
        """Maxwell-slip elements are whole and numbered without a gap."""
        last = True
        for i in range(1, 9):
            pair = [getattr(self, f"slip_{name}_{i}") for name in ("stiffness", "force")]
            there = pair[0] > 0.0
            if there != (pair[1] > 0.0):
                raise ValueError(
                    f"slip_stiffness_{i}: {pair[0]} N/m with slip_force_{i} {pair[1]} N is half an "
                    "element; give both above 0, or neither"
                )
            if there and not last:
                raise ValueError(
                    f"slip_stiffness_{i}: {pair[0]} N/m comes after element {i - 1}, which is not "
                    "there; give it too: elements are numbered from 1 without a gap"
                )
            last = there
        if self.slip_stiffness_1 == 0.0:
            raise ValueError(
                "slip_stiffness_1: 0 N/m leaves friction='maxwell_slip' without an element; give "
                "slip_stiffness_1 and slip_force_1 above 0, or friction='none'"
            )
