"""The core compiled with every warning an error, and run under the sanitizers."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

HERE = Path(__file__).parent
PLUGIN = HERE.parents[1] / "plugin_c"
SANITIZERS = "address,undefined,float-cast-overflow"
COMPILER = os.environ.get("CC") or shutil.which("cc") or shutil.which("gcc")

pytestmark = pytest.mark.skipif(
    not COMPILER or not (PLUGIN / "core").is_dir(),
    reason="needs a C compiler (cc) and the C sources",
)


def compile_c(target: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    sources = sorted((PLUGIN / "core").glob("*.c"))
    command = [
        *str(COMPILER).split(), "-std=c17", "-Wall", "-Wextra", "-Werror", f"-I{PLUGIN}",
        *arguments, *map(str, sources), "-lm", "-o", str(target),
    ]  # fmt: skip
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_no_report(tmp_path: Path) -> None:
    # does the compiler have the sanitizers at all?
    probe = tmp_path / "probe.c"
    probe.write_text("int main(void) { return 0; }\n")
    tried = subprocess.run(
        [*str(COMPILER).split(), f"-fsanitize={SANITIZERS}", str(probe), "-o", str(tmp_path / "p")],
        capture_output=True, check=False,
    )  # fmt: skip
    if tried.returncode:
        pytest.skip(f"{COMPILER} has no -fsanitize={SANITIZERS}")

    program = tmp_path / "core_sanitized"
    compiled = compile_c(
        program, "-O1", "-g", f"-fsanitize={SANITIZERS}", "-fno-sanitize-recover=all",
        str(HERE / "core_sanitized.c"),
    )  # fmt: skip
    assert compiled.returncode == 0, compiled.stderr
    run = subprocess.run([str(program)], capture_output=True, text=True, timeout=120, check=False)
    assert run.returncode == 0, run.stderr
    assert run.stderr == ""
    assert "devices" in run.stdout


def test_the_core_needs_nothing_but_the_standard(tmp_path: Path) -> None:
    # no simulator's header, no extension of the compiler
    library = tmp_path / "core.so"
    compiled = compile_c(library, "-pedantic", "-fPIC", "-shared")
    assert compiled.returncode == 0, compiled.stderr
    for source in (PLUGIN / "core").iterdir():
        assert "mujoco" not in source.read_text(encoding="utf-8").lower().replace("mjcf", "")
