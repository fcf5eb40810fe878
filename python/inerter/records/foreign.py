"""Files of programs that have an export of their own: named, with what to write instead."""

from __future__ import annotations

import re
import zipfile
from pathlib import Path

_CSV = "export the record as CSV"
# how a file begins, and what it is
_BEGINNINGS: tuple[tuple[bytes, str], ...] = (
    (rb"\x1f\x8b", "is packed (gzip); unpack it"),
    (rb"BZh", "is packed (bzip2); unpack it"),
    (rb"\xfd7zXZ", "is packed (xz); unpack it"),
    (rb"\x28\xb5\x2f\xfd", "is packed (zstd); unpack it"),
    (rb"7z\xbc\xaf", "is packed (7z); unpack it"),
    (rb"Rar!", "is packed (rar); unpack it"),
    (rb"\|C[FK],", f"is a file of imc FAMOS; {_CSV}, MAT or TDMS"),
    (rb"\s*DIAdem-Header", "is the header of a DIAdem file, whose numbers lie in another one; "
     f"save it as TDMS, or {_CSV}"),
    (rb"\s*-1\r?\n\s*(?:58|151|55|82|2411|15)b?\s", f"is a universal file (UFF); {_CSV}"),
    (rb"\x93NUMPY", "is an array of NumPy without names; write CSV, Parquet or MATLAB"),
    (rb"%PDF", f"is a PDF; {_CSV}"),
    (rb"\s*[{]", f"is no table (JSON?); {_CSV}"),
    (rb"\s*<(?:\?xml|!DOCTYPE|html)", f"is no table (XML or HTML); {_CSV}"),
)  # fmt: skip
# files of programs by their endings
_ENDINGS = {
    ".dxd": "DEWESoft", ".d7d": "DEWESoft", ".bin": "catman or another program", ".tdm": "DIAdem",
    ".raw": "imc FAMOS or another program", ".pnrf": "HBM Perception",
    ".is_tens": "Instron Bluehill", ".is_tcyclic": "Instron Bluehill",
    ".zs2": "Zwick testXpert", ".mss": "MTS", ".svdx": "TwinCAT",
    ".wdf": "a YOKOGAWA recorder", ".psdata": "PicoScope", ".isf": "a Tektronix oscilloscope",
    ".wfm": "an oscilloscope", ".trc": "a LeCroy oscilloscope", ".svd": "Polytec",
    ".pvd": "Polytec", ".unv": "a modal analysis (UFF)", ".uff": "a modal analysis (UFF)",
    ".wdq": "WinDaq", ".bag": "ROS", ".mcap": "ROS", ".ulg": "PX4", ".npy": "NumPy",
    ".npz": "NumPy", ".pkl": "Python (a pickle, which is not opened)", ".slx": "Simulink",
}  # fmt: skip


def foreign(path: Path, start: bytes) -> str | None:
    """What a file is that no reader reads, and what to do; None where nothing tells it.

    start: its first bytes, some hundred.
    """
    for beginning, what in _BEGINNINGS:
        if re.match(beginning, start):
            return f"{path}: {what}"
    if start[:4] == b"PK\x03\x04" and not _is_workbook(path):
        what = "holds arrays of NumPy; write CSV, Parquet or MATLAB"
        return f"{path}: {what if path.suffix == '.npz' else 'is a zip archive; unpack it'}"
    if (program := _ENDINGS.get(path.suffix.lower())) is not None:
        return f"{path}: a file of {program}, which is not read; {_CSV}, TDMS, MDF4 or MATLAB"
    return None


def _is_workbook(path: Path) -> bool:
    """Whether a zip has parts of a workbook; a damaged one is left to the reader's error."""
    try:
        with zipfile.ZipFile(path) as archive:
            names = archive.namelist()
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError, EOFError):
        return True
    return any(n.startswith(("xl/", "[Content_Types]", "mimetype", "content.xml")) for n in names)
