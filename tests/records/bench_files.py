"""Files as programs of benches write them, by writers of others where there is one.

Each case is a name, a writer, and what is said of it. All hold the same record.
"""

from __future__ import annotations

import datetime
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

ROWS = 400
STEP = 1e-3
TIME = STEP * np.arange(ROWS)
DISPLACEMENT = np.round(0.02 * np.sin(20 * TIME), 7)
FORCE = np.round(-60 * 8 * np.sin(20 * TIME) + 30 * np.sign(np.cos(20 * TIME)), 3)

Writer = Callable[[Path], None]


def lines(
    separator: str = ",",
    decimal: str = ".",
    *,
    length: float = 1.0,
    force: float = 1.0,
    time: str | None = "s",
    quote: bool = False,
    rows: int = ROWS,
) -> str:
    """Data lines; length, force: units per SI unit; time: "s", "ms", or None for no time column."""
    made = []
    for k in range(rows):
        cells = [f"{DISPLACEMENT[k] * length:.9g}", f"{FORCE[k] * force:.9g}"]
        if time is not None:
            cells.insert(0, f"{TIME[k]:.4f}" if time == "s" else f"{k}")
        cells = [cell.replace(".", decimal) for cell in cells]
        made.append(separator.join(f'"{cell}"' for cell in cells) if quote
                    else separator.join(cells))  # fmt: skip
    return "\n".join(made)


def text(head: str, body: str, foot: str = "", encoding: str = "utf-8", end: str = "\n") -> Writer:
    """A writer of a text file."""
    whole = f"{head}\n{body}\n{foot}".rstrip("\n") + "\n"
    data = whole.replace("\n", end).encode(encoding)

    def write(path: Path) -> None:
        path.write_bytes(data)

    return write


def _clock(form: str) -> str:
    start = datetime.datetime(2024, 5, 3, 23, 59, 59, 900_000)
    made = []
    for k in range(ROWS):
        at = start + datetime.timedelta(milliseconds=k)
        stamp = at.strftime(form).replace("%3", f"{at.microsecond // 1000:03d}")
        made.append(f"{stamp};{DISPLACEMENT[k] * 1e3:.9g};{FORCE[k]:.9g}")
    return "\n".join(made)


MTS = """MTS793|MPT|ENU|1|0|/|.|/|:|1|0|0|A

Data Header:\t\tTime:\t12.5\tSec\t5/3/2024 10:40:52 AM
Data Acquisition: Timed

Time\tAxial Displacement\tAxial Force
Sec\tmm\tkN"""
BLUEHILL = """"Results Table 1"
"","Maximum Load (N)","Extension at max (mm)","Modulus (MPa)"
"Specimen 1","510.0","20.0","12.1"

"Raw data"
"Time","Extension","Load"
"(s)","(mm)","(N)\""""
LABVIEW = """Timestamp;03.05.2024 10:40:52;Timestamp;03.05.2024 10:40:52
Interval;0,001;Interval;0,001
Channel name;"Weg";Channel name;"Kraft"
Unit;"mm";Unit;"N\""""
LVM = """LabVIEW Measurement
Writer_Version\t2
Reader_Version\t2
Separator\tTab
Decimal_Separator\t.
Multi_Headings\tNo
X_Columns\tOne
Time_Pref\tRelative
***End_of_Header***

Channels\t2
Samples\t400\t400
Date\t2024/05/03\t2024/05/03
Y_Unit_Label\tmm\tN
X_Dimension\tTime\tTime
X0\t0.0E+0\t0.0E+0
Delta_X\t0.001\t0.001
***End_of_Header***
X_Value\tDisplacement\tForce\tComment"""
DEWESOFT = """Data Info
File name: test_0001.dxd
Start time: 03.05.2024 10:40:52.123
Number of channels: 2
Sample rate: 1000

Time (s);Weg (mm);Kraft (N)"""
CATMAN = """HBM_CATMAN_DATAFILE_40
File: test.bin
Sample rate: 1000 Hz
Channels: 3
Time  1 - default sample rate\tWegaufnehmer Weg\tKMD Kraft
s\tmm\tN"""
TESTXPERT = '"Prüfzeit";"Standardweg";"Standardkraft"\n"s";"mm";"N"'
SERVO = """Axis1
Number of sampling data,400
Sampling time interval(ms),1.000
Position,Analog 2
mm,Load"""


def _labview_pairs() -> str:
    made = []
    for k in range(ROWS):
        cells = (k * STEP, DISPLACEMENT[k] * 1e3, k * STEP, FORCE[k])
        made.append(";".join(f"{c:.9g}".replace(".", ",") for c in cells))
    return "\n".join(made)


TEXTS: dict[str, Writer] = {
    "plain.csv": text("time,displacement,force", lines()),
    "semicolon.csv": text("time;displacement;force", lines(";")),
    "german.csv": text("Zeit [s];Weg [mm];Kraft [kN]", lines(";", ",", length=1e3, force=1e-3)),
    "tab.txt": text("Time\tPosition_mm\tForce_N", lines("\t", length=1e3)),
    "blanks.dat": text("t x F", lines("   ")),
    "padded.dat": text("  t     x     F", "\n".join("  " + x for x in lines("\t ").split("\n"))),
    "bar.txt": text("t|x|F", lines("|")),
    "commas_in_names.tsv": text("Time, s\tDisplacement, mm\tForce, N", lines("\t", length=1e3)),
    "strokes.csv": text("Time/s,Displacement/mm,Force/kN", lines(length=1e3, force=1e-3)),
    "units_row.csv": text("Time,Displacement,Force\ns,mm,N", lines(length=1e3)),
    "units_brackets.csv": text("Time,Extension,Load\n(s),(mm),(N)", lines(length=1e3)),
    "units_first.csv": text("s,mm,N\nTime,Extension,Load", lines(length=1e3)),
    "bom.csv": text("Zeit;Weg in mm;Kraft in N", lines(";", ",", length=1e3), encoding="utf-8-sig"),
    "utf16.txt": text("Time (s)\tStroke (mm)\tLoad (N)", lines("\t", length=1e3),
                      encoding="utf-16"),
    "utf16_be.txt": text("Time (s)\tStroke (mm)\tLoad (N)", lines("\t", length=1e3),
                         encoding="utf-16-be"),
    "latin1.csv": text("Zeit;Weg (µm);Kraft (N)", lines(";", ",", length=1e6), encoding="latin-1"),
    "crlf.csv": text("t;x [mm];F [N]", lines(";", length=1e3), end="\r\n"),
    "mac.csv": text("t;x [mm];F [N]", lines(";", length=1e3), end="\r"),
    "quoted.csv": text('"Time","Extension [mm]","Load [N]"', lines(length=1e3, quote=True)),
    "quoted_comma.csv": text('"Zeit","Weg [mm]","Kraft [N]"',
                             lines(",", ",", length=1e3, quote=True)),
    "milliseconds.csv": text("Time_ms,x,F", lines(time="ms")),
    "milliseconds_german.csv": text("Zeit [ms];Weg [mm];Kraft [N]",
                                    lines(";", ",", length=1e3, time="ms")),
    "rate.csv": text("Sample rate (Hz): 1000\n\nPosition [mm],Load [N]",
                     lines(length=1e3, time=None)),
    "interval.csv": text("Interval;0,001\nWeg [mm];Kraft [N]",
                         lines(";", ",", length=1e3, time=None)),
    "footer.csv": text("Time,Extension [mm],Load [N]", lines(length=1e3),
                       "\nEnd of data\nOperator: A. B., checked\n"),
    "trailing.csv": text("Time;Extension [mm];Load [N];",
                         "\n".join(x + ";" for x in lines(";", length=1e3).split("\n"))),
    "pounds.csv": text("Time [sec],Stroke [in],Load [lbf]",
                       lines(length=1 / 0.0254, force=1 / 4.4482216152605)),
    "french.csv": text("Temps (s);Déplacement (mm);Effort (N)", lines(";", ",", length=1e3)),
    "spanish.csv": text("Tiempo [s];Desplazamiento [mm];Fuerza [N]", lines(";", ",", length=1e3)),
    "italian.csv": text("Tempo (s);Spostamento (mm);Forza (N)", lines(";", ",", length=1e3)),
    "polish.csv": text("Czas [s];Przemieszczenie [mm];Siła [N]", lines(";", ",", length=1e3)),
    "chinese.csv": text("时间(s),位移(mm),力(N)", lines(length=1e3)),
    "mts.dat": text(MTS, lines("\t", length=1e3, force=1e-3)),
    "bluehill.csv": text(BLUEHILL, lines(length=1e3, quote=True)),
    "labview.csv": text(LABVIEW, _labview_pairs(), encoding="utf-8-sig", end="\r\n"),
    "labview.lvm": text(LVM, "\n".join(x + "\t" for x in lines("\t", length=1e3).split("\n"))),
    "dewesoft.csv": text(DEWESOFT, lines(";", ",", length=1e3)),
    "catman.asc": text(CATMAN, lines("\t", length=1e3), encoding="latin-1"),
    "testxpert.tra": text(TESTXPERT, lines(";", ",", length=1e3), encoding="latin-1"),
    "servo.csv": text(SERVO, lines(length=1e3, time=None)),
    "clock.csv": text("Uhrzeit;Weg [mm];Kraft [N]", _clock("%H:%M:%S.%%3")),
    "iso.csv": text("Timestamp;Weg [mm];Kraft [N]", _clock("%Y-%m-%dT%H:%M:%S.%%3Z")),
    "date.csv": text("Datum/Zeit;Weg [mm];Kraft [N]", _clock("%d.%m.%Y %H:%M:%S,%%3")),
}  # fmt: skip


# --- binary formats ----------------------------------------------------------------------------


def _xlsx(rows: list[list[Any]], sheets: dict[str, list[list[Any]]] | None = None) -> Writer:
    def write(path: Path) -> None:
        import openpyxl

        book = openpyxl.Workbook()
        sheet = book.active
        assert sheet is not None
        sheet.title = "Test"
        for row in rows:
            sheet.append(row)
        for name, others in (sheets or {}).items():
            second = book.create_sheet(name)
            for row in others:
                second.append(row)
        book.save(path)

    return write


def _data() -> list[list[Any]]:
    columns = (TIME.tolist(), (1e3 * DISPLACEMENT).tolist(), FORCE.tolist())
    return [list(row) for row in zip(*columns, strict=True)]


def _tdms(path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    about = {"wf_increment": STEP, "wf_start_offset": 0.0}
    with TdmsWriter(str(path)) as writer:
        writer.write_segment(
            [
                ChannelObject("bench", "Weg", 1e3 * DISPLACEMENT, {**about, "unit_string": "mm"}),
                ChannelObject("bench", "Kraft", FORCE, {**about, "unit_string": "N"}),
            ]
        )


def _tdms_two_rates(path: Path) -> None:
    from nptdms import ChannelObject, TdmsWriter

    slow = slice(None, None, 2)
    with TdmsWriter(str(path)) as writer:
        writer.write_segment(
            [
                ChannelObject("fast", "Time", TIME, {"unit_string": "s"}),
                ChannelObject("fast", "Force", FORCE, {"unit_string": "N"}),
                ChannelObject("slow", "Time", TIME[slow], {"unit_string": "s"}),
                ChannelObject("slow", "Stroke", 1e3 * DISPLACEMENT[slow], {"unit_string": "mm"}),
            ]
        )


def _mf4(path: Path) -> None:
    from asammdf import MDF, Signal

    file = MDF(version="4.10")
    file.append(
        [
            Signal(1e3 * DISPLACEMENT, TIME, unit="mm", name="Stroke"),
            Signal(FORCE, TIME, unit="N", name="Load"),
        ]
    )
    file.save(path, overwrite=True)


def _hdf5(path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        group = file.create_group("run")
        group.attrs["sample_rate"] = 1 / STEP
        for name, values, unit in (
            ("position", 1e3 * DISPLACEMENT, "mm"), ("load", FORCE, "N")
        ):  # fmt: skip
            group.create_dataset(name, data=values, compression="gzip").attrs["unit"] = unit


def _mat73(path: Path) -> None:
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("time", TIME), ("displacement", DISPLACEMENT), ("force", FORCE)):
            file.create_dataset(name, data=values[None, :]).attrs["MATLAB_class"] = np.bytes_(
                "double"
            )
    with path.open("r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")


def _mat5(path: Path) -> None:
    from scipy.io import savemat

    savemat(path, {"Zeit": TIME, "Weg": 1e3 * DISPLACEMENT, "Kraft": FORCE,
                   "units": {"Weg": "mm", "Kraft": "N"}})  # fmt: skip


def _table() -> Any:
    import pyarrow as pa

    return pa.table({"Time": TIME, "Stroke [mm]": 1e3 * DISPLACEMENT, "Load [N]": FORCE})


def _feather(path: Path) -> None:
    from pyarrow import feather

    feather.write_feather(_table(), str(path))


def _parquet(path: Path) -> None:
    from pyarrow import parquet

    parquet.write_table(_table(), str(path))


_NAMES = [["Time", "Extension", "Load"], ["s", "mm", "N"]]
BINARIES: dict[str, Writer] = {
    "sheet.xlsx": _xlsx([*_NAMES, *_data()]),
    "report.xlsx": _xlsx(
        [["Test report"], ["Operator", "A. B."], [], *_NAMES, *_data(), [], ["end"]],
        {"Notes": [["nothing", "here"]]},
    ),
    "named.csv": _xlsx([["Zeit [s]", "Weg [mm]", "Kraft [N]"], *_data()]),
    "wave.tdms": _tdms,
    "two_rates.tdms": _tdms_two_rates,
    "logger.mf4": _mf4,
    "data.h5": _hdf5,
    "new.mat": _mat73,
    "old.mat": _mat5,
    "frame.feather": _feather,
    "frame.parquet": _parquet,
}
