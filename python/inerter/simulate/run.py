"""Runs a model file: loads it, drives it, steps it and samples it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.engine_errors import SimulationError
from inerter.simulate.checks import engine_warnings, refuse_divergence, warnings_of
from inerter.simulate.inputs import Inputs, read_inputs
from inerter.simulate.load import integrator_name, load_model, start
from inerter.simulate.sample import DeviceRun, Sampler
from inerter.simulate.tyres import pulling

Array = NDArray[np.float64]
Progress = Callable[[float], None]

DEFAULT_DURATION = 10.0
DEFAULT_RATE = 1000.0
MAX_SAMPLES = 2_000_000
MAX_STEPS = 10**9  # at 1e6 steps a second, and no model is faster, a quarter of an hour


@dataclass(frozen=True, kw_only=True)
class SimulatedRun:
    """A finished run.

    time: [s], (samples,). vehicle: columns of a vehicle record, empty where the model has none.
    joints: position of slide and hinge joints by name. frames: (time, integration state) for a
    video. wall: [s]. warnings: sentences.
    """

    path: Path
    model: mujoco.MjModel
    time: Array
    every: int
    devices: list[DeviceRun]
    vehicle: dict[str, Array]
    joints: dict[str, Array]
    frames: list[Array]
    wall: float
    inputs: Inputs | None = None
    warnings: list[str] = field(default_factory=list)

    @property
    def integrator(self) -> str:
        """The integrator as MJCF spells it."""
        return integrator_name(self.model)


def run_model(
    path: Path,
    duration: float | None = None,
    *,
    timestep: float | None = None,
    integrator: str | None = None,
    keyframe: str | None = None,
    control: Path | None = None,
    rate: float | None = None,
    frame_rate: float = 0.0,
    progress: Progress = lambda share: None,
) -> SimulatedRun:
    """Run a model file.

    Parameters
    ----------
    path : Path
        MJCF or .mjb.
    duration : float, optional
        [s]; the default is the length of `control`, else 10 s.
    timestep, integrator : optional
        In place of the model's.
    keyframe : str, optional
        Name or index of the keyframe to start from.
    control : Path, optional
        Table of inputs, see `inputs.py`.
    rate : float, optional
        Samples per second; rounded to a whole number of steps. The default is at most 1000 Hz.
    frame_rate : float
        Frames per second to keep for a video; 0 for none.
    progress : callable
        Told the share of the run that is done, 0 to 1.

    Raises
    ------
    SimulationError
        The model or the inputs cannot be used, or the run diverges.
    """
    with engine_warnings() as warned:
        model = load_model(path, timestep, integrator)
        plan = _plan(model, duration, rate, keyframe, control)
        run = _march(path, plan, frame_rate, progress)
    return replace(run, warnings=[*run.warnings, *warned])


@dataclass
class _Plan:
    """Start, inputs, number of steps, and of steps between samples."""

    data: mujoco.MjData
    inputs: Inputs | None
    steps: int
    every: int


def _plan(
    model: mujoco.MjModel,
    duration: float | None,
    rate: float | None,
    keyframe: str | None,
    control: Path | None,
) -> _Plan:
    data = start(model, keyframe)
    inputs = read_inputs(control, model) if control else None
    if inputs:
        inputs.outweigh(model)
    if duration is None:
        duration = inputs.duration if inputs else DEFAULT_DURATION
    if not 0 < duration < 1e9:
        raise SimulationError(f"--duration is {duration:g}: give seconds above 0, below 1e9")
    h = float(model.opt.timestep)
    if duration / h > MAX_STEPS:
        raise SimulationError(
            f"{duration:g} s are {duration / h:.3g} time steps of {h:g} s, at most {MAX_STEPS:g} "
            "are made; give a shorter --duration, or a longer --timestep"
        )
    steps, every = round(duration / h), _every(h, rate)
    if steps < 1:
        raise SimulationError(f"--duration {duration:g} s is shorter than a time step of {h:g} s")
    if steps // every + 1 > MAX_SAMPLES:
        raise SimulationError(
            f"{steps // every + 1} samples are too many to keep (at most {MAX_SAMPLES}); "
            f"shorten --duration or lower --rate ({1 / (h * every):g} Hz now)"
        )
    return _Plan(data, inputs, steps, every)


def _march(path: Path, plan: _Plan, frame_rate: float, progress: Progress) -> SimulatedRun:
    """Step from the start to the end."""
    data, inputs, steps, every = plan.data, plan.inputs, plan.steps, plan.every
    model = data.model
    h = float(model.opt.timestep)
    sampler = Sampler(model, steps // every + 1)
    frame_every = max(1, round(1 / (frame_rate * h))) if frame_rate else 0
    frames: list[Array] = []

    # inputs are held over a step: RK4 wants them at its middle; the others take a step from the
    # middle of one interval to the middle of the next, about its beginning
    ahead = 0.5 * h if model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4 else 0.0
    began, shown, t0 = time.perf_counter(), 0.0, float(data.time)
    for step in range(steps + 1):
        # a sample is of this instant, and is completed after the step that follows
        t = step * h
        sampled, framed = step % every == 0, frame_every and step % frame_every == 0
        if inputs and (sampled or framed or not ahead):
            inputs.apply(model, data, t, 0.0)
        if sampled:
            sampler.begin(data)
        if framed:
            frames.append(sampler.state_of(data))
        if inputs and ahead:
            inputs.apply(model, data, t, ahead)
        mujoco.mj_step(model, data)
        refuse_divergence(model, data, t0)
        if sampled:
            sampler.take(data.qvel, inputs.imposed(model, t) if inputs else ([], []))
        if step % 64 == 0 and time.perf_counter() - shown > 0.1:
            shown = time.perf_counter()
            progress(step / steps)
    progress(1.0)

    # the engine adds up its time with rounding errors
    instants = np.asarray([round(t0 + h * every * k, 12) for k in range(steps // every + 1)])
    devices = sampler.devices(instants)
    vehicle = sampler.vehicle.columns(instants)
    if inputs and vehicle:
        vehicle |= inputs.heights(model, instants - t0)
    return SimulatedRun(
        path=path,
        model=model,
        time=instants,
        every=every,
        devices=devices,
        vehicle=vehicle,
        joints=sampler.joints(),
        frames=frames,
        wall=time.perf_counter() - began,
        inputs=inputs,
        warnings=[*warnings_of(model, data, devices, inputs), *pulling(model, vehicle)],
    )


def _every(h: float, rate: float | None) -> int:
    if rate is not None and not 0 < rate < 1e9:
        raise SimulationError(f"--rate is {rate:g}: give samples per second > 0")
    # the default: the first whole number of steps that is not above the rate
    if rate is None:
        return max(1, int(np.ceil(1 / (DEFAULT_RATE * h) - 1e-9)))
    return max(1, round(1 / (rate * h)))
