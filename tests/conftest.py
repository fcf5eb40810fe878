"""What the tests share: the folder of measured records, the seed of hidden effects.

Tests that hide an effect and look for it draw it from one seed, so that a failure can be repeated:
`pytest --effects-seed N` or the environment variable INERTER_SEED choose another, `random` a new
one. The seed of a session stands in pytest's header.
"""

from __future__ import annotations

import os
import secrets
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
MEASURED = ROOT.parent / "shared" / "data"
DEFAULT_SEED = 20261121

_SEED = pytest.StashKey[int]()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add --effects-seed."""
    parser.addoption(
        "--effects-seed",
        default=os.environ.get("INERTER_SEED") or str(DEFAULT_SEED),
        metavar="SEED",
        help="seed of the hidden effects: a whole number, or 'random' (default: $INERTER_SEED, "
        f"else {DEFAULT_SEED})",
    )


def pytest_configure(config: pytest.Config) -> None:
    """Settle the seed once per session."""
    text = str(config.getoption("--effects-seed"))
    try:
        config.stash[_SEED] = secrets.randbelow(2**31) if text == "random" else int(text)
    except ValueError:
        raise pytest.UsageError(
            f"--effects-seed (or INERTER_SEED) is {text!r}: give a whole number or 'random'"
        ) from None


def pytest_report_header(config: pytest.Config) -> str:
    """Show the seed, so that a failure can be repeated."""
    return f"effects seed: {config.stash[_SEED]} (repeat with --effects-seed)"


@pytest.fixture(scope="session")
def effects_seed(request: pytest.FixtureRequest) -> int:
    """Seed that hidden effects are drawn from."""
    return request.config.stash[_SEED]


@pytest.fixture(scope="session")
def measured_data() -> Path:
    """Folder of the measured records; tests that use it are skipped where it is absent."""
    if not MEASURED.is_dir():
        pytest.skip("the measured records (../shared/data beside the repository) are not here")
    return MEASURED
