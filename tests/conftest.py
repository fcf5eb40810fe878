"""What the tests share: the folder of measured records, the seed of hidden effects, long tests.

Tests marked `long` (whole diagnoses, campaigns) are left out unless `--long` asks for all of them
or `--only-long SECONDS` for as many as begin in that time, `--long-first SECONDS` for these before
all others, so that the last of them keeps nobody waiting; every day begins at another one. Of a
test marked `often("case", ...)` its other cases are long; of one marked `rarely("case", ...)`,
these cases. What takes some seconds has its turn every few days (`turns.py`) and is long on the
others. A test that is named on the command line (`file::test`) is run in any case.

Tests that hide an effect and look for it draw it from one seed, so that a failure can be repeated:
`pytest --effects-seed N` or the environment variable INERTER_SEED choose another, `random` a new
one. The seed of a session stands at the end of pytest's output.

With pytest-xdist (`make test`) all workers hide effects by the same seed and compute in one
process and with one thread each. What shares an expensive fixture stays in one worker.
"""

from __future__ import annotations

import os
import secrets
import signal
import time
from datetime import date
from pathlib import Path
from typing import Any

import inerter  # noqa: F401  (with MuJoCo 3 this makes the plugin known, 4 does it by itself)
import pytest
import turns

# before NumPy is imported: one thread for each worker, not one for each core in each of them
if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.setdefault("LOKY_MAX_CPU_COUNT", "1")
    for _library in ("OPENBLAS", "OMP", "MKL"):
        os.environ.setdefault(f"{_library}_NUM_THREADS", "1")

# a shell that runs tests in the background lets them ignore Ctrl-C, and so what they start
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
# a command that takes long here says nothing more than it does where it is quick
os.environ.setdefault("INERTER_PROGRESS", "0")

ROOT = Path(__file__).resolve().parents[1]
MEASURED = ROOT.parent / "shared" / "data"
DEFAULT_SEED = 20261121

_SEED = pytest.StashKey[int]()
_DAY = pytest.StashKey[int]()
_STARTED = time.monotonic()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add --effects-seed, --long, --only-long, --long-first and --measure."""
    parser.addoption(
        "--long",
        action="store_true",
        help="run the tests marked long too, and sanitizers, fuzzers and the soak of "
        "tests/sanitized for minutes each",
    )
    parser.addoption(
        "--only-long",
        type=float,
        metavar="SECONDS",
        help="run the tests marked long, as many as begin in SECONDS; every day begins at another",
    )
    parser.addoption(
        "--long-first",
        type=float,
        metavar="SECONDS",
        help="begin with tests marked long, as many as begin in SECONDS, and run all others",
    )
    parser.addoption(
        "--measure",
        action="store_true",
        help="run what has its turn another day too, and write tests/seconds.csv anew",
    )
    parser.addoption(
        "--effects-seed",
        default=os.environ.get("INERTER_SEED") or str(DEFAULT_SEED),
        metavar="SEED",
        help="seed of the hidden effects: a whole number, or 'random' (default: $INERTER_SEED, "
        f"else {DEFAULT_SEED})",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Settle the seed and the day once per session: a worker has the controller's."""
    config.addinivalue_line("markers", "long: takes long; runs with --long or --only-long")
    config.addinivalue_line("markers", "often(*cases): the other cases of this test are long")
    config.addinivalue_line("markers", "rarely(*cases): these cases of this test are long")
    if config.getoption("measure"):
        turns.measure(config)
    told = getattr(config, "workerinput", {})
    config.stash[_DAY] = told.get("day", date.today().toordinal())
    given = told.get("effects_seed")
    text = str(config.getoption("--effects-seed") if given is None else given)
    try:
        config.stash[_SEED] = secrets.randbelow(2**31) if text == "random" else int(text)
    except ValueError:
        raise pytest.UsageError(
            f"--effects-seed (or INERTER_SEED) is {text!r}: give a whole number or 'random'"
        ) from None


@pytest.hookimpl(optionalhook=True)
def pytest_configure_node(node: Any) -> None:
    """Tell a worker of pytest-xdist the seed and the day."""
    node.workerinput["effects_seed"] = node.config.stash[_SEED]
    node.workerinput["day"] = node.config.stash[_DAY]


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark the cases of a test that are not run often."""
    case = item.name.partition("[")[2].removesuffix("]")
    often, rarely = item.get_closest_marker("often"), item.get_closest_marker("rarely")
    if (often and case not in often.args) or (rarely and case in rarely.args):
        item.add_marker("long")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave out the long tests, or the others; begin somewhere else every day."""
    if not config.getoption("measure"):
        names = [item.nodeid for item in items if not item.get_closest_marker("long")]
        another_day = turns.without_turn(names, turns.read(), config.stash[_DAY])
        for item in items:
            if item.nodeid in another_day:
                item.add_marker("long")
    only, first = (config.getoption(name) is not None for name in ("--only-long", "--long-first"))
    if not only and (config.getoption("--long") or any("::" in arg for arg in config.args)):
        return
    long = [item for item in items if item.get_closest_marker("long")]
    others = [item for item in items if not item.get_closest_marker("long")]
    together = list(dict.fromkeys(_together(item.nodeid) for item in long))
    begin = config.stash[_DAY] * 7919 % max(len(together), 1)
    turn = {name: (k - begin) % len(together) for k, name in enumerate(together)}
    long.sort(key=lambda item: turn[_together(item.nodeid)])
    config.hook.pytest_deselected(items=others if only else [] if first else long)
    items[:] = long if only else [*long, *others] if first else others


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Begin no long test when the time of --only-long or --long-first is over."""
    if not item.get_closest_marker("long"):
        return
    for option in ("--only-long", "--long-first"):
        seconds = item.config.getoption(option)
        if seconds is not None and time.monotonic() - _STARTED > seconds:
            pytest.skip(f"the {seconds:g} s of {option} are over; it has its turn another day")


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
    file = nodeid.partition("::")[0]
    return turns.case_of(nodeid) if file.startswith("tests/diagnosis/") else file


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
