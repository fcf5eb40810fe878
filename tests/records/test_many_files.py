"""Files of benches, spreadsheets and loggers are read as they are, and it is said how."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from bench_files import DISPLACEMENT
from bench_programs import EXPORTS
from bench_table import CASES, differs, read_case
from inerter.records import RecordError, read_records
from inerter.records.stated import FILE, reading

# written in our own names, points and commas: nothing is to be told
SILENT = ("new.mat", "pandas_index.csv", "compound.h5")
# what is said of some, word for word
SAID = {
    "plain.csv": "",
    "german.csv": "semicolon, decimal comma; time = 'Zeit [s]', displacement = 'Weg [mm]', "
    "force = 'Kraft [kN]'",
    "mts.dat": "tab, 3 preamble lines, units from line 7; displacement = "
    "'Axial Displacement [mm]', force = 'Axial Force [kN]'",
    "named.csv": "Excel file named .csv; time = 'Zeit [s]', displacement = 'Weg [mm]', "
    "force = 'Kraft [N]'",
    "footer.csv": "2 footer lines left out; displacement = 'Extension [mm]', force = 'Load [N]'",
}


def test_there_are_forty_files() -> None:
    assert len(CASES) >= 40


@pytest.mark.parametrize("name", CASES)
def test_a_file_is_read_with_its_values_or_refused(name: str, tmp_path: Path) -> None:
    case, path = CASES[name], tmp_path / name
    if name == "polars_xlsxwriter.xlsx":
        pytest.importorskip("xlsxwriter")
    if case.refused:
        with pytest.raises(RecordError) as caught:
            read_case(case, path)
        said = str(caught.value)
        assert said.startswith(str(path))
        assert case.refused in said
        assert "\n" not in said
        return
    record = read_case(case, path)
    assert differs(record, case.within) == ""
    if name in SAID:
        assert record.reading == SAID[name]
    elif name not in SILENT:
        assert record.reading


def test_two_files_of_a_recorder_with_a_channel_each_are_joined(tmp_path: Path) -> None:
    """As oscilloscopes write them: the same times, no motion in both."""
    one, two = tmp_path / "F0000CH1.CSV", tmp_path / "F0000CH2.CSV"
    EXPORTS["tektronix_tds.csv"].write(one)
    two.write_text(one.read_text().replace("Source,CH1", "Source,CH2"))
    stated = ["displacement=10 mm/V * CH1", "force=100 N/V * CH2"]
    with reading(stated, partner=two):
        (record,) = read_records(one, "bench")
    np.testing.assert_allclose(record.displacement, DISPLACEMENT, atol=1e-12)
    np.testing.assert_allclose(record.force, 1e4 * DISPLACEMENT, atol=1e-7)
    assert "the same times in both files" in record.reading


def test_a_channel_of_another_length_without_a_clock_is_refused(tmp_path: Path) -> None:
    """Found by the fuzz: a group of a TDMS file that had lost its time."""
    from nptdms import ChannelObject, TdmsWriter

    path = tmp_path / "run.tdms"
    with TdmsWriter(str(path)) as writer:
        writer.write_segment(
            [
                ChannelObject("a", "Time [s]", 1e-3 * np.arange(400)),
                ChannelObject("a", "Force [N]", np.arange(400.0)),
                ChannelObject("b", "Position [mm]", np.arange(200.0)),
            ]
        )
    assert "'Position [mm]' has not as many values as the others" in refusal(path)


def test_a_unit_that_is_needed_is_the_one_that_fits(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", "t;servo speed;F [N]", ROW)
    stated = "velocity=20 mm/rev * servo speed"
    assert "such as 'servo speed [rpm]'" in refusal(path, stated)
    with reading([f"{stated} [rpm]"]):
        (record,) = read_records(path, "bench")
    assert "velocity = 20 mm/rev * servo speed [rpm]" in record.reading
    # integrated: 1.5 turns a minute for a thousandth of a second
    assert np.ptp(record.displacement) < 60 * 1e-3 * 6.5 * 0.02 / 60


def test_a_set_point_is_not_what_was_measured(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", "t;Sollweg [mm];Istweg [mm];Kraft [N]",
                   [f"{0.001 * k:.3f};9;{k % 7}.5;{k % 5}.25" for k in range(60)])  # fmt: skip
    assert read_records(path, "bench")[0].displacement[1] == pytest.approx(1.5e-3)


def test_columns_without_a_usual_name_go_by_their_units(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", "n;AI0 [mm];AI1 [kN];clock [ms]",
                   [f"{k};{k % 7}.5;{k % 5}.25;{k}" for k in range(60)])  # fmt: skip
    (record,) = read_records(path, "bench")
    assert record.force[1] == pytest.approx(1250.0)
    assert record.sample_rate == pytest.approx(1000.0)
    assert "displacement = 'AI0 [mm]'" in record.reading
    # of two it is not known which is meant
    path = written(tmp_path / "b.csv", "t;AI0 [mm];AI1 [N];AI2 [N]", [f"{r};1.5" for r in ROW])
    assert "no column 'force'" in refusal(path)


def refusal(path: Path, *columns: str) -> str:
    with pytest.raises(RecordError) as caught, reading(columns):
        read_records(path, "bench")
    assert "\n" not in str(caught.value)
    return str(caught.value)


def written(path: Path, head: str, rows: list[str]) -> Path:
    path.write_text("\n".join([head, *rows]) + "\n")
    return path


ROW = [f"{0.001 * k:.3f};{k % 7}.5;{k % 5}.25" for k in range(60)]


def test_every_missing_column_is_told_at_once(tmp_path: Path) -> None:
    said = refusal(written(tmp_path / "a.csv", "t;u1 [V];u2 [V]", ROW))
    for part in ("no column 'displacement', no column 'force'", "found: t, u1 [V], u2 [V]",
                 "--column displacement=", "--column force="):  # fmt: skip
        assert part in said


def test_no_advice_drops_a_unit(tmp_path: Path) -> None:
    said = refusal(written(tmp_path / "a.csv", "t;x [mm];F [V]", ROW))
    assert "--column force='200 N/V * F'" in said
    assert "'F [V]' is in V" in said


def test_of_a_current_the_motors_constant_is_asked_for(tmp_path: Path) -> None:
    said = refusal(written(tmp_path / "a.csv", "t;x [rad];i6 [A]", ROW), "force='i6 [A]'")
    assert "is a current; state the motor's constant" in said
    assert "--column force='0.5 N*m/A * i6'" in said


@pytest.mark.parametrize(
    ("head", "factor"),
    [("i_mA", 1e-3), ("current_A", 1.0), ("i mA", 1e-3), ("i [mA]", 1e-3), ("i_left", 1.0)],
)
def test_a_unit_behind_a_name_counts_in_a_formula(tmp_path: Path, head: str, factor: float) -> None:
    path = written(tmp_path / "a.csv", f"t;x [rad];{head}", ROW)
    with reading([f"torque=0.4 N*m/A * {head}"]):
        (record,) = read_records(path, "bench")
    assert record.force[:5] == pytest.approx(
        0.4 * factor * np.array([0.25, 1.25, 2.25, 3.25, 4.25])
    )


def test_two_columns_that_may_be_meant_are_both_shown(tmp_path: Path) -> None:
    rows = [f"{row};1.5" for row in ROW]
    path = written(tmp_path / "a.csv", "t;Position [mm];Extension [mm];F [N]", rows)
    assert "--column displacement='Position [mm]' or" in refusal(path)
    with reading(["displacement=Extension [mm]"]):
        (record,) = read_records(path, "bench")
    assert record.displacement[1] == pytest.approx(1.25e-3)


def test_groups_of_thousands_or_decimals_are_asked_for(tmp_path: Path) -> None:
    rows = [f"{k + 1},{k % 900 + 100:03d};{k + 2},123;{k + 3},456" for k in range(60)]
    path = written(tmp_path / "a.csv", "t;x [mm];F [N]", rows)
    said = refusal(path)
    assert "1.100 (decimal comma) or 1100 (groups of thousands)" in said
    with reading(decimal="comma"):
        assert read_records(path, "bench")[0].force[0] == 3.456


def test_a_calibration_is_stated_and_remembered(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", "t;pot [V];u [V]", ROW)
    stated = ["force=-200 N/V * (u + 0.115 V)", "displacement=(pot - start) / 55.4 V/m"]
    with reading(stated) as now:
        (record,) = read_records(path, "bench")
        assert now.remember() == tmp_path / FILE
        assert now.remember() is None
    u, pot = (np.array([float(row.split(";")[i]) for row in ROW]) for i in (2, 1))
    np.testing.assert_allclose(record.force, -200 * (u + 0.115), rtol=1e-12)
    np.testing.assert_allclose(record.displacement, (pot - pot[0]) / 55.4, atol=1e-15)
    # without a word on the command line, from the file beside the data
    (again,) = read_records(path, "bench")
    np.testing.assert_array_equal(again.force, record.force)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("u", 2.0), ("'u [kN]'", 2000.0), ("-1 * u", -2.0), ("-u", -2.0), ("u / 4", 0.5),
        ("3 N/V * u", 6.0), ("3 kN/V * (u - 1 V)", 3000.0), ("2 lbf/V * u", 17.792886461042),
        ("u * 3 N/V", 6.0), ("u * 2", 4.0), ("'u' * 1 N*m", 2.0),
    ],
)  # fmt: skip
def test_formulas(text: str, value: float, tmp_path: Path) -> None:
    rows = [f"{0.001 * k:.3f};{k % 7}.5;2.0" for k in range(60)]
    path = written(tmp_path / "a.csv", "t;x;u", rows)
    with reading([f"force={text}"]):
        assert read_records(path, "bench")[0].force[0] == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("toml", "said"),
    [
        ("[[files]]\nwhat = 1", "an entry has a key 'what'"),
        ("[[files]]\n[files.columns]\nforce = 3", "force is 3; give a text"),
        ("[[files]]\n[files.columns]\nforce = {scale = 'x'}", "'x' is no quantity"),
        ("[[files]]\n[files.columns]\nforce = {polarity = 2}", "polarity of force is 2"),
        ("[[files]]\n[files.columns]\ncolour = 'x'", "'colour' is no quantity of a record"),
        ("[[files]]\n[files.columns]\nforce = 'nobody'", "column 'nobody', which is not there"),
        ("[[files]]\n[files.columns]\nforce = '2 kg * F'", "kg times N is not a force"),
        ("[[files]]\ndecimal = 'x'", "decimal is 'x'; take one of point, comma"),
        ("files = 3", "'files' is no list of entries"),
        ("[[files]]\nwith = 3", "are not all texts"),
    ],
)
def test_a_statement_that_cannot_be_is_refused(toml: str, said: str, tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", "t;x [mm];F [N]", ROW)
    (tmp_path / FILE).write_text(toml)
    assert said in refusal(path)


def test_a_delay_and_a_filter_are_dealt_with(tmp_path: Path) -> None:
    from scipy.signal import butter, sosfilt, sosfilt_zi

    time = 1e-3 * np.arange(3000)
    x, force = 0.01 * np.sin(9 * time), 5 * np.cos(9 * time)
    late = 5 * np.cos(9 * (time - 0.004))
    sections = butter(2, 30.0, fs=1000, output="sos")
    slow = sosfilt(sections, force, zi=sosfilt_zi(sections) * force[0])[0]
    path = tmp_path / "a.csv"
    for column, keys in ((late, 'delay = "4 ms"'), (slow, 'filter = "30 Hz"')):
        np.savetxt(path, np.column_stack([time, x, column]), delimiter=",", comments="",
                   header="t,x,load", fmt="%.12g")  # fmt: skip
        (tmp_path / FILE).write_text(
            f'[[files]]\n[files.columns]\nforce = {{column = "load", {keys}}}\n'
        )
        (record,) = read_records(path, "bench")
        # force and displacement are as far apart as they were before the sensor
        middle = slice(500, -500)
        phase = np.corrcoef(record.force[middle], np.gradient(record.displacement)[middle])[0, 1]
        assert phase > 0.999999
