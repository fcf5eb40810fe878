"""Binary formats of others are read in a process of their own, with bounds on memory and time.

Their libraries are large and partly in C: what a damaged or built file does to them, it does there,
and is one line here. The process tells the header, is told which columns are wanted, and leaves
them in a file of NumPy's that is read without pickles.
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from .bounds import VALUES, Wanted, refuse_header
from .record import RecordError

SECONDS = 600  # of one processor
_LIBRARIES = {
    "excel": "python-calamine", "tdms": "npTDMS", "mdf": "asammdf", "hdf5": "h5py",
    "arrow": "pyarrow",
}  # fmt: skip
_NAMES = {"excel": "workbook", "tdms": "TDMS file", "mdf": "MDF file", "hdf5": "HDF5 file",
          "arrow": "Arrow file"}  # fmt: skip


def read_isolated(kind: str, path: Path, wanted: Wanted, sheet: str | None) -> Any:
    """The raw table of a file; RecordError where it cannot be read."""
    import numpy as np
    import polars as pl

    from .raw_table import RawTable

    # the process works in a folder of its own
    where = os.path.abspath(path)
    command = [sys.executable, "-P", "-m", "inerter.records.isolated", kind, where]
    with tempfile.TemporaryDirectory(prefix="inerter") as folder:
        with subprocess.Popen(
            [*command, folder, sheet or ""], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL, text=True, encoding="utf-8", cwd=folder,
            env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
        ) as process:  # fmt: skip
            assert process.stdin is not None
            assert process.stdout is not None
            header = _answer(kind, path, process.stdout.readline())["header"]
            refuse_header(path, header)
            chosen = [index for index, name in enumerate(header) if wanted(name)]
            with contextlib.suppress(BrokenPipeError):
                process.stdin.write(json.dumps(chosen) + "\n")
                process.stdin.flush()
            answer = _answer(kind, path, process.stdout.readline())
        columns: dict[int, pl.Series] = {}
        with np.load(Path(folder) / "columns.npz", allow_pickle=False) as found:
            for name in found.files:
                values = found[name]
                columns[int(name)] = pl.Series(
                    answer["header"][int(name)],
                    values.tolist() if values.dtype.kind == "U" else values,
                )
    return RawTable(path=path, header=tuple(answer["header"]), columns=columns, told=answer["told"])


def _answer(kind: str, path: Path, line: str) -> dict[str, Any]:
    if not line:
        raise RecordError(
            f"{path}: not a readable {_NAMES[kind]}, or too large for the memory; save it again, "
            "or export CSV"
        )
    answer = json.loads(line)
    if "refused" in answer:
        raise RecordError(answer["refused"].replace(os.path.abspath(path), str(path)))
    if "missing" in answer:
        raise RecordError(
            f"{path}: a {_NAMES[kind]} is read by {_LIBRARIES[kind]}, which is not installed; run "
            f"`pip install {_LIBRARIES[kind]}` (the extra `files` has all such readers), "
            "or export CSV"
        )
    return answer


# --- in the process of its own -----------------------------------------------------------------


def _limit() -> None:
    if sys.platform == "win32":
        return
    import resource

    most = (1 << 30) + 24 * VALUES.most
    for what, bound in ((resource.RLIMIT_DATA, most), (resource.RLIMIT_CPU, SECONDS)):
        hard = resource.getrlimit(what)[1]
        bound = bound if hard == resource.RLIM_INFINITY else min(bound, hard)
        resource.setrlimit(what, (bound, bound))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _work(kind: str, path: Path, folder: Path, sheet: str | None, say: Any) -> None:
    from importlib import import_module

    import numpy as np

    from inerter.records.containers.channels import header_of, of_one_group, table_of

    os.environ["HDF5_PLUGIN_PATH"] = str(folder)
    reader = import_module(f"inerter.records.containers.{kind}")
    channels = of_one_group(path, reader.channels(path, sheet), sheet)
    if not channels:
        raise RecordError(f"{path}: no channels of numbers in it; export the record as CSV")
    refuse_header(path, [channel.name for channel in channels])
    say({"header": header_of(channels)})
    chosen = json.loads(sys.stdin.readline() or "[]")
    header, columns, told = table_of(path, channels, chosen)
    arrays = {
        str(i): np.array(v, dtype=np.str_) if isinstance(v, list) else v for i, v in columns.items()
    }
    np.savez(folder / "columns.npz", **arrays)  # pyright: ignore[reportArgumentType]
    say({"header": header, "told": told})


def main() -> None:
    """Read one file; every answer is one line of JSON."""
    kind, path, folder, sheet = sys.argv[1:5]
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    # whatever a library prints is no answer
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)

    def say(answer: dict[str, Any]) -> None:
        print(json.dumps(answer), file=answers, flush=True)

    _limit()
    try:
        _work(kind, Path(path), Path(folder), sheet or None, say)
    except ModuleNotFoundError:
        say({"missing": kind})
    except RecordError as error:
        say({"refused": str(error)})
    except MemoryError:
        say({"refused": f"{path}: the memory does not suffice for it; give a part of it, or leave "
                        "out columns"})  # fmt: skip
    except FileNotFoundError:
        say({"refused": f"{path}: no such file; check the path"})
    # libraries meet damage with exceptions of every kind
    except Exception:
        say({"refused": f"{path}: not a readable {_NAMES[kind]}; save it again, or export CSV"})
    answers.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
