"""Records too long for the memory: read by blocks of any size alike, or refused early."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from inerter.records import RecordError, read_records, text_table
from scipy.io import savemat

HEADER = "time,displacement,force,run"


def lines(count: int) -> list[str]:
    return [f"{0.001 * k:.3f},{np.sin(k):.6f},{np.cos(k):.6f},a{k % 2}" for k in range(count)]


ODD = st.sampled_from(
    [
        "# a comment, with commas",
        "",
        "   ",
        '0.9,"1.5" ,-2,a0',
        "0.9,1.5,high,a0",
        "0.9,1.5",
        "x,,,",
    ]
)


def told(path: Path) -> object:
    """What reading a file gives: numbers, or the error's text."""
    try:
        return [
            (r.name, r.comments, *(v.tobytes() for v in (r.time, r.displacement, r.force)))
            for r in read_records(path, "bench", check=False)
        ]
    except RecordError as error:
        return str(error)


@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_a_file_is_the_same_in_blocks_of_any_size(
    data: st.DataObject, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = lines(120)
    for odd in data.draw(st.lists(ODD, max_size=2)):
        rows.insert(data.draw(st.integers(0, len(rows))), odd)
    above = data.draw(st.lists(st.sampled_from(["# µm and more", "", "#"]), max_size=3))
    end = data.draw(st.sampled_from(["\n", "\r\n", "\r"]))
    text = end.join([*above, HEADER, *rows]) + data.draw(st.sampled_from(["", end, end * 3]))
    bom = data.draw(st.sampled_from([b"", b"\xef\xbb\xbf"]))
    path = tmp_path / "r.csv"
    path.write_bytes(bom + text.encode())
    whole = told(path)
    with monkeypatch.context() as patched:
        patched.setattr(text_table, "BLOCK", data.draw(st.integers(len(bom) + 1, 400)))
        found = told(path)
    # only the end of a file says that it is cut off
    if isinstance(whole, str) and "cut off" in whole:
        assert isinstance(found, str)
        assert found.split(";")[0] == whole.split(";")[0]
    else:
        assert found == whole


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".mat"])
def test_too_many_rows_are_refused(
    suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    time = 1e-3 * np.arange(300)
    columns = {"time": time, "displacement": np.sin(time), "force": np.cos(time)}
    path = tmp_path / f"week{suffix}"
    if suffix == ".mat":
        savemat(path, columns)
    elif suffix == ".parquet":
        pl.DataFrame(columns).write_parquet(path)
    else:
        pl.DataFrame(columns).write_csv(path)
    monkeypatch.setenv("INERTER_MOST_ROWS", "300")
    assert len(read_records(path, "bench")[0].time) == 300
    monkeypatch.setenv("INERTER_MOST_ROWS", "299")
    with pytest.raises(RecordError, match=r"week.*about 300 rows, at most 299 are read; "):
        read_records(path)


def test_a_file_far_too_long_is_refused_by_its_first_block(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "week.csv"
    path.write_text("\n".join([HEADER, *lines(5000)]))
    monkeypatch.setenv("INERTER_MOST_ROWS", "1000")
    monkeypatch.setattr(text_table, "BLOCK", 4096)
    blocks = []
    found = text_table._columns
    monkeypatch.setattr(text_table, "_columns", lambda *of: blocks.append(1) or found(*of))
    with pytest.raises(RecordError, match=r"about [45] ?[0-9]00 rows, at most 1 000"):
        read_records(path)
    assert len(blocks) == 1


def test_a_line_without_end_is_no_csv(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "r.csv"
    path.write_text(HEADER + "\n" + "1," * 5000)
    monkeypatch.setattr(text_table, "BLOCK", 100)
    monkeypatch.setattr(text_table, "LONGEST_LINE", 1000)
    with pytest.raises(RecordError, match="binary file, not CSV"):
        read_records(path)
