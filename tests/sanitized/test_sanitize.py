"""No sanitizer and no valgrind has anything to say of the core, and of the plugin in the engine."""

from __future__ import annotations

import shutil
from pathlib import Path

import inerter
import pytest
from building import (
    ADDRESS,
    CORE,
    HERE,
    PLUGIN,
    build,
    build_plugin,
    compile_files,
    compiler,
    run,
    sanitizer,
)  # fmt: skip

SCENARIOS = (
    "lifetimes", "models", "recompile", "batch", "threads", "other_ways", "bad_numbers",
)  # fmt: skip
ENGINE = [HERE / "engine.c", HERE / "engine_models.c"]


def passes(*command: str | Path, **environment: str) -> str:
    """What a program prints that ends well and has nothing to complain about."""
    done = run([str(part) for part in command], **environment)
    assert done.returncode == 0, done.stderr or done.stdout
    assert done.stderr == ""
    return done.stdout


def test_core(tmp_path: Path) -> None:
    flags = sanitizer(ADDRESS, tmp_path)
    program = build(tmp_path / "core_random", [HERE / "core_random.c"], *flags)
    assert "devices" in passes(program)


def test_the_core_needs_nothing_but_the_standard(tmp_path: Path) -> None:
    # no simulator's header, no extension of the compiler
    compile_files(tmp_path, CORE, compiler(), "-std=c17", "-pedantic")
    for source in (PLUGIN / "core").iterdir():
        assert "mujoco" not in source.read_text(encoding="utf-8").lower().replace("mjcf", "")


def test_plugin_memory(tmp_path: Path, long_run: bool) -> None:
    flags = sanitizer(ADDRESS, tmp_path)
    engine = build(tmp_path / "engine", ENGINE, *flags, mujoco=True, with_core=False)
    plugin = build_plugin(tmp_path, *flags)
    printed = passes(
        engine, plugin, "300" if long_run else "6",
        ASAN_OPTIONS="detect_stack_use_after_return=1:strict_string_checks=1",
    )  # fmt: skip
    for name in SCENARIOS:
        assert name in printed


def test_plugin_threads(tmp_path: Path, long_run: bool) -> None:
    # the engine's own pool hands work over by atomics that the sanitizer does not see in a library
    # that it has not compiled: batches run under the other tools
    flags = sanitizer("thread", tmp_path)
    engine = build(tmp_path / "engine", ENGINE, *flags, mujoco=True, with_core=False)
    plugin = build_plugin(tmp_path, *flags)
    for name in SCENARIOS if long_run else ("threads",):
        if name != "batch":
            passes(engine, plugin, "100" if long_run else "6", name)


def test_shipped_plugin_in_valgrind(tmp_path: Path, long_run: bool) -> None:
    # what users run, with numbers never written and blocks never freed
    valgrind = shutil.which("valgrind")
    if valgrind is None or run([valgrind, "-q", "true"]).returncode:
        pytest.skip("no valgrind that works; on Debian: apt install valgrind libc6-dbg")
    # the older form of debugging information, which every valgrind reads
    engine = build(tmp_path / "engine", ENGINE, "-gdwarf-4", mujoco=True, with_core=False)
    options = ["-q", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite"]
    passes(valgrind, *options, engine, inerter.plugin_path(), "50" if long_run else "1")
