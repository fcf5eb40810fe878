"""A half-car on a four-post rig: records, a model that is wrong, what is wrong with it, the gain.

The reference stands for the rig. Its car carries 10 % more than the model states, and its rear
strut rubs. Runs in a minute or two: `python four_post.py [FOLDER]`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from inerter.diagnose.vehicle import SystemInput, diagnose_model
from inerter.models import model_path
from inerter.reference import HALF_CAR, HalfCar, ReferenceDevice, corner_of
from inerter.reference.vehicle_roads import RoadRun

ENDS, SENSORS = ("front", "rear"), ("body_angular_acceleration=body_angular_acceleration.y",)
NOISE = 0.01  # per channel's spread


def record(path: Path, car: HalfCar, seed: int) -> Path:
    """One run of 6 s on a class B road at 15 m/s, as the rig's logger writes it; SI units."""
    times = np.arange(0.0, 6.0, 0.004)
    road = RoadRun(road_class="B", speed=15.0, seconds=6.0, seed=seed)
    posts = [road.track(0, behind) for behind in (0.0, car.front.distance + car.rear.distance)]
    run = car.simulate(posts, times, method="LSODA", rtol=1e-7, atol=1e-9, max_step=0.01)
    felt = {"body_acceleration": run.heave_acceleration,
            "body_angular_acceleration": run.pitch_acceleration}  # fmt: skip
    felt |= {f"strut_length_{end}": run.suspension_travel[:, i] for i, end in enumerate(ENDS)}
    random = np.random.default_rng(seed)
    table = {"time": times}
    for end, post in zip(ENDS, posts, strict=True):
        table[f"road_{end}"] = np.array([post(t) for t in times])
    for name, values in felt.items():
        table[name] = values + NOISE * np.std(values) * random.standard_normal(times.size)
    np.savetxt(
        path, np.column_stack([*table.values()]), "%.9g", ",", header=",".join(table), comments=""
    )
    return path


def main(folder: Path) -> None:
    """Record three runs, diagnose the shipped half-car, print what is wrong and the gain."""
    rear = ReferenceDevice(inertance=HALF_CAR.rear.inertance, friction="coulomb",
                           coulomb_force=60.0, transition_velocity=1e-3)  # fmt: skip
    car = HalfCar(
        body_mass=1.1 * HALF_CAR.body_mass, pitch_inertia=1.1 * HALF_CAR.pitch_inertia,
        rear=corner_of(HALF_CAR.rear, device=rear),
    )  # fmt: skip
    runs = [record(folder / f"run{i}.csv", car, seed=i) for i in (1, 2, 3)]
    model = model_path("half_car", "model.xml")
    found = diagnose_model(runs, model, SystemInput(sensors=SENSORS), holdout=["run3"])
    for finding in found.findings:
        print(f"{finding.effect}: {finding.evidence}")
    print(f"error on run3: {found.baseline.rmse:.3f} of the spread, then {found.extended.rmse:.3f}")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
