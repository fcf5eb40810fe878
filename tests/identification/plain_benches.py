"""Do two standard errors hold the truth on benches as they are? A campaign, printed as a table.

    python tests/identification/plain_benches.py --count 40 --seed 1 --by fit
    python tests/identification/plain_benches.py --count 20 --by diagnosis --to out/covered.jsonl

A simulator of a few lines that shares no code with the product: closed-form motions, laws written
out, all of it at 16 kHz, filters as differential equations, then 500 samples per second with
quantisation, hum and drift. `fit`: the true model, fitted as a diagnosis fits it; `identify`: the
same by that command; `diagnosis`: whatever a diagnosis finds. With `--to` it goes on where it was
broken off.
"""

from __future__ import annotations

import argparse
import json
import time
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inerter.diagnose import diagnose_bench
from inerter.diagnose.stages import search_in
from inerter.diagnose.start import Given, prepared
from inerter.identify.choices import covered
from inerter.identify.estimate import identify
from inerter.identify.fit import parameter_errors
from inerter.records import Record
from numpy.typing import NDArray
from scipy import signal

Array = NDArray[np.float64]

RATE, FINER, SECONDS, LEAD = 500, 32, 8.0, 1.0
KINDS = ("no filter", "equal filters", "filter of the force", "filter of the displacement")


@dataclass(frozen=True)
class Bench:
    """What the channels do; filters as (Bessel, order, cut-off [Hz]), steps in N and m."""

    kind: str
    force_filter: tuple[bool, int, float] | None
    displacement_filter: tuple[bool, int, float] | None
    force_noise: float
    displacement_noise: float
    force_step: float
    displacement_step: float
    hum: float
    mains: float
    drift: float


@dataclass(frozen=True)
class Case:
    """True parameters (SI) of a device with a friction `law`, its bench and its records."""

    seed: int
    law: str
    parameters: Mapping[str, float]
    bench: Bench
    records: list[Record]


def drawn(seed: int, kind: str | None = None) -> Case:
    """A device, a bench and three runs; all follow from the seed."""
    random = np.random.default_rng([seed, 31])
    motions = [_motion(random, way) for way in random.permutation(4)[:3]]
    b = float(np.exp(random.uniform(np.log(20), np.log(300))))
    fine = np.arange(-LEAD, SECONDS, 1 / (RATE * FINER))
    runs = []
    for motion in motions:
        x, v, a = motion(fine)
        peak = np.exp(random.uniform(np.log(100), np.log(600)))
        size = min(peak / (b * np.max(np.abs(a))), 0.06 / np.max(np.abs(x)))
        runs.append((size * x, size * v, size * a))
    x, v, a = (np.concatenate(each) for each in zip(*runs, strict=True))
    force = b * np.sqrt(np.mean(a**2))

    def share(channel: Array) -> float:
        part = force * np.exp(random.uniform(np.log(0.05), np.log(0.4)))
        return float(part / np.sqrt(np.mean(channel**2)))

    values = {"inertance": b}
    law = str(random.choice(["coulomb", "coulomb", "coulomb", "dahl", "none"]))
    if law != "none":
        values["coulomb_force"] = share(np.sign(v))
    if law == "dahl":
        values["bristle_stiffness"] = values["coulomb_force"] / (
            np.std(x) * np.exp(random.uniform(np.log(0.005), np.log(0.05)))
        )
    for name, column in (("viscous", v), ("stiffness", x), ("quadratic_damping", v * np.abs(v))):
        if random.uniform() < _OFTEN[name]:
            values[name] = share(column)
    if random.uniform() < 0.5:
        values["force_offset"] = float(force * random.uniform(-0.3, 0.3))
    bench = _bench(random, kind or str(random.choice(KINDS)), force)
    records = [
        _record(f"run_{i}", fine, run, _force(values, law, run), bench, random)
        for i, run in enumerate(runs)
    ]
    if "force_offset" in values:
        # what a constant stands for where the zero drifts
        values["force_offset"] += bench.drift / 2
    return Case(seed, law, values, bench, records)


_OFTEN = {"viscous": 0.8, "stiffness": 0.5, "quadratic_damping": 0.2}


def _bench(random: np.random.Generator, kind: str, force: float) -> Bench:
    def low_pass() -> tuple[bool, int, float]:
        cutoff = float(np.exp(random.uniform(np.log(30), np.log(100))))
        return bool(random.integers(2)), int(random.choice([2, 4])), cutoff

    one = low_pass()
    return Bench(
        kind=kind,
        force_filter=one if kind in ("equal filters", "filter of the force") else None,
        displacement_filter=(
            one if kind in ("equal filters", "filter of the displacement") else None
        ),
        force_noise=float(force * np.exp(random.uniform(np.log(1e-3), np.log(1e-2)))),
        displacement_noise=float(np.exp(random.uniform(np.log(5e-7), np.log(1e-5)))),
        force_step=2000 / 2 ** int(random.choice([12, 14, 16])),
        displacement_step=0.2 / 2 ** int(random.choice([14, 16, 18])),
        hum=float(force * random.choice([0, 0.003, 0.01])),
        mains=float(random.choice([50, 60])),
        drift=float(force * random.uniform(-0.01, 0.01)),
    )


def _motion(random: np.random.Generator, way: int) -> Callable[[Array], tuple[Array, ...]]:
    """Displacement, velocity and acceleration of any size, at times [s]."""
    if way == 0:  # a sweep
        low, high = random.uniform(0.2, 0.6), random.uniform(3, 6)
        rate = (high - low) / (2 * SECONDS)

        def sweep(t: Array) -> tuple[Array, ...]:
            phase, speed = 2 * np.pi * (low * t + rate * t**2), 2 * np.pi * (low + 2 * rate * t)
            # smaller where it is faster, by 1 / (1 + t)
            w, dw, ddw = 1 / (2 + t), -1 / (2 + t) ** 2, 2 / (2 + t) ** 3
            s, c, turn = np.sin(phase), np.cos(phase), 4 * np.pi * rate
            return (
                w * s,
                dw * s + w * speed * c,
                ddw * s + 2 * dw * speed * c + w * (turn * c - speed**2 * s),
            )

        return sweep
    count = (1, 2, 12, 50)[way]
    f = np.sort(random.uniform(0.3, 5, count))
    size = f ** -random.uniform(1, 1.8) * random.uniform(0.5, 1.5, count)
    phase, w = random.uniform(0, 2 * np.pi, count), 2 * np.pi * f

    def sines(t: Array) -> tuple[Array, ...]:
        x, v, a = np.zeros_like(t), np.zeros_like(t), np.zeros_like(t)
        for amplitude, turn, begin in zip(size, w, phase, strict=True):
            angle = turn * t + begin
            x += amplitude * np.sin(angle)
            v += amplitude * turn * np.cos(angle)
            a -= amplitude * turn**2 * np.sin(angle)
        return x, v, a

    return sines


def _force(values: Mapping[str, float], law: str, run: tuple[Array, ...]) -> Array:
    x, v, a = run
    level, get = values.get("coulomb_force", 0.0), values.get
    friction = level * np.sign(v)
    if law == "dahl":
        # along the path between two samples the law is linear: an exponential
        ratio, z = values["bristle_stiffness"] / level, 0.0
        step, way = np.exp(-ratio * np.abs(np.diff(x))), np.sign(np.diff(x))
        friction = np.zeros_like(x)
        for i, (decay, sign) in enumerate(zip(step.tolist(), way.tolist(), strict=True)):
            z = sign + (z - sign) * decay
            friction[i + 1] = level * z
    return (
        values["inertance"] * a + get("viscous", 0.0) * v + get("stiffness", 0.0) * x + friction
        + get("quadratic_damping", 0.0) * v * np.abs(v) + get("force_offset", 0.0)
    )  # fmt: skip


def _record(
    name: str, fine: Array, run: tuple[Array, ...], force: Array, bench: Bench,
    random: np.random.Generator,
) -> Record:  # fmt: skip
    first = round(LEAD * RATE * FINER)
    time = fine[first::FINER]
    seen = []
    for values, low_pass in ((run[0], bench.displacement_filter), (force, bench.force_filter)):
        if low_pass is not None:
            bessel, order, cutoff = low_pass
            w = 2 * np.pi * cutoff
            system = (
                signal.bessel(order, w, analog=True, norm="mag")
                if bessel
                else signal.butter(order, w, analog=True)
            )
            values = values[0] + signal.lsim(system, values - values[0], fine - fine[0])[1]
        seen.append(values[first::FINER])
    n, phase = time.size, random.uniform(0, 2 * np.pi, 2)
    angle = 2 * np.pi * bench.mains * time
    hum = bench.hum * (np.sin(angle + phase[0]) + 0.3 * np.sin(3 * angle + phase[1]))
    x = seen[0] + bench.displacement_noise * random.standard_normal(n)
    f = seen[1] + bench.force_noise * random.standard_normal(n) + hum + bench.drift * time / SECONDS
    return Record(
        name=name,
        time=time,
        displacement=bench.displacement_step * np.round(x / bench.displacement_step),
        force=bench.force_step * np.round(f / bench.force_step),
    )


# --- what is found --------------------------------------------------------------------------------

Found = dict[str, tuple[float, float]]


def by_fit(case: Case) -> Found:
    """The true model, fitted as a diagnosis fits it; the kind of a filter is known."""
    start = prepared(Given(records=case.records))
    search = search_in(start, start.weighed)
    terms = {name: value for name, value in case.parameters.items() if name in _LINEAR}
    if case.law != "none":
        terms |= {"coulomb_force": case.parameters["coulomb_force"]}
        terms["transition_velocity"] = 0.01 * search.problem.scales.velocity
    if case.law == "dahl":
        terms["presliding"] = terms["coulomb_force"] / case.parameters["bristle_stiffness"]
    model = start.baseline.adding(case.law if case.law != "none" else None, **terms)
    for channel, low_pass in (
        ("force", case.bench.force_filter), ("displacement", case.bench.displacement_filter)
    ):  # fmt: skip
        if low_pass is not None and case.bench.kind != "equal filters":
            bessel, order, cutoff = low_pass
            model = model.adding(None, **{f"{channel}_filter": cutoff}).holding(
                **{f"{channel}_filter_order": order, f"{channel}_filter_bessel": float(bessel)}
            )
    fit = search.problem.fit(model)
    return parameter_errors(covered(search.problem, fit, start.data.records))


_LINEAR = ("viscous", "stiffness", "quadratic_damping", "force_offset")


def by_identify(case: Case) -> Found:
    """The true model by `identify`; a filter of one channel is left to a delay."""
    parts = [{"none": "viscous"}.get(case.law, case.law)]
    terms = {"stiffness": "stiffness", "quadratic_damping": "quadratic", "force_offset": "offset"}
    parts += [part for name, part in terms.items() if name in case.parameters]
    if case.bench.kind.startswith("filter"):
        parts.append("delay")
    best = identify(case.records, ["+".join(parts)], intervals="normal").best
    return {name: (each.value, each.stderr) for name, each in best.parameters.items()}


def by_diagnosis(case: Case) -> Found:
    """Whatever a diagnosis finds."""
    found = diagnose_bench(case.records)
    named = {name: (each.value, each.stderr) for name, each in found.parameters.items()}
    if {"force_offset", "force_drift"} <= set(named):
        # the truth is the mean over a run
        value, error = named["force_offset"]
        named["force_offset"] = (value + named["force_drift"][0] * SECONDS / 2, error)
    told = [(each.effect, round(each.confidence, 3)) for each in found.findings]
    return named | {"#": (json.dumps(told), 0.0)}  # type: ignore[dict-item]


WAYS = {"fit": by_fit, "identify": by_identify, "diagnosis": by_diagnosis}


def table(rows: Iterable[dict]) -> str:
    """Share within two standard errors of each parameter, by bench and of all."""
    size: dict[tuple[str, str], list[tuple[float, float]]] = defaultdict(list)
    for row in rows:
        for name, truth in row["parameters"].items():
            if name in row["found"] and truth:
                value, error = row["found"][name]
                z, off = (value - truth) / max(error, 1e-300), (value - truth) / truth
                for kind in (row["kind"], "all"):
                    size[kind, name].append((z, off))
    lines = [f"{'bench':28}{'parameter':20}{'held':>9}{'rms z':>8}{'median |error|':>16}"]
    for (kind, name), pairs in sorted(size.items()):
        z, off = np.array(pairs).T
        held, count = int(np.sum(np.abs(z) <= 2)), z.size
        share = f"{held}/{count}"
        lines.append(
            f"{kind:28}{name:20}{share:>9}{np.sqrt(np.mean(np.minimum(z**2, 400))):8.2f}"
            f"{100 * np.median(np.abs(off)):14.2f} %"
        )
    return "\n".join(lines)


def main() -> None:
    """Run the campaign."""
    options = argparse.ArgumentParser(description="Do two standard errors hold?")
    options.add_argument("--count", type=int, default=40)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--by", choices=list(WAYS), default="fit")
    options.add_argument("--kind", choices=KINDS)
    options.add_argument("--to", type=Path)
    given = options.parse_args()
    done = [json.loads(line) for line in given.to.open()] if given.to and given.to.exists() else []
    known = {row["seed"] for row in done}
    for seed in range(given.seed, given.seed + given.count):
        if seed in known:
            continue
        begin, case = time.process_time(), drawn(seed, given.kind)
        row = {"seed": seed, "kind": case.bench.kind, "law": case.law,
               "parameters": dict(case.parameters), "bench": vars(case.bench)}  # fmt: skip
        try:
            row["found"] = WAYS[given.by](case)
        except ValueError as error:
            row |= {"found": {}, "error": str(error)}
        row["seconds"] = time.process_time() - begin
        done.append(row)
        if given.to:
            with given.to.open("a") as file:
                file.write(json.dumps(row) + "\n")
        print(f"seed {seed}: {case.bench.kind}, {case.law}, {row['seconds']:.1f} s", flush=True)
    print(table(done))


if __name__ == "__main__":
    main()
