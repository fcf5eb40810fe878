"""Devices drawn at random for each law, their noisy records by the reference, and what is found.

    python tests/identification/random_devices.py --law dahl --count 100

prints bias, spread and coverage of the 95 % intervals. The records share no code with the fit.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np
from inerter.identify.estimate import identify
from inerter.identify.result import Identified
from inerter.records import Record
from inerter.reference import ReferenceDevice, response
from inerter.reference.bench_motions import Drive, draw_drives

LAWS = (
    "ideal", "viscous", "coulomb", "dahl", "lugre", "bouc_wen", "brown_mcphee", "viscous+series",
    "fluid", "dahl+play",
)  # fmt: skip


@dataclass(frozen=True)
class Drawn:
    """A device's true `parameters` and its `records`; `noise` of the force [N]."""

    parameters: dict[str, float]
    records: list[Record]
    noise: float


def drawn(law: str, seed: int, share: float = 0.01, displacement: float = 1e-6) -> Drawn:
    """A device of a law along three motions; force noise is `share` of its rms, seed as given."""
    random = np.random.default_rng([seed, 17])
    inertance = float(np.exp(random.uniform(np.log(20), np.log(300))))
    drives = draw_drives(random, inertance)[:3]
    x, a = (
        float(np.mean([np.std(getattr(drive, name)) for drive in drives]))
        for name in ("displacement", "acceleration")
    )
    v, force = np.sqrt(x * a), inertance * a

    def between(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    values: dict = {"inertance": inertance}
    parts = law.split("+")
    if parts[0] != "ideal":
        values["viscous"] = between(0.03, 0.3) * force / v
    level = between(0.08, 0.4) * force
    name = {"fluid": "brown_mcphee"}.get(parts[0], parts[0])
    if name in ("coulomb", "brown_mcphee", "dahl", "lugre"):
        values |= {"friction": name, "coulomb_force": level}
    if name in ("brown_mcphee", "lugre"):
        values |= {
            "static_force": level * between(1.2, 2),
            "stribeck_velocity": between(0.05, 0.3) * v,
        }
    if name in ("dahl", "lugre"):
        values["bristle_stiffness"] = level / (between(0.005, 0.2) * x)
    if name == "lugre":
        values["bristle_damping"] = between(0.01, 0.1) * force / v
    if name == "bouc_wen":
        width, exponent = between(0.02, 0.5) * x, float(random.uniform(1.1, 2))
        limit, shape = width**-exponent, random.uniform(0.4, 1)
        values |= {
            "friction": name, "bw_stiffness": level / width, "bw_beta": shape * limit,
            "bw_gamma": (1 - shape) * limit, "bw_exponent": exponent,
        }  # fmt: skip
    if "series" in parts or "fluid" in parts:
        rate, loss = between(2, 6) * np.sqrt(a / x), between(0.03, 0.3)
        values |= {
            "series_stiffness": inertance * rate**2,
            "series_damping": 2 * loss * rate * inertance,
        }
    if "fluid" in parts:
        values["flywheel_viscous"] = between(0.03, 0.3) * force / v

    if "play" in parts:
        values["friction_backlash"] = between(0.02, 0.3) * x

    device = ReferenceDevice(**values)
    forces = [_force(device, drive) for drive in drives]
    size = share * float(np.sqrt(np.mean(np.concatenate(forces) ** 2)))
    shake = np.random.default_rng([seed, 99])
    records = [
        Record(
            name=f"run_{i + 1}",
            time=drive.time,
            displacement=drive.displacement + displacement * shake.standard_normal(f.size),
            force=f + size * shake.standard_normal(f.size),
        )
        for i, (drive, f) in enumerate(zip(drives, forces, strict=True))
    ]
    numbers = {key: float(value) for key, value in values.items() if key != "friction"}
    return Drawn(numbers, records, size)


def _force(device: ReferenceDevice, drive: Drive) -> np.ndarray:
    """Force of a device that has been moving before the record begins [N]."""
    before = np.arange(-4.0, -1e-9, 2e-3)
    whole = response(device, drive.motion, np.concatenate([before, drive.time]))
    return np.asarray(whole.force)[before.size :]


def found(case: Drawn, law: str, intervals: str = "normal") -> Identified:
    """What the records tell of a device of this law."""
    return identify(case.records, [law], intervals=intervals).best


def main() -> None:
    """Bias, spread and coverage over many devices of a law."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--law", default="dahl", help=", ".join(LAWS))
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--intervals", default="normal", choices=("normal", "profile"))
    options = parser.parse_args()
    errors: dict[str, list[tuple[float, float]]] = {}
    inside: list[bool] = []
    seconds: list[float] = []
    for seed in range(options.count):
        case = drawn(options.law, seed)
        result = found(case, options.law, options.intervals)
        seconds.append(result.seconds)
        for key, truth in case.parameters.items():
            if (each := result.parameters.get(key)) is None:
                continue
            low = -np.inf if each.low is None else each.low
            high = np.inf if each.high is None else each.high
            inside.append(low <= truth <= high)
            score = (each.value - truth) / each.stderr if each.stderr else 0.0
            errors.setdefault(key, []).append((each.value / truth - 1, score))
            if abs(score) > 3:
                print(f"  seed {seed}: {key} off by {each.value / truth - 1:+.2%}, {score:+.1f} se")
    print(f"{options.law}: coverage {np.mean(inside):.3f} of {len(inside)} intervals, "
          f"{np.median(seconds):.1f} s each")  # fmt: skip
    for key, pairs in errors.items():
        off, score = np.array(pairs).T
        bias, error = np.median(off), np.median(np.abs(off))
        spread = f"score {score.mean():+.2f} +- {score.std():.2f}"
        print(f"  {key:20} median bias {bias:+.2%}, median error {error:.2%}, {spread}")


if __name__ == "__main__":
    main()
