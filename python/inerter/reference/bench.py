"""Test records with hidden effects, made by the reference ODE.

A random device (an ideal inerter plus one effect, or several) is driven along three or four
motions; force and displacement get white noise. Whoever diagnoses the records can be held against
the truth.

    bench_motions.py   the motions
    bench_effects.py   the effects and which go together
    bench_devices.py   what an effect adds to the device, and its size
    bench_channel.py   what happens to the force on its way into the record
    bench_unknown.py   records with an effect that no name describes
    bench_realistic.py what a bench as it is does to motion and records
Not modelled: coloured noise, rigs that shake in resonance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from .bench_channel import Channel, Situation, answers, shown
from .bench_devices import draw_effect, draw_limits, joined, own_names
from .bench_effects import EFFECTS, HYSTERETIC_LAWS, NEEDS_LEVEL, check_effect, clash
from .bench_motions import draw_drives
from .bench_realistic import Chain, draw_bench_drives, draw_chain, quantised
from .device import ReferenceDevice
from .motion import Response
from .record import write_record
from .sizes import rms, rounded


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


@dataclass(frozen=True, kw_only=True)
class HiddenRun:
    """One run: what the sensors saw, arrays of shape (n,), and the truth behind it.

    shown: the force that the sensors would have seen without noise and converter; truth: the
    device's own, at the same times.
    """

    name: str
    kind: str
    sample_rate: float
    time: NDArray[np.float64]
    displacement: NDArray[np.float64]
    force: NDArray[np.float64]
    shown: NDArray[np.float64] = field(repr=False)
    truth: Response = field(repr=False)


@dataclass(frozen=True, kw_only=True)
class HiddenCase:
    """Runs of one device and what was hidden in them.

    Attributes
    ----------
    effect, also, law
        What was hidden; the law belongs to hysteretic_friction.
    parameters
        The true non-zero values under their public names (SI); `names` says which effect they
        belong to.
    device, delay, channel
        The device; the delay [s] is positive where the force channel lags the displacement.
    share
        rms(F - b a) / rms(F), without noise.
    noise
        The standard deviations used, "force" in N and "displacement" in m.
    stated
        For inertance_error the device that a user would state, with a wrong inertance; else None.
    kind
        For an effect without a name which it is, see `bench_unknown.py`; else None.
    chain
        What a realistic bench does to the records, see `bench_realistic.py`; else None.
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
    also: tuple[str, ...] = ()
    names: dict[str, tuple[str, ...]] = field(default_factory=dict)
    channel: Channel = field(default_factory=Channel)
    stated: dict[str, float] | None = None
    kind: str | None = None
    chain: Chain | None = None

    @property
    def effects(self) -> tuple[str, ...]:
        """All effects; none for "none" and for one without a name."""
        return () if self.effect in ("none", "unknown") else (self.effect, *self.also)

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
    also: Sequence[str] = (),
    realistic: bool = False,
) -> HiddenCase:
    """Draw a device with one hidden effect, or several, and its records.

    Parameters
    ----------
    seed
        Everything follows from it; print it where a test fails.
    effect
        "none" or one of `EFFECTS`; drawn from all of these if not given.
    law
        For hysteretic_friction one of `HYSTERETIC_LAWS`; drawn if not given.
    noise
        Noise levels; 0.2 N and 1 micrometre if not given. `NoiseLevels(0.0, 0.01)` is 1 % of the
        force rms instead of 0.2 N.
    also
        Further effects, each sized as if it were alone; saturation clips what there is.
    realistic
        On a bench with a measuring chain of its own, see `bench_realistic.py`.

    Runs with friction_drift or viscous_drift share one clock: each starts some seconds after
    another. All others start at zero.

    Raises
    ------
    ValueError
        Unknown effect or law, effects that do not go together, or a law given for an effect
        without one.
    """
    choose, draw, move, shake, more = (
        np.random.default_rng(child) for child in np.random.SeedSequence(seed).spawn(5)
    )
    name = effect if effect is not None else str(choose.choice(("none", *EFFECTS)))
    effects = (name, *also)
    check_effect(name)
    reason = clash(effects)
    if reason is not None:
        raise ValueError(f"effects: {', '.join(effects)} do not go together: {reason}")
    law = _law(choose, effects, law)

    ideal = ReferenceDevice(inertance=rounded(np.exp(draw.uniform(np.log(20.0), np.log(400.0)))))
    one_clock = bool({"friction_drift", "viscous_drift"} & set(effects))
    runs = draw_situations(move, more, ideal.inertance, one_clock, realistic=realistic)

    # size each effect as if alone, the first by the numbers it would have alone
    generators = [draw, *more.spawn(len(also))]
    drawn = [
        draw_limits(generator, _bare(ideal, runs))
        if each == "sensor_saturation"
        else draw_effect(generator, each, law, ideal, runs)
        for each, generator in zip(effects, generators, strict=True)
    ]
    whole = joined(effects, drawn, ideal)
    device = replace(ideal, **whole.device)
    channel = Channel(**whole.channel)

    # drive the device along every motion; a sensor's range follows from the whole force
    truths = answers(device, channel, runs)
    if "sensor_saturation" in effects:
        which = effects.index("sensor_saturation")
        forces = np.concatenate([truth.force for truth in truths])
        drawn[which] = draw_limits(more, forces)
        channel = Channel(**{k: v for k, v in whole.channel.items() if k not in _LIMITS})
        channel = replace(channel, **drawn[which].channel)
    names = {
        each: own_names(each, effects, part) for each, part in zip(effects, drawn, strict=True)
    }
    return record_case(
        runs, truths, channel, shake, noise,
        seed=seed, effect=name, law=law, device=device, also=tuple(also), stated=whole.stated,
        names={} if name == "none" else names,
        parameters=_values(device, channel, names),
        ideal=ideal, realistic=realistic,
    )  # fmt: skip


def draw_situations(
    move: Generator, more: Generator, inertance: float, one_clock: bool, *, realistic: bool = False
) -> list[Situation]:
    """The motions of a case, each with its start on the clock and a phase."""
    runs: list[Situation] = []
    start = 0.0
    for drive in (draw_bench_drives if realistic else draw_drives)(move, inertance):
        runs.append(Situation(drive, start, float(more.uniform(0.0, 2.0 * np.pi))))
        if one_clock:
            start = round(start + float(drive.time[-1]) + more.uniform(1.0, 10.0), 1)
    return runs


def record_case(
    runs: list[Situation],
    truths: list[Response],
    channel: Channel,
    shake: Generator,
    noise: NoiseLevels | None,
    ideal: ReferenceDevice,
    *,
    realistic: bool = False,
    **known: Any,
) -> HiddenCase:
    """What the sensors saw of a device's answers; `known` are the case's other fields."""
    clean = [replace(truth, force=channel.clip(truth.force)) for truth in truths]
    forces = np.concatenate([truth.force for truth in clean])
    levels = noise if noise is not None else NoiseLevels()
    sigma = float(np.hypot(levels.force, levels.force_share * rms(forces)))
    chain = draw_chain(shake, [run.drive for run in runs], forces) if realistic else None
    seen = []
    for number, (run, truth, final) in enumerate(zip(runs, truths, clean, strict=True)):
        drive, clock, felt = run.drive, run.drive.time + run.start, truth.force
        displacement = drive.displacement
        if chain is not None:
            grip = shown(channel, drive, drive.motion.acceleration)
            felt, displacement = chain.force(truth, grip), chain.displacement(drive)
            felt, displacement = (
                chain.sampled(each, drive.time, shake) for each in (felt, displacement)
            )
            clock = clock[:: chain.every]
            final = Response(**{n: q[:: chain.every] for n, q in vars(final).items()})
        size = displacement.size
        displacement = displacement + levels.displacement * shake.standard_normal(size)
        force = channel.clip(felt + sigma * shake.standard_normal(size))
        if chain is not None:
            displacement = quantised(displacement, chain.displacement_step)
            force = quantised(force, chain.force_step)
        name = f"run_{number + 1}"
        seen.append(
            HiddenRun(
                name=name,
                kind=drive.kind,
                sample_rate=drive.rate if chain is None else chain.rate,
                time=clock,
                displacement=displacement,
                force=force,
                shown=channel.clip(felt),
                truth=final,
            )
        )
    return HiddenCase(
        share=rms(forces - _bare(ideal, runs)) / rms(forces),
        noise={"force": sigma, "displacement": levels.displacement},
        runs=tuple(seen),
        delay=channel.delay,
        channel=channel,
        chain=chain,
        **known,
    )


_LIMITS = ("force_minimum", "force_maximum")


def _law(choose: Generator, effects: tuple[str, ...], law: str | None) -> str | None:
    if "hysteretic_friction" not in effects:
        if law is not None:
            raise ValueError(f"law: '{law}' given, but only hysteretic_friction has a law")
        return None
    # Bouc-Wen's loop has no level that could differ with direction or position
    levels = [name for name in effects if name in NEEDS_LEVEL]
    laws = HYSTERETIC_LAWS[:2] if levels else HYSTERETIC_LAWS
    law = law if law is not None else str(choose.choice(laws))
    if law not in laws:
        reason = f" with {levels[0]}" if levels else ""
        raise ValueError(f"law: '{law}' is not one of {', '.join(laws)}{reason}")
    return law


def _bare(ideal: ReferenceDevice, runs: list[Situation]) -> NDArray[np.float64]:
    return np.concatenate([ideal.inertance * run.drive.acceleration for run in runs])


def _values(
    device: ReferenceDevice, channel: Channel, names: dict[str, tuple[str, ...]]
) -> dict[str, float]:
    found: dict[str, float] = {}
    for key in dict.fromkeys(name for group in names.values() for name in group):
        value = float(getattr(device if hasattr(device, key) else channel, key))
        if value != 0.0:
            found[key] = value
    return found
