"""Files that are built to cost time and memory, made by a script: none is larger than 10 MB.

`python hostile_files.py FOLDER` writes them all and tells what reading each one costs.
"""

from __future__ import annotations

import os
import resource
import struct
import subprocess
import sys
import tempfile
import threading
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

MEMORY = 500 << 20  # bytes that a refused file may cost, everything that is loaded included
SECONDS = 10.0  # of one processor
_RSS_UNIT = 1 if sys.platform == "darwin" else 1024


def _dots(path: Path) -> None:
    path.write_text("[device]\n" + ".".join("a" * 30_000) + " = 1\n")


def _brackets(path: Path) -> None:
    path.write_text("[device]\ninertance = " + "[" * 20_000 + "\n")


def _tables(path: Path) -> None:
    path.write_text("[device" + ".a" * 20_000 + "]\ninertance = 1\n")


def _inline(path: Path) -> None:
    path.write_text("[device]\ninertance = " + "{a=" * 10_000 + "1" + "}" * 10_000 + "\n")


def _zeros(path: Path) -> None:
    path.write_text("[device]\ninertance = 1" + "0" * 400 + "\n")


def _digits(path: Path) -> None:
    path.write_text("[device]\ninertance = " + "9" * 5_000 + "\n")


def _huge_value(path: Path) -> None:
    path.write_text("[device]\ninertance = 1e308\n")


def _not_utf8(path: Path) -> None:
    path.write_bytes(b"[device]\ninertance = \xff\n")


def _large(path: Path) -> None:
    path.write_text("[device]\n" + "# a comment\n" * 500_000)


def _wide_csv(path: Path) -> None:
    columns = 300_000
    header = ",".join(["time", "displacement", "force", *(f"c{i}" for i in range(columns))])
    path.write_text(header + "\n" + (",".join("1" * (columns + 3)) + "\n") * 5)


def _long_name(path: Path) -> None:
    path.write_text("time,displacement,force,a" + " " * 1_000_000 + "b\n" + "1,2,3,4\n" * 100)


def _no_header(path: Path) -> None:
    path.write_text("# nothing\n" * 1_000_000)


def _quotes(path: Path) -> None:
    width = 4_000
    header = ",".join(["time", "displacement", "force", *(f"c{i}" for i in range(width - 3))])
    path.write_text(header + "\n" + (",".join(['"12"'] * width) + "\n") * 400)


def _ragged(path: Path) -> None:
    path.write_text("time,displacement,force\n" + "1,2,3\n" * 1_000_000 + "1,2\n1,2,3,4\n")


def _nulls(path: Path) -> None:
    path.write_bytes(b"time,displacement,force\n" + bytes(5_000_000))


def _endless_line(path: Path) -> None:
    path.write_text("time,displacement,force\n" + "1" * 9_000_000)


def element(kind: int, data: bytes) -> bytes:
    """An element of a MAT-file with its tag."""
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def matrix(name: str, kind: int, shape: tuple[int, int], data: bytes) -> bytes:
    """A matrix of a MAT-file."""
    about = element(6, struct.pack("<II", kind, 0)) + element(5, struct.pack("<ii", *shape))
    return element(14, about + element(1, name.encode()) + data)


MAT_HEAD = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<H", 0x0100) + b"IM"


def _packed(variable: bytes) -> bytes:
    data = zlib.compress(variable, 9)
    return struct.pack("<II", 15, len(data)) + data


def _packed_zeros(name: str, shape: tuple[int, int], millions: int) -> bytes:
    """A packed vector of so many million zeros."""
    about = matrix(name, 6, shape, b"")[8:]
    size = 8_000_000 * millions
    packing = zlib.compressobj(9)
    data = packing.compress(
        struct.pack("<II", 14, len(about) + 8 + size) + about + struct.pack("<II", 9, size)
    )
    zeros = bytes(8_000_000)
    for _ in range(millions):
        data += packing.compress(zeros)
    data += packing.flush()
    return struct.pack("<II", 15, len(data)) + data


def _packed_vectors(path: Path) -> None:
    names = ["time", "displacement", "force", "velocity", "acceleration", "run"]
    names += [f"c{i}" for i in range(34)]
    path.write_bytes(MAT_HEAD + b"".join(_packed_zeros(n, (1, 19_000_000), 19) for n in names))


def _lying_shape(path: Path) -> None:
    path.write_bytes(MAT_HEAD + _packed_zeros("time", (1, 10), 140))


def _many_cells(path: Path) -> None:
    empty = matrix("", 6, (0, 0), element(9, b""))
    path.write_bytes(MAT_HEAD + _packed(matrix("run", 1, (1, 2_000_000), empty * 2_000_000)))


def _cut_off_mat(path: Path) -> None:
    path.write_bytes(MAT_HEAD + struct.pack("<II", 14, 0xFFFFFFF0) + bytes(100))


def _wide_parquet(path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    rows = 10_000_000
    zeros = pa.array(np.zeros(rows))
    names = ["time", "displacement", "force", *(f"c{i}" for i in range(100))]
    schema = pa.schema([(name, pa.float64()) for name in names])
    with pq.ParquetWriter(path, schema, compression="zstd") as writer:
        writer.write_table(pa.table(dict.fromkeys(names, zeros), schema=schema))


def _long_texts(path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    texts = pa.array(["x" * 1_000_000]).take(pa.array(np.zeros(1000, dtype=np.int64)))
    pq.write_table(pa.table({"time": texts, "displacement": texts, "force": texts}), path)


def _many_columns_parquet(path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    pq.write_table(pa.table({f"c{i}": [1.0] for i in range(40_000)}), path)


def _zero(path: Path) -> None:
    path.symlink_to("/dev/zero")


def _pipe(path: Path) -> None:
    os.mkfifo(path)


@dataclass(frozen=True)
class Hostile:
    """A file, how it is made, and whether that is quick."""

    name: str
    make: Callable[[Path], None]
    quick: bool = True

    def command(self, path: Path, record: str) -> list[str]:
        """Arguments of `inerter`."""
        if self.name.endswith(".toml"):
            return ["diagnose", record, "--device", str(path), "--quick"]
        return ["diagnose", str(path), "--quick"]


FILES = [
    Hostile("dots.toml", _dots), Hostile("brackets.toml", _brackets),
    Hostile("tables.toml", _tables), Hostile("inline.toml", _inline),
    Hostile("zeros.toml", _zeros), Hostile("digits.toml", _digits),
    Hostile("huge_value.toml", _huge_value), Hostile("not_utf8.toml", _not_utf8),
    Hostile("large.toml", _large), Hostile("zero_device.toml", _zero),
    Hostile("pipe.toml", _pipe),
    Hostile("wide.csv", _wide_csv), Hostile("long_name.csv", _long_name),
    Hostile("no_header.csv", _no_header), Hostile("quotes.csv", _quotes),
    Hostile("ragged.csv", _ragged), Hostile("nulls.csv", _nulls),
    Hostile("endless_line.csv", _endless_line), Hostile("zero_device.csv", _zero),
    Hostile("pipe.csv", _pipe),
    Hostile("packed_vectors.mat", _packed_vectors, quick=False),
    Hostile("lying_shape.mat", _lying_shape, quick=False),
    Hostile("many_cells.mat", _many_cells, quick=False), Hostile("cut_off.mat", _cut_off_mat),
    Hostile("wide.parquet", _wide_parquet, quick=False),
    Hostile("long_texts.parquet", _long_texts),
    Hostile("many_columns.parquet", _many_columns_parquet, quick=False),
]  # fmt: skip


@dataclass(frozen=True)
class Cost:
    """What a command said and took: status, stderr, seconds of the processor, bytes at most."""

    status: int
    said: str
    seconds: float
    memory: int


def cost(arguments: list[str], limit: int = 4 << 30, patience: float = 600) -> Cost:
    """Run a command of `inerter` within a limit of memory, and measure it."""

    def within() -> None:
        resource.setrlimit(resource.RLIMIT_DATA, (limit, limit))
        resource.setrlimit(resource.RLIMIT_CPU, (120, 120))

    with tempfile.TemporaryFile() as errors:
        process = subprocess.Popen(
            [sys.executable, "-m", "inerter", *arguments],
            stdout=subprocess.DEVNULL, stderr=errors, preexec_fn=within,
        )  # fmt: skip
        patient = threading.Timer(patience, process.kill)
        patient.start()
        _, status, used = os.wait4(process.pid, 0)
        patient.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        errors.seek(0)
        said = errors.read().decode()
    return Cost(process.returncode, said, used.ru_utime + used.ru_stime, used.ru_maxrss * _RSS_UNIT)


def made(hostile: Hostile, folder: Path) -> Path:
    """Make a file in a process of its own: what that takes would count as a command's."""
    path = folder / hostile.name
    folder.mkdir(parents=True, exist_ok=True)
    path.unlink(missing_ok=True)
    child = os.fork()
    if not child:
        hostile.make(path)
        os._exit(0)
    os.waitpid(child, 0)
    return path


def main(folder: Path, *names: str) -> None:
    """Make every file (or those of some names), and tell what each costs as a command gets it."""
    from inerter.models import data_path

    record = str(data_path("bench_record.csv"))
    nothing = cost(["parameters"])
    print(f"a command that reads nothing: {nothing.seconds:.1f} s, {nothing.memory / 1e6:.0f} MB")
    for hostile in FILES:
        if names and hostile.name not in names:
            continue
        path = made(hostile, folder)
        size = path.stat().st_size if path.is_file() else 0
        found = cost(hostile.command(path, record))
        print(
            f"{hostile.name:21} {size / 1e6:6.2f} MB  status {found.status}  "
            f"{found.seconds - nothing.seconds:4.1f} s more  {found.memory / 1e6:4.0f} MB  "
            f"{found.said.strip()[:200]}",
            flush=True,
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:])
