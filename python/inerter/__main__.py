"""`inerter`: the command line. What needs the lab says so where the lab is not installed."""

from __future__ import annotations

import sys


def main() -> None:
    """Entry point of the `inerter` command."""
    try:
        from inerter.commands import run
    except ModuleNotFoundError as error:
        if (error.name or "").startswith("inerter"):
            raise
        _without_lab(error.name or "")
    else:
        run()


def _without_lab(missing: str) -> None:
    """The one command that needs no lab; for the others, how to install it."""
    if sys.argv[1:] == ["plugin-path"]:
        from inerter.plugin import plugin_path

        print(plugin_path())
        return
    print(
        f"inerter: this needs the lab, and {missing} is not installed; "
        "run `pip install 'inerter[lab]'` (`inerter plugin-path` works without)",
        file=sys.stderr,
    )
    sys.exit(2)


if __name__ == "__main__":
    main()
