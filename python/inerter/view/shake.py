"""A sine on one control, so that a model at rest shows its loops."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import mujoco

from inerter.engine_errors import SimulationError


@dataclass(frozen=True)
class Shake:
    """amplitude sin(2 pi frequency t) on a control: its name, the control's unit, [Hz]."""

    control: str
    amplitude: float
    frequency: float

    def apply(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Set the control for the present time."""
        address = int(model.actuator_ctrladr[model.actuator(self.control).id])
        data.ctrl[address] = self.amplitude * math.sin(2 * math.pi * self.frequency * data.time)


def controls_of(model: mujoco.MjModel) -> list[str]:
    """Names of the actuators with a control."""
    names = (
        (mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, i), int(model.actuator_ctrlnum[i]))
        for i in range(model.nactuator)
    )
    return [name for name, controls in names if name and controls]


def read_shake(text: str, model: mujoco.MjModel) -> Shake:
    """A shake from NAME=AMPLITUDE@HZ.

    Raises
    ------
    SimulationError
        Another form, a control that is not there, a number that cannot be.
    """
    name, equals, rest = text.rpartition("=")
    amplitude, at, frequency = rest.partition("@")
    try:
        found = Shake(name, float(amplitude), float(frequency))
    except ValueError:
        found = None
    if not (found and equals and at and _possible((found.amplitude, found.frequency))):
        raise SimulationError(
            f"--shake is {text!r}: give CONTROL=AMPLITUDE@HZ, as in road=0.01@1.5 (0 to 1000 Hz)"
        )
    if name not in controls_of(model):
        listed = ", ".join(controls_of(model)) or "none"
        raise SimulationError(f"--shake: no control {name!r} in the model; it has {listed}")
    return found


def usual_shake(model: mujoco.MjModel) -> Shake | None:
    """What a viewer begins with: a road goes up and down by 10 mm, any other control rests."""
    names = controls_of(model)
    roads = [name for name in names if "road" in name]
    if roads:
        return Shake(roads[0], 0.01, 1.5)
    return Shake(names[0], 0.0, 1.0) if names else None


def _possible(numbers: Iterable[float]) -> bool:
    amplitude, frequency = numbers
    return math.isfinite(amplitude) and 0 <= frequency <= 1000
