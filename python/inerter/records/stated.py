"""What the user states of his files: on the command line, and in `records.toml` beside them.

```toml
[[files]]                       # each entry holds for the files that match; later ones come first
match = ["run_*.csv"]           # names or patterns; all files of the folder where it is left out
decimal = ","                   # of texts: separator and decimal mark; of workbooks: sheet
with = "servo.csv"              # another file of the same test, on a clock of its own; lag [s]

[files.columns]
time = "every 0.5 ms"
force = "-200 N/V * (u + 0.115 V)"
displacement = {column = "Weg", unit = "mm", polarity = -1, delay = "2 ms", filter = "60 Hz"}
velocity = {role = "leave out"}
```
"""

from __future__ import annotations

import fnmatch
import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from inerter.folder import write_files
from inerter.input_file import read_toml

from .calibration import Statement, own_name, read_statement
from .decimation import MOST
from .record import RecordError
from .text_layout import DECIMALS, SEPARATORS, Asked

FILE = "records.toml"
_KEYS = ("match", "separator", "decimal", "sheet", "with", "lag", "decimate", "columns")


@dataclass(frozen=True)
class Stated:
    """What is stated of one file."""

    columns: Mapping[str, Statement] = field(default_factory=dict)
    asked: Asked = field(default_factory=Asked)
    sheet: str | None = None
    partner: Path | None = None
    lag: float | None = None


@dataclass(kw_only=True)
class Reading:
    """One reading of files: what the command line states, and what was said of each file.

    columns: NAME=COLUMN texts by name; file: the statements' file in place of `records.toml` beside
    the data; told: a line for each file; read: the files, for what is to be remembered.
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    separator: str | None = None
    decimal: str | None = None
    sheet: str | None = None
    partner: Path | None = None
    lag: float | None = None
    decimate: int | None = None
    file: Path | None = None
    told: list[str] = field(default_factory=list)
    read: list[Path] = field(default_factory=list)
    progress: Callable[[Path, float], None] = lambda path, share: None

    def tell(self, path: Path, text: str) -> None:
        """Keep how a file was read, once."""
        line = f"{path}: {text}"
        if line not in self.told:
            self.told.append(line)

    def entry(self) -> dict[str, Any]:
        """What the command line states, as an entry of the file."""
        found: dict[str, Any] = {
            key: value
            for key, value in (
                ("separator", self.separator), ("decimal", self.decimal), ("sheet", self.sheet),
                ("with", str(self.partner) if self.partner else None), ("lag", self.lag),
                ("decimate", self.decimate),
            )
            if value is not None
        }  # fmt: skip
        return found | ({"columns": dict(self.columns)} if self.columns else {})

    def remember(self) -> Path | None:
        """Append what the command line stated to the file of statements; None for nothing new."""
        entry = self.entry()
        files = [path for path in self.read if path != self.partner]
        if not entry or not files:
            return None
        place = self.file or files[0].parent / FILE
        old = _entries(place)
        text = place.read_text("utf-8").rstrip() + "\n\n" if place.exists() else ""
        new = [path for path in files if not _covers(_merged(old, path.name), entry)]
        if not new:
            return None
        partner = entry.get("with")
        if partner is not None:
            entry["with"] = _relative(Path(partner), place.parent)
        write_files(place.parent, {place.name: text + _entry_text(new, entry)})
        return place


_CURRENT: ContextVar[Reading | None] = ContextVar("reading", default=None)


@contextmanager
def reading(
    columns: Sequence[str] = (),
    *,
    separator: str | None = None,
    decimal: str | None = None,
    sheet: str | None = None,
    partner: Path | None = None,
    lag: float | None = None,
    decimate: int | None = None,
    file: Path | None = None,
    progress: Callable[[Path, float], None] = lambda path, share: None,
) -> Iterator[Reading]:
    """Read with what the user states; columns: NAME=COLUMN, see `calibration`.

    Raises
    ------
    RecordError
        A statement cannot be read.
    """
    named: dict[str, str] = {}
    for text in columns:
        name, sign, formula = text.partition("=")
        if not sign or not formula.strip():
            raise RecordError(
                f"--column {text!r}; give NAME=COLUMN, such as --column force='Kraft [kN]'"
            )
        read_statement(name.strip(), formula, "--column")
        named[name.strip()] = formula.strip()
    _decimation(decimate, "--decimate")
    if file is not None and file.suffix.lower() != ".toml":
        raise RecordError(f"--statements {file}: give a .toml file")
    made = Reading(
        columns=named,
        separator=_sign(separator, SEPARATORS, "--separator"),
        decimal=_sign(decimal, DECIMALS, "--decimal"),
        sheet=sheet,
        partner=partner,
        lag=lag,
        decimate=decimate,
        file=file,
        progress=progress,
    )
    token = _CURRENT.set(made)
    try:
        yield made
    finally:
        _CURRENT.reset(token)


_HEARD: ContextVar[Callable[[Sequence[Any]], None] | None] = ContextVar("heard", default=None)


@contextmanager
def heard(by: Callable[[Sequence[Any]], None]) -> Iterator[None]:
    """Have what is read told to somebody as soon as it is, before it is worked on."""
    token = _HEARD.set(by)
    try:
        yield
    finally:
        _HEARD.reset(token)


def announce(records: Sequence[Any]) -> None:
    """Tell who listens that records were read."""
    if (by := _HEARD.get()) is not None:
        by(records)


def _sign(given: str | None, known: Mapping[str, str], where: str) -> str | None:
    """A sign from itself or its name."""
    if given is None or given in known:
        return given
    for sign, name in known.items():
        if given.strip().casefold() in (name, name.rstrip("s"), name + "s"):
            return sign
    raise RecordError(f"{where} is {given!r}; take one of {', '.join(known.values())}")


def _decimation(given: Any, where: str) -> int:
    if given is None:
        return 1
    if isinstance(given, bool) or not isinstance(given, int) or not 1 <= given <= MOST:
        raise RecordError(f"{where} is {given!r}; give a whole number from 1 to {MOST}")
    return given


def current() -> Reading:
    """The reading that is under way; an empty one where there is none."""
    return _CURRENT.get() or Reading()


def stated_of(path: Path) -> Stated:
    """What is stated of a file; RecordError where a statement cannot be read."""
    now = current()
    place = now.file or path.parent / FILE
    where = str(place)
    entry = _merged(_entries(place), path.name)
    partner = place.parent / entry["with"] if "with" in entry else None
    if now.partner is not None:
        partner = now.partner
    columns = _statements(entry.get("columns", {}), where)
    # what is said of a partner's column is handed on by the file whose partner it is
    if now.partner is None or _real(path) != _real(now.partner):
        columns |= _statements(now.columns, "--column")
    found = Stated(
        columns=columns,
        asked=Asked(
            now.separator or _sign(entry.get("separator"), SEPARATORS, f"{where}: separator"),
            now.decimal or _sign(entry.get("decimal"), DECIMALS, f"{where}: decimal"),
            _decimation(now.decimate or entry.get("decimate"), f"{where}: decimate"),
        ),
        sheet=now.sheet or entry.get("sheet"),
        partner=partner,
        lag=now.lag if now.lag is not None else entry.get("lag"),
    )
    # a file is no partner of itself
    same = partner is not None and _real(partner) == _real(path)
    return replace(found, partner=None) if same else found


def _statements(given: Mapping[str, Any], where: str) -> dict[str, Statement]:
    """Statements by our names of the quantities."""
    return {own_name(name): read_statement(name, each, where) for name, each in given.items()}


def _real(path: Path) -> str:
    """A path without links; also of links in a circle."""
    return os.path.realpath(path)


def _entries(place: Path) -> list[dict[str, Any]]:
    if not os.path.lexists(place):
        return []
    try:
        content = read_toml(place)
    except ValueError as error:
        raise RecordError(str(error)) from None
    if strange := sorted(set(content) - {"schema", "files"}):
        raise RecordError(f"{place}: a key {strange[0]!r}; write entries [[files]]")
    entries = content.get("files", [])
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise RecordError(f"{place}: 'files' is no list of entries; write [[files]]")
    for entry in entries:
        if strange := sorted(set(entry) - set(_KEYS)):
            raise RecordError(
                f"{place}: an entry has a key {strange[0]!r}; the keys are {', '.join(_KEYS)}"
            )
        patterns = entry.get("match", ["*"])
        entry["match"] = [patterns] if isinstance(patterns, str) else patterns
        texts = [*entry["match"], *(entry[k] for k in _KEYS[1:5] if k in entry)]
        if not all(isinstance(text, str) for text in texts):
            raise RecordError(f"{place}: {texts!r} are not all texts; put them in quotes")
        lag = entry.get("lag", 0.0)
        if isinstance(lag, bool) or not isinstance(lag, int | float):
            raise RecordError(f"{place}: 'lag' is {lag!r}; give a number of seconds")
        if not isinstance(entry.get("columns", {}), dict):
            raise RecordError(f"{place}: 'columns' is no table; write [files.columns]")
    return entries


def _merged(entries: Sequence[dict[str, Any]], name: str) -> dict[str, Any]:
    """What all entries that match say; of a key the last."""
    found: dict[str, Any] = {}
    for entry in entries:
        if any(fnmatch.fnmatchcase(name, pattern) for pattern in entry["match"]):
            columns = found.get("columns", {}) | entry.get("columns", {})
            found |= {k: v for k, v in entry.items() if k not in ("match", "columns")}
            found["columns"] = columns
    return found


def _covers(old: Mapping[str, Any], entry: Mapping[str, Any]) -> bool:
    columns = old.get("columns", {})
    return all(
        columns.get(n) == text for n, text in entry.get("columns", {}).items()
    ) and all(
        old.get(key) == value or (key == "with" and Path(value).name == Path(old.get(key, "")).name)
        for key, value in entry.items() if key != "columns"
    )  # fmt: skip


def _relative(path: Path, folder: Path) -> str:
    try:
        return str(path.resolve().relative_to(folder.resolve()))
    except ValueError:
        return str(path.resolve())


def _entry_text(files: Sequence[Path], entry: Mapping[str, Any]) -> str:
    # names with signs of patterns stand for themselves
    names = [fnmatch_escaped(path.name) for path in files]
    lines = ["[[files]]", f"match = {json.dumps(names, ensure_ascii=False)}"]
    lines += [
        f"{k} = {json.dumps(v, ensure_ascii=False)}" for k, v in entry.items() if k != "columns"
    ]
    if entry.get("columns"):
        lines += ["", "[files.columns]"]
        lines += [f"{k} = {json.dumps(v, ensure_ascii=False)}" for k, v in entry["columns"].items()]
    return "\n".join(lines) + "\n"


def fnmatch_escaped(name: str) -> str:
    """A name as a pattern that it alone matches."""
    return "".join(f"[{c}]" if c in "[*?" else c for c in name)
