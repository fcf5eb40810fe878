"""Programs in C around the core and the plugin, compiled with the checks of a sanitizer.

Both the quick runs of `make test` and the long ones of `make sanitize`, `make fuzz` and `make soak`
build them here.
"""

from __future__ import annotations

import atexit
import functools
import os
import shlex
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from importlib.util import find_spec
from pathlib import Path

import pytest

HERE = Path(__file__).parent
PLUGIN = HERE.parents[1] / "plugin_c"
CORE = sorted((PLUGIN / "core").glob("*.c"))
ADDRESS = "address,undefined,float-cast-overflow"


def compiler() -> list[str]:
    """The compiler of $CC, else cc; the test is skipped where there is none."""
    command = shlex.split(os.environ.get("CC") or "cc")
    if not shutil.which(command[0]) or not CORE:
        pytest.skip("needs a C compiler (cc, or the one that CC names) and the C sources")
    return command


def mujoco_folder() -> Path:
    """Folder of MuJoCo's headers and library."""
    found = find_spec("mujoco")
    assert found is not None
    assert found.submodule_search_locations is not None
    return Path(found.submodule_search_locations[0])


def sanitizer(name: str, folder: Path, command: Sequence[str] | None = None) -> list[str]:
    """Options for a sanitizer; the test is skipped where compiler or kernel do not bring it."""
    command = command or compiler()
    flags = [f"-fsanitize={name}", "-fno-sanitize-recover=all", "-fno-omit-frame-pointer"]
    source, program = folder / "probe.c", folder / "probe"
    source.write_text(
        "#include <stddef.h>\n"
        "int LLVMFuzzerTestOneInput(const char* b, size_t n) { return b && n && 0; }\n"
        + ("" if "fuzzer" in name else "int main(void) { return 0; }\n")
    )
    build = run([*command, *flags, str(source), "-o", str(program)])
    works = not build.returncode and not run([str(program), "-runs=1"]).returncode
    if not works:
        pytest.skip(f"{' '.join(command)} has no working -fsanitize={name} here")
    return flags


# glibc hides POSIX threads and strtok_r behind gnu17; warnings are errors as in the package
OPTIONS = [
    *("-std=gnu17", "-g", "-O1", "-fPIC", "-Wall", "-Wextra", "-Werror"),
    *(f"-I{PLUGIN}", f"-I{HERE}"),
]


def compile_files(
    folder: Path, sources: Sequence[Path], command: Sequence[str], *flags: str
) -> list[Path]:
    """Object files of C files, a file per processor at a time."""
    folder.mkdir(parents=True, exist_ok=True)

    def one(source: Path) -> Path:
        made = folder / f"{source.stem}.o"
        done = run([*command, *OPTIONS, *flags, "-c", str(source), "-o", str(made)])
        assert done.returncode == 0, done.stderr
        return made

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(one, sources))


@functools.cache
def core(command: tuple[str, ...], *flags: str) -> list[Path]:
    """Object files of the core, compiled once for all who ask for the same."""
    folder = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return compile_files(Path(folder), CORE, command, *flags)


def build(
    target: Path, sources: Sequence[Path], *flags: str, command: Sequence[str] | None = None,
    link: Sequence[str] = (), with_core: bool = True, mujoco: bool = False,
) -> Path:  # fmt: skip
    """A program of C files, the core and, if it is wanted, the engine."""
    command = tuple(command or compiler())
    also, link = list(flags), [*link, "-lm", "-lpthread"]
    if mujoco:
        folder = mujoco_folder()
        also.append(f"-isystem{folder / 'include'}")
        libraries = [str(path) for path in folder.glob("libmujoco.so.*")]
        link = [*libraries, f"-Wl,-rpath,{folder}", *link]
    objects = compile_files(target.with_suffix(".objects"), sources, command, *also)
    if with_core:
        objects += core(command, *[flag for flag in flags if flag.startswith("-f")])
    done = run([*command, *flags, *map(str, objects), *link, "-o", str(target)])
    assert done.returncode == 0, done.stderr
    return target


def build_plugin(folder: Path, *flags: str) -> Path:
    """The plugin with a sanitizer, its scratch memory in blocks of the heap (heap_stack.h)."""
    sources = [*sorted((PLUGIN / "mujoco").glob("*.c")), HERE / "heap_stack.c"]
    # the macros of heap_stack.h leave mjData unused here and there
    heap = ["-include", str(HERE / "heap_stack.h"), "-Wno-unused-parameter"]
    return build(folder / "plugin.so", sources, *heap, *flags, link=["-shared"], mujoco=True)


def run(command: Sequence[str], **environment: str) -> subprocess.CompletedProcess[str]:
    """A program to its end."""
    return subprocess.run(
        command, capture_output=True, text=True, check=False, timeout=3600,
        env={**os.environ, **environment},
    )  # fmt: skip
