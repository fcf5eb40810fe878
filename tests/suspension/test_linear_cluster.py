"""A sweep on a Dask cluster gives the rows of this machine, workers that die or not."""

from __future__ import annotations

import os
import signal
import time
from typing import Any

import pytest
from inerter.commands import app
from inerter.suspension.study import Study
from inerter.suspension.sweep import sweep
from typer.testing import CliRunner

pytestmark = pytest.mark.filterwarnings("default")

STUDY = Study(
    layouts=("S1", "S2", "S3"),
    indices=("J1", "J3", "J5"),
    stiffnesses=(60e3, 120e3, 240e3),
    series={"none": None},
)


def test_a_cluster_whose_workers_die_gives_the_same_rows() -> None:
    distributed = pytest.importorskip("distributed")
    here = [row.json() for row in sweep(STUDY, jobs=1)]
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
    ) as cluster:
        ended: list[int] = []

        def end_workers(share: float) -> None:
            # once, in the middle of the run, every process that is there
            if share > 0.3 and not ended:
                for worker in list(cluster.workers.values()):
                    ended.append(worker.pid)
                    os.kill(worker.pid, signal.SIGKILL)
                time.sleep(0.5)

        there = sweep(STUDY, scheduler=cluster.scheduler_address, progress=end_workers)
    assert len(ended) == 2
    assert [row.json() for row in there] == here


def test_no_scheduler(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("inerter.parallel._PATIENCE", 1.0)
    command = ["suspension", "optimize", "--layout", "S1", "--scheduler", "tcp://127.0.0.1:9"]
    found: Any = CliRunner().invoke(app, command)
    assert found.exit_code == 2
    assert "no Dask scheduler answers at 'tcp://127.0.0.1:9'" in found.stderr
