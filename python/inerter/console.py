"""What the commands share: options, progress on a terminal's stderr, the end of one that fails."""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.text import Text
from typer.core import TyperGroup

from inerter.printable import printable


class _Console(Console):
    """Names come from files: no markup, no control sequences to the terminal."""

    def render_str(self, text: str, **options: Any) -> Text:
        return super().render_str(printable(text), **options)


out = _Console(markup=False, emoji=False)
notes = _Console(stderr=True, markup=False, emoji=False)

# exit statuses: the input cannot be used; it could, but something else failed
UNUSABLE, FAILED = 2, 1
# seconds between lines of progress where there is no terminal; the variable sets it, 0 for none
EVERY, EVERY_VARIABLE = 10, "INERTER_PROGRESS"

Folder = Annotated[Path, typer.Option("--out", help="Folder for the results.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print the JSON result alone on stdout.")]
Filters = Annotated[
    list[str] | None,
    typer.Option(
        "--filter",
        metavar="CHANNEL=KIND:HZ",
        help="A low-pass that the force or the displacement went through: force=bessel:50, "
        "displacement=butterworth:60:2 (order; 4 where it is left out). May be given again.",
    ),
]
Jobs = Annotated[
    int | None, typer.Option("--jobs", min=1, help="Processes; default: one per processor.")
]


# what a user gives for an option, by its annotation
_GIVEN = {str: "TEXT", list[str]: "TEXT", int: "NUMBER", float: "NUMBER", Path: "FILE"}


def _plain_types(command: Any) -> Any:
    """Name what each option takes in plain words; choices are listed as they are."""
    for each in command.params:
        given = _GIVEN.get(getattr(getattr(each, "type_descriptor", None), "annotation", None))
        if given and each.metavar is None:
            each.metavar = "FOLDER" if "--out" in each.opts else given
            if each.param_type_name == "argument":
                each.metavar = each.name.upper()
        if each.param_type_name == "argument" and hasattr(each, "display_type_rich"):
            # its help says what it is
            each.display_type_rich = lambda ctx: ""
    return command


class Commands(TyperGroup):
    """A list of commands with whole sentences, wrapped and never cut; plain types of options."""

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The command of a name."""
        command = super().get_command(ctx, cmd_name)
        return command if command is None else _plain_types(command)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write each command with the first sentence of its help."""
        found = []
        for name in self.list_commands(ctx):
            command = self.get_command(ctx, name)
            if command is None or command.hidden:
                continue
            first = (command.short_help or command.help or "").strip().split("\n\n")[0]
            found.append((name, " ".join(first.replace("\b", "").split())))
        with formatter.section("Commands"):
            formatter.write_dl(found)


def parts_of(given: Sequence[str] | None) -> tuple[str, ...]:
    """What stands in an option that takes lists by comma and may be given again."""
    parts = (part.strip() for text in given or () for part in text.split(","))
    return tuple(part for part in parts if part)


def number(unit: str, text: str, least: float | None = None, **more: Any) -> Any:
    """An option that takes a number; `unit` as in "give a number of seconds", `text` is its help.

    What is no number is told the unit, in which the number stands alone.
    """

    def read(given: str | float) -> float:
        try:
            value = float(given)
        except ValueError:
            kind = f"a number of {unit}, without a unit" if unit else "a plain number"
            raise typer.BadParameter(f"{given!r} is not a number; give {kind}") from None
        if least is not None and not value >= least:
            raise typer.BadParameter(f"{given} is out of range; give at least {least:g} {unit}")
        return value

    return typer.Option(help=text, parser=read, metavar="NUMBER", **more)


def refuse(message: str, status: int = UNUSABLE) -> NoReturn:
    """End with one clear line and a status."""
    print(f"inerter: {printable(' '.join(message.split()))}", file=sys.stderr)
    raise typer.Exit(status)


@contextmanager
def refusing(folder: Path | None, *names: str) -> Iterator[None]:
    """End as `refuse` does where the input cannot be used, or results cannot be written.

    A folder that cannot be written, or holds a folder of one of the `names`, is refused before the
    work is done.
    """
    from inerter.folder import refuse_folder

    try:
        if folder is not None:
            refuse_folder(folder, names)
    except OSError as error:
        refuse(_unwritten(error, folder))
    try:
        yield
    except ValueError as error:
        refuse(str(error))
    except OSError as error:
        refuse(_unwritten(error, folder), FAILED)
    except MemoryError:
        refuse("memory is short; take fewer or shorter records, or fewer --jobs", FAILED)


def _unwritten(error: OSError, folder: Path | None) -> str:
    return f"{error.filename or folder}: cannot be written ({error.strerror}); choose --out"


def seconds_between_lines() -> int:
    """How often progress is told in lines [s]; 0 for never."""
    given = os.environ.get(EVERY_VARIABLE, "")
    return int(given) if given.isascii() and given.isdigit() else EVERY


@contextmanager
def _lines(told: Callable[[], str]) -> Iterator[None]:
    """Where there is no terminal: a line on stderr every ten seconds."""
    every = seconds_between_lines()
    if every == 0:
        yield
        return
    ended = threading.Event()
    start = time.monotonic()

    def say() -> None:
        while not ended.wait(every):
            spent = time.monotonic() - start
            print(f"inerter: {printable(told())}, {spent:.0f} s", file=sys.stderr, flush=True)

    thread = threading.Thread(target=say, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


@contextmanager
def status(quiet: bool) -> Iterator[Callable[[str], None]]:
    """A line that says what is being done; called with a text."""
    if quiet:
        yield lambda text: None
        return
    if not notes.is_terminal:
        said = ["starting"]
        with _lines(lambda: said[0]):
            yield lambda text: said.__setitem__(0, text)
        return
    with notes.status("starting") as line:
        yield lambda text: line.update(Text(printable(text)))


@contextmanager
def progress_bar(text: str, quiet: bool) -> Iterator[Callable[..., None]]:
    """The share that is done and the time that is left; called with that share, and a new text."""
    if quiet:
        yield lambda share, text=None: None
        return
    if not notes.is_terminal:
        now: dict[str, Any] = {"share": 0.0, "text": text}
        begun = time.monotonic()

        def told() -> str:
            share = now["share"]
            if not share > 0:
                return str(now["text"])
            left = (time.monotonic() - begun) * (1 / share - 1)
            return f"{now['text']}: {100 * share:.0f} % done, about {left:.0f} s left"

        def note(share: float, text: str | None = None) -> None:
            now.update(share=share, text=now["text"] if text is None else text)

        with _lines(told):
            yield note
        return
    columns = (
        TextColumn("{task.description}", markup=False), BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"), TimeRemainingColumn(),
    )  # fmt: skip
    with Progress(*columns, console=notes, transient=True) as progress:
        task = progress.add_task(text, total=1.0)

        def update(share: float, text: str | None = None) -> None:
            progress.update(task, completed=share, description=text)

        yield update
