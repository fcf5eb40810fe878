"""The readable telling of the physics: NumPy and SciPy only, from the papers.

It shares no code with the fast core; the two meet in tests and in `inerter validate`. The
published numbers of the models, plain data, come from `inerter/model_parameters.py`.

    laws/            one force law per file
    device.py        the device: inertance, springs, dampers, friction, series element
    motion.py        its force along an imposed motion
    motions.py       test motions in closed form
    contacts.py      integration that locates the contacts of a backlash
    strut.py         spring, damper and device in one of three layouts
    structure.py     bodies with struts between them, solved jointly
    quarter_car.py   the quarter-car with the device in its strut
    vehicle.py       what the two next share
    half_car.py      heave and pitch on two struts
    full_car.py      heave, pitch and roll on four struts
    tuned_inerter_damper.py   a shear frame with inerters between floors
    fluid_inerter.py the fluid inerter on its shaker
    hidden_vehicle.py         vehicle records with hidden effects
    drawn_vehicle.py, vehicle_roads.py, vehicle_draws.py   what it draws from
    bench.py         test records with hidden effects
    bench_motions.py, bench_effects.py, bench_devices.py, bench_channel.py   what it draws from
    bench_unknown.py test records with an effect that no name describes
    bench_realistic.py  what a bench as it is does to motion and records
    wang_su.py       the demonstration record
"""

from __future__ import annotations

from inerter.model_parameters import (
    FLUID_INERTER,
    FRAME,
    FULL_CAR,
    HALF_CAR,
    QUARTER_CAR,
    SHAKER,
    TEST_RIG,
)

from .bench import HiddenCase, HiddenRun, NoiseLevels, hide_effect
from .bench_channel import Channel
from .bench_effects import EFFECTS, HYSTERETIC_LAWS, compatible
from .bench_unknown import UNKNOWN, hide_unknown
from .device import ReferenceDevice
from .drawn_vehicle import DrawnCorner, DrawnVehicle
from .fluid_inerter import (
    FluidInerterResult,
    FluidInerterTest,
    complete_device,
    dry_device,
    receptance,
    sweep_voltage,
)
from .full_car import FullCar, FullCarResult
from .half_car import HalfCar, HalfCarResult
from .hidden_vehicle import HiddenVehicle, hide_in_vehicle
from .laws import FRICTION_LAWS, GAS_LAWS, friction_level
from .motion import Motion, Response, response, sine_motion
from .motions import chirp, scaled, strokes, sum_of_sines, windowed_sines
from .quarter_car import LAYOUTS, QuarterCar, QuarterCarResult
from .record import write_record
from .structure import Structure, StructureRun
from .strut import Strut
from .tuned_inerter_damper import (
    FRAME_DEVICE,
    FloorDevice,
    FrameResult,
    ShearFrame,
    frame_modes,
    frame_receptance,
    frame_state_matrix,
)
from .vehicle import Corner, corner_of
from .vehicle_draws import VEHICLE_EFFECTS, compatible_in_vehicles
from .vehicle_unknown import VEHICLE_UNKNOWN
from .wang_su import WANG_SU_DEVICE, WangSuBench, wang_su_bench, wang_su_motion

__all__ = [
    "EFFECTS",
    "FLUID_INERTER",
    "FRAME",
    "FRAME_DEVICE",
    "FRICTION_LAWS",
    "FULL_CAR",
    "GAS_LAWS",
    "HALF_CAR",
    "HYSTERETIC_LAWS",
    "LAYOUTS",
    "QUARTER_CAR",
    "SHAKER",
    "TEST_RIG",
    "UNKNOWN",
    "VEHICLE_EFFECTS",
    "VEHICLE_UNKNOWN",
    "WANG_SU_DEVICE",
    "Channel",
    "Corner",
    "DrawnCorner",
    "DrawnVehicle",
    "FloorDevice",
    "FluidInerterResult",
    "FluidInerterTest",
    "FrameResult",
    "FullCar",
    "FullCarResult",
    "HalfCar",
    "HalfCarResult",
    "HiddenCase",
    "HiddenRun",
    "HiddenVehicle",
    "Motion",
    "NoiseLevels",
    "QuarterCar",
    "QuarterCarResult",
    "ReferenceDevice",
    "Response",
    "ShearFrame",
    "Structure",
    "StructureRun",
    "Strut",
    "WangSuBench",
    "chirp",
    "compatible",
    "compatible_in_vehicles",
    "complete_device",
    "corner_of",
    "dry_device",
    "frame_modes",
    "frame_receptance",
    "frame_state_matrix",
    "friction_level",
    "hide_effect",
    "hide_in_vehicle",
    "hide_unknown",
    "receptance",
    "response",
    "scaled",
    "sine_motion",
    "strokes",
    "sum_of_sines",
    "sweep_voltage",
    "wang_su_bench",
    "wang_su_motion",
    "windowed_sines",
    "write_record",
]
