"""Published parameter sets of the models, each number once; SI units.

Plain data, and nothing else: the reference models take it as defaults, the Exudyn models are built
from it, and tests hold the MJCF files to it. What is not published but chosen here stands in a
field's own sentence.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, kw_only=True)
class StrutParameters:
    """Damper and inerter of a strut: `damping` [N s/m], `inertance` [kg], 0 without inerter."""

    damping: float
    inertance: float


@dataclass(frozen=True, kw_only=True)
class QuarterCarParameters:
    """Quarter-car: `sprung_mass`, `unsprung_mass` [kg], `tyre_stiffness`, `stiffness` [N/m].

    `struts` has the damper and the inerter of each layout, "S1", "S2" and "S3". `strut_length` [m]
    at rest is this project's.
    """

    sprung_mass: float
    unsprung_mass: float
    tyre_stiffness: float
    stiffness: float
    struts: Mapping[str, StrutParameters]
    strut_length: float


@dataclass(frozen=True, kw_only=True)
class AxleParameters:
    """One wheel of an axle with its strut and tyre.

    `distance` [m] from the body's centre of mass to the axle, along the car; `wheel_mass` [kg];
    `stiffness` [N/m], `damping` [N s/m] of the strut; `tyre_stiffness` [N/m];
    `inertance` [kg] of the strut's inerter.
    """

    distance: float
    wheel_mass: float
    stiffness: float
    damping: float
    tyre_stiffness: float
    inertance: float


@dataclass(frozen=True, kw_only=True)
class HalfCarParameters:
    """Half-car: `body_mass` [kg], `pitch_inertia` [kg m^2] about the centre of mass, two axles.

    `strut_length` [m] at rest, upright, and `centre_height`, `wheel_height` [m] of the centres of
    mass above the road are this project's.
    """

    body_mass: float
    pitch_inertia: float
    front: AxleParameters
    rear: AxleParameters
    strut_length: float
    centre_height: float
    wheel_height: float


@dataclass(frozen=True, kw_only=True)
class FullCarParameters:
    """Full car: as the half-car, with `roll_inertia` [kg m^2] and `track` [m] between wheels.

    `front` and `rear` are each one of the axle's two equal wheels. `yaw_inertia` [kg m^2], which
    counts when the car both pitches and rolls far, is this project's.
    """

    body_mass: float
    pitch_inertia: float
    roll_inertia: float
    yaw_inertia: float
    track: float
    front: AxleParameters
    rear: AxleParameters
    strut_length: float
    centre_height: float
    wheel_height: float


@dataclass(frozen=True, kw_only=True)
class FrameParameters:
    """Shear frame: `storey_mass` [kg], `storey_stiffness` [N/m], `storey_damping` [N s/m].

    Tuples from the lowest storey to the highest. `inertance` [kg], `series_stiffness` [N/m] and
    `series_damping` [N s/m] are a tuned inerter damper between ground and the first floor.
    """

    storey_mass: tuple[float, ...]
    storey_stiffness: tuple[float, ...]
    storey_damping: tuple[float, ...]
    inertance: float
    series_stiffness: float
    series_damping: float


@dataclass(frozen=True, kw_only=True)
class ShakerParameters:
    """Electrodynamic shaker with its amplifier.

    `resistance` [ohm], `inductance` [H], `force_constant` [N/A], `voltage_constant` [V s/m],
    `gain` [-] between input voltage and coil voltage, `armature_mass` [kg], `stiffness` [N/m],
    `damping` [N s/m] of the armature's suspension.
    """

    resistance: float
    inductance: float
    force_constant: float
    voltage_constant: float
    gain: float
    armature_mass: float
    stiffness: float
    damping: float


@dataclass(frozen=True, kw_only=True)
class FluidInerterParameters:
    """Piston, channel, friction, compressible water and trapped air of a fluid inerter.

    Names as in `ReferenceDevice` where they mean the same. `piston_mass` [kg];
    `air_damping_preload` [N s/m] after a preload of 0.05 V and 0.10 V; `air_column` [m] is the
    length of the trapped air in the cylinder, so that the volume is `piston_area * air_column`.
    """

    piston_mass: float
    piston_area: float
    channel_area: float
    channel_length: float
    fluid_density: float
    coulomb_force: float
    static_force: float
    stribeck_velocity: float
    viscous: float
    series_stiffness: float
    series_hardening: float
    series_damping: float
    air_damping_preload: tuple[float, float]
    gas_pressure: float
    gas_exponent: float
    air_column: float


@dataclass(frozen=True, kw_only=True)
class BenchDeviceParameters:
    """A ball-screw inerter on a bench: `screw_inertance`, `flywheel_inertance` [kg].

    `coulomb_force` [N]; `series_stiffness` [N/m], `series_damping` [N s/m] of the shaft; `backlash`
    [m], half of the play. `table_mass` [kg] of the bench that imposes the motion is this
    project's: so heavy that no device moves it.
    """

    screw_inertance: float
    flywheel_inertance: float
    coulomb_force: float
    series_stiffness: float
    series_damping: float
    backlash: float
    table_mass: float

    @property
    def inertance(self) -> float:
        """Screw and flywheel [kg]."""
        return self.screw_inertance + self.flywheel_inertance


QUARTER_CAR = QuarterCarParameters(
    sprung_mass=181.75,
    unsprung_mass=25.0,
    tyre_stiffness=120e3,
    stiffness=120e3,
    struts=MappingProxyType(
        {
            "S1": StrutParameters(damping=4981.0, inertance=0.0),
            "S2": StrutParameters(damping=3705.4, inertance=128.57),
            "S3": StrutParameters(damping=7544.2, inertance=366.52),
        }
    ),
    strut_length=0.5,
)
"""Wang and Su, "Inerter nonlinearities and the impact on suspension control", ACC 2008: masses and
tyre, and at k = 120 kN/m the damping and inertance that minimise the ride comfort index J1 (Table
1, recomputed)."""

TEST_RIG = BenchDeviceParameters(
    screw_inertance=5.0,
    flywheel_inertance=108.0,
    coulomb_force=10.0,
    series_stiffness=1e6,
    series_damping=3200.0,
    backlash=0.0,
    table_mass=1e12,
)
"""The bench device that Wang and Su identified, in the same paper; the model on the test rig has
its inertance alone."""

FULL_CAR = FullCarParameters(
    body_mass=1460.0,
    pitch_inertia=2460.0,
    roll_inertia=460.0,
    yaw_inertia=2600.0,
    track=1.51,
    front=AxleParameters(
        distance=1.011,
        wheel_mass=40.0,
        stiffness=19960.0,
        damping=1290.0,
        tyre_stiffness=175500.0,
        inertance=30.0,
    ),
    rear=AxleParameters(
        distance=1.803,
        wheel_mass=35.5,
        stiffness=17500.0,
        damping=1690.0,
        tyre_stiffness=175500.0,
        inertance=30.0,
    ),
    strut_length=0.55,
    centre_height=0.55,
    wheel_height=0.31,
)
"""A passenger car: Table 2 of "Equivalent air spring suspension model for quarter-passive model
of passenger vehicles", ISRN (Hindawi) 2015, 974020; the set goes back to Bouazara and Richard,
Eur. J. Mech. A/Solids 20(2), 2001, whose rear damping others print as 1620. Left out: the tyre
damping of 14.6 N s/m. The inertance (about a wheel's mass) is this project's choice."""

HALF_CAR = HalfCarParameters(
    body_mass=FULL_CAR.body_mass / 2.0,
    pitch_inertia=FULL_CAR.pitch_inertia / 2.0,
    front=FULL_CAR.front,
    rear=FULL_CAR.rear,
    strut_length=FULL_CAR.strut_length,
    centre_height=FULL_CAR.centre_height,
    wheel_height=FULL_CAR.wheel_height,
)
"""One side of `FULL_CAR`: half its body, one wheel of each axle."""

FRAME = FrameParameters(
    storey_mass=(1000.0, 1000.0, 1000.0),
    storey_stiffness=(1.5e6, 1.5e6, 1.5e6),
    storey_damping=(0.0, 0.0, 0.0),
    inertance=1000.0,
    series_stiffness=2.61e5,
    series_damping=7150.0,
)
"""Three equal undamped storeys of 1 t and 1500 kN/m, after Lazar, Neild and Wagg, "Using an
inerter-based device for structural vibration suppression", Earthquake Eng. Struct. Dyn. 43(8),
2014 (their text was not at hand: compare before quoting). Modes at 2.743, 7.686, 11.107 Hz. The
damper is this project's: one storey's mass as inertance, spring and damper such that the top
floor's largest amplification of a ground acceleration near the first mode is smallest."""

SHAKER = ShakerParameters(
    resistance=1.75,
    inductance=0.022,
    force_constant=20.0,
    voltage_constant=20.0,
    gain=19.0,
    armature_mass=2.7,
    stiffness=106.59,
    damping=6.79,
)
"""Table 2 of the fluid inerter experiment, see `FLUID_INERTER`."""

FLUID_INERTER = FluidInerterParameters(
    piston_mass=1.0,
    piston_area=1.649e-3,
    channel_area=2.827e-5,
    channel_length=1.7,
    fluid_density=995.6,
    coulomb_force=25.0,
    static_force=50.0,
    stribeck_velocity=0.013,
    viscous=515.0,
    series_stiffness=1.25e5,
    series_hardening=43.0,
    series_damping=950.0,
    air_damping_preload=(300.0, 700.0),
    gas_pressure=101325.0,
    gas_exponent=1.4,
    air_column=0.016,
)
"""Tables 1, 3, 4 of the fluid inerter experiment (small-scale prototype of Innsbruck, water in an
external pipe). The areas are computed from the printed diameters (50, 20 and 6 mm). The air's
pressure and volume are not printed: one standard atmosphere, and the 16 mm air column of Fig. 13
taken with the piston's area; for which preload it was read is not legible."""
