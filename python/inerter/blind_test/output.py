"""The files of a blind test: all of them or none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from inerter.blind_test.picture import calibration_picture, confusion_picture
from inerter.folder import json_text, write_files


def write_blind_test(result: dict[str, Any], folder: Path) -> list[str]:
    """Write blind_test.json, confusion.png and calibration.png; returns their names.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    return write_files(
        folder,
        {
            "blind_test.json": json_text(result),
            "confusion.png": confusion_picture(result),
            "calibration.png": calibration_picture(result),
        },
    )
