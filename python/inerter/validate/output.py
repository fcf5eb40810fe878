"""The files of a validation: both of them or none."""

from __future__ import annotations

import json
from pathlib import Path

from inerter.folder import write_files
from inerter.validate.picture import picture
from inerter.validate.result import Validation


def write_validation(validation: Validation, folder: Path) -> list[str]:
    """Write validation.json and validation.png; returns their names.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    return write_files(
        folder,
        {"validation.json": json_text(validation), "validation.png": picture(validation)},
    )


def json_text(validation: Validation) -> str:
    """The content of validation.json."""
    return json.dumps(validation.json(), indent=2, allow_nan=False) + "\n"
