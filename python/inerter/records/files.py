"""The record files that an argument stands for: a file, a folder or a glob."""

from __future__ import annotations

import glob
from pathlib import Path

from .record import RecordError
from .table import EXTENSIONS, OF_FOLDERS

_SOME = ".csv, .xlsx, .tdms, .mf4, .mat, .h5, .parquet, ..."


def record_files(entry: str | Path) -> list[Path]:
    """The record files that one argument stands for; RecordError when there is none."""
    try:
        return _files(Path(entry).expanduser())
    except (OSError, ValueError, RuntimeError) as error:
        if isinstance(error, RecordError):
            raise
        # a folder that may not be entered, a name that no system bears
        reason = getattr(error, "strerror", None) or str(error)
        raise RecordError(f"{entry}: cannot be opened ({reason}); check the path") from None


def _files(path: Path) -> list[Path]:
    if path.is_dir():
        found = sorted(p for p in path.iterdir() if _is_record_file(p))
        if not found:
            raise RecordError(f"{path}: no records in this folder; {_instead(path)}")
        return found
    if path.exists() or not glob.has_magic(str(path)):
        return [path]
    matching = map(Path, glob.glob(str(path), recursive=True))
    found = sorted(p for p in matching if p.is_file() and p.suffix.lower() in EXTENSIONS)
    if not found:
        raise RecordError(f"{path}: no record ({_SOME}) matches; check the pattern and the folder")
    return found


def _instead(folder: Path) -> str:
    """What to do where no file of a folder is taken for a record by its name."""
    others = [p for p in folder.iterdir() if p.is_file() and p.suffix.lower() in EXTENSIONS]
    others = sorted(p for p in others if not p.name.startswith("."))
    if not others:
        return f"put {_SOME} files into it"
    more = f" and {len(others) - 1} more" if len(others) > 1 else ""
    verb = "are such" if more else "is one"
    return f"if {others[0].name}{more} {verb}, name the files: '{folder / f'*{others[0].suffix}'}'"


def _is_record_file(path: Path) -> bool:
    return path.is_file() and path.suffix.lower() in OF_FOLDERS and not path.name.startswith(".")
