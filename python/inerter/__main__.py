"""`inerter`: the command line. What needs the lab says so where the lab is not installed."""

from __future__ import annotations

import os
import signal
import sys
from typing import Any

INTERRUPTED = 130  # exit status after Ctrl-C, as shells give it

# what the lab brings: a command imports it when it is run
_LAB = (
    "PyEMD", "jinja2", "loky", "markupsafe", "matplotlib", "pint", "plotly", "polars", "pyarrow",
    "pydantic", "rich", "scipy", "threadpoolctl", "typer",
)  # fmt: skip


def main() -> None:
    """Entry point of the `inerter` command: no way out shows a traceback that a user can cause."""
    interrupted = False

    def interrupt(*_: Any) -> None:
        nonlocal interrupted
        interrupted = True
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    try:
        try:
            _command()
        finally:
            sys.stdout.flush()
    except BaseException as error:
        # libraries turn an interrupt into errors of their own; a command that Ctrl-C ends as it
        # should ends well
        well = isinstance(error, SystemExit) and not error.code
        if interrupted and not well:
            _leave("interrupted", INTERRUPTED)
        if isinstance(error, BrokenPipeError):
            # whoever read has gone
            _leave("", 1)
        if isinstance(error, OSError):
            place = error.filename or "standard output"
            _leave(f"{place}: cannot be written ({error.strerror})", 1)
        if isinstance(error, ImportError) and not isinstance(error, ModuleNotFoundError):
            _leave(str(error), 1)
        raise


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
    if sys.argv[1:2] == ["plugin-path"] and sys.argv[2:3] in ([], ["--mujoco"]):
        from inerter.plugin import plugin_path

        print(plugin_path(*sys.argv[3:4]))
        return
    if sys.argv[1:] == ["--version"]:
        from inerter import __version__
        from inerter.plugin import supported_text

        print(f"inerter {__version__} for {supported_text()}")
        return
    print(
        f"inerter: this needs the lab, and {missing} is not installed; "
        "run `pip install 'inerter[lab]'` (`inerter plugin-path` works without)",
        file=sys.stderr,
    )
    sys.exit(2)


if __name__ == "__main__":
    main()
