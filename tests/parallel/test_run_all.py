"""Work on processes and on a cluster: every result once, in order, whoever dies."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from inerter.parallel import WorkError, deaf_children, run_all

COUNT = 24


def square(number: int) -> int:
    return number * number


def fail(number: int) -> int:
    raise ValueError(f"number {number} cannot be")


def die_once(task: tuple[int, str]) -> int:
    """Every tenth piece ends its process the first time that it is begun."""
    number, folder = task
    mark = Path(folder) / str(number)
    if number % 10 == 0 and not mark.exists():
        mark.touch()
        os._exit(1)
    return number * number


def wait(seconds: float) -> float:
    time.sleep(seconds)
    return seconds


def die(number: int) -> int:
    os._exit(1)


@pytest.mark.parametrize("jobs", [1, 2, None])
def test_processes(jobs: int | None) -> None:
    shares: list[float] = []
    found = run_all(square, range(COUNT), jobs=jobs, progress=shares.append)
    assert found == [number**2 for number in range(COUNT)]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert len(shares) == COUNT


def test_nothing_to_do() -> None:
    assert run_all(square, []) == []


@pytest.mark.parametrize("jobs", [1, 2])
def test_an_error_of_the_function_arrives(jobs: int) -> None:
    with pytest.raises(ValueError, match="number 0 cannot be"):
        run_all(fail, [0], jobs=jobs)


def test_a_process_that_dies_is_told() -> None:
    with pytest.raises(WorkError, match="a process ended without a result"):
        run_all(die, range(4), jobs=2)


def test_an_interrupt_between_two_results_ends_the_processes() -> None:
    before = set(multiprocessing.active_children())

    def interrupt(share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt) as interrupted:
        run_all(wait, [0.0, 60.0], jobs=2, progress=interrupt)
    # while somebody still holds the error, and with it what was under way
    assert interrupted.tb is not None
    assert set(multiprocessing.active_children()) <= before


def test_no_jobs() -> None:
    with pytest.raises(WorkError, match="jobs: 0 must be at least 1"):
        run_all(square, [1], jobs=0)


# a cluster on this machine


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
    ) as found:
        yield found


pytestmark = pytest.mark.filterwarnings("default")


def test_cluster_gives_the_same(cluster: Any) -> None:
    assert run_all(square, range(COUNT), scheduler=cluster.scheduler_address) == [
        number**2 for number in range(COUNT)
    ]


def test_workers_that_die_lose_nothing(cluster: Any, tmp_path: Path) -> None:
    """Three pieces of twenty-four end the worker that they are on, once each."""
    shares: list[float] = []
    tasks = [(number, str(tmp_path)) for number in range(COUNT)]
    found = run_all(die_once, tasks, scheduler=cluster.scheduler_address, progress=shares.append)
    assert found == [number**2 for number in range(COUNT)]
    assert len(shares) == COUNT
    assert len(list(tmp_path.iterdir())) == 3


def test_a_piece_that_ends_every_worker_is_named(
    cluster: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("inerter.parallel._ATTEMPTS", 1)
    with pytest.raises(WorkError, match="piece 0 of 1 ended every worker"):
        run_all(die, [0], scheduler=cluster.scheduler_address)


def test_no_scheduler(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("inerter.parallel._PATIENCE", 1.0)
    with pytest.raises(WorkError, match=r"no Dask scheduler answers at 'tcp://127.0.0.1:9'"):
        run_all(square, [1], scheduler="tcp://127.0.0.1:9")


def test_an_address_that_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("inerter.parallel._PATIENCE", 1.0)
    with pytest.raises(WorkError, match="no Dask scheduler answers at 'nowhere'"):
        run_all(square, [1], scheduler="nowhere")


def test_whoever_interrupts_does_not_wait() -> None:
    """An interrupt of one's own ends the pieces that run, which would take a minute."""

    def interrupt(share: float) -> None:
        raise KeyboardInterrupt

    began = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        run_all(wait, [0.0, 60.0, 60.0], jobs=2, progress=interrupt)
    assert time.perf_counter() - began < 30.0


@pytest.fixture
def hearing() -> Iterator[None]:
    """Ctrl-C as usual, also where a shell has these tests in the background, deaf to it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.skipif(sys.platform == "win32", reason="there no thread is deaf to it")
def test_an_interrupt_waits_until_the_processes_have_begun(hearing: None) -> None:
    """Where the thread that begins them is deaf to Ctrl-C, the system gives it to another one."""
    asked, sent = threading.Event(), threading.Event()

    def interrupt() -> None:
        asked.wait()
        signal.raise_signal(signal.SIGINT)
        sent.set()

    begun = False

    def begin() -> None:
        nonlocal begun
        with deaf_children():
            asked.set()
            sent.wait()
            begun = True

    threading.Thread(target=interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        begin()
    assert begun
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


SLEEPERS = """
import os, sys, time
from collections.abc import Iterator
from pathlib import Path
from inerter.parallel import run_all
def piece(folder):
    Path(folder, str(os.getpid())).touch()
    time.sleep(600)
if __name__ == "__main__":
    run_all(piece, [sys.argv[1]] * 2, jobs=2)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="there a process has a parent for ever")
def test_processes_end_with_the_one_that_began_them(tmp_path: Path) -> None:
    script, marks = tmp_path / "sleepers.py", tmp_path / "marks"
    script.write_text(SLEEPERS)
    marks.mkdir()
    began = subprocess.Popen([sys.executable, script, marks], stdout=subprocess.PIPE)
    while len(list(marks.iterdir())) < 2:
        assert began.poll() is None
        time.sleep(0.05)
    began.kill()
    # the pipe is open as long as one of them has it
    began.communicate(timeout=60)
