"""Writing a file completely or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path


def write_atomic(path: Path, content: bytes) -> None:
    """Write a file by way of a temporary file beside it.

    A reader sees the old file or the new one, never a part.

    Raises
    ------
    OSError
        The folder does not exist or cannot be written; nothing is left behind.
    """
    path = Path(path)
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
    except OSError as error:
        raise OSError(
            error.errno, f"cannot write {path.name} here ({error.strerror})", str(path.parent)
        ) from error
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        # a temporary file is private; give it the rights of any other new file
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)
        os.replace(name, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(name)
        raise
