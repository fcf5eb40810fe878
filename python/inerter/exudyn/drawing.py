"""How Exudyn draws a device between points: as a spring, which has no force and costs nothing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from numbers import Real
from typing import Any

import numpy as np

from inerter.exudyn.engine import exudyn
from inerter.exudyn.terminals import Terminals


def check_drawing(size: Any, color: Any) -> None:
    """Raise ValueError for a size or a color that Exudyn could not draw."""
    if not isinstance(size, Real) or not math.isfinite(size):
        raise ValueError(f"drawSize: {size!r:.40} is no finite number; -1 is Exudyn's own size")
    if color is None:
        return
    parts = None if isinstance(color, str) else list(color)
    if not parts or len(parts) != 4 or not all(isinstance(part, Real) for part in parts):
        raise ValueError(
            f"color: {color!r:.40} is no color; give red, green, blue and opacity from 0 to 1, as "
            "exudyn.graphics.color.red"
        )


def draw(
    mbs: Any,
    name: str,
    places: Terminals,
    show: bool,
    size: float,
    color: Sequence[float] | None,
) -> Any:
    """Add the drawing of a device, and return its object."""
    items = exudyn("itemInterface")
    shade = list(exudyn("graphics").color.default if color is None else color)
    ends = [
        _marker(mbs, item, [float(x) for x in point])
        for item, point in zip(places.items, map(np.asarray, places.local), strict=True)
    ]
    return mbs.AddObject(
        items.ObjectConnectorSpringDamper(
            name=f"{name}_drawing",
            markerNumbers=ends,
            # it is drawn all the same, but not evaluated
            activeConnector=False,
            referenceLength=1.0,
            visualization=items.VObjectConnectorSpringDamper(show=show, drawSize=size, color=shade),
        )
    )


def _marker(mbs: Any, item: Any, point: list[float]) -> Any:
    """A position marker where a terminal is."""
    engine, items = exudyn(), exudyn("itemInterface")
    if isinstance(item, engine.MarkerIndex):
        return item
    if item is None:
        node = mbs.AddNode(
            items.NodePointGround(
                referenceCoordinates=point, visualization=items.VNodePointGround(show=False)
            )
        )
        return mbs.AddMarker(items.MarkerNodePosition(nodeNumber=node))
    if isinstance(item, engine.NodeIndex):
        # at the node itself: nodes have no marker at a place beside them
        return mbs.AddMarker(items.MarkerNodePosition(nodeNumber=item))
    return mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=item, localPosition=point))
