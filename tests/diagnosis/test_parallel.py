"""Results in order, on threads or one after another."""

from __future__ import annotations

import os
import threading

from inerter.diagnose.parallel import parallel, serial


def test_results_keep_their_order() -> None:
    assert parallel(lambda i: i * i, range(20)) == [i * i for i in range(20)]
    with serial():
        assert parallel(lambda i: i * i, range(20)) == [i * i for i in range(20)]


def test_within_serial_nothing_leaves_the_thread() -> None:
    here = threading.get_ident()
    with serial():
        assert set(parallel(lambda _: threading.get_ident(), range(8))) == {here}
    # and afterwards everything does again
    meet = threading.Barrier(min(os.cpu_count() or 1, 2))

    def who(_: int) -> int:
        meet.wait(timeout=60)
        return threading.get_ident()

    assert here not in parallel(who, range(meet.parties))
