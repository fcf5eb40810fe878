"""Diagnosis at system level: a user's MJCF in the loop, driven by what a vehicle or rig recorded.

mapping.py     columns -> actuators, mocap bodies and sensors;  inputs.py  what drives a model
drive.py       a run on the model's steps;  sensing.py  what sensors do
parts.py       what is wheel, body, spring, damper and tyre
model.py       a model as coordinates;  build.py  the same as an MjSpec
simulate.py    many variants in one batch
effects.py     what is tried;  problem.py  residual and fits;  search.py  selection
members.py     causes that cannot be told apart
diagnosis.py   the whole procedure;  outcome.py, values.py, remainder.py, wording.py  its result
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco

from inerter.diagnose.vehicle.build import read_model
from inerter.diagnose.vehicle.mapping import MappingError, map_columns, read_options
from inerter.diagnose.vehicle.outcome import SystemDiagnosis
from inerter.diagnose.vehicle.sensor_units import unit_of
from inerter.engine_errors import COMPILE_ERRORS
from inerter.plugin import load_plugin
from inerter.records import VehicleRecord, read_records
from inerter.records.free_form import column_names, read_free_form
from inerter.records.read import RecordError
from inerter.records.turning import OWN_NAMES

__all__ = ["MappingError", "SystemDiagnosis", "SystemInput", "diagnose_model", "is_for_a_model"]

_BENCH = ("displacement", "force")
_TABLE = ("frequency", "force_amplitude")


@dataclass(frozen=True)
class SystemInput:
    """COLUMN=ACTUATOR and COLUMN=SENSOR as a user gave them."""

    inputs: tuple[str, ...] = ()
    sensors: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.inputs or self.sensors)


def is_for_a_model(records: Sequence[str | Path], mapping: SystemInput, model: Path) -> bool:
    """Whether records are to be compared with a model in the loop rather than with a device."""
    if mapping:
        return True
    columns = set(column_names(records))
    if set(OWN_NAMES) & columns and not set(OWN_NAMES) & _actuators(model):
        columns |= {OWN_NAMES[name] for name in columns if name in OWN_NAMES}
    return not (all(c in columns for c in _BENCH) or all(c in columns for c in _TABLE))


def _actuators(model: Path) -> set[str]:
    """Names of a model's actuators; none where it cannot be read, which is told later."""
    load_plugin()
    try:
        return {each.name for each in mujoco.MjSpec.from_file(str(model.absolute())).actuators}
    except COMPILE_ERRORS:
        return set()


def diagnose_model(
    records: Sequence[str | Path],
    model: Path,
    mapping: SystemInput | None = None,
    holdout: Sequence[str] = (),
    progress: Callable[[str], None] = lambda text: None,
    threads: int = 0,
) -> SystemDiagnosis:
    """Diagnose a user's MJCF along recorded inputs.

    Parameters
    ----------
    records : sequence of str or Path
        Files, folders or globs: vehicle records, or any columns together with `mapping`.
    model : Path
        The MJCF, with at least one inerter.device.
    mapping : SystemInput, optional
        Which column is which actuator or sensor, where names do not say it.
    holdout : sequence of str
        Names of runs to hold out.
    progress : callable
        Told what is being done.
    threads : int
        0 for every processor.

    Raises
    ------
    RecordError, MappingError, DeviceError, ValueError
        The input cannot be used; one line.
    """
    from inerter.diagnose.vehicle.diagnosis import diagnose_system

    mapping = mapping or SystemInput()
    user = read_model(model)
    progress("reading the records")
    columns = column_names(records)
    inputs = read_options(mapping.inputs, "input")
    sensors = read_options(mapping.sensors, "sensor")
    channels = map_columns(user.model, columns, inputs, sensors)
    used = list(channels.used)
    runs: list[Any]
    if mapping or not set(used) <= {"road", *VehicleRecord.optional}:
        units = {each.column: unit_of(user.model, each) for each in channels.outputs}
        runs = list(read_free_form(records, used, units))
    else:
        runs = list(read_records(records, "vehicle"))
    if not runs:
        raise RecordError("no records given")
    return diagnose_system(runs, user, channels, holdout, progress, threads)
