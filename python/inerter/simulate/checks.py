"""What can go wrong in a run: divergence ends it, the rest is told."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import mujoco
import numpy as np

from inerter.engine_errors import SimulationError
from inerter.simulate.inputs import Inputs
from inerter.simulate.load import integrator_name
from inerter.simulate.sample import DeviceRun

_LARGE = 1e8  # of a position or velocity in SI units: the run has diverged
_SITE = mujoco.mjtWrap.mjWRAP_SITE


def refuse_divergence(model: mujoco.MjModel, data: mujoco.MjData, t0: float) -> None:
    """End a run whose state is no longer finite, or beyond anything physical."""
    largest = max(np.abs(data.qvel).max(initial=0.0), np.abs(data.qpos).max(initial=0.0))
    if largest < _LARGE and np.isfinite(data.act).all():
        return
    # the first dof that is out of bounds
    bad = np.flatnonzero(~(np.abs(data.qvel) < _LARGE))
    joint = int(model.dof_jntid[bad[0]]) if bad.size else -1
    name = model.joint(joint).name if joint >= 0 else ""
    where = f"; joint {name!r} is the first" if name else ""
    advice = f"shorten the step (--timestep {model.opt.timestep / 4:g})"
    if integrator_name(model) not in ("implicit", "implicitfast", "discrete"):
        advice += " or take --integrator implicitfast"
    raise SimulationError(
        f"the simulation diverged at t = {float(data.time) - t0:.6g} s with "
        f"{integrator_name(model)} and a time step of {model.opt.timestep:g} s{where}; {advice}. "
        "Nothing was written"
    )


@contextmanager
def engine_warnings() -> Iterator[dict[str, None]]:
    """Collect what the engine and the plugin warn of, in order and once.

    Otherwise the engine prints it and leaves a MUJOCO_LOG.TXT where it runs.
    """
    found: dict[str, None] = {}
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda text: found.setdefault(" ".join(text.split())))
    try:
        yield found
    finally:
        mujoco.set_mju_user_warning(before)


_WARNINGS = {
    mujoco.mjtWarning.mjWARN_INERTIA: "the inertia matrix was nearly singular",
    mujoco.mjtWarning.mjWARN_CONTACTFULL: "there were more contacts than memory",
    mujoco.mjtWarning.mjWARN_CNSTRFULL: "there were more constraints than memory",
    mujoco.mjtWarning.mjWARN_BADCTRL: "a control was not finite and was taken as 0",
}


def warnings_of(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    devices: Sequence[DeviceRun],
    inputs: Inputs | None,
) -> list[str]:
    """Sentences on what the engine and the inputs have to tell after a run."""
    found = [text for kind, text in _WARNINGS.items() if data.warning[kind].number]
    if inputs and inputs.ignored:
        found.append(f"columns that drive nothing were left aside: {', '.join(inputs.ignored)}")

    if devices and not any(np.ptp(device.columns["displacement"]) for device in devices):
        found.append(
            "no device moved; start from another state (--keyframe) or drive the model (--control)"
        )

    # the engine knows no velocity of mocap bodies
    moved = {body for body, _ in inputs.mocap} if inputs else set()
    for device in devices:
        if moved & set(_mocap_bodies(model, device.place.actuator)):
            found.append(
                f"device {device.place.name!r} is fixed to a mocap body, which has no velocity for "
                "MuJoCo: its damping and inertance do not feel that body move; give it a joint and "
                "drive the joint"
            )
    return found


def _mocap_bodies(model: mujoco.MjModel, actuator: int) -> list[int]:
    """Mocap indices of the bodies that a device's tendon passes."""
    if model.actuator_trntype[actuator] != mujoco.mjtTrn.mjTRN_TENDON:
        return []
    tendon = int(model.actuator_trnid[actuator, 0])
    first = int(model.tendon_adr[tendon])
    part = range(first, first + int(model.tendon_num[tendon]))
    sites = [int(model.wrap_objid[k]) for k in part if model.wrap_type[k] == _SITE]
    roots = [int(model.body_rootid[model.site_bodyid[site]]) for site in sites]
    return [int(model.body_mocapid[body]) for body in roots if model.body_mocapid[body] >= 0]
