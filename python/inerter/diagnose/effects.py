"""The effects that a diagnosis can name: what each adds, what causes it, what it is taken for."""

from __future__ import annotations

from dataclasses import dataclass

# laws whose levels can differ with direction and position
LEVEL_LAWS = ("coulomb", "stribeck", "dahl", "lugre", "brown_mcphee")

# what a user may state of a friction law and no fit changes
LAW_CONSTANTS = ("stribeck_exponent", "bw_alpha", "friction_backlash")
# coordinates that belong to a friction law and leave with it
LAW_COORDINATES = (
    "coulomb_force",
    "static_excess",
    "stribeck_velocity",
    "presliding",
    "bristle_damping",
    "bw_level",
    "bw_shape",
    "bw_stiffness",
    "bw_beta",
    "bw_gamma",
    "bw_exponent",
    "bw_ratio",
    *LAW_CONSTANTS,
)
# of a level that differs with direction and position; a drift is the record's, and every law's
LEVEL_COORDINATES = ("friction_asymmetry", "friction_gradient", "friction_curvature")


@dataclass(frozen=True)
class Effect:
    """An effect by its contract name.

    Attributes
    ----------
    coordinates : tuple of str
        Coordinates that come and go with it (for hysteretic and Stribeck friction: see `law`).
    parameters : tuple of str
        Device parameters that a finding reports.
    plain : str
        The effect in running text.
    meaning, cause : str
        What it adds to F = b a, and what makes it in a real device.
    taken_for, experiment : str
        What it is easily taken for, and the experiment that tells them apart.
    rivals : tuple of str
        Effects among those that it is taken for.
    """

    name: str
    coordinates: tuple[str, ...]
    parameters: tuple[str, ...]
    plain: str
    meaning: str
    cause: str
    taken_for: str
    experiment: str
    rivals: tuple[str, ...] = ()


EFFECTS = {
    effect.name: effect
    for effect in (
        Effect(
            "inertance_error",
            ("inertance",),
            ("inertance",),
            "an inertance other than stated",
            "b differs from what is stated",
            "flywheel inertia, lead or gear ratio other than in the data sheet",
            "a wrong force or displacement calibration",
            "check both against a known mass",
        ),
        Effect(
            "viscous_friction",
            ("viscous",),
            ("viscous",),
            "viscous friction",
            "c v",
            "lubricant shear in bearings, screw and seals",
            "sensor delay",
            "repeat the stroke at twice the frequency, c v doubles and a delay's "
            "force grows eightfold",
            ("sensor_delay",),
        ),
        Effect(
            "coulomb_friction",
            ("coulomb_force",),
            ("coulomb_force",),
            "Coulomb friction",
            "f_c sign(v)",
            "dry sliding in seals, guides and preloaded screws",
            "hysteretic friction",
            "dwell at mid-stroke and watch whether the force stays",
            ("hysteretic_friction",),
        ),
        Effect(
            "stribeck_friction",
            ("coulomb_force", "static_excess", "stribeck_velocity"),
            ("coulomb_force", "static_force", "stribeck_velocity"),
            "Stribeck friction",
            "[f_c + (f_s - f_c) exp(-(v/v_s)^2)] sign(v)",
            "lubricated contacts that lift off their asperities as the speed grows",
            "Coulomb with viscous friction",
            "run slow strokes below the Stribeck velocity",
            ("coulomb_friction", "viscous_friction"),
        ),
        Effect(
            "hysteretic_friction",
            LAW_COORDINATES,
            (
                "coulomb_force",
                "static_force",
                "stribeck_velocity",
                "bristle_stiffness",
                "bristle_damping",
                "bw_stiffness",
                "bw_beta",
                "bw_gamma",
                "bw_exponent",
                "bw_ratio",
            ),
            "friction with memory",
            "friction with memory: it builds up over a pre-sliding distance and stays at rest",
            "elastic asperities, seals and preloaded balls that bend before they slide",
            "parallel stiffness or backlash",
            "repeat with strokes shorter than the pre-sliding distance",
            ("parallel_stiffness", "backlash"),
        ),
        Effect(
            "asymmetric_friction",
            ("friction_asymmetry",),
            ("coulomb_force", "friction_asymmetry"),
            "friction that differs between the two directions",
            "friction level differs between the two directions",
            "one-sided preload, a lip seal, a helical gear's thrust",
            "a constant force",
            "repeat with the device turned round",
            ("force_offset",),
        ),
        Effect(
            "position_dependent_friction",
            ("friction_gradient", "friction_curvature"),
            ("coulomb_force", "friction_gradient", "friction_curvature"),
            "friction that changes along the stroke",
            "friction level changes along the stroke",
            "a bent screw, tight guides, wear at mid-stroke",
            "parallel stiffness",
            "look at slow strokes both ways, a spring's force does not change "
            "sign with the direction",
            ("parallel_stiffness",),
        ),
        Effect(
            "load_dependent_friction",
            ("load_friction",),
            ("load_friction",),
            "friction that grows with the transmitted force",
            "mu |b a| sign(v)",
            "the flywheel's force pressed through screw threads or gear teeth",
            "Coulomb friction",
            "repeat with another flywheel",
            ("coulomb_friction",),
        ),
        Effect(
            "parallel_stiffness",
            ("stiffness",),
            ("stiffness",),
            "a parallel stiffness",
            "k x",
            "a centring spring, a rubber mount, trapped air",
            "a wrong inertance at one frequency",
            "use at least two frequencies",
            ("inertance_error",),
        ),
        Effect(
            "force_offset",
            ("force_offset",),
            ("force_offset",),
            "a constant force",
            "a constant force",
            "weight of the flywheel, preload, a load cell that was not zeroed",
            "asymmetric friction",
            "a dwell shows the constant force alone",
            ("asymmetric_friction",),
        ),
        Effect(
            "sensor_delay",
            ("delay",),
            ("delay",),
            "a delay between the force and the displacement channel",
            "the force channel is late by a constant time",
            "filters or clocks that differ between the channels",
            "series elasticity and viscous friction",
            "they change with amplitude or with frequency, a delay does not",
            ("series_elasticity", "viscous_friction"),
        ),
        Effect(
            "variable_inertance",
            ("inertance_gradient", "inertance_curvature", "inertance_speed_gradient"),
            (
                "inertance",
                "inertance_gradient",
                "inertance_curvature",
                "inertance_speed_gradient",
            ),
            "an inertance that is not constant",
            "b depends on displacement, b(x) a + b'(x) v^2 / 2, or on speed",
            "a ratio that varies along the stroke: rack and pinion, eccentric gear, moving fluid",
            "parallel stiffness",
            "repeat at twice the frequency, the inertance force grows fourfold",
            ("parallel_stiffness",),
        ),
        Effect(
            "quadratic_damping",
            ("quadratic_damping",),
            ("quadratic_damping",),
            "quadratic damping",
            "c2 v |v|",
            "turbulent flow, windage of the flywheel",
            "viscous friction",
            "repeat at twice the amplitude",
            ("viscous_friction",),
        ),
        Effect(
            "friction_drift",
            ("friction_drift",),
            ("coulomb_force", "friction_drift"),
            "a friction level that changes with time",
            "friction level times 1 + friction_drift t",
            "lubricant that warms up, seals that run in, wear",
            "load-dependent friction, where the motion grows in time",
            "repeat the first run last",
            ("load_dependent_friction",),
        ),
        Effect(
            "backlash",
            ("backlash", "series_frequency", "series_loss"),
            ("backlash", "series_stiffness", "series_damping"),
            "free play before the inertance is engaged",
            "free play of half-width eps in series with the inertance",
            "worn screw or gear flanks, loose pins",
            "hysteretic friction",
            "repeat with strokes within the suspected play",
            ("hysteretic_friction",),
        ),
        Effect(
            "series_elasticity",
            ("series_frequency", "series_loss"),
            ("series_stiffness", "series_damping"),
            "elasticity in series with the inertance",
            "spring k_s and damper c_s between the terminal and the inertance",
            "shaft twist, bearing and mount flexibility, fluid compressibility",
            "inertance or delay",
            "repeat at higher frequency, where the inertance resonates on it",
            ("inertance_error", "sensor_delay"),
        ),
        Effect(
            "hardening_stiffness",
            ("stiffness_cubic",),
            ("stiffness_cubic",),
            "a stiffness that grows with the stroke",
            "k3 x^3",
            "rubber, guides that bind, a spring that stacks",
            "an end stop",
            "repeat with half the stroke, k3 x^3 falls to an eighth",
            ("end_stop",),
        ),
        Effect(
            "gas_spring",
            ("gas_push", "gas_reach", "gas_exponent"),
            ("gas_pressure", "gas_area", "gas_volume", "gas_exponent"),
            "a gas spring",
            "p0 A (1 - (1 + A x / V0)^-gamma)",
            "trapped air, an accumulator",
            "a parallel stiffness",
            "repeat with more compression, a gas stiffens on one side only",
            ("parallel_stiffness",),
        ),
        Effect(
            "end_stop",
            ("stop_upper", "stop_lower", "stop_stiffness", "stop_damping"),
            ("stop_upper", "stop_lower", "stop_stiffness", "stop_damping"),
            "an end stop",
            "k_e (x - x_stop) beyond the stop",
            "a bump stop, a nut that reaches its end",
            "hardening stiffness",
            "repeat with strokes that end just before the stop",
            ("hardening_stiffness",),
        ),
        Effect(
            "force_drift",
            ("force_drift",),
            ("force_drift",),
            "a force offset that grows in time",
            "an offset that grows steadily",
            "a load cell that warms up, a charge amplifier that leaks",
            "friction drift",
            "that one changes sign with the velocity",
            ("friction_drift",),
        ),
        Effect(
            "sensor_saturation",
            ("force_maximum", "force_minimum"),
            ("force_maximum", "force_minimum"),
            "a force channel that clips",
            "force beyond a limit is cut off",
            "an amplifier or converter at the end of its range",
            "less inertance in large motion",
            "repeat with half the amplitude",
        ),
        Effect(
            "periodic_disturbance",
            ("disturbance_amplitude", "disturbance_frequency"),
            ("disturbance_amplitude", "disturbance_frequency"),
            "a tone that the motion does not contain",
            "a sine of constant frequency",
            "mains hum, a pump, a machine next door",
            "a resonance of the rig",
            "record with the device at rest",
        ),
    )
}
