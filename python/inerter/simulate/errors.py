"""What goes wrong for reasons that the user can change."""

from __future__ import annotations


class SimulationError(ValueError):
    """A run that cannot be made or has failed; one line: what is wrong, what to do."""

    def __init__(self, message: str) -> None:
        super().__init__(" ".join(message.split()))


def engine_text(error: Exception) -> str:
    """What MuJoCo says, on one line; it repeats what a plugin said."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return "; ".join(dict.fromkeys(lines)).removeprefix("Error: ").removeprefix("XML Error: ")
