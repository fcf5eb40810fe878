"""A run as a video: rendered by MuJoCo, written as GIF or MP4 (ffmpeg)."""

from __future__ import annotations

import contextlib
import itertools
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.engine_errors import SimulationError
from inerter.staging import Staging, to_disk

FRAME_RATE = 25  # frames per second; a GIF counts in hundredths of a second
WIDTH, HEIGHT = 640, 480
_STATE = mujoco.mjtState.mjSTATE_INTEGRATION

Image = NDArray[np.uint8]


def refuse_video(path: Path) -> None:
    """Raise where a video cannot be made, before the run.

    Raises
    ------
    SimulationError
        An extension other than .gif and .mp4, no ffmpeg, no OpenGL; says what to do.
    """
    kind = path.suffix.lower()
    if kind not in (".gif", ".mp4"):
        raise SimulationError(f"--video is {path}: give a name that ends in .gif or .mp4")
    if kind == ".mp4" and shutil.which("ffmpeg") is None:
        raise SimulationError(
            f"--video {path}: ffmpeg is not installed; install it or write a .gif"
        )
    parent = path.absolute().parent
    if not parent.is_dir() or not os.access(parent, os.W_OK):
        raise SimulationError(f"--video {path}: the folder {parent} cannot be written")
    with renderer(mujoco.MjModel.from_xml_string("<mujoco/>"), 16, 16, "--video"):
        pass


def write_video(
    model: mujoco.MjModel,
    states: Sequence[NDArray[np.float64]],
    path: Path,
    progress: Callable[[float], None] = lambda share: None,
) -> None:
    """Write a video of integration states, FRAME_RATE frames per second.

    The view is the model's first camera, or the free camera. The file is replaced as a whole.

    Raises
    ------
    SimulationError
        No OpenGL, or ffmpeg fails.
    OSError
        The file cannot be written.
    """
    with Staging(path.absolute().parent) as staging:
        write = _write_gif if path.suffix.lower() == ".gif" else _write_mp4
        write(_frames(model, states, progress), staging.new / path.name)
        to_disk(staging.new / path.name)
        staging.exchange([path.name])


def _frames(
    model: mujoco.MjModel,
    states: Sequence[NDArray[np.float64]],
    progress: Callable[[float], None],
) -> Iterator[Image]:
    data = mujoco.MjData(model)
    width = min(WIDTH, model.vis.global_.offwidth)
    height = min(HEIGHT, model.vis.global_.offheight)
    with renderer(model, width, height, "--video") as picture:
        for i, state in enumerate(states):
            mujoco.mj_setState(model, data, state, _STATE)
            mujoco.mj_forward(model, data)
            picture.update_scene(data, camera=0 if model.ncam else -1)
            yield picture.render()
            progress((i + 1) / len(states))


@contextlib.contextmanager
def renderer(model: mujoco.MjModel, width: int, height: int, what: str) -> Iterator[Any]:
    """An off-screen renderer; without a display, by EGL unless MUJOCO_GL says otherwise.

    Raises
    ------
    SimulationError
        No OpenGL works here; `what` needs it, and what to do.
    """
    headless = not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
    try:
        if sys.platform == "linux" and headless and not os.environ.get("MUJOCO_GL"):
            from mujoco import egl
            from mujoco.rendering.classic import gl_context

            gl_context.GLContext = egl.GLContext
        found = mujoco.Renderer(model, height, width)
    except Exception as error:
        raise SimulationError(
            f"{what} needs OpenGL, and none works here ({error}); on a machine without a display "
            "install EGL (Debian: libegl1 libgl1-mesa-dri) and set MUJOCO_GL=egl, or leave it out"
        ) from None
    try:
        yield found
    finally:
        found.close()


def _write_gif(frames: Iterator[Image], path: Path) -> None:
    from matplotlib.animation import PillowWriter
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    # a figure that is nothing but the picture, pixel by pixel
    first = next(frames)
    height, width, _ = first.shape
    figure = Figure(figsize=(width / 100, height / 100), dpi=100)
    FigureCanvasAgg(figure)
    picture = figure.figimage(first)
    writer = PillowWriter(fps=FRAME_RATE)
    with writer.saving(figure, str(path), dpi=100):
        for frame in itertools.chain([first], frames):
            picture.set_data(frame)
            writer.grab_frame()


def _write_mp4(frames: Iterator[Image], path: Path) -> None:
    first = next(frames)
    size = f"{first.shape[1]}x{first.shape[0]}"
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
               "-s", size, "-r", str(FRAME_RATE), "-i", "-", "-an", "-pix_fmt", "yuv420p",
               str(path)]  # fmt: skip
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdin is not None
        assert process.stderr is not None
        with contextlib.suppress(BrokenPipeError):
            process.stdin.write(first.tobytes())
            for frame in frames:
                process.stdin.write(frame.tobytes())
            process.stdin.close()
        text = process.stderr.read().decode(errors="replace")
    if process.returncode:
        raise SimulationError(f"ffmpeg could not write the video: {text}")
