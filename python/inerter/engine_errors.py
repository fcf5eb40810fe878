"""What goes wrong for reasons that the user can change."""

from __future__ import annotations


class SimulationError(ValueError):
    """A run that cannot be made or has failed; one line: what is wrong, what to do."""

    def __init__(self, message: str) -> None:
        super().__init__(" ".join(message.split()))


# how the engine begins where the file itself, and none that it names, is of no kind that it reads
_NO_MODEL = "could not find decoder for resource"


def engine_text(error: Exception, endings: str = ".xml") -> str:
    """What MuJoCo says, on one line; it repeats what a plugin said.

    endings: of the files to give where it was given another kind.
    """
    if str(error).startswith(_NO_MODEL):
        return f"by its ending this is no model; give a model, {endings}"
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return "; ".join(dict.fromkeys(lines)).removeprefix("Error: ").removeprefix("XML Error: ")
