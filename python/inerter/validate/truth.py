"""The reference's run of a case, and its own equations stepped by a textbook formula.

The truth is integrated to 1e-10, by DOP853 or where it is stiff by LSODA, contacts located as
events; with a load on maxwell_slip to `KNEE`. `stepped` takes the same
right-hand side through classical Runge-Kutta steps of a fixed size: what that loses is lost by the
step and the law together, not by an engine. See `bounds.py` for what it is used for.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.reference import Structure, StructureRun
from inerter.reference.laws import load
from inerter.validate.case import SAMPLE, Case
from inerter.validate.run import ValidationRun

Array = NDArray[np.float64]

KNEE = 1e-5
"""Share of its limit over which an element of maxwell_slip begins to slip under a load here.

A limit that rises holds the element between two rates; no solver that follows its error gets past
that. Ten times the knee is off by ten times as much of the force, which a test looks at.
"""


def truth(case: Case, times: ArrayLike) -> ValidationRun:
    """The reference at `times` [s], increasing from 0."""
    device, method, rtol = case.reference_device(), case.setup.method, 1e-10
    if device is not None and device.friction == "maxwell_slip" and load.bends(device):
        device, method, rtol = device.with_knee(KNEE), "LSODA", KNEE / 1e3
    structure = case.setup.with_device(device)
    run = structure.simulate(
        forces_of(case), times, method=method, rtol=rtol, atol=1e-3 * rtol, max_step=0.02
    )
    return run_of(structure, run)


def stepped(case: Case, step: float, phase: float) -> ValidationRun:
    """The reference's equations by classical Runge-Kutta steps, at the sample times.

    Parameters
    ----------
    case
        What to run.
    step
        Size of a step [s].
    phase
        Where the steps stand between two samples: the first is `phase * step` long, 0 to 1, and
        the last one makes up for it.
    """
    structure = case.setup.with_device(case.reference_device())
    forces, times = forces_of(case), case.times
    sizes = np.full(round(SAMPLE / step), step)
    if phase:
        sizes = np.concatenate(([phase * step], sizes[1:], [(1.0 - phase) * step]))
    path = np.zeros((times.size, structure.nstate))
    state = path[0].copy()
    with np.errstate(over="raise", invalid="raise"):
        for row, start in enumerate(times[:-1], 1):
            t = float(start)
            for h in sizes.tolist():
                state = _classical(structure, forces, t, state, h)
                t += h
            path[row] = state
    # the reference's own reading of a path of states
    return run_of(structure, structure._run(times, path, forces))


def forces_of(case: Case) -> Callable[[float], Array]:
    """Generalised forces of the inputs: time [s] -> (nq,)."""
    signals = case.signals()
    parts = [(case.setup.inputs[name].push, drive) for name, drive in signals.items()]
    size = len(case.setup.structure.mass)

    def forces(t: float) -> Array:
        found = np.zeros(size)
        for push, drive in parts:
            found += push * drive(t)
        return found

    return forces


def run_of(structure: Structure, run: StructureRun) -> ValidationRun:
    """A run of the reference in the words of the comparison."""
    force: list[Array] = []
    energy: list[Array] = []
    motion: list[tuple[Array, Array]] = []
    state: dict[tuple[int, str], Array] = {}
    for i, strut in enumerate(structure.struts):
        if strut.layout == "S1":
            continue
        device, states = strut.device, run.device_states[i]
        x, v = run.device_displacement[:, i], run.device_velocity[:, i]
        force.append(run.device_force[:, i])
        motion.append((x, v))
        stored = device.stored_energy(x, v, device.state_argument(states))
        energy.append(np.broadcast_to(np.asarray(stored, dtype=np.float64), x.shape))
        for column, name in enumerate(device.state_names):
            state[i, name] = states[:, column]
    nothing = np.empty((run.time.size, 0))
    return ValidationRun(
        time=run.time,
        displacement=run.position,
        velocity=run.velocity,
        force=np.column_stack(force) if force else nothing,
        state=state,
        energy=np.column_stack(energy) if energy else nothing,
        device_motion=(
            np.column_stack([x for x, _ in motion]) if motion else nothing,
            np.column_stack([v for _, v in motion]) if motion else nothing,
        ),
    )


def force_change(case: Case, true: ValidationRun, displacement: float, velocity: float) -> float:
    """By how much the devices' forces differ at most for a motion that is off, relative.

    Parameters
    ----------
    case, true
        A case and its run by `truth`.
    displacement, velocity
        By how much the model's coordinates are off, relative to their largest values.
    """
    if true.device_motion is None or not true.force.size:
        return 0.0
    structure = case.setup.with_device(case.reference_device())
    reach = np.abs(structure.directions)
    slack = [
        size * np.abs(part).max(axis=0) @ reach
        for size, part in ((displacement, true.displacement), (velocity, true.velocity))
    ]
    worst = 0.0
    for i, strut in enumerate(structure.struts):
        device, force = strut.device, true.force[:, i]
        x, v = (part[:, i] for part in true.device_motion)
        states = [true.state[i, name] for name in device.state_names]
        z = device.state_argument(np.column_stack(states) if states else np.empty((x.size, 0)))
        # what goes through the inertance branch, with the load friction taken off
        beside = device.rest_force(x, v, z)
        loaded = force - beside
        carried = loaded / (1.0 + device.load_share(v, loaded, z) * np.sign(loaded))
        for dx in (-slack[0][i], slack[0][i]):
            for dv in (-slack[1][i], slack[1][i]):
                moved = device.rest_force(x + dx, v + dv, z)
                moved = moved + carried + device.load_share(v + dv, carried, z) * np.abs(carried)
                worst = max(worst, float(np.abs(moved - force).max() / np.abs(force).max()))
    return worst


def _classical(
    structure: Structure, forces: Callable[[float], Array], t: float, state: Array, h: float
) -> Array:
    """One step; a play that the step has overrun is put back to its edge."""
    middle = forces(t + 0.5 * h)
    first = structure.rates(state, forces(t))
    second = structure.rates(state + 0.5 * h * first, middle)
    third = structure.rates(state + 0.5 * h * second, middle)
    fourth = structure.rates(state + h * third, forces(t + h))
    after: Array = state + h / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
    for clutch in structure.clutches:
        edge = clutch.device.backlash
        after[clutch.gap_index] = min(edge, max(-edge, after[clutch.gap_index]))
    return after
