"""Options of a command line from declared inputs: names, help and defaults stand in one place."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Annotated, Any

import typer

from inerter.design.inputs import Declared


def with_options(declared: Declared) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command one text option for each declared input, before its own parameters.

    The command takes them as **inputs: the options that were given, by input name.
    """

    def wrap(command: Callable[..., None]) -> Callable[..., None]:
        own = [
            parameter
            for parameter in inspect.signature(command, eval_str=True).parameters.values()
            if parameter.kind is not inspect.Parameter.VAR_KEYWORD
        ]
        made = [
            inspect.Parameter(
                item.name, inspect.Parameter.KEYWORD_ONLY, default=None,
                annotation=Annotated[str | None, typer.Option(help=item.help, metavar="VALUE")],
            )
            for item in declared
        ]  # fmt: skip
        keyword = [p.replace(kind=inspect.Parameter.KEYWORD_ONLY) for p in own]

        def run(**arguments: Any) -> None:
            command(**arguments)

        run.__doc__ = command.__doc__
        run.__name__ = command.__name__
        run.__annotations__ = {p.name: p.annotation for p in (*made, *keyword)}
        run.__signature__ = inspect.Signature((*made, *keyword))  # type: ignore[attr-defined]
        return run

    return wrap
