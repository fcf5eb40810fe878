"""`inerter view` in a process of its own, as it is served to a browser."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from inerter.models import model_path

SCENE = model_path("half_car", "scene.xml")


def _hears_signals() -> None:
    """A shell that runs tests in the background lets them ignore signals, and what they start."""
    for each in (signal.SIGINT, signal.SIGHUP, signal.SIGQUIT, signal.SIGTERM):
        signal.signal(each, signal.SIG_DFL)


@dataclass(frozen=True)
class Served:
    """A viewer that runs: its process, port and token, what it says, its folder for what passes."""

    process: subprocess.Popen[bytes]
    port: int
    token: str
    log: Path
    temporary: Path

    @property
    def address(self) -> str:
        """Of the page, with the token."""
        return f"http://127.0.0.1:{self.port}/?token={self.token}"

    def end(self, number: signal.Signals = signal.SIGINT) -> int:
        """Send a signal; the exit status."""
        self.process.send_signal(number)
        return self.process.wait(30)


def free_port() -> int:
    """A port that nobody has."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


@contextmanager
def served(folder: Path, *options: str) -> Iterator[Served]:
    """A viewer of the half-car, without a display."""
    port, log, temporary = free_port(), folder / "log.txt", folder / "temporary"
    temporary.mkdir()
    command = [sys.executable, "-m", "inerter", "view", str(SCENE), "--port", str(port), *options]
    hidden = ("DISPLAY", "WAYLAND_DISPLAY")
    environment = {key: value for key, value in os.environ.items() if key not in hidden}
    environment["TMPDIR"] = str(temporary)
    with log.open("w") as out:
        process = subprocess.Popen(
            command, stdout=out, stderr=out, env=environment, preexec_fn=_hears_signals
        )
    try:
        for _ in range(400):
            found = re.search(r"http://127\.0\.0\.1:\d+/\?token=(\S+)", log.read_text())
            if found:
                break
            assert process.poll() is None, log.read_text()
            time.sleep(0.1)
        assert found, log.read_text()
        yield Served(process, port, found[1], log, temporary)
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
