"""A car as an Exudyn model: one object of several coordinates, its forces a user function.

Needs Exudyn, an optional extra; nothing that the plain command line imports imports this module.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from inerter.cars.equations import Road, car_equations, heights, rising
from inerter.cars.parts import CarParts
from inerter.exudyn.model_parts import Model


def build_car(mbs: Any, car: CarParts, roads: Mapping[str, Road] | None = None) -> Model:
    """Add a car to an empty system; assemble it afterwards, or hand it to `model_parts.simulate`.

    Parameters
    ----------
    mbs
        An empty `exudyn.MainSystem`.
    car
        As from `inerter.cars.read.read_car`.
    roads
        "road", "road_front", ...: time [s] -> height of the road [m]; flat where not given.
        With damping of tyres it may not jump.

    Raises
    ------
    ValueError
        A road that the car has not, an inerter with friction, play or a shaft, or a damper table
        behind a relaxation spring.

    Notes
    -----
    Of SR, S5 and SW8 the elongation of the relaxation spring is the velocity of a coordinate with
    unit mass, as the states of an inerter are (`inerter.exudyn.element`); it is not among
    `coordinates`. An explicit solver needs steps below 2 c / (k_b + k_1); for stiffer springs take
    "GeneralizedAlpha".
    """
    from exudyn.itemInterface import NodeGenericODE2, ObjectGenericODE2, VObjectGenericODE2

    equations = car_equations(car)
    given = dict(roads or {})
    for name in given:
        if name not in equations.roads:
            raise ValueError(f"no road {name!r}: there are {', '.join(equations.roads)}")
    count, damped = len(equations.names), any(equations.tyre_dampings)
    zeros = [0.0] * count
    node = mbs.AddNode(
        NodeGenericODE2(
            numberOfODE2Coordinates=count,
            referenceCoordinates=zeros,
            initialCoordinates=zeros,
            initialCoordinates_t=zeros,
        )
    )

    def force(mbs: Any, t: float, itemNumber: int, q: Any, q_t: Any) -> Any:
        road = heights(given, equations.roads, t)
        rates = rising(given, equations.roads, t) if damped else None
        return equations.forces(np.asarray(q), np.asarray(q_t), road, rates)

    mbs.AddObject(
        ObjectGenericODE2(
            name=car.name,
            nodeNumbers=[node],
            massMatrix=equations.mass,
            forceUserFunction=force,
            visualization=VObjectGenericODE2(show=False),
        )
    )
    moving = equations.names[: count - len(equations.states)]
    return Model(mbs, {name: (node, n) for n, name in enumerate(moving)}, {})
