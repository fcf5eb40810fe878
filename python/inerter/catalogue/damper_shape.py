"""Coordinates of a damper whose force is no straight line over the velocity."""

from __future__ import annotations

from inerter.catalogue import combinations
from inerter.catalogue.coordinate import Coordinate


def _bend(side: str, where: str = "") -> tuple[Coordinate, ...]:
    """Where a damping bends, and how; of one direction."""
    knee, beyond = f"damping_knee{side}", f"damping_beyond{side}"
    return (
        Coordinate(
            name=knee, unit="m/s", words={knee: f"knee of the damping v_k{where}"}, none=None,
            size=lambda s: s.velocity, lower=lambda s: 0.1 * s.velocity,
            upper=lambda s: 3 * s.velocity, logarithmic=True,
        ),
        Coordinate(
            name=beyond, unit="1", words={beyond: f"slope beyond the knee{where}"},
            lower=lambda s: 0.0, upper=lambda s: 20.0, none=1.0,
        ),
    )  # fmt: skip


COORDINATES = (
    Coordinate(
        name="damping_asymmetry", unit="1", words={"damping_asymmetry": "asymmetry of the damping"},
        lower=lambda s: -0.95, upper=lambda s: 0.95,
    ),
    *_bend(""),
    *_bend("_back", " while x shrinks"),
    Coordinate(
        name="damping_sharpness", unit="1", words={"damping_sharpness": "sharpness of the knee n"},
        lower=lambda s: 1.0, upper=lambda s: 64.0, logarithmic=True, none=None,
    ),
    Coordinate(
        name="damping_power_knee", unit="m/s", words={"damping_knee": "knee of the damping v_k"},
        none=None, size=lambda s: s.velocity, lower=lambda s: 2e-3 * s.velocity,
        upper=lambda s: 5 * s.velocity, logarithmic=True, to_parameters=combinations.power_knee,
    ),
    Coordinate(
        name="damping_exponent", unit="1",
        words={"damping_exponent": "power of the speed beyond the knee"},
        lower=lambda s: -1.0, upper=lambda s: 1.0, none=None,
    ),
    Coordinate(
        name="damper_stiffness", unit="N/m", none=None, logarithmic=True,
        words={"damper_stiffness": "stiffness before the dampers k_d"},
        size=lambda s: s.force / s.displacement, lower=lambda s: 0.1 * s.force / s.displacement,
        upper=lambda s: 1e4 * s.force / s.displacement,
    ),
)  # fmt: skip
"""All of them."""
