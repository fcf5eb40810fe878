"""Signals that end a program: it ends in order, after what may not be broken off."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

# whatever ends a program by default and can be heard; Ctrl-C among them
ENDING = (
    "SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT", "SIGUSR1", "SIGUSR2", "SIGALRM", "SIGVTALRM",
    "SIGPROF", "SIGXCPU", "SIGIO", "SIGPWR", "SIGSTKFLT",
)  # fmt: skip

_heard: list[int] = []
_held = 0


class Ended(KeyboardInterrupt):
    """A signal has come; everything that cleans up after Ctrl-C does so after this too."""


def hear() -> None:
    """Let every signal that ends a program be an `Ended` in its main thread.

    What is ignored already (as by `nohup`) stays ignored.
    """
    for name in ENDING:
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) in (
            signal.SIG_DFL,
            signal.default_int_handler,
        ):
            signal.signal(number, _end)


def heard() -> int | None:
    """The number of the first signal that came."""
    return _heard[0] if _heard else None


def _end(number: int, frame: FrameType | None) -> Any:
    del frame
    _heard.append(number)
    if not _held:
        raise Ended


@contextmanager
def held() -> Iterator[None]:
    """No signal that is heard breaks off what is within; one that came ends the program after it.

    Only the main thread hears signals: elsewhere nothing has to be held.
    """
    global _held
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = len(_heard)
    _held += 1
    try:
        yield
    finally:
        _held -= 1
    if not _held and len(_heard) > before:
        raise Ended
