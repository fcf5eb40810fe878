"""`inerter`: the command line. What needs the lab says so where the lab is not installed."""

from __future__ import annotations

import os
import signal
import sys
from io import TextIOWrapper

from inerter import signals
from inerter.printable import PLAIN

# what the lab brings: a command imports it when it is run
_LAB = (
    "PyEMD", "jinja2", "loky", "markupsafe", "matplotlib", "pint", "plotly", "polars", "pyarrow",
    "rich", "scipy", "threadpoolctl", "typer",
)  # fmt: skip


def main() -> None:
    """Entry point of the `inerter` command: no way out shows a traceback that a user can cause."""
    signals.hear()
    try:
        _settle()
        try:
            _command()
        finally:
            sys.stdout.flush()
    except BaseException as error:
        # libraries turn an interrupt into errors of their own; a command that a signal ends as it
        # should ends well
        well = isinstance(error, SystemExit) and not error.code
        number = signals.heard()
        if number is not None and not well:
            name = signal.Signals(number).name
            # the exit status is as shells give it
            said = "interrupted" if number == signal.SIGINT else f"ended by {name}"
            _leave(said, 128 + number)
        if isinstance(error, BrokenPipeError):
            # whoever read has gone
            _leave("", 1)
        if isinstance(error, MemoryError):
            _leave("memory is short; close other programs, or raise the limit (ulimit -v)", 1)
        if isinstance(error, OSError):
            place = error.filename or "standard output"
            _leave(f"{place}: cannot be written ({error.strerror})", 1)
        if isinstance(error, ImportError) and not isinstance(error, ModuleNotFoundError):
            _leave(str(error), 1)
        raise


def _settle() -> None:
    """Take what the surroundings bring so that it harms nothing."""
    # a number that is closed would be given to the next file: what is printed would go into it
    for number in (0, 1, 2):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDONLY if number < 2 else os.O_WRONLY)
    # to write to the stdout that was closed fails, and is told
    sys.stdin = sys.stdin or os.fdopen(0, closefd=False)
    sys.stdout = sys.stdout or os.fdopen(1, "w", closefd=False)
    sys.stderr = sys.stderr or os.fdopen(2, "w", closefd=False)
    # what cannot be shown is shown otherwise
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors=PLAIN)
    # pictures are drawn into files: whatever window is wished for, none opens
    os.environ["MPLBACKEND"] = "agg"
    # a width in which nothing can be shown
    for name in ("COLUMNS", "LINES"):
        if not _is_size(os.environ.get(name, "80")):
            del os.environ[name]


def _is_size(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) < 5 and int(text) >= 20


def _leave(message: str, status: int) -> None:
    """End now: what is left in the buffer of stdout has nowhere to go."""
    if message:
        print(f"inerter: {message}", file=sys.stderr)
    sys.stderr.flush()
    os._exit(status)


def _command() -> None:
    try:
        from inerter.commands import run

        run()
    except ModuleNotFoundError as error:
        missing = (error.name or "").partition(".")[0]
        if missing not in _LAB:
            raise
        _without_lab(missing)


def _without_lab(missing: str) -> None:
    """What needs no lab; for the rest, how to install it."""
    command, rest = sys.argv[1:2], sys.argv[2:]
    if command == ["plugin-path"] and rest[:1] in ([], ["--mujoco"]):
        from inerter.plugin import plugin_path

        print(plugin_path(*rest[1:2]))
        return
    if sys.argv[1:] == ["--version"]:
        from inerter import __version__
        from inerter.plugin import supported_text

        print(f"inerter {__version__} for {supported_text()}")
        return
    if command == ["parameters"] and "--help" not in rest:
        _list_parameters(rest)
        return
    print(
        f"inerter: this needs the extra `lab` of inerter, and {missing} is not installed; install "
        "inerter again with it: `pip install '.[lab]'` in the folder of its sources, or with "
        "`[lab]` behind the name of its wheel (`inerter plugin-path` and `inerter parameters` work "
        "without)",
        file=sys.stderr,
    )
    sys.exit(2)


def _list_parameters(arguments: list[str]) -> None:
    import json
    import shutil

    from inerter.parameter_list import chosen, rows, text

    parts = [argument for argument in arguments if argument != "--json"]
    try:
        found = chosen(parts[0] if parts else None)
    except ValueError as error:
        print(f"inerter: {error}", file=sys.stderr)
        sys.exit(2)
    if "--json" in arguments:
        print(json.dumps(rows(found), indent=2))
        return
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
    print(text(found, width))


if __name__ == "__main__":
    main()
