"""Results in a folder: all of the files or none."""

from __future__ import annotations

import errno
import json
import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any


def refuse_folder(folder: Path) -> None:
    """Raise OSError where a folder cannot be made or written, before the work is done."""
    existing = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not existing.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "not a folder", str(existing))
    if not os.access(existing, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, "no permission to write", str(existing))


def write_files(folder: Path, files: Mapping[str, bytes | str]) -> list[str]:
    """Write files by name into a folder, which is made, as are folders in names; the names.

    Everything is written beside its place first and moved there when complete.

    Raises
    ------
    OSError
        The folder cannot be written; nothing is left behind.
    """
    refuse_folder(folder)
    folder.mkdir(parents=True, exist_ok=True)
    staging = Path(tempfile.mkdtemp(prefix=".writing-", dir=folder))
    try:
        for name, content in files.items():
            data = content.encode("utf-8", "replace") if isinstance(content, str) else content
            (staging / name).parent.mkdir(exist_ok=True)
            (staging / name).write_bytes(data)
        for name in files:
            (folder / name).parent.mkdir(exist_ok=True)
            os.replace(staging / name, folder / name)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
    return list(files)


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
