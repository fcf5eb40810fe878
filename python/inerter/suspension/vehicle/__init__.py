"""Half- and full cars of the linear suspension study, front and rear struts of their own.

Cars are planes of motion on two axles (`cars`, `state_space`), struts are divided layouts
(`strut`). Mean squares on a road that reaches the rear later come from one Lyapunov equation
(`white_noise`), the largest displacement under a load from certified peaks (`load`, `load_peaks`),
the global optimum from many starts (`optimum`).
"""

from inerter.suspension.vehicle.cars import Axle, FullCar, HalfCar, full_car, half_car
from inerter.suspension.vehicle.indices import vehicle_index
from inerter.suspension.vehicle.optimum import VehicleOptimum, vehicle_optimum
from inerter.suspension.vehicle.strut import VehicleStrut

__all__ = [
    "Axle",
    "FullCar",
    "HalfCar",
    "VehicleOptimum",
    "VehicleStrut",
    "full_car",
    "half_car",
    "vehicle_index",
    "vehicle_optimum",
]
