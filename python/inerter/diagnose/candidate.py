"""A model to try."""

from __future__ import annotations

from dataclasses import dataclass

from inerter.catalogue.friction import FRICTION
from inerter.identify.model import Model


@dataclass(frozen=True)
class Candidate:
    """A model to try for an effect, with the starting points of its fit.

    `law` tells the forms of one effect apart: friction laws, a stop above or below.
    """

    effect: str
    law: str | None
    starts: tuple[Model, ...]

    @property
    def is_rich(self) -> bool:
        """Whether it is a friction law that is tried only where memory is to be seen."""
        return self.law is not None and self.law in FRICTION and FRICTION[self.law].rich

    @property
    def key(self) -> tuple[object, ...]:
        """What tells it from every other candidate for the same model."""
        start = self.starts[0]
        return self.effect, self.law, start.friction, frozenset(start.free)
