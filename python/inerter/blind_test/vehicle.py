"""A case in a vehicle: its records against the model that a user would have of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from inerter.blind_test.vehicle_model import sensors_of, vehicle_mjcf
from inerter.diagnose import Diagnosis
from inerter.diagnose.result import Finding
from inerter.plugin import load_plugin
from inerter.records.free_form import FreeRecord
from inerter.reference import HiddenVehicle

ELSEWHERE = " elsewhere"
"""Behind the name of an effect that is named in another corner or channel than where it is."""


def vehicle_records(case: HiddenVehicle) -> list[FreeRecord]:
    """What a logger in the vehicle would have written."""
    found = []
    for number, run in enumerate(case.runs, 1):
        columns = {name: values for name, values in run.items() if name != "time"}
        found.append(FreeRecord(name=f"run{number}", time=run["time"], extra=columns))
    return found


def diagnose_vehicle(case: HiddenVehicle, threads: int = 1) -> Diagnosis:
    """Against the vehicle as it is stated."""
    # needs mujoco.batch, which benches do without
    from inerter.diagnose.vehicle.build import model_of_text
    from inerter.diagnose.vehicle.diagnosis import diagnose_system
    from inerter.diagnose.vehicle.mapping import map_columns

    load_plugin()
    user = model_of_text(vehicle_mjcf(case.stated, case.active), Path(f"{case.stated.kind}.xml"))
    records = vehicle_records(case)
    columns = list(records[0].channels())
    channels = map_columns(user.model, columns, {}, sensors_of(case.stated))
    return diagnose_system(records, user, channels, threads=threads)


def name_in_vehicle(case: HiddenVehicle, finding: Finding) -> str:
    """A finding's effect, with `ELSEWHERE` where that was hidden in another place."""
    place = case.places.get(finding.effect, "")
    prefixes = {name.rpartition(".")[0] for name in finding.parameters}
    if place and any(prefixes) and not any(each.endswith(place) for each in prefixes):
        return finding.effect + ELSEWHERE
    return finding.effect


def vehicle_parameters(
    case: HiddenVehicle, findings: Sequence[Finding]
) -> Iterator[tuple[str, str, float, float | None, float | None]]:
    """Effect, name, true value, found value and standard error of what was hidden and named."""
    for effect, values in case.names.items():
        finding = next((f for f in findings if name_in_vehicle(case, f) == effect), None)
        if finding is None or (effect == "hysteretic_friction" and finding.law != case.law):
            continue
        reported = {name.rpartition(".")[2]: v for name, v in finding.parameters.items()}
        for name, true in values.items():
            value = reported.get(name)
            if value is None:
                yield effect, name, true, None, None
            else:
                yield effect, name, true, value.value, value.stderr


def vehicle_gain(case: HiddenVehicle, diagnosis: Diagnosis) -> float | None:
    """1 - after / before: errors per spread against the noise-free channels, held-out samples."""
    before = after = 0.0
    for curve in diagnosis.curves:
        run, _, channel = curve.name.partition(": ")
        truth = case.truth[int(run.removeprefix("run")) - 1][channel.replace(" ", "_")]
        judged = curve.inner & curve.holdout
        size = float(np.std(truth)) or 1.0
        before += float(np.sum(((curve.baseline - truth)[judged] / size) ** 2))
        after += float(np.sum(((curve.extended - truth)[judged] / size) ** 2))
    return 1.0 - float(np.sqrt(after / before)) if before > 0.0 else None
