"""What goes wrong for reasons that the user can change, under the name that commands know."""

from inerter.engine_errors import SimulationError, engine_text

__all__ = ["SimulationError", "engine_text"]
