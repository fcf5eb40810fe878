"""Reads files within a limit of memory, each whole or refused in one line; what it took, as JSON.

`python reading.py read FILE...`, or `python reading.py fuzz FOLDER SEED COUNT`: files that are
sound but for some bytes, cut off, or put together of two.
"""

from __future__ import annotations

import json
import random
import resource
import sys
import time
from pathlib import Path

import numpy as np
import polars as pl
from inerter import Device, DeviceError
from inerter.device_file import device_text, read_bench_device, read_delay
from inerter.records import RecordError, read_records
from scipy.io import savemat

LIMIT = 3 << 30


def read(path: Path) -> str:
    """What reading a file comes to: "read", or why not."""
    try:
        if path.suffix == ".toml":
            read_bench_device(path)
            read_delay(path)
        else:
            read_records(path)
    except (RecordError, DeviceError) as error:
        return str(error)
    return "read"


def sound(folder: Path) -> list[Path]:
    """Files of every format with nothing wrong."""
    time_ = 1e-3 * np.arange(400)
    columns = {"time": time_, "displacement": np.sin(20 * time_), "force": np.cos(20 * time_)}
    device = Device(inertance=7, friction="lugre", coulomb_force=3, bristle_stiffness=1e4)
    (folder / "a.toml").write_text(device_text(device, delay=1e-3))
    frame = pl.DataFrame(columns)
    frame.write_csv(folder / "a.csv")
    frame.with_columns(run=pl.lit("a b")).write_csv(folder / "quoted.csv", quote_style="always")
    frame.write_parquet(folder / "a.parquet")
    frame.with_columns(run=pl.lit("a")).write_parquet(folder / "b.parquet", compression="snappy")
    savemat(folder / "a.mat", columns, do_compression=True)
    savemat(folder / "b.mat", {"bench": columns, "units": {"force": "kN"}}, do_compression=False)
    savemat(folder / "old.mat", columns, format="4")
    return sorted(folder.iterdir())


def changed(data: bytes, other: bytes, draw: random.Random) -> bytes:
    """A file with some bytes changed, cut off, or mixed with another."""
    kind = draw.randrange(4)
    if kind == 0:
        return data[: draw.randrange(len(data))]
    if kind == 1:
        cut = draw.randrange(len(data))
        return data[:cut] + other[draw.randrange(len(other)) :]
    made = bytearray(data)
    # where formats keep their sizes: near the ends
    reach = len(made) if kind == 2 else min(400, len(made))
    for _ in range(draw.choice((1, 1, 2, 8))):
        place = draw.randrange(reach)
        place = place if draw.random() < 0.5 else len(made) - 1 - place
        made[place] = draw.choice((0, 1, 0x7F, 0x80, 0xFF, draw.randrange(256)))
    return bytes(made)


def fuzz(folder: Path, seed: int, count: int) -> dict[str, int]:
    """How many were read, and how many refused."""
    told = {"read": 0, "refused": 0}
    files = sound(folder)
    for path in files:
        assert read(path) == "read", (path, read(path))
    for number in range(count):
        draw = random.Random(f"{seed} {number}")
        path = draw.choice(files)
        data, other = path.read_bytes(), draw.choice(files).read_bytes()
        made = folder / f"made{path.suffix}"
        made.write_bytes(changed(data, other, draw))
        try:
            said = read(made)
        except BaseException as error:
            raise AssertionError(f"seed {seed}, number {number}, {path.name}") from error
        assert "\n" not in said
        told["read" if said == "read" else "refused"] += 1
        made.unlink()
    return told


def main() -> None:
    """As the head of this file says."""
    resource.setrlimit(resource.RLIMIT_DATA, (LIMIT, LIMIT))
    told: dict[str, object] = {}
    if sys.argv[1] == "fuzz":
        told = dict(fuzz(Path(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])))
    else:
        for name in sys.argv[2:]:
            started = time.process_time()
            said = read(Path(name))
            told[name] = (said, time.process_time() - started, memory())
    print(json.dumps({"told": told, "memory": memory()}))


def memory() -> int:
    """The most that this process has had so far [bytes]; not what its parent had before."""
    status = Path("/proc/self/status")
    if status.exists():
        line = next(x for x in status.read_text().splitlines() if x.startswith("VmHWM"))
        return 1024 * int(line.split()[1])
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


if __name__ == "__main__":
    main()
