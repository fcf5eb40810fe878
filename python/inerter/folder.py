"""Results in a folder: all of the files or none, whatever ends the program or the power.

Everything is written beside its place first, in a folder of its own (`staging.Staging`), and to the
disk. A folder of results that was not there is then put in place by one rename. Where files are
exchanged in a folder that is there, a note of what is to be moved is left first: whoever finds it,
the next run that is to write there, ends what was begun. Signals wait meanwhile.
"""

from __future__ import annotations

import errno
import json
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from inerter.signals import held
from inerter.staging import LONGEST_NAME, Staging, clear, is_within, to_disk


def refuse_folder(folder: Path, names: Iterable[str] = ()) -> None:
    """Raise OSError where files cannot be written into a folder, before the work is done.

    names: those that are known. What a run that was killed left there is ended or cleared.
    """
    existing = _existing(folder)
    if not existing.is_dir():
        what = "not a folder" if existing.exists() else "a link that leads nowhere"
        raise NotADirectoryError(errno.ENOTDIR, what, str(existing))
    clear(existing)
    # rights do not tell of a read-only or a virtual file system, or of names too long: try
    try:
        with Staging(existing) as staging:
            (staging.new / _below(folder, existing)).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(folder)) from None
    for name in names:
        if (folder / name).is_dir():
            raise IsADirectoryError(errno.EISDIR, "is a folder", str(folder / name))


def refuse_file(path: Path) -> None:
    """Raise OSError where one file cannot be written, before the work is done."""
    refuse_folder(path.absolute().parent, [path.name])


def file_names(names: Sequence[str], otherwise: str) -> list[str]:
    """What files may be called after names from a model, all different; `otherwise_0` for none."""
    found: list[str] = []
    for i, name in enumerate(names):
        safe = re.sub(r"[^\w.+-]+", "_", name).strip("._")
        # room for an ending
        while len(safe.encode()) > LONGEST_NAME:
            safe = safe[:-1]
        safe = safe or f"{otherwise}_{i}"
        while safe.casefold() in [other.casefold() for other in found]:
            safe += "_2"
        found.append(safe)
    return found


def write_files(folder: Path, files: Mapping[str, bytes | str]) -> list[str]:
    """Write files by name into a folder, which is made, as are folders in names; the names.

    Where a move fails or is interrupted, what stood there before comes back.

    Raises
    ------
    ValueError
        A name leads out of the folder.
    OSError
        The folder cannot be written; nothing is left behind.
    """
    for name in files:
        if not is_within(name):
            raise ValueError(f"the name {name!r} of a result leads out of {folder}; rename it")
    existing = _existing(folder)
    refuse_folder(folder, files)
    try:
        with Staging(existing) as staging:
            below = _below(folder, existing)
            _write(files, staging.new / below)
            with held():
                if below == Path():
                    staging.exchange(list(files))
                else:
                    _put_in_place(staging.new / below.parts[0], existing / below.parts[0])
    except OSError as error:
        raise OSError(error.errno, error.strerror, _place(error, folder)) from None
    return list(files)


def _existing(folder: Path) -> Path:
    """The deepest part of a path that is there: a folder, a file, or a link to nowhere."""
    return next(
        path for path in (folder, *folder.absolute().parents) if path.exists() or path.is_symlink()
    )


def _below(folder: Path, existing: Path) -> Path:
    return folder.absolute().relative_to(existing.absolute())


def _put_in_place(source: Path, target: Path) -> None:
    """A folder's whole tree, in one step."""
    os.rename(source, target)
    to_disk(target.parent)


def _write(files: Mapping[str, bytes | str], place: Path) -> None:
    folders = {place}
    place.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        data = content.encode("utf-8", "replace") if isinstance(content, str) else content
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_bytes(data)
        to_disk(place / name)
        folders.add((place / name).parent)
    for each in folders:
        to_disk(each)


def _place(error: OSError, folder: Path) -> str:
    """What could not be written, as the user knows it."""
    name = str(error.filename or "")
    return str(folder) if Staging.PREFIX in name or not name else name


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
