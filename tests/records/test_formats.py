"""Oddities of files, the same in every format: read alike, or refused with the place."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from inerter.records import RecordError, read_records, table
from scipy.io import savemat

Columns = dict[str, np.ndarray]
ROOT = Path(__file__).parents[2]


def _mat(columns: Columns, path: Path) -> None:
    # brackets are no part of a MATLAB name: units go into a struct
    split = {name: name.rstrip("]").split("[") for name in columns}
    units = {parts[0]: parts[1] for parts in split.values() if len(parts) > 1}
    savemat(path, {split[name][0]: v for name, v in columns.items()} | {"units": units})


WRITERS: dict[str, Callable[[Columns, Path], None]] = {
    "csv": lambda columns, path: pl.DataFrame(columns).write_csv(path),
    "parquet": lambda columns, path: pl.DataFrame(columns).write_parquet(path),
    "mat": _mat,
}


def columns(samples: int = 400) -> Columns:
    time = 1e-3 * np.arange(samples)
    return {
        "time": time,
        "displacement": 0.01 * np.sin(20 * time),
        "force": -240 * np.sin(20 * time) + np.random.default_rng(0).normal(0, 1, samples),
    }


@pytest.fixture(params=sorted(WRITERS))
def write(request: pytest.FixtureRequest, tmp_path: Path) -> Callable[[Columns], Path]:
    def written(columns: Columns) -> Path:
        path = tmp_path / f"record.{request.param}"
        WRITERS[request.param](columns, path)
        return path

    return written


def test_units_in_brackets(write: Callable[[Columns], Path]) -> None:
    true = columns()
    path = write(
        {
            "time[ms]": 1e3 * true["time"],
            "displacement[in]": true["displacement"] / 0.0254,
            "force[lbf]": true["force"] / 4.4482216152605,
        }
    )
    (record,) = read_records(path, "bench")
    for name, values in true.items():
        np.testing.assert_allclose(getattr(record, name), values, rtol=1e-12, atol=1e-15)


def test_a_unit_of_another_quantity(write: Callable[[Columns], Path]) -> None:
    true = columns()
    with pytest.raises(RecordError, match=r"column 'force\[kg\]': unit 'kg' is not a force.*kgf"):
        read_records(write({**{k: true[k] for k in ("time", "displacement")},
                            "force[kg]": true["force"]}))  # fmt: skip


@pytest.mark.parametrize(
    ("odd", "said"),
    [
        ("repeated row", r"(line 52|row 51)\b.*repeats the row before; remove the duplicate row"),
        ("unsorted", r"(line 52|row 51)\b.*time goes back.*sort the rows by time"),
        ("backwards", r"time runs backwards; sort the rows by time"),
        ("still", r"is 0 s in every row; record the time"),
        ("impossible", r"(line 102|row 101)\b.*which nothing measures"),
    ],
)
def test_clocks_and_values_that_cannot_be(
    odd: str, said: str, write: Callable[[Columns], Path]
) -> None:
    true = columns()
    order = np.arange(400)
    if odd == "repeated row":
        order = np.r_[0:50, 49:400]
    elif odd == "unsorted":
        order[[49, 50]] = order[[50, 49]]
    elif odd == "backwards":
        order = order[::-1]
    made = {name: values[order] for name, values in true.items()}
    if odd == "still":
        made["time"] = np.zeros(400)
    elif odd == "impossible":
        made["force"] = made["force"].copy()
        made["force"][100] = 1e13
    with pytest.raises(RecordError, match=said):
        read_records(write(made))


def test_the_same_warnings_in_every_format(write: Callable[[Columns], Path]) -> None:
    true = columns(4000)
    force = np.clip(-240 * np.sin(20 * true["time"]), -150, 150)
    made = {**true, "force": force, "acceleration": np.full(4000, 9.8)}
    (record,) = read_records(write(made), "bench")
    assert {w.code for w in record.warnings} == {"clipping", "constant_channel"}


def test_a_file_from_a_spreadsheet(tmp_path: Path) -> None:
    """Byte order mark, quoted names, the line ends of another system: all read."""
    true = columns()
    text = (
        pl.DataFrame(true)
        .write_csv()
        .replace("time,displacement,force", '"Time","Displacement","Force"', 1)
    )
    path = tmp_path / "sheet.csv"
    path.write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    (record,) = read_records(path, "bench")
    for name, values in true.items():
        np.testing.assert_array_equal(getattr(record, name), values)


def test_decimal_commas_between_semicolons_are_read(tmp_path: Path) -> None:
    text = pl.DataFrame(columns()).write_csv()
    path = tmp_path / "sheet.csv"
    path.write_text(text.replace(",", ";").replace(".", ","))
    (record,) = read_records(path, "bench")
    for name, values in columns().items():
        np.testing.assert_array_equal(getattr(record, name), values)
    assert record.reading == "semicolon, decimal comma"


def test_decimal_commas_between_commas_are_asked_for(tmp_path: Path) -> None:
    """Not guessed: 1,5 may be one number or two."""
    lines = [f"0,{k:03d},1,5,-2,{k}" for k in range(60)]
    path = tmp_path / "sheet.csv"
    path.write_text("time,displacement,force\n" + "\n".join(lines))
    said = r"6 cells where the header has 3.*6 whole numbers, or 3 with decimal commas \(0.000, 1.5"
    with pytest.raises(RecordError, match=said):
        read_records(path)


@pytest.mark.parametrize("second", ["force", "road"])
def test_a_time_that_leaps_is_refused_and_a_pause_is_not(
    second: str, write: Callable[[Columns], Path]
) -> None:
    """On an even clock a record with a mistyped time would not fit into any memory."""
    true = columns()
    if second == "road":
        true = {"time": true["time"], "road": true["force"], "suspension_travel": true["force"]}
    # a pause of five times what was recorded
    paused = {**true, "time": true["time"] + 2.0 * (np.arange(400) >= 200)}
    (record,) = read_records(write(paused))
    assert record.samples == 400
    mistyped = {**true, "time": np.r_[true["time"][:-1], 1e9]}
    said = r"(line 401|row 400): time leaps by 1e\+09 s, from 0.398 s to 1e\+09 s.*split the run"
    with pytest.raises(RecordError, match=said):
        read_records(write(mistyped))
    days = {**true, "time": true["time"] + 259200.0 * (np.arange(400) >= 200), "run": [3] * 400}
    with pytest.raises(RecordError, match=r"(line 202|row 201), run '3': time leaps by 2.592e\+05"):
        read_records(write(days))


def test_the_pages_name_every_format_and_ending() -> None:
    page = (ROOT / "docs" / "records.md").read_text(encoding="utf-8")
    section = page.split("\n## Files\n")[1].split("\n\n")[0]
    first = " ".join(row.split("|")[1] for row in section.splitlines() if row.startswith("| "))
    assert set(re.findall(r"`(\.\w+)`", first)) == set(table.EXTENSIONS)
    one_by_one = re.search(r"formats but (.*?),\s+which name by name", page, re.S)
    assert one_by_one is not None
    left_out = set(table.EXTENSIONS) - set(table.OF_FOLDERS)
    assert set(re.findall(r"`(\.\w+)`", one_by_one[1])) == left_out
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    told = readme.split("## Your own data\n")[1].split("\n\n")[0].split("```")[0]
    for kind in table.READERS:
        assert kind.lower() in told.lower(), f"README.md, Your own data: no {kind}"
        assert kind.lower() in first.lower(), f"docs/records.md, Files: no {kind}"
