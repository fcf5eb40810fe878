"""`inerter prepare` as a user runs it: records in every format in, a clean one and a page out."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from inerter.commands import app
from inerter.records import Record, RecordError, read_records
from inerter.records.prepare.options import Options
from inerter.records.prepare.output import file_names, write_prepared
from inerter.records.prepare.pipeline import prepare_records
from scipy.io import savemat
from typer.testing import CliRunner, Result

H, N = 1e-3, 6000
LATE = 2.3e-3
NOISE = 4.0


def signals(k: int, time: np.ndarray) -> np.ndarray:
    """Derivative k of a motion of five tones."""
    tones = ((8e-3, 1.0, 0.3), (2e-3, 2.7, 1.0), (1e-3, 4.1, 2.0), (5e-4, 5.7, 0.5), (3e-4, 7.3, 4))
    return sum(
        size * (2 * np.pi * f) ** k * np.sin(2 * np.pi * f * time + phase + k * np.pi / 2)
        for size, f, phase in tones
    )  # type: ignore[return-value]


def clean_force(time: np.ndarray) -> np.ndarray:
    return 60 * signals(2, time) + 100 * signals(1, time)


TIME = H * np.arange(N, dtype=float)
_RANDOM = np.random.default_rng(5)
COLUMNS = {
    "time": TIME,
    "displacement": signals(0, TIME) + _RANDOM.normal(0, 1e-6, N),
    "force": clean_force(TIME - LATE) + _RANDOM.normal(0, NOISE, N),
    "temperature": 20 + 0.1 * TIME,
}


def inerter(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "inerter", *map(str, arguments)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip


def prepare(*arguments: str | Path) -> Result:
    """The command in this process: a quarter of the time."""
    return CliRunner().invoke(app, ["prepare", *map(str, arguments)])


@pytest.fixture
def record(tmp_path: Path) -> Path:
    path = tmp_path / "bench.csv"
    path.write_text("# a rig\n" + pl.DataFrame(COLUMNS).write_csv())
    return path


def test_everything_at_once(record: Path, tmp_path: Path) -> None:
    out = tmp_path / "deep" / "out"
    done = inerter(
        "prepare", record, "--denoise", "emd", "--derivatives", "--delay", "auto",
        "--resample", "400", "--json", "--out", out,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    found = json.loads(done.stdout)
    assert found == json.loads((out / "preparation.json").read_text())
    assert found["schema"] == "inerter.preparation/1"
    assert sorted(p.name for p in out.iterdir()) == ["bench.csv", "bench.png", "preparation.json"]
    assert (out / "bench.png").read_bytes().startswith(b"\x89PNG")
    (said,) = found["records"]

    # delay: within three standard errors, and the force is moved back by it
    delay = said["delay"]
    assert delay["significant"]
    assert abs(delay["applied"] - LATE) < 3 * delay["all_records"]["stderr"]

    # noise: estimated, and every mode told
    assert said["denoised"]["force"]["noise"] == pytest.approx(NOISE, rel=0.15)
    modes = said["denoised"]["force"]["modes"]
    assert [m["kept"] for m in modes] == sorted(m["kept"] for m in modes)
    assert not modes[0]["kept"]
    assert all(m["rms"] > m["limit_rms"] for m in modes if m["kept"])

    # the record: readable, uniform, and close to the truth
    (after,) = read_records(out / "bench.csv", "bench")
    assert after.warnings == ()
    assert after.sample_rate == pytest.approx(400)
    assert after.comments[0] == "a rig"
    assert any("denoised by emd" in comment for comment in after.comments)
    assert np.std(after.force - clean_force(after.time)) < 0.4 * NOISE
    assert after.velocity is not None
    assert after.acceleration is not None
    for k, values in ((1, after.velocity), (2, after.acceleration)):
        true = signals(k, after.time)
        assert np.std(values - true) < 0.05 * np.std(true)
    np.testing.assert_allclose(after.extra["temperature"], 20 + 0.1 * after.time, atol=1e-9)


@pytest.mark.parametrize("suffix", ["csv", "parquet", "mat"])
def test_nothing_asked_is_the_record_itself(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"bench.{suffix}"
    table = pl.DataFrame(COLUMNS)
    if suffix == "mat":
        savemat(path, COLUMNS)
    elif suffix == "parquet":
        table.write_parquet(path)
    else:
        table.write_csv(path)
    for form in ("csv", "parquet"):
        done = prepare(path, "--format", form, "--out", tmp_path / form)
        assert (done.exit_code, done.stderr) == (0, "")
        (after,) = read_records(tmp_path / form / f"bench.{form}", "bench")
        for name in ("time", "displacement", "force"):
            np.testing.assert_array_equal(getattr(after, name), COLUMNS[name])
        np.testing.assert_array_equal(after.extra["temperature"], COLUMNS["temperature"])


def test_runs_of_one_file_and_units(tmp_path: Path) -> None:
    table = pl.DataFrame(
        {
            "time[ms]": 1e3 * TIME, "displacement[mm]": 1e3 * COLUMNS["displacement"],
            "force[kN]": 1e-3 * COLUMNS["force"],
            "run": ["a b"] * (N // 2) + ["a/b"] * (N // 2),
        }
    )  # fmt: skip
    table.write_csv(tmp_path / "two.csv")
    out = tmp_path / "out"
    done = prepare(tmp_path / "two.csv", "--denoise", "lowpass", "--out", out)
    assert (done.exit_code, done.stderr) == (0, "")
    names = sorted(p.name for p in out.glob("*.csv"))
    assert names == ["two_a_b.csv", "two_a_b_2.csv"]
    first = read_records(out / "two_a_b.csv", "bench")[0]
    np.testing.assert_allclose(first.displacement, COLUMNS["displacement"][: N // 2], rtol=1e-12)
    assert np.std(first.force - clean_force(first.time - LATE)) < 0.5 * NOISE


def test_measured_velocity_is_kept_and_acceleration_derived() -> None:
    measured = signals(1, TIME) + np.random.default_rng(0).normal(0, 1e-4, N)
    record = Record(
        name="r", time=TIME, displacement=COLUMNS["displacement"], force=clean_force(TIME),
        velocity=measured,
    )  # fmt: skip
    (done,) = prepare_records([record], Options(derivatives=True))
    after = done.record
    assert isinstance(after, Record)
    assert done.found["derivatives"]["columns"] == ["acceleration"]
    begin = done.found["derivatives"]["cut"][0]
    np.testing.assert_array_equal(after.velocity, measured[begin : begin + after.samples])
    np.testing.assert_array_equal(after.time, TIME[begin : begin + after.samples])


@pytest.mark.parametrize("delay", [LATE, -LATE])
def test_a_stated_delay_is_taken_out(delay: float) -> None:
    record = Record(
        name="r", time=TIME, displacement=signals(0, TIME), force=clean_force(TIME - delay)
    )
    (done,) = prepare_records([record], Options(delay=delay))
    after = done.record
    assert isinstance(after, Record)
    assert N - after.samples == 3
    error = (after.force - clean_force(after.time))[200:-200]
    assert np.max(np.abs(error)) < 1e-4 * np.max(np.abs(after.force))
    # the other channels stay where they are
    np.testing.assert_allclose(after.displacement, signals(0, after.time), atol=1e-15)


def test_the_delay_of_several_runs_is_one() -> None:
    records = []
    for seed in range(3):
        noise = np.random.default_rng(seed).normal(0, NOISE, N)
        force = clean_force(TIME - LATE) + noise
        records.append(
            Record(name=f"r{seed}", time=TIME, displacement=signals(0, TIME), force=force)
        )
    done = prepare_records(records, Options(delay="auto"))
    assert len({p.found["delay"]["applied"] for p in done}) == 1
    single = done[0].found["delay"]["this_record"]["stderr"]
    assert done[0].found["delay"]["all_records"]["stderr"] < single


def test_no_delay_is_found_and_none_taken_out() -> None:
    force = clean_force(TIME) + np.random.default_rng(2).normal(0, NOISE, N)
    record = Record(name="r", time=TIME, displacement=signals(0, TIME), force=force)
    (done,) = prepare_records([record], Options(delay="auto"))
    assert done.found["delay"]["applied"] == 0
    np.testing.assert_array_equal(done.record.channels()["force"], force)


def test_an_odd_clock_is_made_even_and_told() -> None:
    time = np.cumsum(np.random.default_rng(6).uniform(0.5e-3, 1.5e-3, N))
    record = Record(name="r", time=time, displacement=signals(0, time), force=clean_force(time))
    (done,) = prepare_records([record], Options())
    after = done.record
    assert isinstance(after, Record)
    assert not done.found["clock"]["uniform"]
    assert "not uniform" in done.found["notes"][0]
    assert np.ptp(np.diff(after.time)) < 1e-12
    assert np.max(np.abs(after.force - clean_force(after.time))[5:-5]) < 1e-3
    assert after.warnings == ()


def test_noise_that_is_not_white_is_told() -> None:
    """A force that was low-passed before it was stored shows no white noise."""
    coloured = np.convolve(np.random.default_rng(0).normal(0, 20, N), np.hanning(11) / 10, "same")
    record = Record(
        name="r", time=TIME, displacement=signals(0, TIME), force=clean_force(TIME) + coloured
    )
    (done,) = prepare_records([record], Options(denoise="emd"))
    assert any("state its --cutoff" in note for note in done.found["notes"])
    (stated,) = prepare_records([record], Options(denoise="lowpass", cutoff=20.0))
    assert stated.found["denoised"]["force"]["cutoff"] == 20.0
    before, after = (
        np.std((values - clean_force(TIME))[500:-500])
        for values in (record.force, stated.record.channels()["force"])
    )
    assert after < 0.7 * before


def test_vehicle_records_are_resampled_and_have_no_delay(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    pl.DataFrame(
        {"time": TIME, "road": signals(0, TIME), "body_acceleration": signals(2, TIME)}
    ).write_csv(path)
    (done,) = prepare_records(read_records(path), Options(rate=250.0))
    assert done.record.sample_rate == pytest.approx(250)
    channels = done.record.channels()
    error = channels["body_acceleration"] - signals(2, done.record.time)
    assert np.max(np.abs(error)[50:-50]) < 1e-3
    with pytest.raises(RecordError, match="vehicle record"):
        prepare_records(read_records(path), Options(delay="auto"))


# ------------------------------ refusals: one line, status 2, nothing written ------------------


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--denoise", "wavelet"), "--denoise is 'wavelet'; take one of emd, savgol"),
        (("--channel", "velocity", "--denoise", "emd"), "no column 'velocity' to denoise"),
        (("--delay", "late"), "--delay is 'late'; give 'auto' or seconds"),
        (("--delay", "3"), "--delay is 3 s; give seconds, between -1 and 1"),
        (("--delay", "nan"), "--delay is nan s"),
        (("--resample", "0"), "--resample is 0; give a positive number"),
        (("--resample", "1"), "less than 50; choose another rate"),
        (("--resample", "1e12"), "more than memory holds"),
        (("--noise", "-1"), "--noise is -1; give a positive number"),
        (("--cutoff", "600", "--derivatives"), "--cutoff is 600 Hz and the record has 1000"),
        (("--cutoff", "0.5", "--derivatives"), "samples are far enough from the ends"),
        (("--format", "xlsx"), "--format is 'xlsx'; take one of csv, parquet"),
    ],
)
def test_refusals(arguments: tuple[str, ...], said: str, record: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    done = prepare(record, *arguments, "--out", out)
    assert done.exit_code == 2
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert not out.exists()


def test_the_record_is_not_overwritten(record: Path) -> None:
    before = record.read_bytes()
    done = prepare(record, "--out", record.parent)
    assert done.exit_code == 2
    assert "this is the record itself; choose another folder" in done.stderr
    assert record.read_bytes() == before
    assert [p.name for p in record.parent.iterdir()] == ["bench.csv"]


def test_a_delay_longer_than_the_record_is_refused() -> None:
    record = Record(
        name="r", time=TIME[:300], displacement=signals(0, TIME[:300]),
        force=clean_force(TIME[:300]),
    )  # fmt: skip
    with pytest.raises(RecordError, match=r"moved by 0\.9 s only 0 samples"):
        prepare_records([record], Options(delay=0.9))


def test_a_table_and_a_gap_are_refused(tmp_path: Path) -> None:
    table = tmp_path / "table.csv"
    table.write_text("frequency,force_amplitude,acceleration_amplitude\n1,1,1\n2,2,2\n3,3,3\n")
    assert "a table of amplitudes" in prepare(table, "--out", tmp_path / "o").stderr
    keep = np.r_[0:2000, 2040:N]
    record = Record(
        name="r", time=TIME[keep], displacement=signals(0, TIME)[keep],
        force=clean_force(TIME)[keep],
    )  # fmt: skip
    with pytest.raises(RecordError, match=r"40 samples are missing after t = 1\.999 s"):
        prepare_records([record], Options())


def test_all_files_or_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    record = Record(name="r", time=TIME, displacement=signals(0, TIME), force=clean_force(TIME))
    done = prepare_records([record], Options())
    assert file_names([*done, *done]) == ["r", "r_2"]

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.write_bytes", fail)
    with pytest.raises(OSError, match="No space"):
        write_prepared(done, Options(), tmp_path / "out")
    assert not (tmp_path / "out").exists()
