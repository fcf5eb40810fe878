"""The folder beside results in which they are made, and what a run that was killed left of one.

.inerter-writing-XXXX/
lock       held as long as the run that made it lives
new/       what is to be put in place
old/       second names of what is replaced
commit     what is being moved: from here on it is carried on
undo       the same, where a move failed: from here on it is taken back
"""

from __future__ import annotations

import contextlib
import errno
import json
import os
import shutil
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path, PurePosixPath
from types import TracebackType
from typing import Any, ClassVar, Self

from inerter.signals import held

try:
    import fcntl
except ImportError:  # a system without POSIX: what was left there is cleared after a while
    fcntl = None

LONGEST_NAME = 200  # bytes of a file's name, without its ending: file systems bear 255
ABOVE = 3
"""Folders above one of results in which a run may have made it: those between were not there."""
_YOUNG = 60.0  # seconds in which a folder without a lock may be one that is being made


class Staging:
    """A folder of its own in which files are made; gone at the end.

    Parameters
    ----------
    folder : Path
        Where it is made, and where `exchange` puts the files.

    Raises
    ------
    OSError
        The folder cannot be written.
    """

    PREFIX: ClassVar[str] = ".inerter-writing-"

    place: Path
    """Once it is entered."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._made, self._lock = False, -1

    def __enter__(self) -> Self:
        try:
            with held():
                self.place = Path(tempfile.mkdtemp(prefix=self.PREFIX, dir=self.folder))
                self._made = True
                # it has this name once it is held
                self._lock = _held_open(self.place / "lock.part", os.O_CREAT)
                os.rename(self.place / "lock.part", self.place / "lock")
                self.new.mkdir()
        except BaseException:
            self._remove()
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        with held():
            self._remove()

    def _remove(self) -> None:
        if self._made:
            shutil.rmtree(self.place, ignore_errors=True)
        if self._lock >= 0:
            os.close(self._lock)

    @property
    def new(self) -> Path:
        """Where files are made, under the names that they will have."""
        return self.place / "new"

    def exchange(self, names: Sequence[str]) -> None:
        """Move files from `new` into the folder; where that fails, what stood there comes back."""
        before = {name: _exists(self.folder / name) for name in names}
        for name in names:
            if before[name]:
                _keep(self.folder / name, self.place / "old" / name)
        self._note("commit", before)
        try:
            _carry_on(self.place, self.folder, before)
        except BaseException:
            os.rename(self.place / "commit", self.place / "undo")
            to_disk(self.place)
            _take_back(self.place, self.folder, before)
            raise

    def _note(self, name: str, before: Mapping[str, bool]) -> None:
        part = self.place / f"{name}.part"
        part.write_text(json.dumps(before), encoding="utf-8")
        to_disk(part)
        os.rename(part, self.place / name)
        to_disk(self.place)


def clear(folder: Path) -> None:
    """End or clear what runs that were killed left in a folder, beside it or a little above.

    Raises
    ------
    OSError
        What was begun cannot be ended.
    """
    for place in (folder, *folder.absolute().parents[:ABOVE]):
        try:
            found = sorted(place.glob(f"{Staging.PREFIX}*"))
        except OSError:
            continue  # a parent that may not be read
        for left in found:
            with held():
                _clear(left, place)


def _clear(left: Path, folder: Path) -> None:
    with contextlib.suppress(FileNotFoundError):
        about = left.lstat()
        if not left.is_dir() or left.is_symlink() or not _own(about.st_uid):
            return
        if not (left / "lock").exists():
            if time.time() - about.st_mtime > _YOUNG:
                shutil.rmtree(left, ignore_errors=True)
            return
        try:
            lock = _held_open(left / "lock")
        except BlockingIOError:
            return  # a run that lives
        try:
            for note, end in (("commit", _carry_on), ("undo", _take_back)):
                if (before := _noted(left / note)) is not None:
                    end(left, folder, before)
            shutil.rmtree(left, ignore_errors=True)
        finally:
            os.close(lock)


def _noted(path: Path) -> dict[str, bool] | None:
    """What a note says was to be moved; None where there is none, or none of ours."""
    try:
        before = json.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, ValueError):
        return None
    known = isinstance(before, dict) and all(map(is_within, before))
    return {name: bool(there) for name, there in before.items()} if known else None


def is_within(name: str) -> bool:
    """Whether a file's name does not lead out of its folder."""
    path = PurePosixPath(name)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts


# --- moves, each of which may be done again ------------------------------------------------------


def _carry_on(place: Path, folder: Path, before: Mapping[str, bool]) -> None:
    """Move what is new into the folder."""
    for name in before:
        if (place / "new" / name).exists():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            os.replace(place / "new" / name, folder / name)
    for parent in {(folder / name).parent for name in before}:
        to_disk(parent)


def _take_back(place: Path, folder: Path, before: Mapping[str, bool]) -> None:
    """Bring back what stood in the folder."""
    for name, was_there in before.items():
        if _exists(place / "old" / name):
            os.replace(place / "old" / name, folder / name)
        elif not was_there and not (place / "new" / name).exists():
            (folder / name).unlink(missing_ok=True)
    for parent in sorted({(folder / name).parent for name in before}, reverse=True):
        if parent != folder:
            with contextlib.suppress(OSError):
                parent.rmdir()
    to_disk(folder)


def _keep(path: Path, second: Path) -> None:
    """Give what is to be replaced a second name; of a link, the link itself."""
    second.parent.mkdir(parents=True, exist_ok=True)
    if path.is_dir() and not path.is_symlink():
        raise IsADirectoryError(errno.EISDIR, "is a folder", str(path))
    try:
        os.link(path, second, follow_symlinks=False)
    except (OSError, NotImplementedError):
        # a file system without links
        shutil.copy2(path, second, follow_symlinks=False)


def _exists(path: Path) -> bool:
    return path.exists() or path.is_symlink()


# --- the system ----------------------------------------------------------------------------------


def _own(user: int) -> bool:
    return not hasattr(os, "getuid") or user == os.getuid()


def _held_open(path: Path, more: int = 0) -> int:
    """A file opened and held until it is closed; BlockingIOError where another process holds it."""
    file = os.open(path, os.O_RDWR | getattr(os, "O_NOFOLLOW", 0) | more, 0o600)
    try:
        if fcntl is not None:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(file)
        raise
    except OSError:
        pass  # a file system that holds nothing
    return file


def to_disk(path: Path) -> None:
    """Have a file or a folder written to the disk, where the system can."""
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0)
    full: Any = getattr(fcntl, "F_FULLFSYNC", None)
    try:
        file = os.open(path, flags)
    except PermissionError:
        return  # a folder that may be written and not read
    try:
        if fcntl is not None and full is not None:
            fcntl.fcntl(file, full)
        else:
            os.fsync(file)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP, errno.EBADF):
            raise
    finally:
        os.close(file)
