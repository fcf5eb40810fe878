"""What files from strangers may not do: run code, take all time or memory, end the interpreter."""

from __future__ import annotations

import ast
import pickle
import struct
import subprocess
import sys
import zlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from inerter import DeviceError
from inerter.device_file import read_device
from inerter.records import RecordError, read_records
from inerter.unit_text import parse_unit
from scipy.io import savemat

ROOT = Path(__file__).resolve().parents[2]

# --- the sources -------------------------------------------------------------------------------

MODULES = {
    "pickle", "cPickle", "marshal", "shelve", "dill", "cloudpickle", "joblib", "jsonpickle",
    "yaml", "code", "codeop", "commands", "pty",
}  # fmt: skip
CALLS = {"eval", "exec", "compile", "__import__", "execfile"}
METHODS = {
    "os": ("system", "popen", "exec", "spawn", "posix_spawn", "startfile"),
    "subprocess": ("getoutput", "getstatusoutput"),
    "tempfile": ("mktemp",),
}


def sources() -> list[Path]:
    folders = ("python", "exudyn_models", "benchmarks", "docs")
    found = [path for folder in folders for path in (ROOT / folder).rglob("*.py")]
    if len(found) < 100:
        pytest.skip("not a checkout")
    return found


def dangers(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Line and name of what could run a text from outside, or read one that does."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (
                (node.lineno, a.name) for a in node.names if a.name.split(".")[0] in MODULES
            )
        elif isinstance(node, ast.ImportFrom):
            module = (node.module or "").split(".")[0]
            if not node.level and module in MODULES:
                yield node.lineno, module
            for alias in node.names:
                if alias.name.startswith(METHODS.get(module, ("\0",))):
                    yield node.lineno, f"{module}.{alias.name}"
        elif isinstance(node, ast.Call):
            name = ast.unparse(node.func)
            module, _, method = name.rpartition(".")
            if name in CALLS or method.startswith(METHODS.get(module, ("\0",))):
                yield node.lineno, name
            for keyword in node.keywords:
                given = getattr(keyword.value, "value", None)
                if keyword.arg in ("shell", "allow_pickle") and given is not False:
                    yield node.lineno, f"{keyword.arg}="
            # a command is a list of words
            if module == "subprocess" and node.args and isinstance(
                node.args[0], (ast.Constant, ast.JoinedStr)
            ):  # fmt: skip
                yield node.lineno, f"{name} of a text"


def test_no_source_pickles_evaluates_or_calls_a_shell() -> None:
    found = [
        f"{path.relative_to(ROOT)}:{line}: {name}"
        for path in sources()
        for line, name in dangers(ast.parse(path.read_text(encoding="utf-8")))
    ]
    assert found == []


@pytest.mark.parametrize(
    "text",
    [
        "import pickle", "from pickle import loads", "eval('1')", "import os; os.system('ls')",
        "from os import popen", "import subprocess; subprocess.run('ls', shell=True)",
        "import subprocess; subprocess.run('ls')", "numpy.load('x', allow_pickle=True)",
        "import yaml.x", "__import__('os')", "import os; os.execvp('ls', [])",
    ],
)  # fmt: skip
def test_the_search_finds_what_it_is_for(text: str) -> None:
    assert list(dangers(ast.parse(text)))


def test_the_c_sources_start_no_process_and_load_no_code() -> None:
    plugin = ROOT / "plugin_c"
    if not plugin.is_dir():
        pytest.skip("not a checkout")
    words = (
        "system(",
        "popen(",
        "exec",
        "fork(",
        "dlopen(",
        "getenv(",
        "strcpy(",
        "sprintf(",
        "gets(",
    )
    found = [
        f"{path.name}:{number}: {line.strip()}"
        for path in plugin.rglob("*.[ch]")
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        for word in words
        if word in line.split("//")[0].replace("snprintf(", "")
    ]
    # of a text whose length has been looked at
    assert [line for line in found if "strcpy(local + before + width" not in line] == []


# --- units and device.toml ---------------------------------------------------------------------

TOWERS = [
    "9**9**9**9", "m^9^9^9^9", "m**(9**(9**9))", "((((9^99)^99)^99)^99)m", "m*9^999999999",
    "m" + "^9" * 20, "(" * 50 + "m" + ")" * 50, "m/" * 2000 + "m", "9^9^9^9^9^9*m^2",
]  # fmt: skip


def test_no_unit_takes_for_ever(tmp_path: Path) -> None:
    """In a process of its own, which a time limit can end."""
    program = (
        "import sys\n"
        "from pathlib import Path\n"
        "from inerter.device_file import read_device\n"
        "from inerter.unit_text import parse_unit\n"
        "for text in sys.argv[2:]:\n"
        "    parse_unit(text)\n"
        "    Path(sys.argv[1]).write_text(f'[device]\\ninertance = \"1 {text}\"')\n"
        "    try: print(read_device(Path(sys.argv[1])))\n"
        "    except ValueError as error: print('refused')\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "d.toml"), *TOWERS],
        capture_output=True, text=True, timeout=100, check=True,
    )  # fmt: skip
    assert done.stdout.split() == ["refused"] * len(TOWERS)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("113 kg", 113),
        ("0.1 t", 100),
        ("113000 g", 113),
        ("250 lb", 113.39809250000002),
        (".5kg", 0.5),
    ],
)
def test_a_mass_with_its_unit(text: str, value: float, tmp_path: Path) -> None:
    (tmp_path / "d.toml").write_text(f'[device]\ninertance = "{text}"')
    assert read_device(tmp_path / "d.toml").inertance == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    "text",
    ["1,5 kg", "1_000 kg", "kg", "1 kg + 2 kg", "2*3 kg", "3 m", "__import__('os') kg", "113"],
)
def test_a_text_that_is_no_mass_is_refused(text: str, tmp_path: Path) -> None:
    (tmp_path / "d.toml").write_text(f'[device]\ninertance = "{text}"')
    with pytest.raises(DeviceError, match=r"inertance is .*; give a number, or a text in kg"):
        read_device(tmp_path / "d.toml")


@pytest.mark.parametrize(
    "line",
    [
        'include = "/etc/passwd"', 'inertance = "/etc/passwd"', 'friction = "../../lugre"',
        "inertance = {file = '/etc/passwd'}", "inertance = [1]", "inertance = 1979-05-27",
        "a.b.c = 1", "inertance = 1" + "0" * 400,
    ],
)  # fmt: skip
def test_a_device_file_holds_numbers_and_no_paths(line: str, tmp_path: Path) -> None:
    (tmp_path / "d.toml").write_text(f"[device]\n{line}")
    with pytest.raises(DeviceError, match=r"d\.toml: "):
        read_device(tmp_path / "d.toml")


def test_units_of_people_are_read() -> None:
    for text in ("m/s^2", "m s**-2", "m·s⁻²", "N*m", "kg m^2", "1/s", "(m/s)^2", "m^0.5", "km/h"):
        assert parse_unit(text) is not None, text


# --- Parquet and MATLAB ------------------------------------------------------------------------


class Code:
    """What a pickle would run."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __reduce__(self) -> tuple[object, tuple[str]]:
        return Path.mkdir.__globals__["os"].mkdir, (str(self.folder),)


def test_a_parquet_file_runs_no_code(tmp_path: Path) -> None:
    """Arrow once unpickled the type that a column's metadata name."""
    time = np.arange(60.0)
    columns = {"time": time, "displacement": np.sin(time), "force": np.cos(time)}
    payload = pickle.dumps(Code(tmp_path / "taken"))
    metadata = {
        b"ARROW:extension:name": b"arrow.py_extension_type",
        b"ARROW:extension:metadata": payload,
        b"pandas": payload,
    }
    schema = pa.schema([pa.field(name, pa.float64(), metadata=metadata) for name in columns])
    path = tmp_path / "r.parquet"
    pq.write_table(pa.table(columns, schema=schema), path)
    (record,) = read_records(path, "bench")
    assert record.samples == 60
    assert not (tmp_path / "taken").exists()
    # the payload is a real one
    pickle.loads(payload)
    assert (tmp_path / "taken").exists()


def element(kind: int, data: bytes) -> bytes:
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def nested_cells(depth: int) -> bytes:
    """A MATLAB cell in a cell in a cell ..., and a number within."""
    about = (
        element(6, struct.pack("<II", 1, 0))
        + element(5, struct.pack("<ii", 1, 1))
        + element(1, b"")
    )
    number = element(6, struct.pack("<II", 6, 0)) + element(5, struct.pack("<ii", 1, 1))
    inner = element(14, number + element(1, b"") + element(9, struct.pack("<d", 1.0)))
    heads, size = [], len(inner)
    for _ in range(depth):
        size += len(about)
        heads.append(struct.pack("<II", 14, size) + about)
        size += 8
    return b"".join(reversed(heads)) + inner


MAT_HEAD = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM"


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("depth", [101, 100_000])
def test_cells_within_cells_are_refused(depth: int, packed: bool, tmp_path: Path) -> None:
    """By recursion, as scipy reads them, they end the interpreter."""
    path = tmp_path / "deep.mat"
    body = nested_cells(depth)
    if packed:
        data = zlib.compress(body)
        body = struct.pack("<II", 15, len(data)) + data
    path.write_bytes(MAT_HEAD + body)
    with pytest.raises(RecordError, match=r"deep\.mat: cells within cells, more than 100 deep"):
        read_records(path)


@pytest.mark.parametrize("compressed", [False, True])
def test_what_is_usual_in_a_mat_file_is_not_too_deep(compressed: bool, tmp_path: Path) -> None:
    time = np.arange(60.0)
    run = {"time": time, "displacement": np.sin(time), "force": np.cos(time)}
    path = tmp_path / "r.mat"
    note = {"a": {"b": {"c": np.array(["x", "yy"], dtype=object)}}}
    savemat(path, {**run, "note": note}, do_compression=compressed)
    assert read_records(path, "bench")[0].samples == 60
    savemat(path, {"bench": run}, do_compression=compressed)
    assert read_records(path, "bench")[0].samples == 60
