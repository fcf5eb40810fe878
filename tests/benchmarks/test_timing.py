"""The timing that all benchmarks share: order of the rounds, ratios, rows with aims."""

from __future__ import annotations

import io

import mujoco
import pytest
from inerter.benchmark.machine import busy, machine
from inerter.benchmark.rows import aimed, aims, table
from inerter.benchmark.timing import Spread, Timing, Work, interleaved, once
from rich.console import Console


def test_rounds_go_through_all_variants_there_and_back() -> None:
    calls: list[str] = []
    works = {name: Work(lambda name=name: calls.append(name)) for name in "abc"}
    found = interleaved(works, 3)
    # a round to warm up goes before, backwards
    assert "".join(calls) == "cba" + "abc" + "cba" + "abc"
    assert {name: len(timing.seconds) for name, timing in found.items()} == dict.fromkeys("abc", 3)


def test_preparation_is_not_timed() -> None:
    clock = [0.0]

    def spend(seconds: float) -> None:
        clock[0] += seconds

    def read() -> float:
        return clock[0]

    work = Work(lambda: spend(3.0), units=6, prepare=lambda: spend(100.0))
    assert once(work, read) == 0.5
    assert interleaved({"a": work}, 2, clock=read)["a"].seconds == (0.5, 0.5)


def test_ratios_are_taken_within_rounds() -> None:
    """A slow moment that meets both of a round leaves their ratio as it is."""
    own, other = Timing((2.0, 20.0, 3.0)), Timing((1.0, 10.0, 1.5))
    assert own.ratio(other) == Spread(2.0, 2.0, 2.0)
    assert own.spread.median == 3.0


def test_spread() -> None:
    assert Spread.of([1.0, 2.0, 3.0, 4.0, 5.0]) == Spread(3.0, 2.0, 4.0)
    assert Spread.of(7.0) == Spread(7.0, 7.0, 7.0)
    assert Spread(3.0, 2.0, 4.0).times(10.0) == Spread(30.0, 20.0, 40.0)


def test_no_round_is_an_error() -> None:
    with pytest.raises(ValueError, match="rounds is 0"):
        interleaved({"a": Work(lambda: None)}, 0)


@pytest.mark.parametrize(
    ("ratio", "aim", "met"),
    [
        (1.05, "<= 1.05", True),
        (1.06, "<= 1.05", False),
        (20.0, ">= 20", True),
        (9.0, ">= 20", False),
    ],
)
def test_aims(ratio: float, aim: str, met: bool) -> None:
    assert aimed(ratio, aim) == {"aim": aim, "met": met}
    assert aimed(ratio, None) == {"aim": None, "met": None}
    with pytest.raises(ValueError, match=r"aim is '1\.05'"):
        aimed(ratio, "1.05")


def test_rows_become_a_table() -> None:
    rows = [
        {"variant": "a", "microseconds": 1.234, "ratio": None, **aimed(1.0, None)},
        {
            "variant": "b", "microseconds": 1234567.0, "ratio": 1.0, "ratio_lower": 0.98,
            "ratio_upper": 1.02, **aimed(1.0, "<= 1.05"),
        },
    ]  # fmt: skip
    for row in rows:
        row["question"] = "b against a"
    rows[0] |= {"ratio_lower": None, "ratio_upper": None}
    console = Console(width=100, record=True, file=io.StringIO())
    console.print(table("Cost", rows))
    text = console.export_text()
    for words in ("Cost", "microseconds", "1.23", "1.23e+06", "1.00 ±2%", "<= 1.05", "yes"):
        assert words in text
    assert "lower" not in text
    assert aims({"step": rows}) == [
        {
            "benchmark": "step", "question": "b against a", "aim": "<= 1.05", "met": "1 of 1",
            "least": 1.0, "median": 1.0, "most": 1.0,
        }
    ]  # fmt: skip


def test_the_machine_is_described() -> None:
    found = machine()
    assert found["cores"] >= 1
    assert found["processor"]
    assert any(found["compiler"].startswith(name) for name in ("gcc", "clang", "unknown"))
    assert found["mujoco"] == mujoco.mj_versionString()
    # names and versions only: no host, user or path
    del found["processor"]
    assert not any("/" in str(value) for value in found.values())


def test_a_busy_machine_is_told() -> None:
    assert busy({"load": 0.1, "cores": 2}) is None
    assert busy({"load": None, "cores": 2}) is None
    text = busy({"load": 4.0, "cores": 2})
    assert text is not None
    assert "load 4.0 on 2 cores" in text
