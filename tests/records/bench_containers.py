"""Files of programs that are no plain text, and packed ones, with the record of `bench_files`."""

from __future__ import annotations

import datetime
import gzip
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from bench_export import MM, VOLTS, Export, rows, scope
from bench_files import DISPLACEMENT, FORCE, ROWS, STEP, TIME, Writer, lines, text


def _controldesk_mat(path: Path) -> None:
    from scipy.io import savemat

    def series(name: str, values: Any, unit: str) -> dict[str, Any]:
        return {"Name": name, "Type": "Measurement", "Data": values[None, :], "Unit": unit}

    channels = [series("Position", MM, "mm"), series("Load", FORCE, "N")]
    kinds = [(key, object) for key in channels[0]]
    made = np.empty((1, 2), dtype=kinds)
    for index, channel in enumerate(channels):
        for key, value in channel.items():
            made[0, index][key] = value
    savemat(path, {"bench_001": {"X": series("time", TIME, "s"), "Y": made, "Description": "x"}})


def _picoscope_mat(path: Path) -> None:
    from scipy.io import savemat

    savemat(path, {"A": VOLTS[0][:, None].astype("f4"), "B": VOLTS[1][:, None].astype("f4"),
                   "Tstart": -0.2, "Tinterval": STEP, "Length": ROWS,
                   "ExtraSamples": 0, "RequestedLength": ROWS})  # fmt: skip


def _matrix_mat(path: Path) -> None:
    from scipy.io import savemat

    savemat(path, {"data": np.column_stack([TIME, DISPLACEMENT, FORCE])})


def _xlsxwriter(path: Path) -> None:
    import polars as pl

    pl.DataFrame({"Zeit [s]": TIME, "Weg [mm]": MM, "Kraft [N]": FORCE}).write_excel(path)


def _xlsx_dates(path: Path) -> None:
    import openpyxl

    book = openpyxl.Workbook()
    sheet = book.active
    assert sheet is not None
    sheet.append(["Testbericht", None, None])
    sheet.append(["Datum/Uhrzeit", "Weg", "Kraft"])
    sheet.append([None, "mm", "N"])
    start = datetime.datetime(2024, 5, 3, 10, 40, 52)
    for k in range(ROWS):
        sheet.append([start + datetime.timedelta(milliseconds=k), MM[k], FORCE[k]])
    book.save(path)


def _pandas_hdf(path: Path) -> None:
    import h5py

    with h5py.File(path, "w") as file:
        made = np.zeros(ROWS, dtype=[("time", "f8"), ("displacement", "f8"), ("force", "f8")])
        made["time"], made["displacement"], made["force"] = TIME, DISPLACEMENT, FORCE
        file.create_dataset("bench/table", data=made)


def _tdms_start(path: Path) -> None:
    from nptdms import ChannelObject, RootObject, TdmsWriter

    about = {"wf_increment": STEP, "wf_start_time": np.datetime64("2024-05-03T10:40:52"),
             "wf_samples": ROWS}  # fmt: skip
    with TdmsWriter(str(path)) as writer:
        for part in (slice(0, 150), slice(150, None)):
            writer.write_segment(
                [
                    RootObject({"Operator": "A. B."}),
                    ChannelObject("Log", "LVDT", MM[part], {**about, "NI_UnitDescription": "mm"}),
                    ChannelObject("Log", "Load cell", FORCE[part],
                                  {**about, "NI_UnitDescription": "N"}),
                ]
            )  # fmt: skip


def _mf4_two_groups(path: Path) -> None:
    from asammdf import MDF, Signal

    file = MDF(version="4.10")
    file.append([Signal(FORCE, TIME, unit="N", name="F_Zyl")], comment="raster 1 ms")
    file.append([Signal(MM[::2], TIME[::2], unit="mm", name="Weg_Zyl")], comment="raster 2 ms")
    file.save(path, overwrite=True)


def _gz(path: Path) -> None:
    path.write_bytes(gzip.compress(("time,displacement,force\n" + lines()).encode()))


def _zip(path: Path) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("run.csv", "time,displacement,force\n" + lines())


def _npz(path: Path) -> None:
    np.savez(path, time=TIME, displacement=DISPLACEMENT, force=FORCE)


def _bytes(data: bytes) -> Writer:
    def write(path: Path) -> None:
        path.write_bytes(data)

    return write


CONTAINERS: dict[str, Export] = {
    "controldesk.mat": Export(_controldesk_mat),
    "picoscope.mat": Export(_picoscope_mat, scope("A", "B"), within=(1e-8, 1e-4)),
    "matrix.mat": Export(_matrix_mat, ("time=data 1", "displacement=data 2", "force=data 3")),
    "polars_xlsxwriter.xlsx": Export(_xlsxwriter),
    "dates.xlsx": Export(_xlsx_dates),
    "compound.h5": Export(_pandas_hdf),
    "daqmx_log.tdms": Export(_tdms_start),
    "two_rasters.mf4": Export(_mf4_two_groups, within=(1e-7, 1e-8)),
    "run.csv.gz": Export(_gz, refused="unpack it"),
    "run.zip": Export(_zip, refused="unpack it"),
    "arrays.npz": Export(_npz, refused="NumPy"),
    "famos.dat": Export(_bytes(b"|CF,2,1,1;|CK,1,3,1,1;|NO,1,12,7,FAMOS-7,0,;\x00\x01" * 20),
                        refused="FAMOS"),
    "diadem.dat": Export(text("DIAdem-Header\n#BEGINGLOBALHEADER\n1,WINDOWS 32Bit",
                              "#ENDGLOBALHEADER\n#BEGINCHANNELHEADER\n200,Force\n202,N\n"
                              "#ENDCHANNELHEADER"), refused="DIAdem"),
    "universal.unv": Export(text("    -1\n    58", "NONE\n" * 5 + "    -1"),
                            refused="universal file"),
    "text.xls": Export(text("Zeit [s]\tWeg [mm]\tKraft [N]",
                            rows(TIME, MM, FORCE, separator="\t", decimal=","))),
}  # fmt: skip
