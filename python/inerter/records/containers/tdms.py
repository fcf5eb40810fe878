"""TDMS files of LabVIEW and DIAdem, by npTDMS."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .channels import Channel, with_unit

_UNITS = ("unit_string", "NI_UnitDescription", "unit", "Unit", "units")


def channels(path: Path, sheet: str | None) -> list[Channel]:
    """The channels of a file; times of a waveform are its start offset and increment."""
    from nptdms import TdmsFile

    del sheet
    file = TdmsFile.open(path)
    found = []
    for group in file.groups():
        for channel in group.channels():
            about = channel.properties
            step = about.get("wf_increment")
            found.append(
                Channel(
                    name=with_unit(
                        channel.name, next((about[key] for key in _UNITS if about.get(key)), None)
                    ),
                    rows=len(channel),
                    group=group.name,
                    load=_loader(channel),
                    clock=(float(about.get("wf_start_offset") or 0.0), float(step))
                    if isinstance(step, int | float) and step > 0
                    else None,
                )
            )
    return found


def _loader(channel: Any) -> Any:
    return lambda: channel[:]
