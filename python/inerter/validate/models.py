"""The models of the comparison: the reference's matrices and what they are called elsewhere.

Every model is a `Structure` of the reference with its inputs. Beside it stands what the MuJoCo
file needs to be read in the same words: which joints add up to a coordinate, which configuration
keys belong to the inerter itself (a law replaces them) and which to the spring and damper beside
it, and how small a motion has to be for a spatial geometry to be linear.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from inerter.reference import (
    FLUID_INERTER,
    FRAME,
    FRAME_DEVICE,
    FULL_CAR,
    HALF_CAR,
    Corner,
    FloorDevice,
    FullCar,
    HalfCar,
    QuarterCar,
    ReferenceDevice,
    ShearFrame,
    Structure,
    Strut,
    complete_device,
    corner_of,
    dry_device,
)
from inerter.validate.laws import INERTANCE

Array = NDArray[np.float64]

SMALL = 1e-5
"""Scale of motions in a spatial geometry: linear to travel over the strut's length, about 1e-7."""


@dataclass(frozen=True)
class Input:
    """An input: generalised forces (nq,) of a unit, its size beside the others, its delay [s]."""

    push: Array
    size: float = 1.0
    delay: float = 0.0


@dataclass(frozen=True, kw_only=True)
class ValidationModel:
    """A model in one layout.

    Attributes
    ----------
    name, layout
        As users say it; a layout is S1, S2, S3 or the name of a variant.
    structure
        The reference with its published device.
    coordinates
        Names in the reference's order, each with the MuJoCo joints that may be it: the first that
        a file has; joints joined by + are added.
    inputs
        The inputs by their names.
    amplitude, frequency
        Size and frequency [Hz] of the inputs.
    inerters
        Names of the devices, in the reference's order.
    folder, files
        The model's folder and its MuJoCo files, by what a row calls the model.
    own
        Configuration keys that are the inerter itself, the others being spring and damper of its
        strut; None where the device stands alone.
    scale
        Size of the motion in MuJoCo, see `SMALL`.
    mass
        Unit of mass in which the laws are read, see `laws.py`.
    step
        Time step [s] of a validation.
    method
        Integrator of the truth, see `scipy.integrate.solve_ivp`.
    variant
        How the Exudyn model is told this variant.
    """

    name: str
    layout: str
    structure: Structure
    coordinates: Mapping[str, tuple[str, ...]]
    inputs: Mapping[str, Input]
    amplitude: float
    frequency: float
    inerters: tuple[str, ...]
    folder: str
    files: Mapping[str, str]
    own: tuple[str, ...] | None = ("inertance",)
    scale: float = 1.0
    mass: float = 1.0
    step: float = 1e-3
    method: str = "DOP853"
    variant: Mapping[str, object] | None = None

    @property
    def duration(self) -> float:
        """Of a run [s]: eight periods, in which the road comes once."""
        return 8.0 / self.frequency

    @property
    def key(self) -> str:
        """Name and layout in one word."""
        return f"{self.name}/{self.layout}" if self.layout else self.name

    def with_device(self, device: ReferenceDevice | None) -> Structure:
        """The structure with another device in place of each inerter; None: the published one."""
        if device is None:
            return self.structure
        struts = tuple(replace(strut, device=device) for strut in self.structure.struts)
        return replace(self.structure, struts=struts)


@cache
def models() -> dict[str, ValidationModel]:
    """Every model and layout by its key."""
    found = [
        *(_quarter_car(layout) for layout in ("S1", "S2", "S3")),
        *(_half_car(layout) for layout in ("S1", "S2", "S3")),
        *(_full_car(layout) for layout in ("S1", "S2", "S3")),
        _frame("floors", 1, 3, "model.xml"),
        _frame("ground", 0, 1, "model_ground.xml"),
        _fluid("dry"),
        _fluid("complete"),
    ]
    return {model.key: model for model in found}


# damping [N s/m], inertance [kg] of the shipped files (Wang and Su, Table 1)
_TABLE_1 = {"S1": (4981.0, 0.0), "S2": (3705.4, 128.57), "S3": (7544.2, 366.52)}


def _quarter_car(layout: str) -> ValidationModel:
    damping, inertance = _TABLE_1[layout]
    car = QuarterCar(layout=layout, damping=damping, device=ReferenceDevice(inertance=inertance))
    # the same car twice: bodies nested, or side by side in the world
    files = {"quarter_car": _file(layout)}
    if layout == "S2":
        files["quarter_car_siblings"] = "model_siblings.xml"
    return ValidationModel(
        name="quarter_car",
        layout=layout,
        structure=car.structure,
        coordinates={"body": ("body", "wheel+travel"), "wheel": ("wheel",)},
        inputs={"road": Input(np.array([0.0, car.tyre_stiffness]))},
        amplitude=0.03,
        frequency=4.0,
        inerters=() if layout == "S1" else ("strut",),
        files=files,
        folder="quarter_car",
        mass=(inertance or INERTANCE) / INERTANCE,
    )


def _half_car(layout: str) -> ValidationModel:
    corners = {name: corner_of(axle, layout) for name, axle in
               (("front", HALF_CAR.front), ("rear", HALF_CAR.rear))}  # fmt: skip
    car = HalfCar(front=corners["front"], rear=corners["rear"])
    return _vehicle("half_car", layout, car.structure, ("heave", "pitch"), corners)


def _full_car(layout: str) -> ValidationModel:
    corners = {
        f"{axle}_{side}": corner_of(getattr(FULL_CAR, axle), layout)
        for axle in ("front", "rear")
        for side in ("left", "right")
    }
    car = FullCar(
        front_left=corners["front_left"],
        front_right=corners["front_right"],
        rear_left=corners["rear_left"],
        rear_right=corners["rear_right"],
    )
    return _vehicle("full_car", layout, car.structure, ("heave", "pitch", "roll"), corners)


def _vehicle(
    name: str,
    layout: str,
    structure: Structure,
    body: tuple[str, ...],
    corners: Mapping[str, Corner],
) -> ValidationModel:
    """Roads of different height, the rear ones later: every motion of the body is there."""
    heights = dict(zip(corners, (1.0, 0.6, 0.8, 0.5), strict=False))
    inputs: dict[str, Input] = {}
    for i, (where, corner) in enumerate(corners.items()):
        push = np.zeros(len(structure.mass))
        push[len(body) + i] = corner.tyre_stiffness
        delay = 0.0 if where.startswith("front") else 0.1
        inputs[f"road_{where}"] = Input(push, heights[where], delay)
    wheels = {f"wheel_{where}": (f"wheel_{where}",) for where in corners}
    return ValidationModel(
        name=name,
        layout=layout,
        structure=structure,
        coordinates={part: (part,) for part in body} | wheels,
        inputs=inputs,
        amplitude=0.03,
        frequency=4.0,
        inerters=() if layout == "S1" else tuple(f"strut_{where}" for where in corners),
        files={name: _file(layout)},
        folder=name,
        scale=SMALL,
        mass=HALF_CAR.front.inertance / INERTANCE,
    )


def _frame(layout: str, lower: int, upper: int, file: str) -> ValidationModel:
    frame = ShearFrame(devices=(FloorDevice(lower=lower, upper=upper, device=FRAME_DEVICE),))
    return ValidationModel(
        name="tuned_inerter_damper",
        layout=layout,
        structure=frame.structure,
        coordinates={f"floor_{i}": (f"floor_{i}",) for i in (1, 2, 3)},
        inputs={"ground": Input(-np.array(FRAME.storey_mass))},
        amplitude=3.0,
        frequency=2.5,
        inerters=("damper",),
        files={"tuned_inerter_damper": file},
        folder="tuned_inerter_damper",
        own=None,
        mass=FRAME.inertance / INERTANCE,
        variant={"ground": lower == 0},
    )


def _fluid(layout: str) -> ValidationModel:
    dry = layout == "dry"
    structure = Structure(
        mass=np.array([[FLUID_INERTER.piston_mass]]),
        damping=np.zeros((1, 1)),
        stiffness=np.zeros((1, 1)),
        directions=np.ones((1, 1)),
        struts=(Strut(layout="S2", device=dry_device() if dry else complete_device()),),
    )
    return ValidationModel(
        name="fluid_inerter",
        layout=layout,
        structure=structure,
        coordinates={"piston": ("piston",)},
        inputs={"force": Input(np.ones(1))},
        # the air spring's law ends at 6.6 mm
        amplitude=120.0 if dry else 100.0,
        frequency=8.0,
        inerters=("device",),
        files={"fluid_inerter": "model_dry.xml" if dry else "model.xml"},
        folder="fluid_inerter",
        # a piston of 1 kg in its seals is quick, and stiff
        own=None,
        step=1e-4,
        method="LSODA",
        variant={"variant": layout},
    )


def _file(layout: str) -> str:
    return "model.xml" if layout == "S2" else f"model_{layout.lower()}.xml"
