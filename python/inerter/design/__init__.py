"""Design calculators: inertance, losses and elasticity of a device from its geometry.

>>> from inerter.design import design_ball_screw
>>> design = design_ball_screw(lead="4 mm", inertia=6.43e-5)
>>> round(design.value("inertance"), 2)
158.65
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from inerter.design.inputs import DesignError

if TYPE_CHECKING:
    from inerter.design.ball_screw.design import design_ball_screw
    from inerter.design.fluid.design import design_fluid
    from inerter.design.rack_pinion.design import design_rack_pinion
    from inerter.design.result import Design

__all__ = ["Design", "DesignError", "design_ball_screw", "design_fluid", "design_rack_pinion"]

# imported when they are asked for, so that the command line starts without SciPy
_PLACES = {
    "Design": "result",
    "design_ball_screw": "ball_screw.design",
    "design_fluid": "fluid.design",
    "design_rack_pinion": "rack_pinion.design",
}


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_PLACES[name]}"), name)
