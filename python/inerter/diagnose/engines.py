"""The extended device simulated again, in each engine, along the measured motion."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter import rig
from inerter.core import Device
from inerter.exudyn.engine import installed
from inerter.identify.between import about_samples, between, quintics
from inerter.identify.channel import through_channel
from inerter.identify.forgetting import Forgetting
from inerter.identify.model import Model
from inerter.identify.prediction import (
    begin,
    felt_beside,
    settled,
    with_friction_drift,
    with_late_motion,
)
from inerter.identify.runs import BenchRun, from_first, held
from inerter.parallel_steps import parallel
from inerter.reference import Motion, ReferenceDevice, response

Array = NDArray[np.float64]
Along = Callable[[Device, BenchRun, Any], dict[str, Array]]

# shortest step [s] of a device with free play, and steps per sample at most: half as long changes
# nothing where an impact hardly comes, in either engine
PLAY_STEP, PLAY_PARTS = 3e-5, 32
# steps of a run at most where a bristle asks for more of them: a minute of Exudyn, which with fewer
# may diverge and say nothing
MOST_STEPS = 80_000
# steps from which on the engines run at the same time
_LONG = 100_000
# an error this many times the force is that of a simulation which has run away
RUN_AWAY = 10.0
# what an error of a per cent needs is far less; and how often the reference may ask for the
# velocity, half a minute of stiff bristles
_EXACT, _MOST_CALLS = 1e-6, 1_000_000


def simulate_engines(
    model: Model, runs: Sequence[BenchRun], masks: Sequence[NDArray[np.bool_]]
) -> dict[str, float | None]:
    """Rms force error [N] of each engine over the masked samples.

    None: Exudyn is not installed, or Exudyn or the reference cannot follow this device along this
    motion (a bristle too stiff for the samples, a friction level that reaches zero).
    """

    def of(name: str) -> float | None:
        return _of_engine(name, model, runs, masks)

    # the slowest first
    names = ["reference", "mujoco", "exudyn"]
    # of short runs another process would take longer to begin
    steps = PLAY_PARTS if "backlash" in model.values else 1
    long = steps * sum(run.force.size for run in runs) > _LONG
    errors = dict(zip(names, parallel(of, names) if long else map(of, names), strict=True))
    return {name: errors[name] for name in ("mujoco", "exudyn", "reference")}


def _of_engine(
    name: str, model: Model, runs: Sequence[BenchRun], masks: Sequence[NDArray[np.bool_]]
) -> float | None:
    if name == "mujoco":
        with rig.quiet():
            return _error(_mujoco, model, runs, masks)
    if name == "exudyn" and not installed():
        return None
    try:
        return _error(_exudyn if name == "exudyn" else _reference, model, runs, masks, RUN_AWAY)
    except (ValueError, RuntimeError):
        return None


def _error(
    along: Along,
    model: Model,
    runs: Sequence[BenchRun],
    masks: Sequence[NDArray[np.bool_]],
    most: float = np.inf,
) -> float:
    """Rms error [N]; ValueError if a force is not finite, or the error `most` times the force."""
    device = model.device()
    square, whole, count = 0.0, 0.0, 0
    for run, mask in zip(runs, masks, strict=True):
        if not mask.any():
            continue
        moved, values = with_late_motion(model, run)

        begins = begin(device, moved, values)

        def forces(each: Device, run: BenchRun = moved, begins: Any = begins) -> dict[str, Array]:
            found = along(each, from_first(run), begins)
            return {name: held(force, run.force.size) for name, force in found.items()}

        drift = values.get("friction_drift", 0.0)
        force = with_friction_drift(device, drift, forces, run.elapsed)
        motion = moved.displacement, moved.velocity, moved.acceleration
        force = force + felt_beside(device, values, motion, run.elapsed)
        if not np.all(np.isfinite(force)):
            raise ValueError("the force is not finite")
        shown = through_channel(values, force, run.elapsed - run.zero, run.spacing)
        residual = settled(model, run, run.force - shown, mask & run.inner)
        square += float(np.sum(residual[mask] ** 2))
        whole += float(np.sum(run.force[mask] ** 2))
        count += int(mask.sum())
    if square > most**2 * whole:
        raise ValueError("the force has run away")
    return float(np.sqrt(square / count))


def _mujoco(device: Device, run: BenchRun, state: Any) -> dict[str, Array]:
    parts, channels = _steps(device, run)
    step, every = run.spacing / parts, parts if run.instants == 1 else 1
    found = rig.simulate_along(device, step, *channels, state, run.motion, every)
    return _at_samples(run, found, parts // every)


def _exudyn(device: Device, run: BenchRun, state: Any) -> dict[str, Array]:
    from inerter.exudyn.rig import simulate_along

    parts, channels = _steps(device, run, Forgetting.of(device).reach)
    step, every = run.spacing / parts, parts if run.instants == 1 else 1
    found = simulate_along(device, step, *channels, state, every=every, motion=run.motion)
    return _at_samples(run, found, parts // every)


def _steps(device: Device, run: BenchRun, reach: float = 0.0) -> tuple[int, tuple[Any, Any, Any]]:
    """Steps per sample, and the motion at them; behind a play many, for when the flywheel lands.

    Where there is a bristle no step is longer than its `reach` [m], as far as so many are allowed.
    """
    channels = run.displacement, run.velocity, run.acceleration
    parts = run.instants
    if reach:
        path = float(np.max(np.abs(run.velocity))) * run.spacing / parts
        most = min(PLAY_PARTS, MOST_STEPS // run.force.size)
        parts *= max(1, min(math.ceil(path / reach), most // parts))
    if device.backlash:
        parts = min(PLAY_PARTS, math.ceil(run.spacing / PLAY_STEP))
    return parts, between(run.spacing, channels, parts) if parts > 1 else channels


def _at_samples(run: BenchRun, found: Mapping[str, Array], parts: int) -> dict[str, Array]:
    """Forces of some steps per sample as the run's samples show them."""
    if run.instants > 1:
        return about_samples(found, parts)
    return {name: found[name][::parts] for name in ("total", "friction")}


def _reference(device: Device, run: BenchRun, state: Any) -> dict[str, Array]:
    parts = run.instants
    times = run.spacing / parts * np.arange(parts * (run.displacement.size - 1) + 1)
    given: dict[str, Any] = device.given
    reference, motion = ReferenceDevice(**given), _motion(run)
    found = response(reference, motion, times, initial_state=state, rtol=_EXACT)
    states = reference.state_argument(found.states) if reference.nstate else 0.0
    friction = reference.friction_force(
        found.displacement, found.velocity, states, a=found.acceleration
    )
    return _at_samples(run, {"total": found.force, "friction": np.asarray(friction)}, parts)


def _motion(run: BenchRun) -> Motion:
    """The recorded motion between its samples: the quintic through x, v and a of both."""
    h, last = run.spacing, run.displacement.size - 2
    rows = quintics(h, run.displacement, run.velocity, run.acceleration)
    table = rows.tolist()

    def piece(t: Any) -> tuple[Any, Any]:
        if isinstance(t, float):
            row = min(max(int(t / h + 1e-9), 0), last)
            return table[row], t - row * h
        row = np.clip((np.asarray(t) / h + 1e-9).astype(int), 0, last)
        return rows[row].T, t - row * h

    def displacement(t: Any) -> Any:
        c, u = piece(t)
        return c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5]))))

    calls = 0

    def velocity(t: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls > _MOST_CALLS:
            raise RuntimeError("the reference takes too long along this motion")
        c, u = piece(t)
        return c[1] + u * (2.0 * c[2] + u * (3.0 * c[3] + u * (4.0 * c[4] + u * 5.0 * c[5])))

    def acceleration(t: Any) -> Any:
        c, u = piece(t)
        return 2.0 * c[2] + u * (6.0 * c[3] + u * (12.0 * c[4] + u * 20.0 * c[5]))

    return Motion(displacement, velocity, acceleration)
