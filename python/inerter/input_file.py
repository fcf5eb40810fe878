"""Files from strangers: plain files only, and no more of them than a bound."""

from __future__ import annotations

import errno
import os
import re
import stat
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

# a TOML file of ours has a few keys; what is built to cost time and memory has them nested
TOML_BYTES = 1 << 16
TOML_PARTS = 8  # of a key between dots, of brackets within brackets
TOML_DIGITS = 300  # of a number


@dataclass(frozen=True)
class Bound:
    """How much is read of a file; an environment variable sets it otherwise."""

    variable: str
    usual: int
    what: str

    @property
    def most(self) -> int:
        """The bound that holds.

        Raises
        ------
        ValueError
            The environment variable is no whole number above 0.
        """
        return whole_number(self.variable, self.usual)

    def refusal(self, path: Path, found: float, advice: str) -> str:
        """What is said of a file that has more."""
        return (
            f"{path}: about {counted(float(f'{found:.2g}'))} {self.what}, at most "
            f"{counted(self.most)} are read; {advice}, or set {self.variable} to more"
        )


def whole_number(variable: str, usual: int) -> int:
    """A number that an environment variable may set.

    Raises
    ------
    ValueError
        It is no whole number above 0.
    """
    text = os.environ.get(variable, "").strip()
    if not text:
        return usual
    if not (text.isascii() and text.isdigit() and len(text) < 19 and int(text) > 0):
        shown = text if len(text) <= 40 else text[:37] + "..."
        raise ValueError(
            f"the environment variable {variable} is {shown!r}; give a whole number above 0, or "
            "leave it unset"
        )
    return int(text)


def counted(number: float) -> str:
    """A count with blanks between thousands."""
    return f"{number:,.0f}".replace(",", " ")


def refuse_special(path: Path) -> int:
    """The size of a plain file [bytes]; of what is none the reading may never end.

    Raises
    ------
    OSError
        It is not there, may not be looked at, or is a folder, a pipe, a device or a socket.
    """
    about = os.stat(path)
    if stat.S_ISDIR(about.st_mode):
        raise IsADirectoryError(errno.EISDIR, "it is a folder", str(path))
    if not stat.S_ISREG(about.st_mode):
        kind = "a pipe" if stat.S_ISFIFO(about.st_mode) else "a device or a socket"
        raise OSError(errno.EINVAL, f"it is {kind}, not a file; save what it gives", str(path))
    return about.st_size


def read_toml(path: Path) -> dict[str, Any]:
    """The content of a small TOML file.

    Raises
    ------
    ValueError
        It cannot be read; names the file, says why and what to do.
    """
    try:
        size = refuse_special(path)
        with path.open("rb") as file:
            data = file.read(TOML_BYTES + 1)
    except OSError as error:
        raise ValueError(f"{path}: cannot be opened ({error.strerror}); check the path") from None
    if len(data) > TOML_BYTES:
        raise ValueError(
            f"{path}: {counted(max(size, len(data)))} bytes, at most {counted(TOML_BYTES)} are "
            "read; is it another file?"
        )
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        raise ValueError(f"{path}: not UTF-8 text; give a TOML file") from None
    _refuse_nested(path, text)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{path}: not TOML ({error}); correct the line") from None
    except (ValueError, RecursionError):
        raise ValueError(f"{path}: not TOML that can be read; write it anew") from None


# strings and comments of TOML, whose dots, brackets and digits mean nothing
_QUIET = re.compile(
    r'"""(?:\\.|[^\\])*?"""' r"|'''.*?'''" r'|"(?:\\.|[^"\\\n])*"' r"|'[^'\n]*'" r"|#[^\n]*",
    re.DOTALL,
)


def _refuse_nested(path: Path, text: str) -> None:
    """Refuse what takes a reader of TOML more than the length of the file."""
    bare = _QUIET.sub(lambda match: "" if match[0].startswith("#") else "q", text)
    for number, line in enumerate(bare.splitlines(), start=1):
        key = max((part.count(".") for part in re.split(r"[=,{}]", line)), default=0)
        if key >= TOML_PARTS:
            raise ValueError(
                f"{path}: a key of {key + 1} parts between dots (line {number}), at most "
                f"{TOML_PARTS} are read; correct it"
            )
        digits = max(map(len, re.findall(r"[0-9_]+", line)), default=0)
        if digits > TOML_DIGITS:
            raise ValueError(
                f"{path}: a number of {digits} digits (line {number}), at most {TOML_DIGITS} are "
                "read; correct it"
            )
    depth = deepest = 0
    for sign in re.findall(r"[\[\]{}]", bare):
        depth = max(0, depth + (1 if sign in "[{" else -1))
        deepest = max(deepest, depth)
    if deepest > TOML_PARTS:
        raise ValueError(
            f"{path}: brackets within brackets, {deepest} deep, at most {TOML_PARTS} are read; "
            "correct it"
        )
