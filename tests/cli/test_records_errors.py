"""Every way in which a record cannot be used, and the one line that says so."""

from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inerter.records import RecordError, read_records
from scipy.io import savemat

HEADER = "time,displacement,force"


def rows(count: int = 60, start: int = 0) -> list[str]:
    """Data lines of a usable record: time 1 ms apart, half a sine."""
    return [
        f"{0.001 * k:.3f},{np.sin(0.1 * k):.6f},{np.cos(0.1 * k):.6f}"
        for k in range(start, start + count)
    ]


def replaced(index: int, line: str) -> list[str]:
    """The rows with one of them exchanged; it stands at line index + 2 of the file."""
    lines = rows()
    lines[index] = line
    return lines


def message(path: Path, **options: object) -> str:
    """The error text, checked for what every error text has: one line that names the file."""
    with pytest.raises(RecordError) as caught:
        read_records(path, **options)  # type: ignore[call-overload]
    text = str(caught.value)
    assert "\n" not in text
    assert path.name in text
    # what is wrong, then what to do
    assert ";" in text
    return text


def assert_read_or_refused(path: Path) -> None:
    """A file may be good or bad, but no other exception than ours leaves the reader."""
    text = f"{path.name}: good"
    with contextlib.suppress(RecordError):
        try:
            read_records(path)
        except RecordError as error:
            text = str(error)
            raise
    assert "\n" not in text
    assert path.name in text


CASES = {
    "empty": ("", ["file is empty"]),
    "blank": ("\n\n# nothing\n", ["blanks and comments only"]),
    "header only": (HEADER, ["only one line", "rows below"]),
    "header and comment": (HEADER + "\n# end\n\n", ["no data below", HEADER.replace(",", ", ")]),
    "no header": ("\n".join(rows()), ["line 1", "no header", "time,displacement,force"]),
    "commented header": (
        "\n".join(["# time,how far,pull", *rows()]),
        ["line 2", "no header", "remove its '#'", "time,how far,pull"],
    ),
    "missing column": (
        "\n".join(["time,displacement,pull", *rows()]),
        ["no column 'force'", "found: time, displacement, pull", "needs the columns"],
    ),
    "misspelt column": (
        "\n".join(["time,displacment[V],force", *rows()]),
        ["no column 'displacement'", "--column displacement='200 m/V * displacment'"],
    ),
    "decimal commas": (
        "\n".join([HEADER, *(line.replace(".", ",") for line in rows())]),
        ["line 2", "6 cells where the header has 3", "decimal commas", "point"],
    ),
    "quoted decimal comma": (
        "\n".join([HEADER, *replaced(4, '0.004,"0,389",1.0')]),
        ["line 6", "column 'displacement'", "'0,389' is not a number", "decimal point"],
    ),
    "no number": (
        "\n".join(["# bench 3", HEADER, "", *replaced(9, "0.009,0.1,high")]),
        ["line 13", "column 'force'", "'high' is not a number"],
    ),
    "header again": (
        "\n".join([HEADER, *rows(), HEADER, *rows()]),
        ["line 62", "header stands here again", "'run' column"],
    ),
    "ragged short": (
        "\n".join([HEADER, *replaced(20, "0.020,0.3")]),
        ["line 22", "2 cells where the header has 3", "'0.020,0.3'"],
    ),
    "ragged long": (
        "\n".join([HEADER, *replaced(20, "0.020,0.3,1.0,7.5")]),
        ["line 22", "4 cells where the header has 3"],
    ),
    "ragged both ways": (
        "\n".join([HEADER, *replaced(20, "0.020,0.3"), "0.060,0.3,1.0,7.5"]),
        ["line 22", "2 cells"],
    ),
    "cut off": ("\n".join([HEADER, *rows(), "0.060,0.2"]), ["line 62", "cut off"]),
    "unknown unit": (
        "\n".join(["time,displacement[xyz],force", *rows()]),
        ["column 'displacement[xyz]'", "unknown unit 'xyz'", "m, mm"],
    ),
    "unit in the wrong case": (
        "\n".join(["time,displacement,force[KN]", *rows()]),
        ["unknown unit 'KN'", "did you mean 'kN'?"],
    ),
    "wrong dimension": (
        "\n".join(["time,displacement,force[mm]", *rows()]),
        ["column 'force[mm]'", "'mm' is not a force", "N, kN, lbf"],
    ),
    "a mass as force": (
        "\n".join(["time,displacement,force[kg]", *rows()]),
        ["'kg' is not a force", "'kgf'"],
    ),
    "grams as length": (
        "\n".join(["time,displacement[g],force", *rows()]),
        ["'g' is not a length"],
    ),
    "the same quantity twice": (
        "\n".join(["time,displacement,displacement[mm],force", *(line + ",1" for line in rows())]),
        ["'displacement' and 'displacement[mm]'", "both hold 'displacement'"],
    ),
    "an extra column twice": (
        "\n".join([HEADER + ",note,note", *(line + ",1,2" for line in rows())]),
        ["'note' and 'note'"],
    ),
    "time goes back": (
        "\n".join([HEADER, *replaced(20, "0.0185,0.3,1.0")]),
        ["line 22", "time goes back from 0.019 s to 0.0185 s", "sort the rows"],
    ),
    "time repeats": (
        "\n".join([HEADER, *replaced(20, "0.019,0.3,1.0")]),
        ["line 22", "time 0.019 s repeats the row before", "duplicate"],
    ),
    "runs in one file": (
        "\n".join([HEADER, *rows(), *rows()]),
        ["line 62", "time goes back", "'run' column"],
    ),
    "time runs backwards": (
        "\n".join([HEADER, *rows()[::-1]]),
        ["line 3", "time runs backwards", "sort"],
    ),
    "constant time": (
        "\n".join([HEADER, *("5,0.1,0.2" for _ in range(60))]),
        ["column 'time' is 5 s in every row"],
    ),
    "too few samples": ("\n".join([HEADER, *rows(49)]), ["only 49 samples", "at least 50"]),
    "too many empty cells": (
        "\n".join([HEADER, *rows(30), *("," * 2 for _ in range(5)), *rows(30, 35)]),
        ["line 32", "column 'time'", "5 of 65 rows"],
    ),
    "a long gap": (
        "\n".join(
            [HEADER, *rows(2000)]
            + [f"{0.001 * k:.3f},,1" for k in range(2000, 2026)]
            + rows(1000, 2026)
        ),
        ["line 2002", "column 'displacement'", "longest stretch 26", "at most 30 may"],
    ),
    "an empty column": (
        "\n".join([HEADER, *(line.rsplit(",", 1)[0] + ",nan" for line in rows())]),
        ["column 'force' holds no number"],
    ),
    "an unnamed run": (
        "\n".join([HEADER + ",run", *(line + ",a" for line in rows()), "1,1,1,"]),
        ["line 62", "column 'run'", "no run is named"],
    ),
    "a short run": (
        "\n".join([HEADER + ",run", *(line + ",a" for line in rows()), "1,1,1,b"]),
        ["run 'b'", "only 1 samples"],
    ),
    "a bad clock in one run": (
        "\n".join(
            [HEADER + ",run", *(line + ",a" for line in rows())]
            + [line + ",b" for line in replaced(3, "0.001,1,1")]
        ),
        ["line 65", "run 'b'", "time goes back"],
    ),
    "an absurd number": (
        "\n".join([HEADER, *replaced(5, "0.005,1,-1e240")]),
        ["line 7", "'force' is -1e+240"],
    ),
    "a short table": (
        "frequency,force_amplitude,acceleration_amplitude\n1,2,3\n2,3,4\n",
        ["only 2 rows", "needs 3"],
    ),
    "a negative amplitude": (
        "frequency,force_amplitude,acceleration_amplitude\n1,2,3\n2,-3,4\n3,4,5\n",
        ["line 3", "'force_amplitude' is -3"],
    ),
    "a hole in a table": (
        "frequency,force_amplitude,acceleration_amplitude\n1,2,3\n2,,4\n3,4,5\n",
        ["line 3", "'force_amplitude' has no value", "remove the row"],
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_csv_error(name: str, tmp_path: Path) -> None:
    text, parts = CASES[name]
    path = tmp_path / "bench run.csv"
    path.write_text(text)
    error = message(path)
    for part in parts:
        assert part in error


BYTES = {
    "binary": (bytes(range(256)) * 10, ["binary file"]),
    "parquet": (b"PAR1" + bytes(100), ["not a readable Parquet file"]),
    "excel": (b"PK\x03\x04" + bytes(100), ["not a readable workbook", "export CSV"]),
}


@pytest.mark.parametrize("name", BYTES)
def test_csv_that_is_no_utf8_text(name: str, tmp_path: Path) -> None:
    data, parts = BYTES[name]
    path = tmp_path / "r.csv"
    path.write_bytes(data)
    error = message(path)
    for part in parts:
        assert part in error


@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_a_damaged_file_is_read_or_refused(data: st.DataObject, tmp_path_factory) -> None:
    good = ("# note\n" + HEADER + "\n" + "\n".join(rows())).encode()
    piece = st.one_of(
        st.binary(max_size=4),
        st.sampled_from([b",", b"\n", b'"', b"#", b"\r", b"-", b"e9", b"nan", b"[mm]", b";", b" "]),
    )
    for _ in range(data.draw(st.integers(1, 4))):
        # near the header as often as anywhere
        start = data.draw(st.one_of(st.integers(0, 40), st.integers(0, len(good))))
        stop = start + data.draw(st.sampled_from([0, 0, 1, 1, 5, 200, len(good)]))
        good = good[:start] + data.draw(piece) + good[stop:]
    path = tmp_path_factory.mktemp("fuzz") / "r.csv"
    path.write_bytes(good)
    assert_read_or_refused(path)


def binary_record(path: Path) -> bytes:
    """A usable Parquet or MATLAB file, written and returned."""
    time = np.arange(60.0)
    columns = {"time": time, "displacement": np.sin(time), "force": np.cos(time)}
    if path.suffix == ".mat":
        savemat(path, columns)
    else:
        pl.DataFrame(columns).write_parquet(path)
    return path.read_bytes()


@settings(max_examples=80, deadline=None)
@given(data=st.data())
def test_a_damaged_parquet_file_is_read_or_refused(data: st.DataObject, tmp_path_factory) -> None:
    path = tmp_path_factory.mktemp("fuzz") / "r.parquet"
    good = binary_record(path)
    for _ in range(data.draw(st.integers(1, 3))):
        start = data.draw(st.integers(0, len(good)))
        stop = start + data.draw(st.sampled_from([0, 1, 8, 300]))
        good = good[:start] + data.draw(st.binary(max_size=8)) + good[stop:]
    path.write_bytes(good)
    assert_read_or_refused(path)


@pytest.mark.parametrize("suffix", [".parquet", ".mat"])
def test_a_binary_file_cut_off_is_refused(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"r{suffix}"
    good = binary_record(path)
    for size in range(1, len(good), 37):
        path.write_bytes(good[:size])
        message(path)


def test_missing_file(tmp_path: Path) -> None:
    assert "no such file" in message(tmp_path / "absent.csv")


def test_folder_without_records(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("x")
    assert "no records in this folder" in message(tmp_path)
    assert f"if notes.txt is one, name the files: '{tmp_path}/*.txt'" in message(tmp_path)
    (tmp_path / "zeros.dat").write_text("x")
    assert "if notes.txt and 1 more are such" in message(tmp_path)
    for path in tmp_path.iterdir():
        path.unlink()
    assert "put .csv, .xlsx," in message(tmp_path)


def test_glob_without_match(tmp_path: Path) -> None:
    assert "no record (.csv, .xlsx," in message(tmp_path / "run*.csv")


def test_no_paths() -> None:
    with pytest.raises(RecordError, match="no records given; name a file"):
        read_records([])


def test_unknown_extension(tmp_path: Path) -> None:
    path = tmp_path / "r.docx"
    path.write_bytes(b"1,2,3")
    assert "unknown extension '.docx'" in message(path)


def test_missing_file_is_reported_before_its_extension(tmp_path: Path) -> None:
    assert "no such file" in message(tmp_path / "absent")


def test_another_kind_is_wanted(tmp_path: Path) -> None:
    path = tmp_path / "sweep.csv"
    path.write_text("frequency,force_amplitude,acceleration_amplitude\n1,2,3\n2,3,4\n3,4,5\n")
    error = message(path, kind="bench")
    assert "this is a table record, a bench record is needed" in error


@pytest.mark.parametrize("suffix", [".parquet", ".mat"])
def test_broken_binary_file(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"r{suffix}"
    path.write_bytes(b"no such format" * 40)
    assert "not a readable" in message(path)


@pytest.mark.parametrize("head", [b"\x89HDF\r\n\x1a\n", b"MATLAB 7.3 MAT-file, Platform: GLNXA64"])
def test_mat_73(head: bytes, tmp_path: Path) -> None:
    path = tmp_path / "r.mat"
    path.write_bytes(head + bytes(600))
    error = message(path)
    assert "not a readable HDF5 file" in error


def test_mat_without_vectors(tmp_path: Path) -> None:
    path = tmp_path / "r.mat"
    savemat(path, {"gain": 3.0})
    assert "no vectors found (variables: gain)" in message(path)


def test_mat_with_vectors_of_different_lengths(tmp_path: Path) -> None:
    path = tmp_path / "r.mat"
    time = np.arange(60.0)
    savemat(path, {"time": time, "displacement": time, "force": time[:50]})
    assert "'force' has 50 values where others have 60" in message(path)


def test_parquet_errors_name_the_row(tmp_path: Path) -> None:
    path = tmp_path / "r.parquet"
    time = np.arange(60.0)
    time[7] = 2.0
    pl.DataFrame({"time": time, "displacement": time, "force": time}).write_parquet(path)
    error = message(path)
    assert "row 8" in error
    assert "time goes back from 6 s to 2 s" in error


def test_parquet_text_in_a_channel(tmp_path: Path) -> None:
    path = tmp_path / "r.parquet"
    time = np.arange(60.0)
    force = ["1.0"] * 59 + ["off"]
    pl.DataFrame({"time": time, "displacement": time, "force": force}).write_parquet(path)
    error = message(path)
    assert "row 60, column 'force': 'off' is not a number" in error


def test_long_cells_are_cut_and_stay_on_one_line(tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    path.write_text("\n".join([HEADER, *replaced(3, "0.003,1," + "x" * 500)]))
    assert len(message(path)) < 300


def test_a_file_that_cannot_be_opened(tmp_path: Path) -> None:
    path = tmp_path / "r.csv"
    path.symlink_to(path)
    assert "cannot be opened" in message(path)
