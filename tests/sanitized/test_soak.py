"""States and energies stay where they belong, however long a run is: 1e8 steps by `make soak`."""

from __future__ import annotations

from pathlib import Path

import inerter
from building import HERE, build, run


def test_soak(tmp_path: Path, long_run: bool) -> None:
    program = build(tmp_path / "soak", [HERE / "soak.c"], "-O2", mujoco=True, with_core=False)
    done = run([str(program), str(inerter.plugin_path()), "100000000" if long_run else "500000"])
    print(done.stdout)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("lossless") == 2
