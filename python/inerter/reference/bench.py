"""Test records with one hidden effect, made by the reference ODE.

A random device (an ideal inerter plus one effect) is driven along three or four motions; force
and displacement get white noise. Whoever diagnoses the records can be held against the truth.

The motions are drawn in `bench_motions.py`, the device and its effect's size in
`bench_devices.py`; a delayed force channel is drawn here, 1 to 6 ms.
Not modelled: coloured noise, quantisation, drift, rigs that shake in resonance.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .bench_devices import draw_device, rms, rounded
from .bench_motions import draw_drives
from .device import ReferenceDevice
from .motion import Response, response
from .record import write_record

EFFECTS = (
    "none",
    "viscous_friction",
    "coulomb_friction",
    "stribeck_friction",
    "hysteretic_friction",
    "asymmetric_friction",
    "position_dependent_friction",
    "load_dependent_friction",
    "parallel_stiffness",
    "force_offset",
    "sensor_delay",
    "quadratic_damping",
)

HYSTERETIC_LAWS = ("dahl", "lugre", "bouc_wen")


@dataclass(frozen=True)
class NoiseLevels:
    """Standard deviations of white Gaussian noise.

    Attributes
    ----------
    force
        On the force [N].
    force_share
        On the force, as a share of the case's force rms [-]; adds to `force` in quadrature.
    displacement
        On the displacement [m].
    """

    force: float = 0.2
    force_share: float = 0.0
    displacement: float = 1e-6


@dataclass(frozen=True)
class HiddenRun:
    """One run: what the sensors saw, arrays of shape (n,), and the truth behind it."""

    name: str
    kind: str
    sample_rate: float
    time: NDArray[np.float64]
    displacement: NDArray[np.float64]
    force: NDArray[np.float64]
    truth: Response = field(repr=False)


@dataclass(frozen=True)
class HiddenCase:
    """Runs of one device and what was hidden in them.

    `parameters` holds the true non-zero values under their public names (SI); `delay` [s] is
    positive where the force channel lags the displacement; `share` is rms(F - b a) / rms(F);
    `noise` holds the standard deviations used, in N and m.
    """

    seed: int
    effect: str
    law: str | None
    parameters: dict[str, float]
    device: ReferenceDevice
    share: float
    noise: dict[str, float]
    runs: tuple[HiddenRun, ...]
    delay: float = 0.0

    def write(self, folder: str | Path) -> list[Path]:
        """Write each run as `<folder>/<run name>.csv`; the files do not tell the effect."""
        target = Path(folder)
        target.mkdir(parents=True, exist_ok=True)
        comments = ("synthetic record, made by the reference ODE; SI units",)
        return [
            write_record(
                target / f"{run.name}.csv", run.time, run.displacement, run.force, comments
            )
            for run in self.runs
        ]


def hide_effect(
    seed: int,
    effect: str | None = None,
    *,
    law: str | None = None,
    noise: NoiseLevels | None = None,
) -> HiddenCase:
    """Draw a device with one hidden effect and its records.

    Parameters
    ----------
    seed
        Everything follows from it; print it where a test fails.
    effect
        One of `EFFECTS`; drawn if not given.
    law
        For hysteretic_friction one of `HYSTERETIC_LAWS`; drawn if not given.
    noise
        Noise levels; 0.2 N and 1 micrometre if not given. `NoiseLevels(0.0, 0.01)` is 1 % of the
        force rms instead of 0.2 N.

    Raises
    ------
    ValueError
        Unknown effect or law, or a law given for an effect without one.
    """
    choose, draw, move, shake = (
        np.random.default_rng(child) for child in np.random.SeedSequence(seed).spawn(4)
    )
    name = effect if effect is not None else str(choose.choice(EFFECTS))
    if name not in EFFECTS:
        raise ValueError(f"effect: '{name}' is not one of {', '.join(EFFECTS)}")
    if name == "hysteretic_friction":
        law = law if law is not None else str(choose.choice(HYSTERETIC_LAWS))
        if law not in HYSTERETIC_LAWS:
            raise ValueError(f"law: '{law}' is not one of {', '.join(HYSTERETIC_LAWS)}")
    elif law is not None:
        raise ValueError(f"law: '{law}' given, but only hysteretic_friction has a law")

    ideal = ReferenceDevice(inertance=rounded(np.exp(draw.uniform(np.log(20.0), np.log(400.0)))))
    drives = draw_drives(move, ideal.inertance)
    delay = rounded(draw.uniform(1e-3, 6e-3)) if name == "sensor_delay" else 0.0

    # size the effect, then drive the device along every motion
    device, names = draw_device(draw, name, law, ideal, drives)
    truths = [response(device, drive.motion, drive.time - delay) for drive in drives]
    forces = np.concatenate([truth.force for truth in truths])
    bare = np.concatenate([ideal.inertance * drive.acceleration for drive in drives])
    parameters = {key: float(getattr(device, key)) for key in names if getattr(device, key) != 0.0}
    if delay:
        parameters["delay"] = delay

    # what the sensors saw
    levels = noise if noise is not None else NoiseLevels()
    sigma = float(np.hypot(levels.force, levels.force_share * rms(forces)))
    runs = tuple(
        HiddenRun(
            name=f"run_{i + 1}",
            kind=drive.kind,
            sample_rate=drive.rate,
            time=drive.time,
            displacement=drive.displacement
            + levels.displacement * shake.standard_normal(drive.time.size),
            force=truth.force + sigma * shake.standard_normal(drive.time.size),
            truth=truth,
        )
        for i, (drive, truth) in enumerate(zip(drives, truths, strict=True))
    )
    return HiddenCase(
        seed=seed,
        effect=name,
        law=law,
        parameters=parameters,
        device=device,
        share=rms(forces - bare) / rms(forces),
        noise={"force": sigma, "displacement": levels.displacement},
        runs=runs,
        delay=delay,
    )
