"""Steps many quarter-cars at once and hands out what happens, in chunks, at the instants.

Simulations differ in design, time step and controls; `mujoco.batch` runs them on threads and gives
each the numbers of a loop over `mj_step`, whatever the number of threads or of neighbours.

RK4: sensors show the state at the beginning of a step, with the control that is held over it.
discrete is semi-implicit, q_k+1 = q_k + h w_k+1: the body's acceleration at the instant of q_k
is (w_k+1 - w_k) / h, the second difference of the motion.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from mujoco import batch
from numpy.typing import NDArray

from inerter.simulate.checks import engine_warnings
from inerter.suspension.time_domain.model import CarModel, Design

Array = NDArray[np.float64]
Control = Callable[[int, int], Array]

CHUNK = 500
"""Steps between two looks at the simulations."""


@dataclass(frozen=True)
class Chunk:
    """Steps `first` to `first + n`, arrays (simulations, n): at the beginning of each step.

    `body`, `wheel` displacement [m], `acceleration` of the body [m/s^2] under the held control,
    `control` as given.
    """

    first: int
    body: Array
    wheel: Array
    acceleration: Array
    control: Array


class StepError(ValueError):
    """Simulations that cannot be run; one line."""


def step_all(
    car: CarModel,
    designs: Sequence[Design],
    steps: Array,
    count: int,
    address: int,
    control: Control,
    threads: int,
) -> Iterator[Chunk]:
    """Run one simulation per design from rest.

    Parameters
    ----------
    car
        The model of all of them.
    designs
        One for each simulation.
    steps
        Time step of each simulation [s], shape (simulations,).
    count
        Number of steps.
    address
        Which control is driven: `car.road` or `car.load`.
    control
        Called with the first step and the number of steps: values to hold, shape
        (simulations, number).
    threads
        0 for every processor.

    Raises
    ------
    StepError
        A value that the device refuses, or a simulation that diverged.
    """
    model = car.model
    worlds = _worlds(car, designs, steps, threads)
    dofs = [int(model.joint(name).dofadr[0]) for name in ("wheel", "travel")]
    places = {name: int(model.sensor(name).adr[0]) for name in ("wheel", "body")}
    upward = int(model.sensor("body_acceleration").adr[0]) + 2
    speed = np.zeros((len(designs), 1))
    for first in range(0, count, CHUNK):
        number = min(CHUNK, count - first)
        held = control(first, number)
        inputs = np.zeros((len(designs), number, model.nu))
        inputs[:, :, address] = held
        record = ("sensordata", "qvel") if car.implicit else ("sensordata",)
        try:
            with engine_warnings():
                found = worlds.rollout(number, inputs, record=record)
        except batch.SimulationError as error:
            raise StepError(" ".join(str(error).split())) from None
        sensors = found["sensordata"]
        if car.implicit:
            after = found["qvel"][:, :, dofs].sum(axis=2)
            before = np.concatenate([speed, after[:, :-1]], axis=1)
            acceleration, speed = (after - before) / steps[:, None], after[:, -1:].copy()
        else:
            acceleration = sensors[:, :, upward]
        yield Chunk(
            first, sensors[:, :, places["body"]], sensors[:, :, places["wheel"]], acceleration, held
        )
    _refuse_divergence(car, worlds, designs, count * steps)


def _worlds(car: CarModel, designs: Sequence[Design], steps: Array, threads: int) -> batch.Batch:
    """The simulations, each with its own design."""
    model = car.model
    worlds = batch.Batch(model, len(designs), threads)
    integrators = mujoco.mjtIntegrator
    worlds.expand("opt.integrator")[:] = int(
        integrators.mjINT_DISCRETE if car.implicit else integrators.mjINT_RK4
    )
    worlds.expand("opt.timestep")[:] = steps
    worlds.expand("tendon_stiffness")[:, car.spring] = [d.stiffness for d in designs]
    worlds.expand("tendon_damping")[:, car.damper] = [d.damping for d in designs]
    if car.device is not None:
        live = car.device.live
        inertances = [d.inertance for d in designs]
        if "inertance" in live:
            worlds.expand("numeric_data")[:, live["inertance"]] = inertances
        else:
            worlds.expand("actuator_armature")[:, car.device.actuator] = inertances
        for key, value in car.case.parameters.items():
            column = [d.parameters.get(key, value) for d in designs]
            worlds.expand("numeric_data")[:, live[key]] = column
    worlds.set_const()
    return worlds


def _refuse_divergence(
    car: CarModel, worlds: batch.Batch, designs: Sequence[Design], ends: Array
) -> None:
    """A simulation that the engine stopped or began anew has not reached its end."""
    time = worlds.bind("time").reshape(len(designs))
    late = np.flatnonzero(~(np.abs(time - ends) < 1e-6 * ends))
    if late.size:
        design = designs[int(late[0])]
        raise StepError(
            f"layout {car.layout}, case {car.case.name}: the simulation with damping "
            f"{design.damping:g} N s/m and inertance {design.inertance:g} kg diverged; "
            "shorten the step"
        )
