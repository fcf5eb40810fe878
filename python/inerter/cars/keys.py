"""Keys of a car file: which units their names may end in, and what is plausible.

A key is a name and a unit, `tyre_stiffness_kN_per_m`. What lies outside the plausible range is
asked about: most often the unit is another one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

UNITS: Mapping[str, Mapping[str, float]] = {
    "mass": {"kg": 1.0, "t": 1e3},
    "inertia": {"kg_m2": 1.0},
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3},
    "stiffness": {"N_per_m": 1.0, "kN_per_m": 1e3, "N_per_mm": 1e3},
    "damping": {"N_s_per_m": 1.0, "kN_s_per_m": 1e3},
    "table": {"m_per_s_N": 1.0, "mm_per_s_N": 1e-3},
    "number": {"": 1.0},
}
"""Factor to SI of each unit of a quantity."""


@dataclass(frozen=True)
class Key:
    """`quantity` in `UNITS`, plausible `low` to `high` (SI), where it `belongs`, `meaning`.

    `needed`: a file without it is refused. 0 is always plausible where it is not needed.
    """

    quantity: str
    low: float
    high: float
    meaning: str
    needed: bool = False

    def spellings(self, name: str) -> list[str]:
        """The key with each of its units."""
        return [f"{name}_{unit}" if unit else name for unit in UNITS[self.quantity]]


CAR_KEYS: Mapping[str, Key] = {
    "body_mass": Key("mass", 20.0, 40e3, "sprung mass", needed=True),
    "pitch_inertia": Key("inertia", 5.0, 400e3, "about the lateral axis"),
    "roll_inertia": Key("inertia", 5.0, 100e3, "about the long axis"),
    "track": Key("length", 0.5, 3.0, "between left and right wheel"),
    "correlation": Key("number", 0.0, 1.0, "of the left and the right road"),
}
"""Of the table [car]."""

AXLE_KEYS: Mapping[str, Key] = {
    "distance": Key("length", 0.2, 10.0, "from the centre of mass to the axle"),
    "wheel_mass": Key("mass", 2.0, 1000.0, "unsprung mass of one wheel", needed=True),
    "tyre_stiffness": Key("stiffness", 30e3, 2e6, "of one tyre", needed=True),
    "tyre_damping": Key("damping", 5.0, 5e3, "of one tyre"),
    "anti_roll_stiffness": Key("stiffness", 500.0, 500e3, "at each wheel in roll"),
}
"""Of the tables [front] and [rear]."""

STRUT_KEYS: Mapping[str, Key] = {
    "stiffness": Key("stiffness", 2e3, 1e6, "static stiffness of the strut", needed=True),
    "damping": Key("damping", 50.0, 100e3, "of the damper"),
    "inertance": Key("mass", 0.1, 5e3, "of the inerter"),
    "relaxation_stiffness": Key("stiffness", 1e3, 1e9, "k_b"),
    "damper_stiffness": Key("stiffness", 10.0, 1e7, "k_1 beside the damper"),
    "inerter_stiffness": Key("stiffness", 10.0, 1e7, "k_2 beside the inerter"),
    "motion_ratio": Key("number", 0.2, 2.0, "travel of the strut per travel of the wheel"),
    "bump_stop_gap": Key("length", 0.0, 0.5, "until the bump stop"),
    "bump_stop_stiffness": Key("stiffness", 1e3, 1e8, "of the bump stop"),
    "rebound_stop_gap": Key("length", 0.0, 0.5, "until the rebound stop"),
    "rebound_stop_stiffness": Key("stiffness", 1e3, 1e8, "of the rebound stop"),
    "damper_bump": Key("table", 0.0, 1e5, "pairs [speed, force] while the strut shortens"),
    "damper_rebound": Key("table", 0.0, 1e5, "pairs [speed, force] while the strut lengthens"),
}
"""Of the tables [front.strut] and [rear.strut]."""
