"""Steps many cars at once and hands out what happens, in chunks, at the instants.

Simulations differ in design, time step and controls; `mujoco.batch` runs them on threads and gives
each the numbers of a loop over `mj_step`, whatever the number of threads or of neighbours.

RK4: sensors show the state at the beginning of a step, with the control that is held over it.
discrete is semi-implicit, q_k+1 = q_k + h w_k+1: the body's acceleration at the instant of q_k
is (w_k+1 - w_k) / h, the second difference of the motion.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.engine_batch import batch
from inerter.simulate.checks import engine_warnings
from inerter.suspension.time_domain.car_model import FIELDS, CarModel
from inerter.suspension.time_domain.design import Design

Array = NDArray[np.float64]
Control = Callable[[int, int], Array]

CHUNK = 500
"""Steps between two looks at the simulations."""


@dataclass(frozen=True)
class Chunk:
    """Steps `first` to `first + n`, arrays (simulations, n, ...): at the beginning of each step.

    `body` displacement under the load [m], `wheels` displacements, `rates` of them [m/s] and
    `travels` of the struts [m] (..., wheels),
    `accelerations` of the body's points [m/s^2] (..., points) under the held control, `control` as
    given.
    """

    first: int
    body: Array
    wheels: Array
    accelerations: Array
    control: Array
    travels: Array
    rates: Array


class StepError(ValueError):
    """Simulations that cannot be run; one line."""


def step_all(
    car: CarModel,
    designs: Sequence[Design],
    steps: Array,
    count: int,
    addresses: Sequence[int],
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
    addresses
        Which controls are driven: the wheels' `road`, or `car.load`.
    control
        Called with the first step and the number of steps: values to hold, shape
        (simulations, number, addresses).
    threads
        0 for every processor.

    Raises
    ------
    StepError
        A value that the device refuses, or a simulation that diverged.
    """
    model = car.model
    worlds = _worlds(car, designs, steps, threads)
    heights = [wheel.height for wheel in car.wheels]
    travels = [wheel.travel for wheel in car.wheels]
    speeds = [wheel.rate for wheel in car.wheels]
    before = np.zeros((len(designs), 1, model.nv))
    for first in range(0, count, CHUNK):
        number = min(CHUNK, count - first)
        held = control(first, number)
        inputs = np.zeros((len(designs), number, model.nu))
        inputs[:, :, list(addresses)] = held
        record = ("sensordata", "qvel") if car.implicit else ("sensordata",)
        try:
            with _quietly():
                found = worlds.rollout(number, inputs, record=record)
        except batch.SimulationError as error:
            raise StepError(" ".join(str(error).split())) from None
        sensors = found["sensordata"]
        if car.implicit:
            after = found["qvel"]
            rates = np.diff(np.concatenate([before, after], axis=1), axis=1)
            accelerations = rates @ car.by_rates.T / steps[:, None, None]
            before = after[:, -1:].copy()
        else:
            accelerations = sensors @ car.by_sensors.T
        shown = (sensors[:, :, at] for at in (car.body, heights, travels, speeds))
        body, wheels, moves, moving = shown
        yield Chunk(first, body, wheels, accelerations, held, moves, moving)
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
    # designs are alike on many roads
    models = {id(design): car.of(design) for design in designs}
    chosen = [models[id(design)] for design in designs]
    for name in FIELDS:
        if getattr(model, name).size:
            worlds.expand(name)[:] = [getattr(each, name) for each in chosen]
    worlds.set_const()
    return worlds


def _refuse_divergence(
    car: CarModel, worlds: batch.Batch, designs: Sequence[Design], ends: Array
) -> None:
    """A simulation that the engine stopped or began anew has not reached its end."""
    time = worlds.bind("time").reshape(len(designs))
    late = np.flatnonzero(~(np.abs(time - ends) < 1e-6 * ends))
    if late.size:
        struts = designs[int(late[0])].struts
        values = " and ".join(
            f"damping {strut.damping:g} N s/m and inertance {strut.inertance:g} kg"
            for strut in struts
        )
        raise StepError(
            f"layout {car.layout}, case {car.case.name}: the simulation with {values} diverged; "
            "shorten the step"
        )


_lock = threading.Lock()
_stack = ExitStack()
_running = 0


@contextmanager
def _quietly() -> Iterator[None]:
    """Keep the engine's warnings from the terminal; for several threads of a worker at once."""
    global _running
    with _lock:
        if _running == 0:
            _stack.enter_context(engine_warnings())
        _running += 1
    try:
        yield
    finally:
        with _lock:
            _running -= 1
            if _running == 0:
                _stack.close()
