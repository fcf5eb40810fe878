"""The files of a design: all of them or none."""

from __future__ import annotations

import json
from pathlib import Path

from inerter.design.result import Design
from inerter.device_file import device_text
from inerter.folder import write_files


def design_json(design: Design) -> str:
    """The text that --json prints and design.json holds."""
    return json.dumps(design.json(), indent=2, allow_nan=False) + "\n"


def write_design(design: Design, folder: Path) -> list[str]:
    """Write design.json, device.toml, model.xml and, with curves, design.png and .html; names.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    from inerter.design.figures import page, picture
    from inerter.rig import device_mjcf

    title = f"calculated by inerter design {design.kind}"
    files: dict[str, bytes | str] = {
        "design.json": design_json(design),
        "device.toml": device_text(design.device, design.comments, title=title),
        "model.xml": device_mjcf(design.device, "designed_device"),
    }
    if design.panels:
        files |= {"design.png": picture(design), "design.html": page(design)}
    return write_files(folder, files)
