"""What goes wrong for reasons that the user can change."""

from __future__ import annotations

import re
from pathlib import Path

from inerter.core import names
from inerter.parameter_text import with_suggestion


class SimulationError(ValueError):
    """A run that cannot be made or has failed; one line: what is wrong, what to do."""

    def __init__(self, message: str) -> None:
        super().__init__(" ".join(message.split()))


# what the engine's compiler raises; the last where it runs out of memory
COMPILE_ERRORS = (ValueError, MemoryError, RuntimeError)
_UNKNOWN = "Caught an unknown exception"

# [s] what a model may state; the engine takes any number
TIMESTEPS = (1e-9, 1e3)


def timestep_fault(timestep: float) -> str:
    """What is wrong with a model's time step [s], nothing where it can be run."""
    least, most = TIMESTEPS
    if least <= timestep <= most:
        return ""
    return f"the model's timestep is {timestep:g} s; give one of {least:g} to {most:g} s"


# how the engine begins where the file itself, and none that it names, is of no kind that it reads
_NO_MODEL = "could not find decoder for resource"


def engine_text(error: Exception, endings: str = ".xml") -> str:
    """What MuJoCo says, on one line; it repeats what a plugin said.

    endings: of the files to give where it was given another kind.
    """
    if str(error).startswith(_NO_MODEL):
        return f"by its ending this is no model; give a model, {endings}"
    if str(error).startswith(_UNKNOWN) or isinstance(error, MemoryError):
        return (
            "MuJoCo cannot compile it and does not say why; a model that states more than fits "
            "into memory ends so: look at counts, <size>, the sizes of textures and height fields"
        )
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    text = "; ".join(dict.fromkeys(lines)).removeprefix("Error: ").removeprefix("XML Error: ")
    return text + _meant(text)


def cannot_be_opened(path: Path, error: OSError) -> str:
    """What is said of a model file that is not there, or is none."""
    if isinstance(error, FileNotFoundError):
        return f"{path}: no such file; give a model, .xml or .mjb"
    return f"{path}: cannot be opened ({error.strerror}); give a model, .xml or .mjb"


def _meant(text: str) -> str:
    """For a key of a device that the compiler does not know: which may be meant."""
    found = re.match(r"unrecognized attribute 'plugin:(.*?)' for plugin inerter\.device", text)
    if not found:
        return ""
    return with_suggestion(found[1], "", names())
