"""What the tests share: the folder of measured records, the seed of hidden effects.

Tests that hide an effect and look for it draw it from one seed, so that a failure can be repeated:
`pytest --effects-seed N` or the environment variable INERTER_SEED choose another, `random` a new
one. The seed of a session stands at the end of pytest's output.

With pytest-xdist (`make test`) all workers hide effects by the same seed and compute in one
process and with one thread each. What shares an expensive fixture stays in one worker.
"""

from __future__ import annotations

import os
import secrets
from pathlib import Path
from typing import Any

import inerter  # noqa: F401  (with MuJoCo 3 this makes the plugin known, 4 does it by itself)
import pytest

# before NumPy is imported: one thread for each worker, not one for each core in each of them
if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.setdefault("LOKY_MAX_CPU_COUNT", "1")
    for _library in ("OPENBLAS", "OMP", "MKL"):
        os.environ.setdefault(f"{_library}_NUM_THREADS", "1")

# a command that takes long here says nothing more than it does where it is quick
os.environ.setdefault("INERTER_PROGRESS", "0")

ROOT = Path(__file__).resolve().parents[1]
MEASURED = ROOT.parent / "shared" / "data"
DEFAULT_SEED = 20261121

_SEED = pytest.StashKey[int]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add --effects-seed and --long."""
    parser.addoption(
        "--long",
        action="store_true",
        help="run sanitizers, fuzzers and the soak of tests/sanitized for minutes each",
    )
    parser.addoption(
        "--effects-seed",
        default=os.environ.get("INERTER_SEED") or str(DEFAULT_SEED),
        metavar="SEED",
        help="seed of the hidden effects: a whole number, or 'random' (default: $INERTER_SEED, "
        f"else {DEFAULT_SEED})",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Settle the seed once per session: a worker has the controller's."""
    given = getattr(config, "workerinput", {}).get("effects_seed")
    text = str(config.getoption("--effects-seed") if given is None else given)
    try:
        config.stash[_SEED] = secrets.randbelow(2**31) if text == "random" else int(text)
    except ValueError:
        raise pytest.UsageError(
            f"--effects-seed (or INERTER_SEED) is {text!r}: give a whole number or 'random'"
        ) from None


@pytest.hookimpl(optionalhook=True)
def pytest_configure_node(node: Any) -> None:
    """Tell a worker of pytest-xdist the seed."""
    node.workerinput["effects_seed"] = node.config.stash[_SEED]


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    """Show the seed, so that a failure can be repeated; -q would hide it in the header."""
    terminalreporter.write_line(f"effects seed: {config.stash[_SEED]} (repeat with --effects-seed)")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Let --dist loadfile deal out the diagnoses, which are long, one by one."""
    if config.getoption("dist") != "loadfile":
        return None
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return _together(nodeid)

    return Scheduling(config, log)


def _together(nodeid: str) -> str:
    """What one worker runs: a test file; of the diagnoses, the tests of a case."""
    file, _, test = nodeid.partition("::")
    if not file.startswith("tests/diagnosis/"):
        return file
    name, bracket, case = test.partition("[")
    return f"{file}::[{case}" if bracket else f"{file}::{name}"


@pytest.fixture(scope="session")
def effects_seed(request: pytest.FixtureRequest) -> int:
    """Seed that hidden effects are drawn from."""
    return request.config.stash[_SEED]


@pytest.fixture(scope="session")
def long_run(request: pytest.FixtureRequest) -> bool:
    """Whether the programs of tests/sanitized are to run for minutes."""
    return bool(request.config.getoption("--long"))


@pytest.fixture(scope="session")
def measured_data() -> Path:
    """Folder of the measured records; tests that use it are skipped where it is absent."""
    if not MEASURED.is_dir():
        pytest.skip("the measured records (../shared/data beside the repository) are not here")
    return MEASURED
