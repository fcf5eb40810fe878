"""The files of a validation: both of them or none."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from pathlib import Path

from inerter.folder import refuse_folder
from inerter.validate.picture import picture
from inerter.validate.result import Validation


def write_validation(validation: Validation, folder: Path) -> list[str]:
    """Write validation.json and validation.png; returns their names.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    files = {"validation.json": json_text(validation).encode()}
    files["validation.png"] = picture(validation)
    refuse_folder(folder)
    folder.mkdir(parents=True, exist_ok=True)
    staging = Path(tempfile.mkdtemp(prefix=".validation-", dir=folder))
    try:
        for name, content in files.items():
            (staging / name).write_bytes(content)
        for name in files:
            os.replace(staging / name, folder / name)
    finally:
        shutil.rmtree(staging, ignore_errors=True)
    return list(files)


def json_text(validation: Validation) -> str:
    """The content of validation.json."""
    return json.dumps(validation.json(), indent=2, allow_nan=False) + "\n"
