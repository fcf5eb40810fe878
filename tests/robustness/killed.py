"""Writes results again and again, each time ended at another of the steps that writing takes.

Prints, for each signal and start, what was found other than it should be, and how many steps.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import sys
import traceback
from pathlib import Path

from inerter import signals
from inerter.folder import refuse_folder, write_files
from inerter.staging import Staging

OLD = {"a.txt": "old a", "c.txt": "old c", "mine.txt": "mine"}
NEW = {"a.txt": "new a", "deep/b.txt": "new b", "c.txt": "new c", "d.txt": "new d"}
STEPS = ("os.", "open", "fcntl.", "shutil.", "tempfile.")


def listing(folder: Path) -> dict[str, str] | None:
    """Files by name, None where the folder is not there."""
    if not folder.exists():
        return None
    files = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.read_text() for path in files}


def staged(folder: Path) -> list[str]:
    return [str(path) for path in folder.rglob(f"{Staging.PREFIX}*")]


def write(out: Path, number: int, step: int) -> None:
    """Write, and get a signal at a step; this process ends."""
    seen = 0

    def at_step(event: str, arguments: object) -> None:
        nonlocal seen
        if event.startswith(STEPS):
            seen += 1
            if seen == step:
                os.kill(os.getpid(), number)

    try:
        signals.hear()
        sys.addaudithook(at_step)
        write_files(out, NEW)
    except KeyboardInterrupt:
        os._exit(3)
    except BaseException:
        traceback.print_exc()
        os._exit(4)
    os._exit(0 if seen < step else 5)


def killed(root: Path, number: int, old: dict[str, str] | None) -> tuple[list[str], int]:
    """What was wrong, and at how many steps it was looked."""
    wrong: list[str] = []
    out = root / "deep" / "out"
    before, after = (old, NEW) if old is None else (old, {**old, **NEW})
    for step in range(1, 400):
        shutil.rmtree(root, ignore_errors=True)
        root.mkdir()
        if old is not None:
            out.mkdir(parents=True)
            for name, text in old.items():
                (out / name).write_text(text)
        child = os.fork()
        if not child:
            write(out, number, step)
        _, status = os.waitpid(child, 0)
        code = os.waitstatus_to_exitcode(status)
        if code == 0:
            return wrong, step
        where = f"step {step}, status {code}"
        if code == 4:
            wrong.append(f"{where}: an error")
        found = listing(out)
        # a folder that is new is there as a whole or not at all, even before the next run
        if (number != signal.SIGKILL or old is None) and found not in (before, after):
            wrong.append(f"{where}: {found}")
        if number != signal.SIGKILL and staged(root):
            wrong.append(f"{where}: left {staged(root)}")
        # the next run ends or clears it
        if number == signal.SIGKILL:
            for left in root.rglob(f"{Staging.PREFIX}*"):
                os.utime(left, (0, 0))
            refuse_folder(out)
            if listing(out) not in (before, after) or staged(root):
                wrong.append(f"{where}: after the next run {listing(out)} {staged(root)}")
    return [*wrong, "no end"], 400


if __name__ == "__main__":
    told = {}
    for name in sys.argv[2:]:
        for start, old in (("new", None), ("old", OLD)):
            told[f"{name}, {start}"] = killed(
                Path(sys.argv[1]) / "root", getattr(signal, name), old
            )
    print(json.dumps(told))
