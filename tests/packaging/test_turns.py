"""Tests that take long have their turn, none is forgotten."""

from __future__ import annotations

from pathlib import Path

import turns

CASES = [f"tests/a.py::test_x[{i}]" for i in range(40)]


def days_run(names: list[str], seconds: dict[str, float]) -> dict[str, list[int]]:
    left = [turns.without_turn(names, seconds, day) for day in range(8)]
    return {name: [day for day in range(8) if name not in left[day]] for name in names}


def test_each_case_has_its_turn_as_often_as_the_table_says() -> None:
    for seconds, times in ((0.01, 8), (0.02, 4), (0.04, 2), (0.06, 1), (90.0, 1)):
        found = days_run(CASES, {"tests/a.py::test_x": seconds})
        assert {len(days) for days in found.values()} == {times}, seconds
        if times < 8:
            assert {day for days in found.values() for day in days} == set(range(8))


def test_what_shares_something_has_one_turn() -> None:
    """Also where one of them takes long by itself, and comes more rarely."""
    names = ["tests/a.py::test_x", "tests/a.py::test_y[1]", "tests/a.py::test_y[2]"]
    found = days_run(names, {"tests/a.py": 1.5, "tests/a.py::test_y": 40.0})
    assert len(found[names[0]]) == 2
    assert found[names[1]] == found[names[2]]
    assert set(found[names[1]]) < set(found[names[0]])


def test_what_the_tests_of_a_case_share_is_made_once_a_turn() -> None:
    names = [f"tests/a.py::test_{name}[{case}]" for name in "xy" for case in range(20)]
    found = days_run(names, {"tests/a.py::[case]": 3.0})
    for case in range(20):
        (day,) = found[f"tests/a.py::test_x[{case}]"]
        assert found[f"tests/a.py::test_y[{case}]"] == [day]


def test_what_is_measured_is_written_and_the_rest_stays(tmp_path: Path) -> None:
    table, file = tmp_path / "tests" / "seconds.csv", tmp_path / "tests" / "a.py"
    table.parent.mkdir()
    file.write_text("")
    turns.written({"tests/a.py::test_x": 8.0, "tests/a.py": 3.0}, CASES, table)
    assert turns.read(table) == {"tests/a.py": 3.0, "tests/a.py::test_x": 0.2}
    # another test of the file: what the file shares is as it was measured last, here nothing
    turns.written({"tests/a.py::test_y": 2.0, "tests/a.py": 0.1}, ["tests/a.py::test_y"], table)
    assert turns.read(table) == {"tests/a.py::test_x": 0.2, "tests/a.py::test_y": 2.0}


def test_every_row_is_of_a_test_that_there_is() -> None:
    root = Path(turns.__file__).parents[1]
    for what in turns.read():
        file, _, test = what.partition("::")
        assert (root / file).is_file(), what
        assert test in ("", "[case]") or f"def {test}(" in (root / file).read_text("utf-8"), what
