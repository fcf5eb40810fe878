"""Files from strangers that are built to cost time and memory are refused early, in one line."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hostile_files import FILES, MEMORY, SECONDS, Hostile
from inerter.models import data_path

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
PROGRAM = Path(__file__).with_name("reading.py")


def run(*arguments: str | Path) -> dict[str, Any]:
    done = subprocess.run(
        [sys.executable, PROGRAM, *map(str, arguments)],
        capture_output=True, text=True, timeout=1500, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3000:]
    return json.loads(done.stdout)


def test_hostile_files_are_refused_within_bounds(tmp_path: Path) -> None:
    """Those that are quickly made, one after another in one process."""
    paths = []
    for hostile in FILES:
        if hostile.quick:
            hostile.make(tmp_path / hostile.name)
            paths.append(tmp_path / hostile.name)
    found = run("read", *paths)
    for name, (said, seconds, _) in found["told"].items():
        assert said.startswith(name), said
        assert len(said) < 300 + len(name), said
        assert seconds < SECONDS, name
    assert found["memory"] < MEMORY


@pytest.mark.parametrize("hostile", FILES, ids=lambda hostile: hostile.name)
def test_a_command_refuses_a_hostile_file(hostile: Hostile, tmp_path: Path, long_run: bool) -> None:
    if not long_run:
        pytest.skip("with --long")
    done = subprocess.run(
        [sys.executable, PROGRAM.with_name("hostile_files.py"), tmp_path, hostile.name],
        capture_output=True, text=True, timeout=1500, check=True,
    )  # fmt: skip
    told = re.fullmatch(
        r".*\n\S+ +[\d.]+ MB  status 2  +([\d.-]+) s more  +(\d+) MB  (inerter: .*)\n", done.stdout
    )
    assert told, done.stdout
    assert float(told[1]) < SECONDS
    assert int(told[2]) * 1e6 < MEMORY


@pytest.mark.parametrize("seed", [1, 2])
def test_a_damaged_file_is_read_or_refused(seed: int, tmp_path: Path, long_run: bool) -> None:
    """Within a limit of memory; a crash, a traceback or a number of the seed tells which."""
    count = 20_000 if long_run else 150
    found = run("fuzz", tmp_path, str(seed), str(count))
    print(found)
    assert found["told"]["read"] + found["told"]["refused"] == count
    assert found["told"]["refused"] > 0.2 * count
    assert found["memory"] < MEMORY


@pytest.mark.parametrize("text", ["abc", "0", "-5", "1e6", "9" * 30])
def test_a_bound_that_is_no_number_is_named(
    text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from inerter.records import RecordError, read_records

    monkeypatch.setenv("INERTER_MOST_ROWS", text)
    with pytest.raises(RecordError, match=r"variable INERTER_MOST_ROWS is .*; give a whole"):
        read_records(data_path("bench_record.csv"))


@pytest.mark.parametrize("suffix", [".csv", ".parquet", ".mat"])
@pytest.mark.parametrize("variable", ["COLUMNS", "VALUES", "BYTES"])
def test_a_bound_can_be_raised_and_says_how(
    suffix: str, variable: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import numpy as np
    import polars as pl
    from inerter.records import RecordError, read_records
    from scipy.io import savemat

    time = 1e-3 * np.arange(300)
    columns = {"time": time, "displacement": np.sin(time), "force": np.cos(time), "aside": time}
    path = tmp_path / f"r{suffix}"
    if suffix == ".mat":
        savemat(path, columns)
    elif suffix == ".parquet":
        pl.DataFrame(columns).write_parquet(path)
    else:
        pl.DataFrame(columns).write_csv(path)
    usual = {"COLUMNS": 4, "VALUES": 1200 if suffix != ".mat" else 2000, "BYTES": 100_000}
    low = {"COLUMNS": 3, "VALUES": 1000, "BYTES": 1000}[variable]
    monkeypatch.setenv(f"INERTER_MOST_{variable}", str(usual[variable]))
    assert read_records(path, "bench")[0].samples == 300
    # columns that are not used do not count
    if variable == "VALUES":
        monkeypatch.setenv("INERTER_MOST_VALUES", "1000" if suffix != ".mat" else "1500")
        assert read_records(path, "bench", others=False)[0].extra == {}
    monkeypatch.setenv(f"INERTER_MOST_{variable}", str(low))
    with pytest.raises(RecordError, match=rf"or set INERTER_MOST_{variable} to more"):
        read_records(path, "bench")
