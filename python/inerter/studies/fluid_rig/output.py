"""The files of a study."""

from __future__ import annotations

from pathlib import Path

from inerter.folder import json_text as finite_json
from inerter.folder import write_files
from inerter.studies.fluid_rig.figures import picture
from inerter.studies.fluid_rig.page import page
from inerter.studies.fluid_rig.panels import pictures
from inerter.studies.fluid_rig.study import Study
from inerter.studies.fluid_rig.summary import study_json


def json_text(study: Study) -> str:
    """What --json prints."""
    return finite_json(study_json(study))


def write_study(study: Study, folder: Path) -> list[str]:
    """Write fluid_rig.json, fluid_rig.html, dry.png, complete.png, levels.png; their names.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    files: dict[str, bytes | str] = {
        "fluid_rig.json": json_text(study),
        "fluid_rig.html": page(study),
    }
    files |= {f"{each.name}.png": picture(each) for each in pictures(study)}
    return write_files(folder, files)
