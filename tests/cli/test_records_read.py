"""Files, folders, globs and runs in; the same SI arrays out, whatever the format and the units."""

from __future__ import annotations

import dataclasses
import io
import time as clock
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from inerter.records import (
    BenchTable,
    Record,
    RecordError,
    RecordWarning,
    VehicleRecord,
    read_records,
    share_one_clock,
)
from inerter.records.units import QUANTITIES, TURNING, si_factor, split_header
from scipy.io import savemat

# what one of each unit is in SI, by hand
LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "cm": 1e-2, "in": 0.0254, "ft": 0.3048}
FORCES = {"N": 1.0, "kN": 1e3, "mN": 1e-3, "lbf": 4.4482216152605, "kgf": 9.80665, "kp": 9.80665}
TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "sec": 1.0}
SPEEDS = {"m/s": 1.0, "mm/s": 1e-3, "km/h": 1 / 3.6, "in/s": 0.0254, "m s^-1": 1.0}
ACCELERATIONS = {
    "m/s^2": 1.0, "m/s2": 1.0, "m/s²": 1.0, "m/s**2": 1.0, "m s-2": 1.0,
    "mm/s^2": 1e-3, "g": 9.80665, "mg": 9.80665e-3, "standard_gravity": 9.80665, "Gal": 1e-2,
}  # fmt: skip
FREQUENCIES = {"Hz": 1.0, "kHz": 1e3, "rad/s": 0.5 / np.pi, "rpm": 1 / 60, "1/s": 1.0}


def signals(samples: int = 80, start: float = 0.0) -> dict[str, np.ndarray]:
    """A smooth bench record, 1 kHz."""
    time = start + 1e-3 * np.arange(samples)
    phase = 40.0 * (time - start)
    return {
        "time": time,
        "displacement": 0.01 * np.sin(phase) + 0.002 * np.sin(3 * phase),
        "force": 300.0 * np.cos(phase) + start,
    }


def csv_text(columns: dict[str, np.ndarray], units: dict[str, str] | None = None) -> str:
    """The columns as CSV, written exactly."""
    heads = [f"{name}[{units[name]}]" if units and name in units else name for name in columns]
    lines = [",".join(heads)]
    lines += [",".join(repr(float(v)) for v in row) for row in zip(*columns.values(), strict=True)]
    return "\n".join(lines) + "\n"


def one(path: Path) -> Record:
    (record,) = read_records(path, "bench", check=False)
    return record


@pytest.mark.parametrize(
    ("name", "units"),
    [
        ("displacement", LENGTHS),
        ("force", FORCES),
        ("time", TIMES),
        ("velocity", SPEEDS),
        ("acceleration", ACCELERATIONS),
        ("frequency", FREQUENCIES),
    ],
)
def test_units(name: str, units: dict[str, float]) -> None:
    for unit, factor in units.items():
        assert si_factor(name, unit, "here") == pytest.approx(factor, rel=1e-12), unit


@pytest.mark.parametrize("unit", ["rad", "%", "5 mm", "m**", "()", "1+1", "degC", "N m", "-"])
@pytest.mark.parametrize("name", sorted(QUANTITIES))
def test_no_unit_of_ours(name: str, unit: str) -> None:
    if TURNING.get(name, QUANTITIES[name]).unit == unit.replace(" ", "*"):
        assert si_factor(name, unit, "here") == 1.0
        return
    with pytest.raises(RecordError, match="here: un"):
        si_factor(name, unit, "here")


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        ("force", ("force", None)),
        (" Force [kN] ", ("force", "kN")),
        ("Time (s)", ("time", "s")),
        ("TIME[ ms ]", ("time", "ms")),
        ("Force Amplitude [N]", ("force_amplitude", "N")),
        ("acceleration (m/(s^2))", ("acceleration", "m/(s^2)")),
        ("force[]", ("force", None)),
        ('"force"', ("force", None)),
        ("[mm]", ("[mm]", None)),
        ("", ("", None)),
    ],
)
def test_headers(header: str, expected: tuple[str, str | None]) -> None:
    assert split_header(header) == expected


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(data=st.data())
def test_round_trip_with_any_units_and_layout(data: st.DataObject, tmp_path_factory) -> None:
    truth = signals(60)
    truth["velocity"] = np.gradient(truth["displacement"], truth["time"])
    truth["acceleration"] = np.gradient(truth["velocity"], truth["time"])
    tables = {
        "time": TIMES, "displacement": LENGTHS, "force": FORCES,
        "velocity": SPEEDS, "acceleration": ACCELERATIONS,
    }  # fmt: skip
    order = data.draw(st.permutations(list(truth)))
    units = {name: data.draw(st.sampled_from(sorted(tables[name]))) for name in order}
    brackets = data.draw(st.sampled_from(["[]", "()", " []", " ( )"]))
    case = data.draw(st.sampled_from([str.lower, str.upper, str.title]))
    heads = [case(n) + brackets[:-1] + units[n] + brackets[-1] for n in order]
    columns = [truth[n] / tables[n][units[n]] for n in order]
    cells = [[repr(float(v)) for v in row] for row in zip(*columns, strict=True)]

    # comments, blank lines, blanks around cells, quotes and line ends of any kind
    pad = data.draw(st.sampled_from(["", " ", "\t"]))
    quote = data.draw(st.sampled_from(["", '"']))
    lines = [",".join(heads)]
    lines += [(pad + ",").join(quote + cell + quote for cell in row) for row in cells]
    if not quote:
        lines[1:] = [pad + line for line in lines[1:]]
    for where in data.draw(st.lists(st.integers(0, len(lines)), max_size=5)):
        lines.insert(where, data.draw(st.sampled_from(["", "  ", "# note, 5", "   # note", "#"])))
    end = data.draw(st.sampled_from(["\n", "\r\n", "\r"]))
    text = end.join(lines) + data.draw(st.sampled_from(["", end, end + end]))
    path = tmp_path_factory.mktemp("csv") / "r.csv"
    mark = data.draw(st.sampled_from([b"", b"\xef\xbb\xbf"]))
    path.write_bytes(mark + text.encode("utf-8"))

    record = one(path)
    for name, values in truth.items():
        np.testing.assert_allclose(getattr(record, name), values, rtol=1e-12, atol=1e-15)
    assert record.warnings == ()


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_numbers_keep_every_bit(seed: int, tmp_path_factory) -> None:
    rng = np.random.default_rng(seed)
    truth = {
        "time": np.cumsum(rng.uniform(1e-4, 1.0, 60)),
        "displacement": rng.standard_normal(60) * 10.0 ** rng.integers(-12, 12, 60),
        "force": rng.standard_normal(60) * 10.0 ** rng.integers(-12, 12, 60),
    }
    path = tmp_path_factory.mktemp("csv") / "r.csv"
    path.write_text(csv_text(truth))
    record = one(path)
    for name, values in truth.items():
        np.testing.assert_array_equal(getattr(record, name), values)


def test_csv_parquet_and_mat_agree(tmp_path: Path) -> None:
    truth = signals()
    (tmp_path / "a.csv").write_text(csv_text(truth))
    pl.DataFrame(truth).write_parquet(tmp_path / "b.parquet")
    savemat(tmp_path / "c.mat", truth)
    savemat(tmp_path / "d.mat", {"data": truth, "gain": 2.0})
    millimetres = {**truth, "displacement": 1e3 * truth["displacement"]}
    savemat(tmp_path / "e.mat", {**millimetres, "units": {"displacement": "mm"}})
    records = read_records(tmp_path, "bench", check=False)
    assert [r.name for r in records] == ["a", "b", "c", "d", "e"]
    for record in records:
        for name, values in truth.items():
            np.testing.assert_allclose(getattr(record, name), values, rtol=1e-14)


@pytest.mark.parametrize("zone", [None, "Europe/Berlin"])
def test_dates_tell_the_time_of_day(tmp_path: Path, zone: str | None) -> None:
    """Files of one day share a clock; one that runs past midnight goes on."""
    truth = signals()
    elapsed = np.round(1e3 * truth["time"]).astype(int)
    starts = {"a": datetime(2026, 7, 1, 10), "b": datetime(2026, 7, 1, 11, 0, 0, 500000),
              "c": datetime(2026, 7, 1, 23, 59, 59, 990000)}  # fmt: skip
    for name, start in starts.items():
        time = pl.Series("time", [start + timedelta(milliseconds=int(ms)) for ms in elapsed])
        time = time.dt.replace_time_zone(zone)
        frame = pl.DataFrame(truth).with_columns(time)
        frame.write_parquet(tmp_path / f"{name}.parquet")
    records = read_records(tmp_path, "bench")
    for record, begin in zip(records, (36000.0, 39600.5, 86399.99), strict=True):
        np.testing.assert_allclose(record.time, begin + 1e-3 * elapsed, rtol=0, atol=1e-9)
    assert records[2].time[-1] > 86400
    assert share_one_clock(records)


def test_parquet_with_durations_dates_and_integers(tmp_path: Path) -> None:
    truth = signals()
    micro = np.round(1e6 * truth["time"]).astype(np.int64)
    for dtype in (pl.Duration("us"), pl.Datetime("us")):
        frame = pl.DataFrame({
            "time": pl.Series(micro).cast(dtype),
            "displacement": truth["displacement"],
            "force": np.arange(80),
        })  # fmt: skip
        frame.write_parquet(tmp_path / "r.parquet")
        record = one(tmp_path / "r.parquet")
        np.testing.assert_allclose(record.time, truth["time"], atol=1e-12)
        np.testing.assert_array_equal(record.force, np.arange(80.0))


def test_record_properties(tmp_path: Path) -> None:
    path = tmp_path / "run 7.csv"
    path.write_text("# rig 3\n#  oil at 40 C\n" + csv_text(signals(start=12.0)))
    record = one(path)
    assert record.name == "run 7"
    assert record.source == path
    assert record.kind == "bench"
    assert record.samples == 80
    assert record.sample_rate == pytest.approx(1000.0)
    assert record.duration == pytest.approx(0.079)
    assert record.comments == ("rig 3", "oil at 40 C")
    assert record.velocity is None
    assert list(record.channels()) == ["displacement", "force"]


def test_records_are_immutable(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_text(csv_text(signals()))
    record = one(tmp_path / "r.csv")
    with pytest.raises(ValueError, match="read-only"):
        record.force[0] = 1.0
    with pytest.raises(dataclasses.FrozenInstanceError):
        record.name = "other"  # type: ignore[misc]
    warned = record.warn("outliers", "two")
    assert record.warnings == ()
    assert warned.warnings == (RecordWarning("outliers", "two"),)
    with pytest.raises(ValueError, match="unknown warning code 'spikes'"):
        record.warn("spikes", "two")


def test_a_record_does_not_follow_the_array_it_was_made_from() -> None:
    truth = signals()
    record = Record(name="r", **truth)  # type: ignore[arg-type]
    before = record.force.copy()
    truth["force"][:] = 0.0
    np.testing.assert_array_equal(record.force, before)
    with pytest.raises(ValueError, match=r"'force' has shape \(3,\)"):
        Record(name="r", time=truth["time"], displacement=truth["time"], force=np.zeros(3))


def test_further_columns_are_kept_as_written(tmp_path: Path) -> None:
    columns = signals()
    columns["Temperature[degC]"] = np.linspace(20.0, 30.0, 80)
    lines = csv_text(columns).splitlines()
    lines = [lines[0] + ",note,", *(line + ",good," for line in lines[1:])]
    (tmp_path / "r.csv").write_text("\n".join(lines))
    record = one(tmp_path / "r.csv")
    # text is no measurement, and a column without a name is some row number
    assert list(record.extra) == ["Temperature[degC]"]
    np.testing.assert_array_equal(record.extra["Temperature[degC]"], np.linspace(20.0, 30.0, 80))


def test_a_set_point_is_no_measured_velocity(tmp_path: Path) -> None:
    columns = signals() | {"speed_set [mm/s]": signals()["time"]}
    (tmp_path / "r.csv").write_text(csv_text(columns))
    record = one(tmp_path / "r.csv")
    assert record.velocity is None
    assert list(record.extra) == ["speed_set [mm/s]"]


def test_run_column_splits_interleaved_rows_in_order_of_appearance(tmp_path: Path) -> None:
    runs = {"up": signals(60), "down": signals(70, start=1.0), "3": signals(55, start=2.0)}
    parts = [
        [line + f",{name}" for line in csv_text(run).splitlines()[1:]] for name, run in runs.items()
    ]
    lines = ["time,displacement,force,Run", parts[0].pop(0), parts[1].pop(0)]
    while any(parts):
        lines += [part.pop(0) for part in parts if part]
    (tmp_path / "r.csv").write_text("\n".join(lines))
    records = read_records(tmp_path / "r.csv", "bench", check=False)
    assert [r.name for r in records] == ["r:up", "r:down", "r:3"]
    for record, run in zip(records, runs.values(), strict=True):
        np.testing.assert_array_equal(record.force, run["force"])


@pytest.mark.parametrize("suffix", [".parquet", ".mat"])
def test_run_numbers(suffix: str, tmp_path: Path) -> None:
    first, second = signals(60), signals(60, start=1.0)
    columns = {name: np.concatenate((first[name], second[name])) for name in first}
    columns["run"] = np.repeat([2.0, 1.0], 60)
    path = tmp_path / f"r{suffix}"
    if suffix == ".mat":
        savemat(path, columns)
    else:
        pl.DataFrame(columns).write_parquet(path)
    assert [r.name for r in read_records(path)] == ["r:2", "r:1"]


def test_folder_is_sorted_and_skips_other_files(tmp_path: Path) -> None:
    for name in ("b.csv", "a.CSV", "notes.txt", ".hidden.csv"):
        (tmp_path / name).write_text(csv_text(signals()))
    (tmp_path / "more").mkdir()
    assert [r.name for r in read_records(tmp_path)] == ["a", "b"]


def test_glob_and_order_of_arguments(tmp_path: Path) -> None:
    for name in ("run2", "run1", "other"):
        (tmp_path / f"{name}.csv").write_text(csv_text(signals()))
    (tmp_path / "run3.md").write_text("no record")
    found = read_records([tmp_path / "other.csv", str(tmp_path / "run*")])
    assert [r.name for r in found] == ["other", "run1", "run2"]


def test_a_file_name_may_look_like_a_glob(tmp_path: Path) -> None:
    path = tmp_path / "run[1].csv"
    path.write_text(csv_text(signals()))
    assert one(path).name == "run[1]"


def test_names_are_told_apart(tmp_path: Path) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "r.csv").write_text(csv_text(signals()))
    pl.DataFrame(signals()).write_parquet(tmp_path / "b" / "r.parquet")
    paths = [tmp_path / "a", tmp_path / "b", tmp_path / "a" / "r.csv"]
    names = [r.name for r in read_records(paths)]
    assert names == ["a/r.csv", "b/r.csv", "r.parquet", "a/r.csv#2"]


def test_bench_table(tmp_path: Path) -> None:
    path = tmp_path / "sweep.csv"
    path.write_text("Frequency[rpm],Force Amplitude[kN],Acceleration_amplitude[g]\n"
                    "60,1,0.5\n120,2,1\n180,3,2\n")  # fmt: skip
    (table,) = read_records(path)
    assert isinstance(table, BenchTable)
    assert table.kind == "table"
    assert table.samples == 3
    np.testing.assert_allclose(table.frequency, [1.0, 2.0, 3.0])
    np.testing.assert_allclose(table.force_amplitude, [1e3, 2e3, 3e3])
    np.testing.assert_allclose(table.acceleration_amplitude, [4.903325, 9.80665, 19.6133])


def test_vehicle_record(tmp_path: Path) -> None:
    time = 0.01 * np.arange(100)
    columns = {"time": time, "road": np.sin(time), "body_acceleration": np.cos(time),
               "tyre_force": np.sin(2.0 * time)}  # fmt: skip
    path = tmp_path / "drive.csv"
    path.write_text(csv_text(columns, {"road": "mm", "body_acceleration": "g", "tyre_force": "kN"}))
    (drive,) = read_records(path, "vehicle")
    assert isinstance(drive, VehicleRecord)
    np.testing.assert_allclose(drive.road, 1e-3 * columns["road"])
    assert drive.body_acceleration is not None
    np.testing.assert_allclose(drive.body_acceleration, 9.80665 * columns["body_acceleration"])
    assert drive.wheel_acceleration is None
    assert list(drive.channels()) == ["road", "body_acceleration", "tyre_force"]
    assert drive.warnings == ()


def test_a_bench_record_may_have_a_road_column(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_text(csv_text({**signals(), "road": np.zeros(80)}))
    assert one(tmp_path / "r.csv").kind == "bench"


@pytest.mark.parametrize(
    "cell",
    ["", "nan", " NaN ", "NA", "null", "inf", "-inf", "#N/A", "#NV", "#DIV/0!", "#WERT!", "#NAME?"],
)
def test_few_missing_cells_are_interpolated(cell: str, tmp_path: Path) -> None:
    truth = signals(400)
    lines = csv_text(truth).splitlines()
    for row in (100, 101, 300):
        lines[row + 1] = f"{truth['time'][row]!r},{truth['displacement'][row]!r},{cell}".replace(
            "np.float64(", "").replace(")", "")  # fmt: skip
    (tmp_path / "r.csv").write_text("\n".join(lines))
    record = one(tmp_path / "r.csv")
    (warning,) = record.warnings
    assert warning.code == "missing_samples"
    assert "3 of 400" in warning.text
    assert "line 102" in warning.text
    assert record.samples == 400
    # cubic pieces through a smooth signal: 300 N within a few thousandths
    np.testing.assert_allclose(record.force, truth["force"], atol=1.0)
    np.testing.assert_array_equal(record.displacement, truth["displacement"])


def test_missing_cells_at_the_ends_and_missing_times_are_dropped(tmp_path: Path) -> None:
    truth = signals(400)
    lines = csv_text(truth).splitlines()
    lines[1] = f"{float(truth['time'][0])!r},,"
    lines[200] = ",0.1,0.2"
    lines[400] = ",,"
    (tmp_path / "r.csv").write_text("\n".join(lines))
    record = one(tmp_path / "r.csv")
    np.testing.assert_array_equal(record.time, np.delete(truth["time"], [0, 199, 399]))
    assert "3 dropped" in record.warnings[0].text


def test_an_empty_optional_column_is_left_out(tmp_path: Path) -> None:
    lines = csv_text(signals()).splitlines()
    lines = [lines[0] + ",velocity", *(line + "," for line in lines[1:])]
    (tmp_path / "r.csv").write_text("\n".join(lines))
    record = one(tmp_path / "r.csv")
    assert record.velocity is None
    assert [w.code for w in record.warnings] == ["missing_samples"]


def test_parquet_nulls_are_missing_cells(tmp_path: Path) -> None:
    truth = signals(400)
    force: list[float | None] = truth["force"].tolist()
    force[7] = None
    pl.DataFrame({**truth, "force": force}).write_parquet(tmp_path / "r.parquet")
    record = one(tmp_path / "r.parquet")
    assert "row 8" in record.warnings[0].text
    np.testing.assert_allclose(record.force, truth["force"], atol=1.0)


@pytest.mark.parametrize(
    ("starts", "shared"),
    [
        ([0.0], True),
        ([0.0, 1.0, 2.0], True),
        ([2.0, 0.0, 1.0], True),
        ([0.0, 0.0], False),
        ([0.0, 0.05], False),
        ([0.0, 1.0, 1.05], False),
        ([], True),
    ],
)
def test_share_one_clock(starts: list[float], shared: bool) -> None:
    records = [Record(name="r", **signals(start=t)) for t in starts]  # type: ignore[arg-type]
    assert share_one_clock(records) is shared


def test_runs_may_touch() -> None:
    first, second = signals(), signals(start=0.079)
    second["time"] = first["time"] + first["time"][-1]
    records = [Record(name="r", **s) for s in (first, second)]  # type: ignore[arg-type]
    assert share_one_clock(records)


def test_reading_is_fast(tmp_path: Path) -> None:
    # a limit that only a row-by-row reader would exceed: 200 000 rows in two seconds
    columns = signals(200_000)
    buffer = io.BytesIO()
    pl.DataFrame(columns).write_csv(buffer)
    (tmp_path / "r.csv").write_bytes(buffer.getvalue())
    start = clock.perf_counter()
    record = one(tmp_path / "r.csv")
    assert clock.perf_counter() - start < 2.0
    assert record.samples == 200_000
