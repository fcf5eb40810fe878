"""An evaluation on a Dask cluster gives the rows of this machine, workers that die or not."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from inerter.suspension.time_domain.cases import CASES
from inerter.suspension.time_domain.evaluate import evaluate
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.simulate import RunSettings

pytestmark = pytest.mark.filterwarnings("default")

PLAN = Plan(
    layouts=("S2", "S3"),
    cases=tuple(CASES[name] for name in ("ideal", "friction100", "both", "lugre")),
    indices=("J1", "J3"),
    seeds=3,
    settings=RunSettings(step=2e-3),
)


@pytest.mark.long
def test_a_cluster_whose_workers_die_gives_the_same_rows() -> None:
    distributed = pytest.importorskip("distributed")
    here = evaluate(PLAN)
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, silence_logs=50
    ) as cluster:
        ended: list[int] = []

        def end_a_worker(share: float, text: str) -> None:
            # once, in the middle of the run
            if share > 0.2 and not ended:
                worker = next(iter(cluster.workers.values()))
                ended.append(worker.pid)
                os.kill(worker.pid, signal.SIGKILL)

        there = evaluate(PLAN, end_a_worker, scheduler=cluster.scheduler_address)
    assert len(ended) == 1
    # every row once, to the last digit
    assert there == here
    assert [(row.index, row.layout, row.case) for row in there] == [
        (index, layout, case.name) for _, index, layout, case in PLAN.rows
    ]


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for a child there")
def test_an_interrupt_ends_at_once(tmp_path: Path) -> None:
    begin = (
        "import sys\n"
        "import inerter.commands, inerter.folder, inerter.suspension.time_domain.asked\n"
        "import inerter.suspension.time_domain.evaluate, inerter.suspension.time_domain.output\n"
        "from inerter.__main__ import main\n"
        "print('ready', flush=True)\n"
        f"sys.argv[1:] = 'suspension evaluate --case tables --out {tmp_path / 'out'}'.split()\n"
        "main()\n"
    )
    run = subprocess.Popen(
        [sys.executable, "-c", begin],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert run.stdout is not None
    assert run.stdout.readline() == b"ready\n"
    # in the middle of simulations
    time.sleep(4.0)
    assert run.poll() is None
    run.send_signal(signal.SIGINT)
    asked = time.monotonic()
    _, told = run.communicate(timeout=60)
    assert time.monotonic() - asked < 10.0
    assert run.returncode not in (0, 2)
    assert b"Traceback" not in told
    assert not (tmp_path / "out").exists()
