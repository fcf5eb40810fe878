"""Massless points that carry a terminal where Exudyn gives a marker but no coordinates of its own.

Cables, beams, kinematic trees and superelements: a NodePoint without mass is held to the marker by
a spherical joint, and the device acts on the point. The joint is an algebraic constraint, which
asks for an implicit solver.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from inerter.exudyn.engine import exudyn

CARRIED_MARKERS = ("SuperElementPosition", "SuperElementRigid", "KinematicTreeRigid")
CARRIED_BODIES = (
    "ANCFCable2D", "ANCFCable", "ALEANCFCable2D", "ANCFBeam", "ObjectANCFBeam",
    "BeamGeometricallyExact", "BeamGeometricallyExact3D", "BeamGeometricallyExact2D",
    "ANCFThinPlate",
)  # fmt: skip
"""As `GetObject` calls them, which is not always the name of the item."""


class Carrier(NamedTuple):
    """A massless point and the marker that it is held to."""

    node: Any
    marker: Any


def is_carried(mbs: Any, item: Any) -> bool:
    """Whether a terminal on this item needs a massless point."""
    engine = exudyn()
    if isinstance(item, engine.ObjectIndex):
        return mbs.GetObject(item)["objectType"] in CARRIED_BODIES
    if not isinstance(item, engine.MarkerIndex):
        return False
    marker = mbs.GetMarker(item)
    if marker["markerType"] in CARRIED_MARKERS:
        return True
    if marker["markerType"] not in ("BodyPosition", "BodyRigid"):
        return False
    body = mbs.GetObject(engine.ObjectIndex(int(marker["bodyNumber"])))
    return body["objectType"] in CARRIED_BODIES


def carry(mbs: Any, name: str, item: Any, local: Any) -> Carrier:
    """Add the point and its joint to the system; `name` is the device's."""
    engine, items = exudyn(), exudyn("itemInterface")
    marker = item
    if isinstance(item, engine.ObjectIndex):
        marker = mbs.AddMarker(
            items.MarkerBodyPosition(bodyNumber=item, localPosition=[float(x) for x in local])
        )
    place = mbs.GetMarkerOutput(
        marker, engine.OutputVariableType.Position, engine.ConfigurationType.Reference
    )
    node = mbs.AddNode(
        items.NodePoint(
            name=f"{name}_point{int(marker)}",
            referenceCoordinates=[float(x) for x in place],
            visualization=items.VNodePoint(show=False),
        )
    )
    own = mbs.AddMarker(items.MarkerNodePosition(nodeNumber=node))
    mbs.AddObject(
        items.SphericalJoint(
            name=f"{name}_joint{int(marker)}",
            markerNumbers=[marker, own],
            visualization=items.VSphericalJoint(show=False),
        )
    )
    return Carrier(node, marker)


def follow(mbs: Any, carriers: Sequence[Carrier]) -> bool:
    """Put points to where their markers start, in an assembled system; whether one had to move."""
    engine, moved = exudyn(), False
    kind, initial = engine.OutputVariableType, engine.ConfigurationType.Initial
    for node, marker in carriers:
        told = mbs.GetNode(node)
        place = mbs.GetMarkerOutput(marker, kind.Position, initial)
        speed = mbs.GetMarkerOutput(marker, kind.Velocity, initial)
        shift = place - told["referenceCoordinates"]
        for key, value in (("initialCoordinates", shift), ("initialVelocities", speed)):
            if not np.allclose(told[key], value, rtol=0.0, atol=1e-15):
                mbs.SetNodeParameter(node, key, [float(x) for x in value])
                moved = True
    return moved
