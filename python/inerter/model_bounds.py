"""Models from strangers: compiled once in a process of their own, with bounds on memory and time.

A model may name any file, and state more than any machine has. What the engine does with that, it
does there, and it is one line here. A small model that names no file and counts nothing is compiled
where it is wanted, at once.
"""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from inerter.input_file import Bound, counted, refuse_special

MEMORY = Bound("INERTER_MOST_MODEL_BYTES", 1 << 30, "bytes")
SECONDS = Bound("INERTER_MOST_MODEL_SECONDS", 10, "seconds")  # of one processor
_PATIENCE = 2  # times that by the clock

# a file without any of it makes a model of its own size: parts from elsewhere, what is repeated or
# made, whole numbers that may be counts
_GROWS = re.compile(
    rb"<(include|replicate|flexcomp|composite|attach|texture|hfield|size|!)|file\w*\s*=|builtin|\0"
    rb"|(?<![0-9.])[0-9]{5,}"
)
_PLAIN_BYTES = 1 << 20
# files that are known to keep the bounds, as they lie on the disk
_known: set[tuple[str, int, int]] = set()


def refuse_unbounded(path: Path) -> None:
    """Refuse a model whose compilation takes too much memory or time, or ends the process.

    Parameters
    ----------
    path : Path
        MJCF, URDF or a compiled .mjb.

    Raises
    ------
    ValueError
        It is refused: one line says what was met, and how to raise the bound. A model that does not
        compile is refused with the engine's words.
    OSError
        It is not there, may not be looked at, or is a folder, a pipe or a device.
    """
    size = refuse_special(path)
    state = (os.path.abspath(path), size, path.stat().st_mtime_ns)
    # a car file is bounded by its reader
    if (
        path.suffix.lower() == ".toml"
        or state in _known
        or _is_shipped(path)
        or _is_plain(path, size)
    ):
        return
    _refuse_special_parts(path)
    _compile_apart(path)
    _known.add(state)


def refuse_not_a_number(model: Any) -> None:
    """Refuse a compiled model that states what is no number: the engine would let it travel.

    Raises
    ------
    ValueError
        Names the first field, and whose it is.
    """
    found = [(owner, field) for owner, field in _fields(model) if np.isnan(_of(owner, field)).any()]
    if not found:
        return
    # what the engine computes comes last: its cause is better named
    owner, field = min(found, key=lambda each: each[1].endswith("0"))
    values = np.atleast_1d(_of(owner, field))
    index = int(np.argwhere(np.isnan(values))[0][0])
    whose = f"of {_named(model, field, index)}" if owner is model else "in its <option>"
    advice = (
        "look for masses and sizes too large or too small" if field.endswith("0") else "correct it"
    )
    raise ValueError(f"{field} {whose} is not a number; {advice}")


def _fields(model: Any) -> list[tuple[Any, str]]:
    """What a model has of floating-point numbers: (owner, name)."""
    return [
        (owner, name)
        for owner in (model.opt, model)
        for name in dir(owner)
        if not name.startswith("_") and name != "timestep" and _is_float(getattr(owner, name))
    ]


def _is_float(value: Any) -> bool:
    return isinstance(value, float) or (isinstance(value, np.ndarray) and value.dtype.kind == "f")


def _of(owner: Any, field: str) -> np.ndarray[Any, np.dtype[np.floating[Any]]]:
    return np.asarray(getattr(owner, field))


# the accessors of a model's elements, by how its fields begin
_ACCESSORS = {
    "body": "body", "jnt": "joint", "geom": "geom", "site": "site", "cam": "camera",
    "light": "light", "tendon": "tendon", "actuator": "actuator", "sensor": "sensor",
    "eq": "equality", "key": "key", "mat": "material", "pair": "pair",
}  # fmt: skip


def _named(model: Any, field: str, index: int) -> str:
    kind = _ACCESSORS.get(field.split("_")[0])
    if kind is None:
        return f"the model (place {index})"
    name = getattr(model, kind)(index).name
    return f"{kind} {name!r}" if name else f"{kind} number {index}"


def _is_shipped(path: Path) -> bool:
    from inerter.models import models_folder

    return models_folder() in path.resolve().parents


def _is_plain(path: Path, size: int) -> bool:
    if size > _PLAIN_BYTES or path.suffix.lower() == ".mjb":
        return False
    return not _GROWS.search(path.read_bytes())


_FILES = re.compile(r"""\bfile\w*\s*=\s*["']([^"'\0]+)["']""")
_FOLDERS = re.compile(r"""\b(?:mesh|texture|asset)dir\s*=\s*["']([^"'\0]+)["']""")


def _refuse_special_parts(path: Path) -> None:
    """Refuse pipes and devices that the model itself names; of a part's parts the process tells."""
    if path.suffix.lower() == ".mjb":
        return
    text = path.read_text("utf-8", errors="replace")
    folders = [path.parent, *(path.parent / name for name in _FOLDERS.findall(text))]
    for name in dict.fromkeys(_FILES.findall(text)):
        for folder in folders:
            try:
                refuse_special(folder / name)
            except (FileNotFoundError, IsADirectoryError):
                continue
            except OSError as error:
                raise ValueError(f"it names {name!r}: {error.strerror}") from None


def _compile_apart(path: Path) -> None:
    seconds = SECONDS.most
    command = [sys.executable, "-P", "-m", "inerter.model_bounds", os.path.abspath(path)]
    too_long = (
        f"MuJoCo is not done with it after {seconds} s; a pipe among the files that it names, or "
        f"counts of millions, end so; or set {SECONDS.variable} to more"
    )
    try:
        # the engine leaves its log where it works
        with tempfile.TemporaryDirectory(prefix="inerter") as folder:
            done = subprocess.run(
                [*command, str(MEMORY.most), str(seconds)], stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False, cwd=folder,
                timeout=_PATIENCE * seconds,
                env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
            )  # fmt: skip
    except subprocess.TimeoutExpired:
        raise ValueError(too_long) from None
    if done.returncode == 0:
        answer = json.loads(done.stdout)
        if answer["refused"]:
            raise ValueError(answer["refused"])
    elif done.returncode in (-getattr(signal, "SIGXCPU", 0), -getattr(signal, "SIGKILL", 0)):
        raise ValueError(too_long)
    else:
        raise ValueError(
            "MuJoCo ends the process that compiles it, or needs more than "
            f"{counted(MEMORY.most)} bytes; look at counts, <size>, the sizes of textures and "
            f"height fields, or set {MEMORY.variable} to more"
        )


# --- in the process of its own -----------------------------------------------------------------


def _limit(memory: int, seconds: int) -> None:
    if sys.platform == "win32":
        return
    import resource

    for what, bound in ((resource.RLIMIT_DATA, memory), (resource.RLIMIT_CPU, seconds)):
        hard = resource.getrlimit(what)[1]
        bound = bound if hard == resource.RLIM_INFINITY else min(bound, hard)
        resource.setrlimit(what, (bound, bound))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def main() -> None:
    """Compile one model; the answer is a line of JSON."""
    path, memory, seconds = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    # whatever the engine prints is no answer
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)

    import mujoco

    from inerter.engine_errors import COMPILE_ERRORS, engine_text
    from inerter.plugin import load_plugin

    load_plugin()
    _limit(memory, seconds)
    refused = ""
    try:
        if path.lower().endswith(".mjb"):
            mujoco.MjModel.from_binary_path(path)
        else:
            mujoco.MjSpec.from_file(path).compile()
    except (*COMPILE_ERRORS, mujoco.FatalError) as error:
        refused = engine_text(error, ".xml or .mjb")
        if "memory" in refused:
            refused += f"; {counted(memory)} bytes were given, {MEMORY.variable} gives more"
    print(json.dumps({"refused": refused}), file=answers, flush=True)
    os._exit(0)


if __name__ == "__main__":
    main()
