"""The effects that a diagnosis can name on a bench: what each adds, its words, its traits.

In the order in which they are read off a model, so that a name does not depend on the way that a
search took.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from inerter.catalogue.along_stroke import QUANTITIES
from inerter.catalogue.effect import Effect
from inerter.catalogue.friction import LAW_COORDINATES, PLAY_COORDINATES

_ALONG = {quantity.effect: quantity for quantity in QUANTITIES}
_FORCE = _ALONG["position_force"]
_RATIO = _ALONG["variable_inertance"]
_LEVEL = _ALONG["position_dependent_friction"]


_ALL = (
    Effect(
        name="coulomb_friction", rank=2, kind="law", coordinates=("coulomb_force",), on_table=True,
        plain="Coulomb friction", meaning="f_c sign(v)",
        cause="dry sliding in seals, guides and preloaded screws", taken_for="hysteretic friction",
        experiment="dwell at mid-stroke and watch whether the force stays",
        rivals=("hysteretic_friction",),
    ),
    Effect(
        name="stribeck_friction", rank=11, kind="law",
        coordinates=("coulomb_force", "static_excess", "stribeck_velocity"),
        telling=("static_excess",), far=True, plain="Stribeck friction",
        meaning="[f_c + (f_s - f_c) exp(-(v/v_s)^2)] sign(v)",
        cause="lubricated contacts that lift off their asperities as the speed grows",
        taken_for="Coulomb with viscous friction",
        experiment="run slow strokes below the Stribeck velocity",
        rivals=("coulomb_friction", "viscous_friction"),
    ),
    Effect(
        name="hysteretic_friction", rank=8, kind="law", coordinates=LAW_COORDINATES,
        telling=("coulomb_force", "bw_level", "bw_stiffness"), far=True, tells_law=True,
        plain="friction with memory",
        meaning="friction with memory: it builds up over a pre-sliding distance and stays at rest",
        cause="elastic asperities, seals and preloaded balls that bend before they slide",
        taken_for="parallel stiffness or backlash",
        experiment="repeat with strokes shorter than the pre-sliding distance",
        rivals=("parallel_stiffness", "backlash"),
    ),
    Effect(
        name="rate_state_friction", rank=15, kind="law",
        coordinates=("coulomb_force", "rate_effect", "age_effect", "age_distance"),
        telling=("rate_effect", "age_effect"), far=True,
        plain="friction that goes with the logarithm of speed and ages at rest",
        meaning="f_c (1 + A ln(v / v_0) + B ln(v_0 theta / L)) sign(v), theta' = 1 - v theta / L",
        cause="contacts that creep together while they touch: dry metal, plastic and rubber slides",
        taken_for="Coulomb with viscous friction",
        experiment="hold still for 1, 10 and 100 s, the peak of the next start grows with each",
        rivals=("coulomb_friction", "viscous_friction", "stribeck_friction"),
    ),
    Effect(
        name="friction_play", rank=18, coordinates=PLAY_COORDINATES,
        reported=("friction_backlash",), telling=("friction_backlash",), far=True,
        plain="free play before the friction",
        meaning="after each reversal the friction sets in only when 2 eps are used up",
        cause="a friction ring or seal with room in its groove",
        taken_for="a softer bristle or backlash of the drive",
        experiment="repeat with strokes within the suspected play, there is no friction",
        rivals=("hysteretic_friction", "backlash"),
    ),
    Effect(
        name="asymmetric_friction", rank=10, kind="level", coordinates=("friction_asymmetry",),
        reported=("coulomb_force", "friction_asymmetry"),
        plain="friction that differs between the two directions",
        meaning="friction level differs between the two directions",
        cause="one-sided preload, a lip seal, a helical gear's thrust",
        taken_for="a constant force", experiment="repeat with the device turned round",
        rivals=("force_offset",),
    ),
    Effect(
        name="position_dependent_friction", rank=12, kind="level",
        coordinates=("friction_gradient", "friction_curvature", *_LEVEL.coordinates),
        telling=("friction_gradient", "friction_curvature", *_LEVEL.amplitudes), tells_law=True,
        reported=("coulomb_force", "friction_gradient", "friction_curvature", *_LEVEL.reported),
        plain="friction that changes along the stroke",
        meaning="friction level changes along the stroke",
        cause="a bent screw, tight guides, wear at mid-stroke", taken_for="parallel stiffness",
        experiment=(
            "look at slow strokes both ways, a spring's force does not change sign with "
            "the direction"
        ),
        rivals=("parallel_stiffness",),
    ),
    Effect(
        name="friction_drift", rank=16, kind="level", coordinates=("friction_drift",),
        reported=("coulomb_force", "friction_drift"),
        plain="a friction level that changes with time",
        meaning="friction level times 1 + friction_drift t",
        cause="lubricant that warms up, seals that run in, wear",
        taken_for="load-dependent friction, where the motion grows in time",
        experiment="repeat the first run last", rivals=("load_dependent_friction",),
    ),
    Effect(
        name="hardening_stiffness", rank=14,
        coordinates=("stiffness_cubic", "rest_length"), telling=("stiffness_cubic",), local=True,
        unlike_friction=True, plain="a stiffness that grows with the stroke",
        meaning="k3 x^3, or k3 (x - l0)^3 about a place l0",
        cause="rubber, guides that bind, a spring that stacks", taken_for="an end stop",
        experiment="repeat with half the stroke, k3 x^3 falls to an eighth", rivals=("end_stop",),
    ),
    Effect(
        name="gas_spring", rank=20,
        coordinates=("gas_push", "gas_reach", "gas_reach_above", "gas_exponent"),
        telling=("gas_push",), stated_as=("gas_pressure", "gas_volume"),
        local=True, unlike_friction=True, plain="a gas spring",
        meaning="p0 A (1 - (1 + A x / V0)^-gamma)",
        cause="trapped air, an accumulator", taken_for="a parallel stiffness",
        experiment="repeat with more compression, a gas stiffens on one side only",
        rivals=("parallel_stiffness",),
    ),
    Effect(
        name="end_stop", rank=19,
        coordinates=(
            "stop_upper", "stop_lower", "stop_stiffness", "stop_stiffness_cubic", "stop_damping"
        ),
        telling=(), local=True, unlike_friction=True, plain="an end stop",
        meaning="k_e d + k_e3 d^3 at a depth d beyond the stop",
        cause="a bump stop, rubber that stiffens, a nut that reaches its end",
        taken_for="hardening stiffness",
        experiment="repeat with strokes that end just before the stop",
        rivals=("hardening_stiffness",),
    ),
    Effect(
        name="position_force", rank=15, coordinates=_FORCE.coordinates,
        telling=_FORCE.amplitudes, reported=_FORCE.reported, tells_law=True, unlike_friction=True,
        plain="a force of the place along the stroke",
        meaning="a curve F(x), or a sum of sines of x",
        cause="magnets and teeth that lock at places, detents, cams, a misaligned guide; about an "
        "axis a weight out of balance",
        taken_for="a spring that is not straight, or friction that changes along the stroke",
        experiment="move slowly both ways, this force does not change sign with the direction",
        rivals=("hardening_stiffness", "position_dependent_friction"),
    ),
    Effect(
        name="force_drift", rank=15,
        smooth=True, coordinates=("force_drift",), unlike_friction=True,
        plain="a force offset that grows in time",
        meaning="an offset that grows steadily",
        cause="a load cell that warms up, a charge amplifier that leaks",
        taken_for="friction drift", experiment="that one changes sign with the velocity",
        rivals=("friction_drift",),
    ),
    Effect(
        name="zero_settling", rank=15, telling=(), coordinates=("settling_time",),
        unlike_friction=True, plain="a zero of the force that settles",
        meaning="an offset that dies away as exp(-t / tau), of a size of its own in each run",
        cause="a load cell or an amplifier that warms up, a charge amplifier after its reset",
        taken_for="a constant force, a drift, a spring that relaxes",
        experiment="hold the device still and wait, the force settles while nothing moves",
        rivals=("force_drift", "viscoelasticity"),
    ),
    Effect(
        name="sensor_coupling", rank=12, telling=(), coordinates=("force_coupling",),
        unlike_friction=True, plain="a force channel that does not hold a constant force",
        meaning="what is slow in the force dies away, a high-pass of the first order",
        cause="a piezoelectric cell with a charge amplifier or IEPE, an input coupled to AC",
        taken_for="damping and stiffness below 0",
        experiment="hang a weight on the cell, the force that is shown dies away",
        rivals=("parallel_stiffness", "viscous_friction"),
    ),
    Effect(
        name="sensor_saturation", rank=17, coordinates=("force_maximum", "force_minimum"),
        telling=(), local=True, unlike_friction=True, far=True,
        plain="a force channel that clips", meaning="force beyond a limit is cut off",
        cause="an amplifier or converter at the end of its range",
        taken_for="less inertance in large motion", experiment="repeat with half the amplitude",
    ),
    Effect(
        name="periodic_disturbance", rank=18,
        coordinates=("disturbance_amplitude", "disturbance_frequency"),
        telling=("disturbance_amplitude",), unlike_friction=True,
        plain="a tone that the motion does not contain", meaning="a sine of constant frequency",
        cause="mains hum, a pump, a machine next door", taken_for="a resonance of the rig",
        experiment="record with the device at rest",
    ),
    Effect(
        name="viscous_friction", rank=3, smooth=True,
        coordinates=("viscous", "flywheel_viscous"), on_table=True,
        plain="viscous friction", meaning="c v",
        cause="lubricant shear in bearings, screw and seals", taken_for="sensor delay",
        experiment=(
            "repeat the stroke at twice the frequency, c v doubles and a delay's force "
            "grows eightfold"
        ),
        rivals=("sensor_delay",),
    ),
    Effect(
        name="viscous_drift", rank=16, smooth=True, kind="damper", coordinates=("viscous_drift",),
        reported=("viscous", "viscous_drift"), plain="viscous damping that changes with time",
        meaning="c (1 + d t) v", cause="oil and grease that warm up and thin",
        taken_for="a friction level that changes with time",
        experiment="repeat the first run last", rivals=("friction_drift", "viscous_friction"),
    ),
    Effect(
        name="viscoelasticity", rank=17, smooth=True,
        coordinates=(
            "branch_stiffness_1", "branch_time_1", "branch_stiffness_2", "branch_time_2",
            "branch_stiffness_3", "branch_time_3",
        ),
        telling=("branch_stiffness_1", "branch_stiffness_2", "branch_stiffness_3"),
        plain="a spring that relaxes", meaning="springs K, each with a dashpot C in series with it",
        cause="rubber mounts, seals, plastic bushes, a gas that gives its heat away",
        taken_for="a spring with viscous friction, or friction with memory",
        experiment="hold at an end of the stroke, the force fades while nothing moves",
        rivals=("parallel_stiffness", "hysteretic_friction", "viscous_friction"),
    ),
    Effect(
        name="load_dependent_friction", rank=9, coordinates=("load_friction",), on_table=True,
        plain="friction that grows with the transmitted force", meaning="mu |b a| sign(v)",
        cause="the flywheel's force pressed through screw threads or gear teeth",
        taken_for="Coulomb friction", experiment="repeat with another flywheel",
        rivals=("coulomb_friction",),
    ),
    Effect(
        name="parallel_stiffness", rank=5,
        smooth=True, coordinates=("stiffness",), unlike_friction=True,
        on_table=True, plain="a parallel stiffness", meaning="k x",
        cause="a centring spring, a rubber mount, trapped air",
        taken_for="a wrong inertance at one frequency", experiment="use at least two frequencies",
        rivals=("inertance_error",),
    ),
    Effect(
        name="force_offset", rank=4,
        smooth=True, coordinates=("force_offset",), plain="a constant force",
        meaning="a constant force",
        cause="weight of the flywheel, preload, a load cell that was not zeroed",
        taken_for="asymmetric friction", experiment="a dwell shows the constant force alone",
        rivals=("asymmetric_friction",),
    ),
    Effect(
        name="sensor_delay", rank=6, coordinates=("delay",),
        plain="a delay between the force and the displacement channel",
        meaning="the force channel is late by a constant time",
        cause="filters or clocks that differ between the channels; of a fluid inerter a leak past "
        "the piston, whose force is late by the inertance over the leak's damping",
        taken_for="series elasticity and viscous friction",
        experiment="what a shaft or a damper does changes with amplitude or frequency, a delay not",
        rivals=("series_elasticity", "viscous_friction"),
    ),
    Effect(
        name="sensor_filter", rank=8, telling=(), far=True, unlike_friction=True,
        coordinates=(
            "force_filter", "force_filter_order", "force_filter_bessel",
            "displacement_filter", "displacement_filter_order", "displacement_filter_bessel",
        ),
        plain="a low-pass filter of one channel that the other has not",
        meaning="one channel is late, and what is fast in it is smaller",
        cause="a filter of the amplifier or the card in one of the channels",
        taken_for="a delay, series elasticity and viscous friction",
        experiment="state the filter (--filter), or record once without it",
        rivals=("sensor_delay", "series_elasticity"),
    ),
    Effect(
        name="quadratic_damping", rank=7,
        coordinates=("quadratic_damping",), on_table=True,
        plain="quadratic damping", meaning="c2 v |v|",
        cause="turbulent flow, windage of the flywheel", taken_for="viscous friction",
        experiment="repeat at twice the amplitude", rivals=("viscous_friction",),
    ),
    Effect(
        name="asymmetric_damping", rank=10,
        kind="damper", coordinates=("damping_asymmetry",),
        reported=("viscous", "damping_asymmetry"),
        plain="damping that differs between the two directions",
        meaning="c v (1 + kappa sgn(v))",
        cause="bump and rebound valves of their own, a check valve",
        taken_for="asymmetric friction or a constant force",
        experiment="repeat at half the speed, damping halves and friction stays",
        rivals=("asymmetric_friction", "force_offset"),
    ),
    Effect(
        name="digressive_damping", rank=12, kind="damper",
        coordinates=(
            "damping_knee", "damping_beyond", "damping_knee_back", "damping_beyond_back",
            "damping_sharpness", "damping_power_knee", "damping_exponent",
        ),
        telling=(),
        reported=(
            "viscous", "damping_knee", "damping_beyond", "damping_knee_back",
            "damping_beyond_back", "damping_sharpness", "damping_exponent",
        ),
        far=True,
        plain="damping that bends with the speed",
        meaning="c v up to a speed v_k, beyond it less for every further m/s, or more; or a power "
        "of the speed",
        cause="a valve that opens, one for each direction, shear thinning of the oil, an "
        "eddy-current brake",
        taken_for="Coulomb with viscous friction",
        experiment="run slow strokes, there the force goes with the speed and friction does not",
        rivals=("coulomb_friction", "stribeck_friction", "quadratic_damping"),
    ),
    Effect(
        name="damper_elasticity", rank=18, kind="damper", coordinates=("damper_stiffness",),
        telling=(), reported=("viscous", "damper_stiffness"), plain="dampers behind a spring",
        meaning="the dampers' force D(w), w less than v by the rate at which k_d is bent",
        cause="oil or gas in it that is compressed, hoses, rubber mounts at the ends of a damper",
        taken_for="a delay, or friction with memory",
        experiment="repeat at twice the frequency and half the stroke, the loop of the force over "
        "the velocity opens twice as wide, and one of friction does not",
        rivals=("sensor_delay", "viscoelasticity", "hysteretic_friction"),
    ),
    Effect(
        name="variable_inertance", rank=13,
        coordinates=(
            "inertance_gradient", "inertance_curvature", "inertance_speed_gradient",
            *_RATIO.coordinates,
        ),
        telling=(
            "inertance_gradient", "inertance_curvature", "inertance_speed_gradient",
            *_RATIO.amplitudes,
        ),
        reported=(
            "inertance", "inertance_gradient", "inertance_curvature",
            "inertance_speed_gradient", *_RATIO.reported,
        ),
        tells_law=True,
        unlike_friction=True, plain="an inertance that is not constant",
        meaning="b depends on displacement, b(x) a + b'(x) v^2 / 2, or on speed",
        cause="a ratio that varies along the stroke: rack and pinion, eccentric gear, moving fluid",
        taken_for="parallel stiffness",
        experiment="repeat at twice the frequency, the inertance force grows fourfold",
        rivals=("parallel_stiffness",),
    ),
    Effect(
        name="backlash", rank=22, kind="play",
        coordinates=("backlash", "series_frequency", "series_loss"), telling=(),
        unlike_friction=True, far=True, plain="free play before the inertance is engaged",
        meaning="free play of half-width eps in series with the inertance",
        cause="worn screw or gear flanks, loose pins", taken_for="hysteretic friction",
        experiment="repeat with strokes within the suspected play",
        rivals=("hysteretic_friction",),
    ),
    Effect(
        name="clutch_slip", rank=24, kind="play",
        coordinates=("clutch_force", "series_frequency", "series_loss"), telling=(),
        unlike_friction=True, far=True, plain="a clutch that slips before the inertance",
        meaning="what comes through to the inertance is F_c at most",
        cause="a torque limiter, a belt or a press fit that slips",
        taken_for="a force channel that clips, or Coulomb friction",
        experiment="repeat with half the stroke, below its force a clutch does not slip",
        rivals=("sensor_saturation", "coulomb_friction"),
    ),
    Effect(
        name="leak", rank=23, coordinates=("leak_corner", "leak_quadratic_damping"), telling=(),
        stated_as=("leak_damping", "leak_quadratic_damping"),
        unlike_friction=True, plain="a leak past the inertance",
        meaning="a damper c_l u + q_l u |u| in series with the inertance, u = v - w",
        cause="fluid that passes its piston or its gear beside the channel, a coupling that slips",
        taken_for="a low-pass of the force, or viscous friction and less inertance",
        experiment="repeat at a tenth of the frequency, slow motion passes a leak, and hardly "
        "drives the inertance",
        rivals=("sensor_filter", "viscous_friction", "sensor_delay"),
    ),
    Effect(
        name="series_elasticity", rank=21, smooth=True, kind="shaft",
        coordinates=("series_frequency", "series_loss"), telling=(),
        stated_as=("series_stiffness", "series_damping"), unlike_friction=True,
        plain="elasticity in series with the inertance",
        meaning="spring k_s and damper c_s between the terminal and the inertance",
        cause="shaft twist, bearing and mount flexibility, fluid compressibility, "
        "a base that gives",
        taken_for="inertance or delay",
        experiment="repeat at higher frequency, where the inertance resonates on it",
        rivals=("inertance_error", "sensor_delay"),
    ),
    Effect(
        name="grip_mass", rank=20, smooth=True, coordinates=("grip_mass",), unlike_friction=True,
        plain="a mass before the shaft", meaning="m a at the terminal, before a shaft or a play",
        cause="a grip or an adapter between load cell and device; a nut, a coupling, a rotor "
        "before the shaft",
        taken_for="a stiffer shaft, or inertance",
        experiment="weigh what moves with the terminal, or repeat above the shaft's resonance, "
        "where this mass alone is felt",
        rivals=("series_elasticity",),
    ),
    Effect(
        name="inertance_error", rank=1,
        smooth=True, coordinates=("inertance",), telling=(), on_table=True,
        plain="an inertance other than stated", meaning="b differs from what is stated",
        cause="flywheel inertia, lead or gear ratio other than in the data sheet, or the mass of a "
        "grip behind the load cell",
        taken_for="a wrong force or displacement calibration",
        experiment="weigh the grip and check both channels against a known mass",
    ),
)  # fmt: skip

EFFECTS: Mapping[str, Effect] = MappingProxyType({effect.name: effect for effect in _ALL})
"""Every effect of a bench record by its name."""
