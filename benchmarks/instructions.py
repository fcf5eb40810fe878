"""Instructions that the core takes for a sample, counted by callgrind, and the least it could.

A bare Python process calls `inerter_along` through ctypes under valgrind, once with few and once
with many samples; everything else in it is the same, so that the difference is that of the samples.

The least is counted by hand from the equations (`LEAST`: one instruction for each addition,
multiplication, division, absolute value, sign and comparison, for each load of a sample's x, v, a
and each store of total, friction, state, one sample at a time), plus what the mathematical library
takes where it is called, as measured. So the ratio says what calls, branches and generality of the
core add, and what is saved where several samples are taken at once.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

from inerter.benchmark.laws import LAWS, parameters_of
from inerter.core import library_path

# what core/elementary.h takes for one number
EXP, EXPM1, TANH = 40, 41, 47
# arithmetic, loads and stores, functions that a sample cannot do without
LEAST = {
    "none": 1 + 3,
    "coulomb": 4 + 4 + TANH,
    "stribeck": 8 + 4 + EXP + TANH,
    "dahl": 13 + 5 + EXPM1,
    "lugre": 28 + 6 + 2 * EXP + EXPM1,
    "bouc_wen": 17 + 5 + EXPM1,
    "brown_mcphee": 13 + 4 + TANH,
    "rate_state": 25 + 6,
    "maxwell_slip": 7 + 4 * 10 + 4 + 4,
}
FEW, MANY = 2000, 20_000

# arguments: library, number of samples, size of the arrays, then key value ...
_SCRIPT = """
import ctypes, math, sys
core, n, size = ctypes.CDLL(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
device, message = ctypes.create_string_buffer(1 << 16), ctypes.create_string_buffer(512)
core.inerter_default(device)
for key, value in zip(sys.argv[4::2], sys.argv[5::2]):
    assert not core.inerter_set(device, key.encode(), value.encode(), message), message.value
assert not core.inerter_finish(device, message), message.value
x, v, a = [], [], []
for i in range(2000):
    angle = 2 * math.pi * i / 1000
    x.append(0.01 * math.sin(angle) + 0.003 * math.sin(5 * angle))
    v.append(0.06 * math.cos(angle) + 0.09 * math.cos(5 * angle))
    a.append(-0.4 * math.sin(angle) - 2.8 * math.sin(5 * angle))
series = ctypes.c_double * size
inputs = [series(*(part * (size // 2000))) for part in (x, v, a)]
states = ctypes.c_double * (size * max(1, core.inerter_nstate(device)))
outputs = [series(), series(), series(), states()]
core.inerter_along(device, n, ctypes.c_double(1e-3), *inputs, *outputs)
"""


def lacking() -> str | None:
    """Why nothing can be counted here."""
    if sys.platform != "linux":
        return "instructions are counted on Linux only"
    if shutil.which("valgrind") is None:
        return "no instruction counts without valgrind; on Debian: apt install valgrind"
    return None


def per_sample(law: str) -> tuple[float, float]:
    """Instructions of a sample: all, and those of them in the mathematical library."""
    few, many = (_counted(law, count) for count in (FEW, MANY))
    found = {name: (many[name] - few[name]) / (MANY - FEW) for name in many.keys() | few.keys()}
    return sum(found.values()), sum(n for name, n in found.items() if "libm" in name)


def _counted(law: str, count: int) -> Mapping[str, int]:
    """Instructions of the whole process by library, `count` samples in it."""
    given = [str(part) for pair in parameters_of(law).items() for part in pair]
    steady = {**os.environ, "PYTHONHASHSEED": "0"}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "counts"
        command = [
            "valgrind", "--tool=callgrind", f"--callgrind-out-file={file}",
            sys.executable, "-s", "-S", "-c", _SCRIPT,
            os.fspath(library_path("inerter_core")), str(count), str(MANY), *given,
        ]  # fmt: skip
        done = subprocess.run(command, capture_output=True, text=True, check=False, env=steady)
        if done.returncode:
            raise RuntimeError(f"valgrind failed: {done.stderr[-500:]}")
        return by_library(file.read_text(encoding="utf-8"))


def by_library(profile: str) -> Mapping[str, int]:
    """Instructions by library, from callgrind's output: own costs, not those of calls."""
    found: dict[str, int] = defaultdict(int)
    for library, called, cost in costs(profile):
        if called is None:
            found[library] += cost
    return found


def costs(profile: str) -> Iterator[tuple[str, str | None, int]]:
    """Costs in callgrind's output: library, the one that it calls if it is a call, instructions.

    Those of a call are counted in its callee too.
    """
    names: dict[str, str] = {}
    library, callee, called = "", None, False
    for line in profile.splitlines():
        if match := re.match(r"(c?)ob=\((\d+)\)(?: (.+))?", line):
            of_call, number, name = match.groups()
            if name:
                names[number] = Path(name).name
            if of_call:
                callee = names[number]
            else:
                library = names[number]
        elif line.startswith("calls="):
            # the line after it is the cost of the call
            called = True
        elif re.match(r"[+\-*\d]", line):
            yield library, (callee or library) if called else None, int(line.split()[1])
            callee, called = None, False


def counts(laws: tuple[str, ...] = tuple(LAWS)) -> dict[str, tuple[float, float, float]]:
    """By law: instructions of a sample, those in the mathematical library, the least there can be.

    Raises
    ------
    RuntimeError
        valgrind failed.
    """
    found = {}
    for law in laws:
        total, library = per_sample(law)
        found[law] = (total, library, LEAST[law] + library)
    return found
