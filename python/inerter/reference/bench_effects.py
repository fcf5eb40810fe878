"""The effects that a test record can hide, and which of them go together."""

from __future__ import annotations

from collections.abc import Sequence

EFFECTS = (
    "viscous_friction",
    "coulomb_friction",
    "stribeck_friction",
    "hysteretic_friction",
    "asymmetric_friction",
    "position_dependent_friction",
    "load_dependent_friction",
    "parallel_stiffness",
    "force_offset",
    "sensor_delay",
    "quadratic_damping",
    "inertance_error",
    "friction_drift",
    "backlash",
    "series_elasticity",
    "hardening_stiffness",
    "gas_spring",
    "end_stop",
    "variable_inertance",
    "force_drift",
    "sensor_saturation",
    "periodic_disturbance",
    "sensor_filter",
    "asymmetric_damping",
    "digressive_damping",
    "viscous_drift",
    "viscoelasticity",
    "rate_state_friction",
    "position_force",
    "leak",
    "clutch_slip",
)
"""Every effect that a bench record can hide."""

HYSTERETIC_LAWS = ("dahl", "lugre", "bouc_wen")

# a device has one friction law; these say what it is
FRICTION_LAWS = (
    "coulomb_friction",
    "stribeck_friction",
    "hysteretic_friction",
    "rate_state_friction",
)

# these change a law's level, and bring a Coulomb level along where there is no law
LEVEL_CHANGES = ("asymmetric_friction", "position_dependent_friction", "friction_drift")

# of them, what Bouc-Wen's loop has no level for
NEEDS_LEVEL = LEVEL_CHANGES[:2]

# these are all of one viscous damping
DAMPERS = ("viscous_friction", "asymmetric_damping", "digressive_damping", "viscous_drift")

# an inertance has one series element; a gap and a clutch come with their own
_SERIES = ("backlash", "clutch_slip", "leak", "series_elasticity")


def compatible(effects: Sequence[str]) -> bool:
    """Whether one device can have all of these effects, each of them nameable.

    Raises
    ------
    ValueError
        A name is not one of `EFFECTS` or "none".
    """
    return clash(effects) is None


def clash(effects: Sequence[str]) -> str | None:
    """Why effects do not go together, in words; None where they do."""
    for name in effects:
        check_effect(name)
    if len(set(effects)) < len(effects):
        return "an effect is given twice"
    if "none" in effects and len(effects) > 1:
        return "'none' stands alone"
    laws = [name for name in effects if name in FRICTION_LAWS]
    if len(laws) > 1:
        return f"{' and '.join(laws)} are two friction laws; a device has one"
    levels = [name for name in effects if name in LEVEL_CHANGES]
    if levels and "coulomb_friction" in laws:
        return f"{levels[0]} brings its own Coulomb friction; leave coulomb_friction out"
    dampers = [name for name in effects if name in DAMPERS]
    if len(dampers) > 1:
        return f"{' and '.join(dampers)} are of the same damping; leave one of them out"
    series = [name for name in _SERIES if name in effects]
    if len(series) > 1:
        return f"{series[0]} has its own series element; leave {series[1]} out"
    return None


def check_effect(name: str) -> None:
    """Raise ValueError for a name that is no effect."""
    if name != "none" and name not in EFFECTS:
        known = ", ".join(("none", *EFFECTS))
        raise ValueError(f"effect: '{name}' is not one of {known}")
