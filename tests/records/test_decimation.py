"""Every n-th row behind a low-pass: the same in any format and blocks, linear laws untouched."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
from inerter.records import RecordError, read_records
from inerter.records.decimation import Decimator
from inerter.records.stated import FILE, reading

BY = 8
RATE = 4000.0


def response(frequency: float) -> float:
    """Gain of the low-pass, by hand: the sum of its taps times a cosine."""
    decimator = Decimator(BY)
    k = np.arange(-decimator.half, decimator.half + 1)
    return float(np.sum(decimator.taps * np.cos(2 * np.pi * frequency / RATE * k)))


@pytest.mark.parametrize("lengths", [[20_000], [7] * 3000, [161, 1, 5000, 3, 14_835]])
def test_blocks_of_any_length_give_the_same(lengths: list[int]) -> None:
    values = np.random.default_rng(1).normal(size=sum(lengths)) + 1.7e9
    decimator = Decimator(BY)
    blocks = np.split(values, np.cumsum(lengths)[:-1])
    made = np.concatenate([decimator.add(block) for block in blocks])
    whole = Decimator(BY)
    # each new sample by its definition
    n = len(whole.taps)
    starts = range(0, len(values) - n + 1, BY)
    expected = np.array([np.dot(whole.taps, values[s : s + n] - 1.7e9) for s in starts])
    np.testing.assert_allclose(made - 1.7e9, expected, atol=1e-6)
    assert Decimator(1).add(values) is values


def columns() -> dict[str, np.ndarray]:
    time = 5.0 + np.arange(30_000) / RATE
    slow, high = 2 * np.pi * 20.0, 2 * np.pi * 1500.0
    x = 0.01 * np.sin(slow * time)
    force = 60 * -(slow**2) * x + 400 * x + 50 * np.cos(high * time)
    return {"time": time, "displacement": x, "force": force}


@pytest.mark.parametrize("form", ["csv", "parquet", "mat"])
def test_a_tone_stays_and_what_would_fold_down_is_gone(form: str, tmp_path: Path) -> None:
    true = columns()
    path = tmp_path / f"run.{form}"
    if form == "csv":
        pl.DataFrame(true).write_csv(path)
    elif form == "parquet":
        pl.DataFrame(true).write_parquet(path, row_group_size=1000)
    else:
        from scipy.io import savemat

        savemat(path, true)
    with reading(decimate=BY) as now:
        (record,) = read_records(path, "bench")
        now.remember()
    assert "every 8th row kept" in record.reading
    assert record.sample_rate == pytest.approx(RATE / BY, rel=1e-12)
    # the clock is even and begins half a filter later
    expected = 5.0 + (Decimator(BY).half + BY * np.arange(record.samples)) / RATE
    np.testing.assert_allclose(record.time, expected, rtol=0, atol=1e-12)
    slow = 2 * np.pi * 20.0
    x = 0.01 * np.sin(slow * record.time)
    assert abs(response(20.0) - 1) < 2e-4
    assert abs(response(1500.0)) < 2e-4
    np.testing.assert_allclose(record.displacement, response(20.0) * x, atol=1e-12)
    # the law between force and displacement is the one of the file
    law = (400 - 60 * slow**2) * record.displacement
    np.testing.assert_allclose(record.force, law, atol=50 * abs(response(1500.0)) + 1e-8)
    # remembered beside the data
    assert "decimate = 8" in (tmp_path / FILE).read_text()
    (again,) = read_records(path, "bench")
    np.testing.assert_array_equal(again.force, record.force)


def test_a_stated_interval_counts_the_rows_of_the_file(tmp_path: Path) -> None:
    true = columns()
    path = tmp_path / "run.csv"
    pl.DataFrame({n: true[n] for n in ("displacement", "force")}).write_csv(path)
    with reading(["time=every 0.25 ms"], decimate=BY):
        (record,) = read_records(path, "bench")
    assert record.sample_rate == pytest.approx(RATE / BY, rel=1e-12)


def test_more_rows_than_are_read_are_read_behind_a_low_pass(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("INERTER_MOST_ROWS", "20000")
    path = tmp_path / "run.csv"
    pl.DataFrame(columns()).write_csv(path)
    with pytest.raises(RecordError, match="--decimate 10"):
        read_records(path)
    with reading(decimate=BY):
        assert read_records(path, "bench")[0].samples == (30_000 - 161) // BY + 1


@pytest.mark.parametrize(("text", "said"), [("0", "a whole number from 1"), ("'2'", "is '2'")])
def test_no_such_number(text: str, said: str, tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    pl.DataFrame(columns()).write_csv(path)
    (tmp_path / FILE).write_text(f"[[files]]\ndecimate = {text}\n")
    with pytest.raises(RecordError, match=said):
        read_records(path)


def test_runs_in_one_file_are_not_mixed(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    pl.DataFrame(columns()).with_columns(run=pl.lit("a")).write_csv(path)
    with pytest.raises(RecordError, match="column 'run' is not decimated"), reading(decimate=BY):
        read_records(path)
