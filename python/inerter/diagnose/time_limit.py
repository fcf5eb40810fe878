"""How long causes are searched for; what was found until then is judged and reported."""

from __future__ import annotations

import time

import numpy as np


class OverTimeError(Exception):
    """The time is over amid a step, of which nothing is known then."""


class TimeLimit:
    """Time that a search may take, counted from when it is made.

    Attributes
    ----------
    seconds : float
        The time [s]; infinite for none.
    was_felt : bool
        Whether something was left out because the time was over.
    """

    def __init__(self, seconds: float = np.inf) -> None:
        if not seconds > 0:
            raise ValueError(f"--time-limit is {seconds:g} s; give more than 0 s")
        self.seconds = seconds
        self.was_felt = False
        self._ends = time.monotonic() + seconds

    def is_over(self) -> bool:
        """Whether to leave out what is only asked to find more, or to be surer."""
        over = time.monotonic() >= self._ends
        self.was_felt = self.was_felt or over
        return over

    def check(self) -> None:
        """Amid a step: raise OverTimeError where it is over."""
        if time.monotonic() >= self._ends:
            self.was_felt = True
            raise OverTimeError

    def tried(self, summary: str) -> str:
        """A summary of what remains, which claims no more than was tried in the time."""
        known, tried = "No effect that is known here", "No effect that was tried in the time given"
        return summary.replace(known, tried) if self.was_felt else summary

    def in_words(self, without_rivals: int) -> str:
        """What it has cost, in two sentences; findings that were not compared with their rivals."""
        if not self.was_felt:
            return ""
        text = (
            f"The search ended after the {self.seconds:g} s of --time-limit: what it had not come "
            "to is not named, and may be in what remains."
        )
        if not without_rivals:
            return text
        which = "A finding was" if without_rivals == 1 else f"{without_rivals} findings were"
        return (
            f"{text} {which} not compared with what else could explain the data: no confidence of "
            "such a one is above 0.5."
        )
