"""What a reading says can be typed: a sign turned round, which of two columns, u of a formula."""

from __future__ import annotations

import shlex
from pathlib import Path

import numpy as np
import pytest
from inerter.records import Record, RecordError, read_records
from inerter.records.stated import reading

TIME = 1e-3 * np.arange(6000)
X = 0.02 * np.sin(8 * TIME) + 0.004 * np.sin(26 * TIME)
A = -0.02 * 64 * np.sin(8 * TIME) - 0.004 * 676 * np.sin(26 * TIME)


def written(path: Path, **columns: np.ndarray) -> Path:
    np.savetxt(
        path, np.column_stack(list(columns.values())), delimiter=",", comments="",
        header=",".join(columns),
    )  # fmt: skip
    return path


def one(path: Path, *columns: str) -> Record:
    with reading(columns):
        (record,) = read_records(path, "bench")
    return record


@pytest.mark.parametrize("stated", [(), ("force=-60 N/V * Force (V)",)])
def test_a_wrong_sign_says_what_turns_it_round(stated: tuple[str, ...], tmp_path: Path) -> None:
    header, values = ("Force (V)", A) if stated else ("Force (N)", -60 * A)
    path = written(tmp_path / "run.csv", **{"time": TIME, "Position (m)": X, header: values})
    (warning,) = one(path, *stated).warnings
    assert warning.code == "sign_flip"
    # what stands there, as a shell takes it
    words = shlex.split(warning.text.split("give ")[1].split(", or")[0])
    assert words[0] == "--column"
    mended = one(path, words[1])
    assert mended.warnings == ()
    np.testing.assert_allclose(mended.force, 60 * A, rtol=1e-12, atol=1e-12)


def test_which_of_two_forces_was_taken_is_told(tmp_path: Path) -> None:
    path = written(
        tmp_path / "run.csv",
        **{
            "time": TIME,
            "displacement": X,
            "Force (V)": A,
            "Force (N)": 60 * A,
            "Set force (N)": X,
        },
    )
    record = one(path)
    assert record.reading == "force = 'Force (N)', not 'Force (V)' or 'Set force (N)'"
    np.testing.assert_allclose(record.force, 60 * A)
    assert one(written(tmp_path / "own.csv", time=TIME, displacement=X, force=A)).reading == ""


def test_u_is_the_column_itself(tmp_path: Path) -> None:
    """Of its name, else the only one in volts; a column that is called u comes first."""
    volts = {"time": TIME, "Force [V]": 0.3 * A - 0.1, "Potentiometer [V]": 50 * X + 1}
    path = written(tmp_path / "run.csv", **volts)
    formulas = "force=200 N/V * (u + 0.1 V)", "displacement=(x - start) / 50 V/m"
    record = one(path, *formulas)
    np.testing.assert_allclose(record.force, 60 * A, atol=1e-9)
    np.testing.assert_allclose(record.displacement, X, atol=1e-12)
    called = written(tmp_path / "called.csv", **volts, u=A)
    assert one(called, "force=60 N * u", formulas[1]).headers["force"] == "60 N * u"
    # of two in volts none is meant
    path = written(tmp_path / "two.csv", **volts, **{"Other [V]": X})
    with pytest.raises(RecordError, match=r"displacement is stated as column 'x', which is not th"):
        one(path, *formulas)


def test_volts_are_asked_for_by_the_columns_name(tmp_path: Path) -> None:
    path = written(tmp_path / "run.csv", **{"time": TIME, "displacement": X, "Force [V]": A})
    with pytest.raises(RecordError, match=r"force='200 N/V \* Force'"):
        one(path)


def test_a_formula_that_is_none_is_told_how_one_is_written(tmp_path: Path) -> None:
    path = written(tmp_path / "run.csv", time=TIME, displacement=X, current_mA=A)
    with pytest.raises(RecordError, match=r"--column force='0.05 \* current_mA'"):
        one(path, "force=current_mA / 1000 * 50")
    with pytest.raises(RecordError, match=r"correct the statement$"):
        one(path, "force=current")
    np.testing.assert_allclose(one(path, "force=0.05 * current_mA").force, 0.05 * A)
