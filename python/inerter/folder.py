"""Results in a folder: all of the files or none."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import re
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import Any


def refuse_folder(folder: Path) -> None:
    """Raise OSError where a folder cannot be made or written, before the work is done."""
    existing = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not existing.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "not a folder", str(existing))
    # rights do not tell of a read-only or a virtual file system: try
    try:
        os.rmdir(tempfile.mkdtemp(prefix=".writing-", dir=existing))
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(existing)) from None


def file_names(names: Sequence[str], otherwise: str) -> list[str]:
    """What files may be called after names from a model, all different; `otherwise_0` for none."""
    found: list[str] = []
    for i, name in enumerate(names):
        safe = re.sub(r"[^\w.+-]+", "_", name).strip("._") or f"{otherwise}_{i}"
        while safe.casefold() in [other.casefold() for other in found]:
            safe += "_2"
        found.append(safe)
    return found


def write_files(folder: Path, files: Mapping[str, bytes | str]) -> list[str]:
    """Write files by name into a folder, which is made, as are folders in names; the names.

    Everything is written beside its place first and moved there when complete. Where a move fails
    or is interrupted, what stood there before comes back.

    Raises
    ------
    ValueError
        A name leads out of the folder.
    OSError
        The folder cannot be written; nothing is left behind.
    """
    for name in files:
        if PurePosixPath(name).is_absolute() or ".." in PurePosixPath(name).parts:
            raise ValueError(f"the name {name!r} of a result leads out of {folder}; rename it")
    refuse_folder(folder)
    made = _make(folder)
    try:
        staging = Path(tempfile.mkdtemp(prefix=".writing-", dir=folder))
        try:
            _write(files, staging / "new")
            _keep(files, folder, staging / "old")
            _move(files, folder, staging)
        finally:
            shutil.rmtree(staging, ignore_errors=True)
    except BaseException as error:
        _unmake(made)
        if isinstance(error, OSError):
            raise OSError(error.errno, error.strerror, _place(error, folder)) from None
        raise
    return list(files)


def _make(folder: Path) -> list[Path]:
    """Make a folder; those that were not there, the deepest first."""
    missing = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        _unmake(missing)
        raise
    return missing


def _unmake(folders: Sequence[Path]) -> None:
    for path in folders:
        with contextlib.suppress(OSError):
            path.rmdir()


def _write(files: Mapping[str, bytes | str], place: Path) -> None:
    for name, content in files.items():
        data = content.encode("utf-8", "replace") if isinstance(content, str) else content
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_bytes(data)


def _keep(files: Mapping[str, bytes | str], folder: Path, place: Path) -> None:
    """Second names of the files that are to be replaced."""
    for name in files:
        if (folder / name).is_dir():
            raise IsADirectoryError(errno.EISDIR, "is a folder", str(folder / name))
        if (folder / name).exists():
            (place / name).parent.mkdir(parents=True, exist_ok=True)
            try:
                os.link(folder / name, place / name)
            except OSError:
                # a file system without links
                shutil.copy2(folder / name, place / name)


def _move(files: Mapping[str, bytes | str], folder: Path, staging: Path) -> None:
    made: list[Path] = []
    try:
        for name in files:
            made += _make((folder / name).parent)
            os.replace(staging / "new" / name, folder / name)
    except BaseException:
        for name in files:
            if (staging / "old" / name).exists():
                os.replace(staging / "old" / name, folder / name)
            elif not (staging / "new" / name).exists():
                (folder / name).unlink(missing_ok=True)
        _unmake(made[::-1])
        raise


def _place(error: OSError, folder: Path) -> str:
    """What could not be written, as the user knows it."""
    name = str(error.filename or "")
    return str(folder) if ".writing-" in name or not name else name


def json_text(data: Any) -> str:
    """Data as the text of a JSON file; null for numbers that are not finite."""
    return json.dumps(_finite(data), indent=2, allow_nan=False) + "\n"


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(each) for each in value]
    if isinstance(value, float) and not abs(value) < float("inf"):
        return None
    return value
