"""No bytes break the configuration, no doubles the core.

The quick run draws inputs by itself; the long one (`make fuzz`) is libFuzzer's where a clang brings
it, which looks for inputs that reach new code.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from building import ADDRESS, HERE, build, run, sanitizer

SECONDS = 180
MOST_STATES = 15


@pytest.mark.parametrize("target", ["configuration", "core"])
def test_any_input(target: str, tmp_path: Path, long_run: bool) -> None:
    sources = [HERE / f"fuzz_{target}.c"]
    if long_run and shutil.which("clang"):
        flags = sanitizer(f"fuzzer,{ADDRESS}", tmp_path, ["clang"])
        program = build(tmp_path / target, sources, *flags, command=["clang"])
        (tmp_path / "inputs").mkdir()
        done = run([
            str(program), f"-max_total_time={SECONDS}", "-timeout=5", "-max_len=512",
            "-print_final_stats=1", f"-artifact_prefix={tmp_path}/", str(tmp_path / "inputs"),
        ])  # fmt: skip
    else:
        flags = sanitizer(ADDRESS, tmp_path)
        program = build(tmp_path / target, [*sources, HERE / "fuzz_driver.c"], *flags)
        done = run([str(program), "3000000" if long_run else "100000"])
    assert done.returncode == 0, done.stderr[-4000:]
    print(done.stdout, done.stderr[-2000:])
    if target == "core":
        # the promise of finite results was asked for, whatever the number of states
        counts = re.findall(r"(\d+) inputs with moderate numbers", done.stdout)
        assert len(counts) == MOST_STATES + 1
        assert min(map(int, counts)) > 0
        # more states than these need several parts at once, which few inputs have
        assert min(map(int, counts[:5])) > 100
