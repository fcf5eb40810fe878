"""Coordinates of what stands between the terminals and the flywheel."""

from __future__ import annotations

import numpy as np

from inerter.catalogue import combinations
from inerter.catalogue.coordinate import Coordinate

COORDINATES = (
    Coordinate(
        name="series_frequency", unit="Hz", words={"series_stiffness": "series stiffness k_s"},
        size=lambda s: s.frequency, lower=lambda s: 0.1 * s.frequency,
        upper=lambda s: 8 * s.highest_frequency, logarithmic=True, none=None, entangled=True,
        start=(1.5, 30.0), start_unit=lambda s: s.frequency, to_parameters=combinations.shaft,
        of_device=lambda d: np.sqrt(d.series_stiffness / d.inertance) / (2 * np.pi),
    ),
    Coordinate(
        name="series_loss", unit="1", words={"series_damping": "series damping c_s"},
        size=lambda s: 0.1, lower=lambda s: 1e-4, upper=lambda s: 1e2, logarithmic=True, none=None,
        start=(0.01, 1.0),
        of_device=lambda d: d.series_damping / (2 * np.sqrt(d.series_stiffness * d.inertance)),
    ),
    Coordinate(
        name="series_hardening", unit="1/m", size=lambda s: 0.1 / s.displacement,
        lower=lambda s: -3 / s.displacement, upper=lambda s: 3 / s.displacement,
    ),
    Coordinate(
        name="flywheel_viscous", unit="N*s/m", words={"flywheel_viscous": "c_w of the flywheel"},
        size=lambda s: s.force / s.velocity, lower=lambda s: 0.0, start=(1e-3, 0.3),
        start_unit=lambda s: s.force / s.velocity, entangled=True, proportional_to="inertance",
    ),
    Coordinate(
        name="backlash", unit="m", words={"backlash": "half of the free play eps"},
        size=lambda s: s.displacement, lower=lambda s: 1e-5 * s.displacement,
        upper=lambda s: 2 * s.displacement, logarithmic=True, jumps=True,
        start=(1e-3, 0.3), start_unit=lambda s: s.displacement,
    ),
    Coordinate(
        name="clutch_force", unit="N", words={"clutch_force": "force at which it slips F_c"},
        size=lambda s: s.force, lower=lambda s: 1e-2 * s.force, upper=lambda s: 5 * s.force,
        logarithmic=True, none=None, jumps=True, entangled=True, also=("clutch_asymmetry",),
    ),
    Coordinate(
        name="leak_corner", unit="Hz", words={"leak_damping": "damping of the leak c_l"},
        size=lambda s: s.frequency, lower=lambda s: 1e-2 * s.frequency,
        upper=lambda s: 10 * s.highest_frequency, logarithmic=True, none=None, entangled=True,
        to_parameters=combinations.leak,
        of_device=lambda d: d.leak_damping / (2 * np.pi * d.inertance),
    ),
    Coordinate(
        name="leak_quadratic_damping", unit="N*s^2/m^2", logarithmic=True, none=None,
        words={"leak_quadratic_damping": "quadratic damping of the leak q_l"},
        size=lambda s: s.force / s.velocity**2, lower=lambda s: 1e-2 * s.force / s.velocity**2,
        upper=lambda s: 1e4 * s.force / s.velocity**2, entangled=True,
    ),
)  # fmt: skip
"""All of them."""
