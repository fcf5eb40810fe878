"""Diagnosis: what a simulation gets wrong, named, added and measured on data it has not seen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from inerter.core import Device
from inerter.device_file import (
    read_bench_device,
    read_delay,
    read_filters,
    read_motion,
    refuse_other_motion,
)
from inerter.diagnose.budget.carried import Carrying
from inerter.diagnose.result import Diagnosis, Finding
from inerter.diagnose.rig import diagnose_bench
from inerter.diagnose.table import diagnose_table
from inerter.diagnose.vehicle import SystemInput, diagnose_model, is_for_a_model
from inerter.identify.channel_filter import Filter, read_filter, stated_filters
from inerter.mjcf import device_of_model, motion_of_model
from inerter.records import BenchTable, Record, RecordError, read_records

__all__ = ["Diagnosis", "Finding", "diagnose", "diagnose_bench", "diagnose_table"]


def diagnose(
    records: Sequence[str | Path],
    device: Path | Device | None = None,
    model: Path | None = None,
    holdout: Sequence[str] = (),
    progress: Callable[[str], None] = lambda text: None,
    inputs: Sequence[str] = (),
    sensors: Sequence[str] = (),
    filters: Sequence[str] = (),
    carry: Carrying = "any",
    time_limit: float = np.inf,
) -> Diagnosis:
    """Diagnose records from files.

    Parameters
    ----------
    records : sequence of str or Path
        Files, folders or globs: bench records, bench tables or vehicle records, of one kind; with
        `inputs` or `sensors` any columns over time.
    device : Path or Device, optional
        The user's own device as baseline.
    model : Path, optional
        A MuJoCo model; not together with `device`. Bench records and tables take its one
        `inerter.device` as baseline, other records drive the whole model.
    holdout : sequence of str
        Names of runs to hold out.
    progress : callable
        Told what is being done.
    inputs, sensors : sequence of str
        COLUMN=ACTUATOR and COLUMN=SENSOR, where the names in `model` are others than the columns'.
    filters : sequence of str
        CHANNEL=KIND:CUTOFF[:ORDER] of low-passes that a channel of bench records went through, such
        as "force=bessel:50".
    carry : str
        What the extended device may carry without a name, see `diagnose_bench`.
    time_limit : float
        Seconds after which bench records are searched no further, see `diagnose_bench`.

    Raises
    ------
    RecordError, DeviceError, ValueError
        The input cannot be used; the message says what and why.
    """
    if device is not None and model is not None:
        raise ValueError("--device and --model are both given; the baseline can be only one")
    mapping = SystemInput(tuple(inputs), tuple(sensors))
    if model is None and mapping:
        raise ValueError("--input and --sensor name parts of a model; give one with --model")
    if model is not None and is_for_a_model(records, mapping, model):
        if np.isfinite(time_limit):
            raise ValueError("--time-limit is of bench records, not of vehicles; leave it out")
        return diagnose_model(records, model, mapping, holdout, progress)
    if isinstance(device, Path):
        baseline, delay, motion = read_bench_device(device), read_delay(device), read_motion(device)
    else:
        baseline, delay, motion = device, 0.0, None
    if model is not None:
        baseline, motion = device_of_model(model), motion_of_model(model)
    # the displacement of a record counts from the rest length
    rest_length = baseline.rest_length if baseline else 0.0
    if baseline and rest_length:
        baseline = Device(**{k: v for k, v in baseline.given.items() if k != "rest_length"})
    known = _filters(device, filters)
    progress("reading the records")
    read = read_records(records)
    if where := model or (device if isinstance(device, Path) else None):
        refuse_other_motion(where, motion, read)
    tables = [record for record in read if isinstance(record, BenchTable)]
    bench = [record for record in read if isinstance(record, Record)]
    if len(bench) == len(read):
        found = diagnose_bench(bench, baseline, holdout, progress, delay, known, carry, time_limit)
        return replace(found, rest_length=rest_length)
    if np.isfinite(time_limit):
        raise ValueError("--time-limit is of bench records over time; leave it out")
    if len(tables) == len(read):
        if holdout:
            raise ValueError("--holdout names runs, and a table has none; leave it out")
        return replace(diagnose_table(tables, baseline, progress), rest_length=rest_length)
    if known:
        raise ValueError("--filter is of a channel of bench records over time; leave it out")
    kinds = ", ".join(f"{record.name} ({record.kind})" for record in read)
    if tables and bench:
        raise RecordError(f"records of different kinds: {kinds}; give one kind at a time")
    raise RecordError(
        f"vehicle records are judged against a model of the vehicle: {kinds}; give its MJCF with "
        "--model, or bench records (time, displacement, force)"
    )


def _filters(device: Path | Device | None, given: Sequence[str]) -> dict[str, Filter]:
    """Low-passes that the channels went through, as a device's file and the options state them."""
    found = {}
    if isinstance(device, Path):
        for channel, text in read_filters(device).items():
            found[channel] = read_filter(text, f"{device}: {channel}_filter")
    return found | stated_filters(given)
