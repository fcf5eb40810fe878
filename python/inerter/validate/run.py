"""What one engine did in one case, in the same words for every engine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

QUANTITIES: tuple[str, ...] = ("displacement", "velocity", "force", "state", "energy")


class RunError(RuntimeError):
    """An engine could not finish a run; the text says why."""


@dataclass(frozen=True, kw_only=True)
class ValidationRun:
    """Samples of a run; arrays of shape (times, columns), SI units.

    Attributes
    ----------
    time
        [s], shape (times,).
    displacement, velocity
        Of the model's coordinates, from equilibrium.
    force
        Of each device alone [N], without the spring and damper of its strut.
    state
        The devices' states by (device number, name of the state), shape (times,).
    energy
        Stored in each device [J].
    device_motion
        Displacement and velocity of each device; of the reference only.
    """

    time: Array
    displacement: Array
    velocity: Array
    force: Array
    state: Mapping[tuple[int, str], Array]
    energy: Array
    device_motion: tuple[Array, Array] | None = None

    def at(self, rows: NDArray[np.intp]) -> ValidationRun:
        """Some of the samples."""
        motion = self.device_motion
        return ValidationRun(
            time=self.time[rows],
            displacement=self.displacement[rows],
            velocity=self.velocity[rows],
            force=self.force[rows],
            state={name: values[rows] for name, values in self.state.items()},
            energy=self.energy[rows],
            device_motion=None if motion is None else (motion[0][rows], motion[1][rows]),
        )


def columns(run: ValidationRun, quantity: str, names: list[tuple[int, str]]) -> Array:
    """A quantity as an array (times, columns); of the states those that are named."""
    if quantity != "state":
        return np.asarray(getattr(run, quantity), dtype=np.float64)
    found = [run.state[name] for name in names]
    return np.column_stack(found) if found else np.empty((run.time.size, 0))


def errors(found: ValidationRun, true: ValidationRun) -> dict[str, float | None]:
    """Relative error of each quantity; None where the case has none of it or it stays 0.

    Largest difference over the largest value of the truth, column by column; then the worst
    column. States are compared where both runs have them.
    """
    shared = [name for name in true.state if name in found.state]
    result: dict[str, float | None] = {}
    for quantity in QUANTITIES:
        here, there = (columns(run, quantity, shared) for run in (found, true))
        result[quantity] = relative(here, there)
    return result


def relative(found: Array, true: Array) -> float | None:
    """Largest difference over largest true value, the worst column; None without any."""
    scale = np.abs(true).max(axis=0, initial=0.0)
    live = scale > 0.0
    if not live.any():
        return None
    return float((np.abs(found - true).max(axis=0)[live] / scale[live]).max())
