"""A step of a search on all processors, or on one where others are at work already.

Long tasks that know nothing of each other are run by `inerter.parallel`; here it is closures over
the data, for tenths of a second, many times in a row.
"""

from __future__ import annotations

import os
import warnings
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
from loky import ProcessPoolExecutor, cpu_count
from loky.backend import resource_tracker

from inerter.input_file import whole_number
from inerter.parallel import ONE_THREAD, deaf_children, end_with

S = TypeVar("S")
T = TypeVar("T")

# processors that are used at most: more save less than the memory of a process is worth
MOST = 8
# parts of the work of each, so that none waits long for the last
PARTS = 8
_NOT_SENT = "PicklingError"


@dataclass(frozen=True)
class _Helpers:
    count: int
    pool: ProcessPoolExecutor | None = None


# none: no helpers unless asked for; a count of 0: none, whoever asks
_helpers: ContextVar[_Helpers | None] = ContextVar("helpers", default=None)


def parallel(
    function: Callable[[S], T], items: Iterable[S], cost: Callable[[S], float] | None = None
) -> list[T]:
    """Results in order; within `helped` worked out on all processors.

    What is of the largest `cost`, where one is given, is begun with, so that none waits for it.

    Much of the work is in Python, where threads would wait for each other. So other processes take
    items from the beginning and this one from the end: it need not wait for them to start. The
    function may be a closure; what it holds is copied, and what it changes of that may be lost.
    """
    several = list(items)
    helpers = _helpers.get()
    if helpers is None or helpers.pool is None or len(several) < 2:
        return _each(function, several)
    if cost:
        costs = [cost(item) for item in several]
        order = sorted(range(len(several)), key=lambda i: -costs[i])
        results = parallel(function, [several[i] for i in order])
        return [result for _, result in sorted(zip(order, results, strict=True), key=_place)]
    size = max(1, len(several) // (PARTS * (helpers.count + 1)))
    parts = [several[i : i + size] for i in range(0, len(several), size)]
    with serial():
        found = _Shared(function, parts).worked_out(helpers.pool, helpers.count)
    return [result for part in found for result in part]


@contextmanager
def helped() -> Iterator[None]:
    """Within it, `parallel` has the help of other processes, which end with it.

    There are as many as processors but this one's, LOKY_MAX_CPU_COUNT at most.
    """
    # a text that is no number is an error of loky's, without the name of the variable
    whole_number("LOKY_MAX_CPU_COUNT", 1)
    count = min(cpu_count(), MOST) - 1
    if _helpers.get() or not count:
        yield
        return
    # one that has come to hold much is begun anew, and goes on
    warnings.filterwarnings("ignore", "A worker was restarted", UserWarning, r"loky\.")
    with deaf_children(resource_tracker):
        pool = ProcessPoolExecutor(
            count, env=ONE_THREAD, initializer=_begin, initargs=(os.getpid(),)
        )
        # importing this module will have imported what the work needs
        pool.submit(_each, abs, [])
    token = _helpers.set(_Helpers(count, pool))
    try:
        yield
    finally:
        _helpers.reset(token)
        pool.shutdown(kill_workers=True)


@contextmanager
def serial() -> Iterator[None]:
    """Within it, `parallel` takes one item after another, in this process.

    For what runs in several processes already.
    """
    token = _helpers.set(_Helpers(0))
    try:
        yield
    finally:
        _helpers.reset(token)


def _begin(parent: int) -> None:
    """A process that ends with its parent, and where a prediction may run away as it may there."""
    end_with(parent)
    np.seterr(over="ignore", invalid="ignore")


class _Shared(Generic[S, T]):
    """Parts of some work, each done by whoever is free."""

    def __init__(self, function: Callable[[S], T], parts: list[list[S]]) -> None:
        self.function, self.parts = function, parts
        self.waiting = deque(range(len(parts)))
        self.results: list[Future[list[T]]] = [Future() for _ in parts]

    def worked_out(self, pool: ProcessPoolExecutor, helpers: int) -> list[list[T]]:
        """Results of every part."""
        for _ in range(helpers):
            self._hand_out(pool)
        try:
            while (i := self._taken(self.waiting.pop)) is not None:
                self.results[i].set_result(_each(self.function, self.parts[i]))
            return [self._result(i) for i in range(len(self.parts))]
        finally:
            self.waiting.clear()

    def _result(self, i: int) -> list[T]:
        try:
            return self.results[i].result()
        except Exception as error:
            # the system ended a process, for its memory perhaps; or what was to be sent grew
            # meanwhile, as work goes on and remembers what it worked out
            if isinstance(error, BrokenProcessPool) or type(error).__name__ == _NOT_SENT:
                return _each(self.function, self.parts[i])
            raise

    def _taken(self, take: Callable[[], int]) -> int | None:
        with suppress(IndexError):
            return take()

    def _hand_out(self, pool: ProcessPoolExecutor) -> None:
        """Give a helper the first part that waits; another one when it has done it."""
        i = self._taken(self.waiting.popleft)
        if i is None:
            return

        def received(future: Future[list[T]]) -> None:
            self._hand_out(pool)
            if error := future.exception():
                self.results[i].set_exception(error)
            else:
                self.results[i].set_result(future.result())

        try:
            pool.submit(_each, self.function, self.parts[i]).add_done_callback(received)
        except Exception as error:
            self.results[i].set_exception(error)


def _place(numbered: tuple[int, object]) -> int:
    return numbered[0]


def _each(function: Callable[[S], T], items: list[S]) -> list[T]:
    return [function(item) for item in items]
