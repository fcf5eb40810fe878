"""Tests that take long have their turn: each case every 2nd, 4th ... day, another share every day.

`tests/seconds.csv` says what takes how many seconds of a quiet processor, and so how often it is
run: so that a day has half a second of each, and of what takes longer an eighth. Its rows are

- a file, for what all of its tests share (a fixture of the module): they have one turn;
- a file and `[case]`, for what the tests of a case share: they have one turn;
- a file and a test, for each of its cases.

`--measure` runs all of them and writes it anew for what was run.
"""

from __future__ import annotations

import csv
import os
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from zlib import crc32

import pytest

TABLE = Path(__file__).with_name("seconds.csv")
# what a day has of a test, and the most days until a case has its turn again
DAILY, MOST_DAYS = 0.5, 8
_SHARED_SCOPES = ("class", "module", "package", "session")


def case_of(nodeid: str) -> str:
    """The tests of a file that have one case, which may share what is expensive; or one test."""
    file, _, test = nodeid.partition("::")
    name, bracket, case = test.partition("[")
    return f"{file}::[{case}" if bracket else f"{file}::{name}"


def test_of(nodeid: str) -> str:
    """A test without its case."""
    return nodeid.partition("[")[0]


def read(path: Path = TABLE) -> dict[str, float]:
    """Seconds by row."""
    if not path.exists():
        return {}
    with path.open(newline="", encoding="utf-8") as file:
        return {row["what"]: float(row["seconds"]) for row in csv.DictReader(file)}


def without_turn(nodeids: Iterable[str], seconds: Mapping[str, float], day: int) -> set[str]:
    """Those of some tests that are not run on a day."""
    nodeids = list(nodeids)
    cases = {name: case_of(name) for name in nodeids}
    counts = Counter(test_of(name) for name in nodeids)
    groups = Counter(name.partition("::")[0] for name in {*cases.values()} if "::[" in name)
    left = set()
    for name in nodeids:
        file, test, case = name.partition("::")[0], test_of(name), cases[name]
        whole = seconds.get(file, 0.0)
        of_case = seconds.get(f"{file}::[case]", 0.0) * groups[file] * ("::[" in case)
        days = _days(max(whole, of_case, seconds.get(test, 0.0) * counts[test]))
        key = file if _days(whole) > 1 else case
        if (crc32(key.encode()) - day) % days:
            left.add(name)
    return left


def _days(seconds: float) -> int:
    """Of what takes so long, the days from one turn to the next: one that is rarer keeps step."""
    days = 1
    while days * DAILY < seconds and days < MOST_DAYS:
        days *= 2
    return days


class Spent:
    """Processor seconds of the tests of this process and of the programs that they started."""

    def __init__(self) -> None:
        self.rows: defaultdict[str, float] = defaultdict(float)
        self.ran: set[str] = set()
        self._file = ""
        self._shared = 0.0
        self._within = False

    @contextmanager
    def test(self, nodeid: str) -> Iterator[None]:
        """Around a test: what it takes beside what it shares with others."""
        self._file, self._shared, before = nodeid.partition("::")[0], 0.0, _busy()
        yield
        self.rows[test_of(nodeid)] += _busy() - before - self._shared
        self.ran.add(nodeid)

    @contextmanager
    def shared(self, of_case: bool) -> Iterator[None]:
        """Around the making of what tests share; what it needs for that is in it."""
        if self._within:
            yield
            return
        self._within, before = True, _busy()
        try:
            yield
        finally:
            self._within = False
        spent = _busy() - before
        self.rows[f"{self._file}::[case]" if of_case else self._file] += spent
        self._shared += spent


def _busy() -> float:
    """Processor seconds so far."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def written(rows: Mapping[str, float], ran: Iterable[str], path: Path = TABLE) -> None:
    """Write the table anew for the tests that ran; the rows of the others stay."""
    ran = {*ran}
    counts = Counter(test_of(name) for name in ran)
    files = {name.partition("::")[0] for name in ran}
    cases = Counter(file.partition("::")[0] for file in {*map(case_of, ran)} if "::[" in file)
    kept = {
        what: value
        for what, value in read(path).items()
        if (what.partition("::")[0] not in files if what.endswith("]") or "::" not in what
            else what not in counts)
        and (path.parent.parent / what.partition("::")[0]).exists()
    }  # fmt: skip
    for what, total in rows.items():
        if _days(total) > 1:
            number = counts.get(what) or cases.get(what.removesuffix("::[case]"), 1)
            kept[what] = total / (number if "::" in what else 1)
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["what", "seconds"])
        table.writerows([what, f"{value:.2g}"] for what, value in sorted(kept.items()))


# ---- hooks ----


def measure(config: pytest.Config) -> None:
    """Measure from now on."""
    config.pluginmanager.register(_Measuring(), "measuring")


class _Measuring:
    """Around every test and what tests share; at the end the table."""

    def __init__(self) -> None:
        self.spent = Spent()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Any:
        """Count a test."""
        with self.spent.test(item.nodeid):
            return (yield)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any, request: Any) -> Any:
        """Count what tests share."""
        if fixturedef.scope not in _SHARED_SCOPES:
            return (yield)
        with self.spent.shared(hasattr(request, "param")):
            return (yield)

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any) -> None:
        """Take what a worker of pytest-xdist has counted."""
        output = getattr(node, "workeroutput", {})
        for what, value in output.get("seconds", {}).items():
            self.spent.rows[what] += value
        self.spent.ran |= {*output.get("ran", ())}

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Tell the controller, or write the table."""
        output = getattr(session.config, "workeroutput", None)
        if output is None:
            written(self.spent.rows, self.spent.ran)
        else:
            output["seconds"], output["ran"] = dict(self.spent.rows), sorted(self.spent.ran)
