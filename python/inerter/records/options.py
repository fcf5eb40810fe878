"""The options with which commands read records, and the lines that say how they were read."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer

from inerter.console import notes, number, seconds_between_lines

Column = Annotated[
    list[str] | None,
    typer.Option(
        "--column",
        metavar="NAME=COLUMN",
        help="Which column holds what, with its unit or calibration: force='Kraft [kN]', "
        "force='-200 N/V * (u + 0.115 V)', time='every 0.5 ms'. May be given again; remembered "
        "in records.toml beside the data.",
    ),
]
With = Annotated[
    Path | None,
    typer.Option(
        "--with",
        metavar="FILE",
        help="A second file of the same test on a clock of its own; joined by the motion of both.",
    ),
]
Lag = Annotated[
    float | None,
    number("seconds", "Seconds to add to the clock of --with. Default: found."),
]
Decimal = Annotated[
    str | None, typer.Option("--decimal", metavar="MARK", help="Decimal mark: point or comma.")
]
Decimate = Annotated[
    int | None,
    typer.Option(
        "--decimate",
        metavar="N",
        min=1,
        help="Keep every N-th row behind a low-pass of all columns alike, for files of more rows "
        "than are read.",
    ),
]
Separator = Annotated[
    str | None,
    typer.Option(
        "--separator", metavar="SIGN", help="Between columns: comma, semicolon, tab, bar, blanks."
    ),
]
Sheet = Annotated[
    str | None,
    typer.Option("--sheet", metavar="NAME", help="Sheet of a workbook, or group of a file."),
]
Statements = Annotated[
    Path | None,
    typer.Option(
        "--statements",
        metavar="FILE",
        help="A .toml file in place of records.toml beside the data.",
    ),
]


class _Told:
    """A line every ten seconds while a long file is read."""

    def __init__(self) -> None:
        self.begun = self.last = time.monotonic()
        self.path: Path | None = None

    def __call__(self, path: Path, share: float) -> None:
        now = time.monotonic()
        if path != self.path:
            self.path, self.begun, self.last = path, now, now
        every = seconds_between_lines()
        if every and share < 1 and now - self.last >= every:
            self.last = now
            left = (now - self.begun) * (1 / share - 1)
            notes.print(
                f"reading {path}: {share:.0%} done, about {left:.0f} s left",
                highlight=False,
                soft_wrap=True,
            )


@contextmanager
def told_reading(
    column: list[str] | None = None,
    partner: Path | None = None,
    lag: float | None = None,
    decimal: str | None = None,
    separator: str | None = None,
    sheet: str | None = None,
    decimate: int | None = None,
    statements: Path | None = None,
) -> Iterator[Callable[[], None]]:
    """Read with what the command line states; call it when the files are read.

    Then it is told on stderr how they were, and what was stated is remembered.
    """
    from inerter.records.stated import reading

    with reading(
        column or (), separator=separator, decimal=decimal, sheet=sheet, partner=partner,
        lag=lag, decimate=decimate, file=statements, progress=_Told(),
    ) as now:  # fmt: skip

        def tell() -> None:
            for line in now.told:
                notes.print(line, highlight=False, soft_wrap=True)
            now.told.clear()
            try:
                place = now.remember()
            except OSError as error:
                notes.print(f"not remembered: {error.filename} ({error.strerror})", soft_wrap=True)
                return
            if place is not None:
                notes.print(f"remembered in {place}", highlight=False, soft_wrap=True)

        yield tell


def with_reading(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command that takes `stated` the options above, joined into it.

    stated: keyword arguments of `told_reading`.
    """
    import inspect

    options: dict[str, Any] = {
        "column": Column, "partner": With, "lag": Lag, "decimal": Decimal,
        "separator": Separator, "sheet": Sheet, "decimate": Decimate, "statements": Statements,
    }  # fmt: skip
    own = [
        p for name, p in inspect.signature(command, eval_str=True).parameters.items()
        if name != "stated"
    ]  # fmt: skip
    made = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=kind)
        for name, kind in options.items()
    ]
    keyword = [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in own]

    def run(**arguments: Any) -> Any:
        stated = {name: arguments.pop(name) for name in options}
        return command(**arguments, stated=stated)

    run.__doc__ = command.__doc__
    run.__name__ = command.__name__
    run.__annotations__ = {p.name: p.annotation for p in (*keyword, *made)}
    run.__signature__ = inspect.Signature((*keyword, *made))  # type: ignore[attr-defined]
    return run
