"""What the commands share: progress on a terminal's stderr, and the end of one that cannot be."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

out = Console()
notes = Console(stderr=True)


def refuse(message: str) -> NoReturn:
    """End with one clear line and status 2: the input cannot be used."""
    print(f"inerter: {' '.join(message.split())}", file=sys.stderr)
    raise typer.Exit(2)


@contextmanager
def refusing(folder: Path | None) -> Iterator[None]:
    """End as `refuse` does where the input cannot be used, or results cannot be written."""
    try:
        yield
    except ValueError as error:
        refuse(str(error))
    except OSError as error:
        refuse(f"{error.filename or folder}: cannot be written ({error.strerror}); choose --out")


@contextmanager
def status(quiet: bool) -> Iterator[Callable[[str], None]]:
    """A line that says what is being done; called with a text."""
    if quiet or not notes.is_terminal:
        yield lambda text: None
        return
    with notes.status("starting") as line:
        yield lambda text: line.update(text)


@contextmanager
def progress_bar(text: str, quiet: bool) -> Iterator[Callable[..., None]]:
    """A bar with the time that is left; called with the share that is done, and a new text."""
    if quiet or not notes.is_terminal:
        yield lambda share, text=None: None
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TimeRemainingColumn())
    with Progress(*columns, console=notes, transient=True) as progress:
        task = progress.add_task(text, total=1.0)

        def update(share: float, text: str | None = None) -> None:
            progress.update(task, completed=share, description=text)

        yield update
