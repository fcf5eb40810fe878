"""MDF files (version 4 and before) of vehicle and bench loggers, by asammdf."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

from .channels import Channel, with_unit


def channels(path: Path, sheet: str | None) -> list[Channel]:
    """The channels of a file; the master of each group is its time."""
    from asammdf import MDF

    del sheet
    logging.disable(logging.CRITICAL)
    file: Any = MDF(path)
    found = []
    for number, group in enumerate(file.groups):
        rows = int(group.channel_group.cycles_nr)
        name = (getattr(group.channel_group, "acq_name", "") or "") or f"group {number + 1}"
        if any(c.group == name for c in found):
            name = f"{name} {number + 1}"
        master = file.masters_db.get(number)
        for index, channel in enumerate(group.channels):
            if index == master:
                found.append(
                    Channel(name="time [s]", rows=rows, group=name, load=_master(file, number))
                )
                continue
            unit = getattr(channel, "unit", "") or ""
            if not unit and getattr(channel, "conversion", None) is not None:
                unit = getattr(channel.conversion, "unit", "") or ""
            found.append(
                Channel(
                    name=with_unit(channel.name, unit), rows=rows, group=name,
                    load=_loader(file, number, index),
                )
            )  # fmt: skip
    return found


def _master(file: Any, group: int) -> Any:
    return lambda: file.get_master(group)


def _loader(file: Any, group: int, index: int) -> Any:
    return lambda: (
        file.get(group=group, index=index, raw=False, ignore_invalidation_bits=True).samples
    )
