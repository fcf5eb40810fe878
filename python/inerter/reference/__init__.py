"""The readable telling of the physics: NumPy and SciPy only, from the papers.

It shares no code with the fast core; the two meet in tests and in `inerter validate`.

    laws/            one force law per file
    device.py        the device: inertance, springs, dampers, friction
    motion.py        its force along an imposed motion
    motions.py       test motions in closed form
    quarter_car.py   the quarter-car with the device in its strut
    bench.py         test records with one hidden effect
    bench_motions.py, bench_devices.py   what it draws from
    wang_su.py       the demonstration record
"""

from __future__ import annotations

from .bench import EFFECTS, HYSTERETIC_LAWS, HiddenCase, HiddenRun, NoiseLevels, hide_effect
from .device import ReferenceDevice
from .laws import FRICTION_LAWS, friction_level
from .motion import Motion, Response, response, sine_motion
from .motions import chirp, scaled, strokes, sum_of_sines, windowed_sines
from .quarter_car import LAYOUTS, QuarterCar, QuarterCarResult
from .record import write_record
from .wang_su import WANG_SU_DEVICE, WangSuBench, wang_su_bench, wang_su_motion

__all__ = [
    "EFFECTS",
    "FRICTION_LAWS",
    "HYSTERETIC_LAWS",
    "LAYOUTS",
    "WANG_SU_DEVICE",
    "HiddenCase",
    "HiddenRun",
    "Motion",
    "NoiseLevels",
    "QuarterCar",
    "QuarterCarResult",
    "ReferenceDevice",
    "Response",
    "WangSuBench",
    "chirp",
    "friction_level",
    "hide_effect",
    "response",
    "scaled",
    "sine_motion",
    "strokes",
    "sum_of_sines",
    "wang_su_bench",
    "wang_su_motion",
    "windowed_sines",
    "write_record",
]
