"""Work that is shared with other processes: the same results, wherever they were worked out."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from bench_runs import measured
from inerter import parallel_steps as module
from inerter.diagnose import diagnose_bench
from inerter.parallel_steps import helped, parallel, serial
from inerter.reference import ReferenceDevice, sine_motion


@pytest.fixture
def _helper(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setattr(module, "cpu_count", lambda: 2)
    with helped():
        yield


with_a_helper = pytest.mark.usefixtures("_helper")


def when_both_are_there(folder: Path) -> Callable[[int], int]:
    """A function that waits until two processes have begun, and tells which one it ran in."""

    def who(_: int) -> int:
        (folder / str(os.getpid())).touch()
        latest = time.monotonic() + 120
        while len(list(folder.iterdir())) < 2 and time.monotonic() < latest:
            time.sleep(0.01)
        return os.getpid()

    return who


@with_a_helper
def test_a_helper_says_nothing_of_predictions_that_run_away(tmp_path: Path) -> None:
    who = when_both_are_there(tmp_path)

    def told(item: int) -> tuple[int, str]:
        return who(item), np.geterr()["over"]

    by_process = dict(parallel(told, range(2)))
    del by_process[os.getpid()]
    assert list(by_process.values()) == ["ignore"]


class _Growing:
    """Something that another thread adds to whenever it is to be sent."""

    def __getstate__(self) -> dict[str, int]:
        raise RuntimeError("dictionary changed size during iteration")


@with_a_helper
def test_what_cannot_be_sent_is_worked_out_here() -> None:
    items = [_Growing() for _ in range(6)]
    assert parallel(lambda _: os.getpid(), items) == [os.getpid()] * 6
    # and the helper goes on
    assert parallel(lambda i: i * i, range(20)) == [i * i for i in range(20)]


@with_a_helper
@pytest.mark.parametrize("count", [0, 1, 2, 3, 20, 257])
def test_results_keep_their_order(count: int) -> None:
    expected = [i * i for i in range(count)]
    assert parallel(lambda i: i * i, range(count)) == expected
    with serial():
        assert parallel(lambda i: i * i, range(count)) == expected


@with_a_helper
def test_another_process_does_some_of_it(tmp_path: Path) -> None:
    places = parallel(when_both_are_there(tmp_path), range(4))
    assert len(set(places)) == 2
    assert os.getpid() in places


def test_without_help_nothing_leaves_the_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "cpu_count", lambda: 2)
    here = {os.getpid()}
    assert set(parallel(lambda _: os.getpid(), range(8))) == here
    with serial(), helped():
        assert set(parallel(lambda _: os.getpid(), range(8))) == here
    monkeypatch.setattr(module, "cpu_count", lambda: 1)
    with helped():
        assert set(parallel(lambda _: os.getpid(), range(8))) == here


@with_a_helper
def test_work_within_work_is_not_shared_again(tmp_path: Path) -> None:
    both = when_both_are_there(tmp_path)

    def nested(i: int) -> set[int]:
        return {both(i), *parallel(lambda _: os.getpid(), range(4))}

    assert all(len(places) == 1 for places in parallel(nested, range(4)))


@with_a_helper
def test_an_error_is_raised_wherever_it_occurs_and_leaves_nothing_behind(tmp_path: Path) -> None:
    here = os.getpid()

    def fails_in(folder: Path, *, there: bool) -> Callable[[int], None]:
        folder.mkdir()
        both = when_both_are_there(folder)

        def fails(i: int) -> None:
            if (both(i) != here) is there:
                raise ValueError(f"item {i}")

        return fails

    for where, there in (("there", True), ("here", False)):
        with pytest.raises(ValueError, match="item"):
            parallel(fails_in(tmp_path / where, there=there), range(6))
    assert parallel(lambda i: i + 1, range(6)) == [1, 2, 3, 4, 5, 6]


@with_a_helper
def test_what_a_process_that_ends_had_to_do_is_done_here(tmp_path: Path) -> None:
    here, both = os.getpid(), when_both_are_there(tmp_path)

    def ends(i: int) -> int:
        if both(i) != here:
            os.kill(os.getpid(), signal.SIGKILL)
        return i + 1

    assert parallel(ends, range(6)) == [1, 2, 3, 4, 5, 6]
    # and what comes next is done, too
    assert parallel(lambda i: i + 1, range(6)) == [1, 2, 3, 4, 5, 6]


@with_a_helper
def test_help_within_help_is_the_same(tmp_path: Path) -> None:
    with helped():
        places = parallel(when_both_are_there(tmp_path), range(4))
    assert len(set(places)) == 2
    assert set(parallel(lambda _: os.getpid(), range(100))) <= set(places)


def test_helpers_end_with_the_work(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(module, "cpu_count", lambda: 2)

    def interrupted() -> None:
        with helped():
            parallel(when_both_are_there(tmp_path), range(4))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    (helper,) = {int(path.name) for path in tmp_path.iterdir()} - {os.getpid()}
    with pytest.raises(ProcessLookupError):
        os.kill(helper, 0)


def test_a_diagnosis_is_the_same_to_the_last_digit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "cpu_count", lambda: 2)
    device = ReferenceDevice(inertance=80.0, friction="coulomb", coulomb_force=20.0)
    motions = [sine_motion(0.02, frequency) for frequency in (0.5, 1.0, 2.0)]
    records = measured(device, motions, np.arange(0.0, 4.0, 2e-3))
    with serial():
        alone = diagnose_bench(records)
    shared = diagnose_bench(records)
    assert [f.effect for f in shared.findings] == ["coulomb_friction"]
    assert shared.parameters == alone.parameters
    assert shared.extended == alone.extended
    assert [f.confidence for f in shared.findings] == [f.confidence for f in alone.findings]
