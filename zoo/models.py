"""The MJCF files of the packages, and how one becomes a model to draw devices into."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np


class NoModelError(Exception):
    """A file that the engine compiles no model with a degree of freedom from: a part of another."""


def found_in(folders: list[Path]) -> list[tuple[str, Path]]:
    """(package, file) of every MJCF file below the folders, in a fixed order.

    The package is the first folder below the one given, or that folder itself.
    """
    found = []
    for folder in folders:
        for path in sorted(folder.rglob("*.xml")):
            text = path.read_bytes()
            if b"<mujoco" in text and b"<mujocoinclude" not in text:
                below = path.relative_to(folder).parts
                found.append((below[0] if len(below) > 1 else folder.name, path))
    return found


def bare(path: Path) -> tuple[mujoco.MjSpec, mujoco.MjModel]:
    """The spec and the model of a file, as its authors wrote it; bodies without a name get one.

    Raises
    ------
    NoModelError
        It does not compile by itself, or nothing in it moves.
    """
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        for number, body in enumerate(spec.bodies):
            if not body.name:
                body.name = f"unnamed_{number}"
        model = spec.copy().compile()
    except (ValueError, mujoco.FatalError) as error:
        raise NoModelError(" ".join(str(error).split())[:160]) from None
    if not model.nv:
        raise NoModelError("nothing moves in it")
    return spec, model


def started(model: mujoco.MjModel, rng: np.random.Generator, steps: int) -> mujoco.MjData:
    """A state of the bare model: its first keyframe or pose, some steps with random controls.

    Raises
    ------
    NoModelError
        The bare model does not run: it diverges by itself.
    """
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    low, high = model.actuator_ctrlrange.T if model.nu else (np.zeros(0), np.zeros(0))
    free = low >= high
    data.ctrl[:] = np.where(
        free, 0.1 * rng.standard_normal(model.nu), rng.uniform(low, np.where(free, low, high))
    )
    mujoco.mj_step(model, data, steps)
    if bad(data) or np.abs(data.qvel).max() > 1e3:
        raise NoModelError("the bare model diverges within some steps")
    return data


def bad(data: mujoco.MjData) -> bool:
    """Whether the engine has warned of numbers that cannot be."""
    kinds = mujoco.mjtWarning
    wrong = (kinds.mjWARN_BADQPOS, kinds.mjWARN_BADQVEL, kinds.mjWARN_BADQACC)
    return any(data.warning[int(kind)].number for kind in wrong) or not np.isfinite(data.qvel).all()
