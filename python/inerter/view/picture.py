"""A picture instead of a window: the scene at the end of a run, and a device's loops."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.engine_errors import SimulationError
from inerter.folder import write_files
from inerter.simulate.checks import engine_warnings
from inerter.simulate.video import renderer
from inerter.view.loop import Axes, Loop, instant
from inerter.view.session import Session
from inerter.view.shake import Shake

WIDTH, HEIGHT = 640, 480
DIVERGED = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
    mujoco.mjtWarning.mjWARN_BADCTRL,
)


def run_loop(
    session: Session, device: str, shake: Shake | None, seconds: float, shown: float
) -> Loop:
    """Run a session, and keep the last seconds of a device's motion and force.

    Raises
    ------
    SimulationError
        The run diverges.
    """
    model, data, place = session.model, session.data, session.devices[device]
    steps = round(seconds / model.opt.timestep)
    loop = Loop(min(steps, round(shown / model.opt.timestep)) + 1)
    for _ in range(steps):
        if shake:
            shake.apply(model, data)
        mujoco.mj_step(model, data)
        loop.append(*instant(place, model, data))
        if any(data.warning[int(kind)].number for kind in DIVERGED):
            raise SimulationError(
                f"{session.path}: the run diverged; shake it less, or take a smaller time step"
            )
    return loop


def render(model: mujoco.MjModel, data: mujoco.MjData) -> NDArray[np.uint8]:
    """The scene, (height, width, 3), from the model's first camera or the free one.

    Raises
    ------
    SimulationError
        No OpenGL works here.
    """
    width = min(WIDTH, int(model.vis.global_.offwidth))
    height = min(HEIGHT, int(model.vis.global_.offheight))
    with renderer(model, width, height, "a picture of the scene") as picture:
        mujoco.mj_forward(model, data)
        picture.update_scene(data, camera=0 if model.ncam else -1)
        return picture.render()


def write_picture(
    session: Session, device: str, shake: Shake | None, path: Path, seconds: float, shown: float
) -> list[str]:
    """Run a session and write scene and loops as PNG; what there is to say about it.

    Raises
    ------
    SimulationError
        The run diverges, or the name is not one of a PNG.
    OSError
        The file cannot be written.
    """
    from matplotlib.figure import Figure

    if path.suffix.lower() != ".png":
        raise SimulationError(f"--picture is {path}: give a name that ends in .png")
    with engine_warnings() as warnings:
        loop = run_loop(session, device, shake, seconds, shown)
    notes = list(warnings)
    try:
        scene = render(session.model, session.data)
    except SimulationError as error:
        scene = None
        notes.append(f"the loops alone: {error}")

    figure = Figure(figsize=(12 if scene is not None else 8, 4), layout="constrained")
    axes = figure.subplots(1, 2 if scene is None else 3)
    if scene is not None:
        axes[0].imshow(scene)
        axes[0].set_axis_off()
    _, x, v, force = loop.last(shown)
    units = Axes.of(session.motion(device))
    labels = (f"displacement [{units.length}]", f"velocity [{units.speed}]")
    for axis, across, label in zip(axes[-2:], (units.per_length * x, v), labels, strict=True):
        axis.plot(across, force, linewidth=1)
        axis.set(xlabel=label, ylabel=f"{units.force} [{units.newton}]")
        axis.grid(alpha=0.3)
    figure.suptitle(f"{session.path}: {device}", fontsize=10)
    buffer = BytesIO()
    figure.savefig(buffer, format="png", dpi=120)
    write_files(path.absolute().parent, {path.name: buffer.getvalue()})
    return notes
