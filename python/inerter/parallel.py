"""Independent pieces of work on several processes, or on a Dask cluster.

Every piece is there in the end, once, in the order in which it was given, with the same numbers
wherever it ran; a worker that dies takes no result with it.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, closing, contextmanager
from importlib.util import find_spec
from multiprocessing import resource_tracker
from types import FrameType
from typing import Any, TypeVar
from uuid import uuid4

from inerter.signals import held

Item = TypeVar("Item")
Result = TypeVar("Result")
Progress = Callable[[float], None]

# libraries' own threads would fight the processes for the processors
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
_ATTEMPTS = 5
_PATIENCE = 20.0


class WorkError(ValueError):
    """Work that cannot be done as asked: names the scheduler or the piece, says what to do."""


def run_all(
    function: Callable[[Item], Result],
    items: Sequence[Item],
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: Progress = lambda share: None,
) -> list[Result]:
    """The function of every item, in their order.

    Parameters
    ----------
    function
        A function at the top of a module, so that another process finds it.
    items
        What it is called with, one at a time.
    jobs
        Processes on this machine: as many as processors if not given; 1 stays in this one.
    scheduler
        Address of a Dask scheduler, such as "tcp://host:8786", whose workers have this package;
        `jobs` does not count then.
    progress
        Called with the share that is done, 0 to 1.

    Raises
    ------
    WorkError
        The scheduler cannot be reached or has no workers, Dask is not installed, or a piece of
        work ended worker after worker.
    Exception
        What the function raises.
    """
    if jobs is not None and jobs < 1:
        raise WorkError(f"jobs: {jobs} must be at least 1")
    if not items:
        return []
    found: dict[int, Result] = {}
    if scheduler is not None:
        source = _on_cluster(function, items, scheduler)
    else:
        source = _on_processes(function, items, min(jobs or os.cpu_count() or 1, len(items)))
    # whoever interrupts the progress ends the processes too, not once the error is forgotten
    with closing(source):
        for number, result in source:
            found[number] = result
            progress(len(found) / len(items))
    return [found[number] for number in range(len(items))]


def _on_processes(
    function: Callable[[Item], Result], items: Sequence[Item], workers: int
) -> Generator[tuple[int, Result]]:
    if workers == 1:
        for number, item in enumerate(items):
            yield number, function(item)
        return
    # a fresh interpreter each: engines do not outlive a fork
    context = multiprocessing.get_context("spawn")
    others = set(multiprocessing.active_children())
    watched = {"initializer": end_with, "initargs": (os.getpid(),)}
    with environment(ONE_THREAD), ExitStack() as start:
        start.enter_context(deaf_children())
        with ProcessPoolExecutor(workers, context, **watched) as pool:
            try:
                waiting = {pool.submit(function, item): n for n, item in enumerate(items)}
                start.close()
                while waiting:
                    # a wait without end would not hear Ctrl-C where another thread gets it
                    done, _ = wait(waiting, timeout=0.2, return_when=FIRST_COMPLETED)
                    for future in done:
                        yield waiting.pop(future), future.result()
            except BrokenProcessPool:
                raise WorkError(
                    "jobs: a process ended without a result; is memory short? Take fewer --jobs"
                ) from None
            except BaseException:
                # whoever interrupts does not wait for the pieces that run
                for worker in set(multiprocessing.active_children()) - others:
                    worker.terminate()
                pool.shutdown(cancel_futures=True)
                raise


def _on_cluster(
    function: Callable[[Item], Result], items: Sequence[Item], address: str
) -> Generator[tuple[int, Result]]:
    if find_spec("distributed") is None:
        raise WorkError(
            "scheduler: Dask is not installed; run `pip install distributed` (the extra `cluster`) "
            "here and on the workers"
        )
    import distributed

    with _client(distributed, address) as client:
        run = uuid4().hex

        def submit(number: int, attempt: int) -> Any:
            # a key of its own: no result of another run or attempt is taken for this one
            key = f"inerter-{run}-{number}-{attempt}"
            return client.submit(function, items[number], key=key, pure=False)

        futures = {submit(number, 0): (number, 0) for number in range(len(items))}
        waiting = distributed.as_completed(list(futures), loop=client.loop)
        for future in waiting:
            number, attempt = futures.pop(future)
            try:
                result = future.result()
            except distributed.KilledWorker:
                # it was on workers that died, perhaps by chance; a few times more
                if attempt + 1 == _ATTEMPTS:
                    raise WorkError(
                        f"scheduler: piece {number} of {len(items)} ended every worker that took "
                        "it; give the workers more memory, or look into their logs"
                    ) from None
                again = submit(number, attempt + 1)
                futures[again] = number, attempt + 1
                waiting.add(again)
                continue
            future.release()
            yield number, result


@contextmanager
def _client(distributed: Any, address: str) -> Iterator[Any]:
    try:
        client = distributed.Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise WorkError(
            f"scheduler: no Dask scheduler answers at {address!r} ({type(error).__name__}); give "
            "an address such as tcp://host:8786"
        ) from None
    with client:
        try:
            client.wait_for_workers(1, timeout=_PATIENCE)
        except TimeoutError:
            raise WorkError(
                f"scheduler: {address} has no workers; start some: `dask worker {address}`"
            ) from None
        yield client


@contextmanager
def deaf_children(tracker: Any = resource_tracker) -> Iterator[None]:
    """Processes begun here do not hear the Ctrl-C or the end of a terminal: this one ends them.

    It hears it when they have begun; one begun by halves would complain. The `tracker` is the
    module of what begins them that cleans up after them.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    deaf = {signal.SIGINT, signal.SIGHUP, signal.SIGQUIT}
    with held(), _interrupts_held():
        before = signal.pthread_sigmask(signal.SIG_BLOCK, deaf - {signal.SIGINT})
        # begun before, as its beginning lets the signal through again; what it cleans up after a
        # process that was ended is nobody's trouble
        with environment({"PYTHONWARNINGS": _without_tracker()}):
            tracker.ensure_running()
        signal.pthread_sigmask(signal.SIG_BLOCK, deaf)
        try:
            yield
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _interrupts_held() -> Iterator[None]:
    """A Ctrl-C waits until the end of this: where one thread is deaf, another one hears it."""
    handler = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(handler):
        yield
        return
    heard: list[tuple[int, FrameType | None]] = []
    signal.signal(signal.SIGINT, lambda *call: heard.append(call))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
        if heard:
            handler(*heard[0])


def _without_tracker() -> str:
    """Warnings as they are set; none of what the tracker cleans up."""
    set_already = os.environ.get("PYTHONWARNINGS")
    return ",".join(filter(None, (set_already, "ignore:resource_tracker")))


def end_with(parent: int) -> None:
    """Let this process end with the one that began it, whatever ends that: `kill -9` tells nobody.

    Where a process without a parent keeps its number (Windows) it does nothing.
    """

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(0.5)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextmanager
def environment(values: dict[str, str]) -> Iterator[None]:
    """Environment variables for the processes that are begun within."""
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
