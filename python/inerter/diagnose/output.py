"""The files of a diagnosis: all of them or none."""

from __future__ import annotations

import errno
import json
import os
import shutil
import tempfile
from pathlib import Path

from inerter.core import Device
from inerter.device_file import device_text
from inerter.diagnose.result import Diagnosis
from inerter.report.page import write_report
from inerter.rig import device_mjcf


def refuse_folder(folder: Path) -> None:
    """Raise OSError where a folder cannot be made or written, before the work is done."""
    existing = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not existing.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "not a folder", str(existing))
    if not os.access(existing, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, "no permission to write", str(existing))


def write_outputs(diagnosis: Diagnosis, folder: Path) -> None:
    """Write diagnosis.json, report.html, device.toml and model.xml.

    Everything is written beside the folder first and moved into it when complete.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    device = Device(**diagnosis.extended.device)
    names = ", ".join(record.name for record in diagnosis.records)
    comments = {
        name: f"{value.unit} (standard error {value.stderr:.2g})".removeprefix("1 ")
        for name, value in diagnosis.parameters.items()
    }
    rest_length = {"rest_length": diagnosis.rest_length} if diagnosis.rest_length else {}
    toml = device_text(
        device.replace(**rest_length),
        comments,
        diagnosis.extended.delay,
        f"identified by inerter diagnose from {names}",
    )
    model = device_mjcf(device, "identified_device")
    refuse_folder(folder)
    folder.mkdir(parents=True, exist_ok=True)
    staging = Path(tempfile.mkdtemp(prefix=".diagnosis-", dir=folder))
    try:
        (staging / "diagnosis.json").write_text(
            json.dumps(diagnosis.json(), indent=2, allow_nan=False) + "\n", encoding="utf-8"
        )
        (staging / "device.toml").write_text(toml, encoding="utf-8")
        (staging / "model.xml").write_text(model, encoding="utf-8")
        write_report(diagnosis, staging / "report.html", toml, model)
        for file in sorted(staging.iterdir()):
            os.replace(file, folder / file.name)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
