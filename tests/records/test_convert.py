"""`inerter convert`: what a bench's program wrote and the record format hold the same."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from inerter.records import Record, read_records

HEADER = ["Zeit [ms]", "Weg [mm]", "Kraft [kN]"]


def rows() -> np.ndarray:
    """Time [ms], displacement [mm], force [kN] of a strut of 60 kg, shape (400, 3)."""
    t = 2e-3 * np.arange(400)
    x = 0.02 * np.sin(2 * np.pi * 1.5 * t)
    force = -60.0 * (2 * np.pi * 1.5) ** 2 * x
    return np.round(np.column_stack([1e3 * t, 1e3 * x, 1e-3 * force]), 5)


def semicolons(path: Path) -> None:
    lines = [";".join(HEADER), *(";".join(f"{v:.5f}" for v in row) for row in rows())]
    path.write_text("\n".join(lines).replace(".", ","), encoding="latin-1")


def workbook(path: Path) -> None:
    book = openpyxl.Workbook()
    assert book.active is not None
    for row in [HEADER, *rows().tolist()]:
        book.active.append(row)
    book.save(path)


def convert(*arguments: object, folder: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "inerter", "convert", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=folder, check=False)


def same(one: Record, other: Record) -> None:
    np.testing.assert_array_equal(one.time, other.time)
    assert one.channels().keys() == other.channels().keys()
    for name, values in one.channels().items():
        np.testing.assert_array_equal(values, other.channels()[name])


@pytest.mark.parametrize("form", ["csv", "parquet"])
@pytest.mark.parametrize(("name", "write"), [("test.csv", semicolons), ("test.xlsx", workbook)])
def test_the_record_format_holds_the_same(name: str, write, form: str, tmp_path: Path) -> None:
    write(tmp_path / name)
    done = convert(name, "--format", form, "--out", "records", "--json", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    (told,) = json.loads(done.stdout)["records"]
    (before,) = read_records([tmp_path / name])
    (after,) = read_records([tmp_path / "records" / told["file"]])
    assert isinstance(before, Record)
    assert isinstance(after, Record)
    same(before, after)
    true = rows()
    np.testing.assert_allclose(after.displacement, 1e-3 * true[:, 1], rtol=1e-12)
    np.testing.assert_allclose(after.force, 1e3 * true[:, 2], rtol=1e-12)
    # where it comes from goes with it
    assert any(name in note for note in after.comments)


def test_a_record_is_not_written_over_itself(tmp_path: Path) -> None:
    semicolons(tmp_path / "test.csv")
    before = (tmp_path / "test.csv").read_bytes()
    done = convert("test.csv", "--out", ".", folder=tmp_path)
    assert done.returncode == 2
    assert "choose another --out" in done.stderr
    assert (tmp_path / "test.csv").read_bytes() == before
