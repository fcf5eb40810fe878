"""Binary files of others that are damaged or built to harm: refused in one line, nothing run."""

from __future__ import annotations

import random
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from inerter.records import RecordError, read_records

sys.path.insert(0, str(Path(__file__).parents[1] / "records"))
from bench_files import BINARIES  # pyright: ignore[reportMissingImports]

CONTAINERS = ("sheet.xlsx", "wave.tdms", "logger.mf4", "data.h5", "frame.feather")


def refused(path: Path) -> str:
    with pytest.raises(RecordError) as caught:
        read_records(path)
    said = str(caught.value)
    assert "\n" not in said
    assert path.name in said
    return said


@pytest.mark.parametrize("name", CONTAINERS)
def test_a_damaged_file_is_read_or_refused(name: str, tmp_path: Path, long_run: bool) -> None:
    sound = tmp_path / name
    BINARIES[name](sound)
    data = sound.read_bytes()
    for number in range(40 if long_run else 1):
        draw = random.Random(f"{name} {number}")
        made = bytearray(data[: draw.randrange(len(data))] if draw.random() < 0.3 else data)
        for _ in range(draw.choice((1, 4, 40))):
            made[draw.randrange(min(len(made), 2000) or 1)] = draw.randrange(256)
        path = tmp_path / f"made{sound.suffix}"
        path.write_bytes(made)
        said = ""
        try:
            read_records(path)
        except RecordError as error:
            said = str(error)
        assert "\n" not in said, number


def test_a_workbook_that_unpacks_to_too_much(tmp_path: Path) -> None:
    path = tmp_path / "bomb.xlsx"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/worksheets/sheet1.xml", b"0" * 150_000_000)
    assert "times its size when unpacked" in refused(path)


def test_links_to_other_files_are_not_followed(tmp_path: Path) -> None:
    import h5py

    BINARIES["data.h5"](tmp_path / "secret.h5")
    with h5py.File(tmp_path / "link.h5", "w") as file:
        file["time"] = np.arange(100.0)
        file["force"] = h5py.ExternalLink("secret.h5", "/run/load")
    assert "no column" in refused(tmp_path / "link.h5")
    raw = tmp_path / "raw.bin"
    raw.write_bytes(bytes(800))
    with h5py.File(tmp_path / "external.h5", "w") as file:
        file.create_dataset("force", (100,), "f8", external=[(str(raw), 0, 800)])
    assert "lie in another file" in refused(tmp_path / "external.h5")


def test_a_huge_empty_dataset_is_refused_before_it_is_read(tmp_path: Path) -> None:
    import h5py

    with h5py.File(tmp_path / "huge.h5", "w") as file:
        for name in ("time", "displacement", "force"):
            file.create_dataset(name, (10_000_000_000,), "f8", chunks=(1_000_000,))
    assert "at most" in refused(tmp_path / "huge.h5")
