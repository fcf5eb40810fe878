"""The table of what is read of files of benches, and how: `python tests/records/bench_table.py`.

Writes every file of `bench_files` and `bench_programs`, reads it with what a user would state of
it, and prints: read, and what was said; or refused, with the line.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from bench_export import Export
from bench_files import BINARIES, DISPLACEMENT, FORCE, STEP, TEXTS, TIME
from bench_programs import EXPORTS
from inerter.records import Record, RecordError, read_records
from inerter.records.stated import reading

CASES: dict[str, Export] = {
    **{name: Export(write) for name, write in (TEXTS | BINARIES).items()},
    "two_rates.tdms": Export(BINARIES["two_rates.tdms"], within=(1e-7, 1e-8)),
    **EXPORTS,
}


def read_case(case: Export, path: Path) -> Record:
    """Write a file and read it with what is stated of it; RecordError where it is refused.

    A diagnosis reads no further columns, and has to get the same.
    """
    case.write(path)
    with reading(case.columns):
        (record,) = read_records(path, "bench")
    with reading(case.columns):
        (bare,) = read_records(path, "bench", others=False)
    for name in ("time", "displacement", "force"):
        np.testing.assert_array_equal(getattr(bare, name), getattr(record, name))
    return record


def differs(record: Record, within: tuple[float, float]) -> str:
    """What of a record is not what was written; empty where all is. The first samples count.

    A channel at half the rate ends one sample earlier.
    """
    if not 0 <= len(TIME) - record.samples <= 1:
        return f"{record.samples} samples"
    n = record.samples
    told = []
    for name, found, true, bound in (
        # of seconds since 1970 a double has a quarter of a microsecond
        ("time", record.time - record.time[0], TIME[:n], 3e-4 * STEP),
        ("displacement", record.displacement, DISPLACEMENT[:n], within[0]),
        ("force", record.force, FORCE[:n], within[1]),
    ):
        off = float(np.max(np.abs(found - true)))
        if not off <= bound + 1e-8 * float(np.max(np.abs(true))):
            told.append(f"{name} off by {off:.3g}")
    return ", ".join(told)


def main() -> None:
    """Print the table; a file that no writer is there for is left out."""
    print("| file | stated | read, and what was said; or refused |\n| --- | --- | --- |")
    count = {"read": 0, "refused": 0, "WRONG": 0, "left out": 0}
    with tempfile.TemporaryDirectory() as folder:
        for name, case in CASES.items():
            path = Path(folder) / name
            try:
                record = read_case(case, path)
                wrong = differs(record, case.within)
                kind, said = ("WRONG" if wrong else "read"), record.reading or "nothing to say"
                said = f"{wrong}; {said}" if wrong else said
            except RecordError as error:
                kind, said = "refused", str(error).replace(str(path), name)
            except ModuleNotFoundError as error:
                kind, said = "left out", f"no writer for it ({str(error).splitlines()[0]})"
            count[kind] += 1
            stated = " ".join(f"`{text}`" for text in case.columns)
            print(f"| {name} | {stated} | **{kind}**: {said.replace('|', chr(0xA6))} |", flush=True)
    print(f"\n{len(CASES)} files: {count['read']} read, {count['refused']} refused, "
          f"{count['WRONG']} read with wrong values, {count['left out']} left out")  # fmt: skip


if __name__ == "__main__":
    main()
