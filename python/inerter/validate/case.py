"""One case: a model in a layout, a law, an input, a duration."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.reference import ReferenceDevice
from inerter.validate.inputs import Signal, signal
from inerter.validate.laws import LAWS, Kind, exponents, in_units, state_exponents
from inerter.validate.models import ValidationModel, models

PUBLISHED = "published"
"""The law's name where a model keeps the device that it is shipped with."""

SAMPLE = 5e-3
"""Time between samples [s]: a multiple of every step."""

# shipped devices: smooth, all of them
_PUBLISHED_KIND: Kind = "smooth"


@dataclass(frozen=True)
class Case:
    """Names only, so that it travels to another process; what they mean follows from them.

    `headline` marks the long runs whose engines have to agree to 1e-6.
    """

    model: str
    law: str
    input: str
    duration: float
    headline: bool = False

    @property
    def setup(self) -> ValidationModel:
        """The model."""
        return models()[self.model]

    @property
    def step(self) -> float:
        """Time step [s], before it is halved; a step of the input excites the fastest motions."""
        quick = self.input == "step" and self.setup.method == "LSODA"
        return self.setup.step / 4.0 if quick else self.setup.step

    @property
    def kind(self) -> Kind:
        """How smooth the law is."""
        return LAWS[self.law].kind if self.law in LAWS else _PUBLISHED_KIND

    def device(self, length: float = 1.0) -> dict[str, float | str] | None:
        """The inerter's parameters for motions `length` times as large; None: the shipped ones.

        The shipped inerters of the vehicles are an inertance, which no unit of length changes.
        """
        if self.law == PUBLISHED:
            return None
        return in_units(LAWS[self.law].device, mass=self.setup.mass, length=length)

    def command(self, length: float = 1.0) -> float:
        """What the device's control is told, NaN for a device without one."""
        told = LAWS[self.law].command if self.law in LAWS else math.nan
        if math.isnan(told):
            return told
        of_mass, of_length = exponents("control_upper", LAWS[self.law].device)
        return told * self.setup.mass**of_mass * length**of_length

    def state_size(self, name: str, length: float) -> float:
        """Size of a state of the device for motions `length` times as large."""
        device = LAWS[self.law].device if self.law in LAWS else {}
        return length ** state_exponents(name, device)[1]

    def reference_device(self) -> ReferenceDevice | None:
        """The device in the reference."""
        device = self.device()
        if device is None:
            return None
        return ReferenceDevice(**device, command=self.command())  # pyright: ignore[reportArgumentType]

    def signals(self, size: float = 1.0) -> dict[str, Signal]:
        """The inputs by name, `size` times the model's amplitude."""
        model, found = self.setup, {}
        for name, part in model.inputs.items():
            shape = signal(self.input, model.frequency, self.duration, part.delay)
            found[name] = _sized(shape, size * model.amplitude * part.size)
        return found

    @property
    def times(self) -> NDArray[np.float64]:
        """Sample times [s], shape (times,)."""
        return np.asarray(SAMPLE * np.arange(round(self.duration / SAMPLE) + 1), dtype=np.float64)


def _sized(shape: Signal, size: float) -> Signal:
    return lambda t: size * shape(t)
