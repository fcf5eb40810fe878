"""Diagnosis of bench records: displacement in, force out, what does the simulation lack?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from inerter.core import Device, parameters
from inerter.diagnose import wording
from inerter.diagnose.acceptance import visible, visible_delay
from inerter.diagnose.effects import EFFECTS, effects_of, simpler_laws, submodel
from inerter.diagnose.engines import simulate_engines
from inerter.diagnose.result import (
    Accuracy,
    Diagnosis,
    Finding,
    ParameterValue,
    RecordSummary,
    RunCurves,
)
from inerter.diagnose.rivals import Standing, standing
from inerter.diagnose.search import Scored, Search
from inerter.diagnose.statistics import advantage, block_squares
from inerter.diagnose.unexplained import unexplained
from inerter.identify.bench import Run, scales, thin, whole
from inerter.identify.coordinates import Scales
from inerter.identify.fit import (
    Fit,
    Model,
    Problem,
    force_along,
    parameter_errors,
    stated_values,
)
from inerter.identify.preparation import Preparation, prepare, refuse_unusable
from inerter.identify.split import Split, blocks, split
from inerter.records import Record

Array = NDArray[np.float64]
Progress = Callable[[str], None]

# how surely an effect must help on the held-out data to be reported (standard errors)
CONFIRMING_ADVANTAGE = 2.0
# width of sign(v) in fits, per rms velocity: wide enough for the velocity's noise at rest
TRANSITION = 0.005
# samples without which there is nothing to learn from or to judge on
FEWEST = 8


def diagnose_bench(
    records: Sequence[Record],
    device: Device | None = None,
    holdout: Sequence[str] = (),
    progress: Progress = lambda text: None,
    delay: float = 0.0,
) -> Diagnosis:
    """What a simulation of the device lacks, on data it has not seen.

    Parameters
    ----------
    records : sequence of Record
        One or several runs.
    device : Device, optional
        The user's own device; its stated parameters are held until the data contradict them. By
        default the baseline is the ideal inerter with unknown inertance.
    holdout : sequence of str
        Names of runs to hold out.
    progress : callable
        Told what is being done, a line each.
    delay : float
        Time by which the force channel is known to be late [s].

    Raises
    ------
    ValueError
        Runs that cannot be split or do not move.
    """
    with threadpool_limits(limits=1, user_api="blas"):
        return _Bench(records, device, holdout, progress, delay).run()


def baseline_model(device: Device | None, sizes: Scales) -> Model:
    """The model to start from: ideal inerter with free inertance, or the device as stated."""
    transition = max(parameters()["transition_velocity"].initial, TRANSITION * sizes.velocity)
    if device is None:
        start = sizes.force / sizes.acceleration
        return Model(
            "none", {"inertance": start, "transition_velocity": transition}, ("inertance",)
        )
    values, texts = stated_values(device)
    values.setdefault("transition_velocity", transition)
    level = values.get("coulomb_force", 0.0)
    if "static_force" in values:
        values["static_excess"] = values.pop("static_force") - level
    if "bristle_stiffness" in values:
        values["presliding"] = level / values.pop("bristle_stiffness")
    free = () if "inertance" in values else ("inertance",)
    values.setdefault("inertance", sizes.force / sizes.acceleration)
    return Model(device.friction, values, free, texts)


def _refuse_too_little(split: Split, band: Problem, raw: Problem) -> None:
    """Where gaps and ends leave nothing to learn from or to judge on, there is no diagnosis."""
    learnt = band.with_masks(split.fit).masks
    for masks, purpose in (
        (learnt, "learn from"),
        (raw.masks, "judge on"),
        (band.masks, "judge on"),
    ):
        if sum(int(mask.sum()) for mask in masks) < FEWEST:
            raise ValueError(
                f"{split.description}: gaps and ends leave no motion to {purpose}; record "
                "longer or without gaps"
            )


class _Bench:
    """One diagnosis, step by step."""

    def __init__(
        self,
        records: Sequence[Record],
        device: Device | None,
        holdout: Sequence[str],
        progress: Progress,
        delay: float,
    ) -> None:
        self.all_records = list(records)
        self.records = [
            r for r in records if not any(w.code == "duplicate_record" for w in r.warnings)
        ]
        self.progress = progress
        for record in records:
            if record.name in holdout and record not in self.records:
                raise ValueError(f"--holdout {record.name}: {record.warnings[-1].text}")
        refuse_unusable(self.records)
        progress("smoothing: choosing the cut-off")
        self.preparation: Preparation = prepare(self.records)
        self.runs: list[Run] = [thin(motion) for motion in self.preparation.motions]
        self.whole: list[Run] = [whole(motion) for motion in self.preparation.motions]
        self.split: Split = split(self.runs, holdout)
        held = [r.name for i, r in enumerate(self.runs) if self.split.role(i) == "holdout"]
        self.full = split(self.whole, held)
        self.band = Problem(self.runs, self.split.holdout, scales(self.runs))
        self.raw = Problem(self.whole, self.full.holdout, self.band.scales)
        _refuse_too_little(self.split, self.band, self.raw)
        self.baseline = baseline_model(device, self.band.scales)
        if delay:
            stated = {**self.baseline.values, "delay": delay}
            self.baseline = replace(self.baseline, values=stated)
        self.search = Search(self.runs, self.split, self.baseline, progress)

    def run(self) -> Diagnosis:
        """The whole procedure."""
        before = self.search.problem.fit(self.baseline)
        final = self._plainest_law(self.search.run())
        final, standings = self._settle(final)
        chain = self._chain(final.model)
        while (weak := self._unconfirmed(chain)) is not None:
            self.progress(f"{weak} is not confirmed on held-out data: dropped")
            rest = [name for name, _ in effects_of(final.model, self.baseline) if name != weak]
            fit = self.search.problem.fit(submodel(final.model, rest, self.baseline))
            final = self.search.score("", None, fit)
            chain = self._chain(final.model)
        findings = self._findings(final.fit, chain, standings)
        return self._diagnosis(before, final.fit, findings)

    def _plainest_law(self, final: Scored) -> Scored:
        """The simplest friction law from which the one found does not differ visibly."""
        if final.model.friction == self.baseline.friction:
            return final
        for model in simpler_laws(final.model):
            fit = self.search.problem.fit(model)
            apart = self.band.residual(fit.model), self.band.residual(final.model)
            squares = [(a - b)[m] ** 2 for a, b, m in zip(*apart, self.band.masks, strict=True)]
            difference = float(np.sqrt(np.mean(np.concatenate(squares))))
            if not self._is_visible(difference, 0.0, final.model):
                return self.search.score("", None, fit)
        return final

    def _settle(self, final: Scored) -> tuple[Scored, dict[str, Standing]]:
        """Compare every effect with its rivals; where they are equal, name the usual one."""
        for _ in range(3):
            standings = {}
            swap = None
            for effect, _ in effects_of(final.model, self.baseline):
                standings[effect] = standing(self.search, final, effect)
                swap = standings[effect].better
                if swap is not None:
                    break
            if swap is None:
                return final, standings
            final = swap
        return final, standings

    def _chain(self, model: Model) -> list[tuple[str, str | None, Fit, Fit]]:
        """The effects one after another, the most useful first: name, law, fit before and after."""
        self.progress("measuring the gain of each effect")
        left = effects_of(model, self.baseline)
        fit = self.search.problem.fit(self.baseline)
        masks = self.search.problem.masks
        taken: list[str] = []
        chain = []
        while left:
            trials = []
            for effect, law in left:
                names = [*taken, effect]
                trial = self.search.problem.fit(submodel(model, names, self.baseline))
                trials.append((trial.rmse(masks), effect, law, trial))
            _, effect, law, after = min(trials, key=lambda trial: trial[0])
            chain.append((effect, law, fit, after))
            left = [pair for pair in left if pair[0] != effect]
            taken.append(effect)
            fit = after
        return chain

    def _unconfirmed(self, chain: list[tuple[str, str | None, Fit, Fit]]) -> str | None:
        """The first effect of a chain that does not help on the held-out data, or not visibly."""
        stretches = blocks(self.runs, self.band.masks)
        for effect, _, before, after in reversed(chain):
            squares = [
                block_squares(self.band.residual(fit.model), stretches) for fit in (before, after)
            ]
            if (
                squares[1].sum() >= squares[0].sum()
                or advantage(squares[0], squares[1]) < CONFIRMING_ADVANTAGE
                or not self._is_visible(
                    self._raw_rmse(before.model), self._raw_rmse(after.model), after.model
                )
                or (effect == "sensor_delay" and not self._delay_is_visible(after.model))
            ):
                return effect
        return None

    def _is_visible(self, before: float, after: float, model: Model) -> bool:
        force = float(np.sqrt(np.mean(self._held_out_force() ** 2)))
        return visible(before, after, self._noise_floor(model), force)

    def _delay_is_visible(self, model: Model) -> bool:
        stated = self.baseline.values.get("delay", 0.0)
        spacing = max(run.spacing for run in self.whole)
        return visible_delay(model.delay - stated, spacing)

    def _findings(
        self,
        final: Fit,
        chain: list[tuple[str, str | None, Fit, Fit]],
        standings: dict[str, Standing],
    ) -> list[Finding]:
        values = self._parameters(final)
        findings = []
        for effect, law, before, after in chain:
            known = standings.get(effect)
            named = {n: values[n] for n in EFFECTS[effect].parameters if n in values}
            if effect == "sensor_delay":
                named = {"delay": values["delay"]}
            finding = Finding(
                effect,
                law,
                known.confidence if known else 0.5,
                named,
                self._raw_rmse(before.model),
                self._raw_rmse(after.model),
                "",
                [r for r in known.rivals if r.confidence >= 0.005] if known else [],
            )
            findings.append(replace(finding, evidence=wording.evidence(finding)))
        return sorted(findings, key=lambda finding: -finding.gain)

    def _parameters(self, fit: Fit) -> dict[str, ParameterValue]:
        units = {name: entry.unit for name, entry in parameters().items()} | {"delay": "s"}
        return {
            name: ParameterValue(value, error, units[name])
            for name, (value, error) in parameter_errors(fit).items()
        }

    def _raw_rmse(self, model: Model) -> float:
        residual = self.raw.residual(model)
        square = sum(
            float(np.sum(r[m] ** 2)) for r, m in zip(residual, self.raw.masks, strict=True)
        )
        return float(np.sqrt(square / sum(int(m.sum()) for m in self.raw.masks)))

    def _accuracy(self, model: Model) -> Accuracy:
        rmse, spread = self._raw_rmse(model), float(np.std(self._held_out_force()))
        return Accuracy(model.device().given, rmse, rmse / (spread or 1.0), model.delay)

    def _held_out_force(self) -> Array:
        return np.concatenate(
            [run.force[m] for run, m in zip(self.whole, self.raw.masks, strict=True)]
        )

    def _diagnosis(self, before: Fit, final: Fit, findings: list[Finding]) -> Diagnosis:
        baseline, extended = self._accuracy(before.model), self._accuracy(final.model)
        floor = self._noise_floor(final.model)
        remains = unexplained(
            self.runs, self.split, self.band.residual(final.model), floor, extended.rmse
        )
        self.progress("simulating the extended device in MuJoCo")
        engines = simulate_engines(final.model, self.whole, self.raw.masks)
        names = [r.name for r in self.records]
        summaries = [
            RecordSummary(
                record.name,
                record.samples,
                record.sample_rate,
                self.split.role(names.index(record.name)) if record in self.records else "unused",
                [vars(w) for w in record.warnings],
            )
            for record in self.all_records
        ]
        diagnosis = Diagnosis(
            summaries,
            baseline,
            findings,
            extended,
            floor,
            remains,
            engines,
            "",
            self._parameters(final),
            self._method(),
            self._curves(before.model, final.model),
        )
        return replace(diagnosis, verdict=wording.verdict(diagnosis))

    def _noise_floor(self, model: Model) -> float:
        """Noise of the force, and of the acceleration times the inertance, rms [N]."""
        force = self.preparation.noise_floor
        if self.preparation.channels:
            # the noise of a fused acceleration is not known
            return force
        variances = [motion.acceleration_noise**2 for motion in self.preparation.motions]
        return float(np.hypot(force, model.values["inertance"] * np.sqrt(np.mean(variances))))

    def _method(self) -> dict:
        p = self.preparation
        return {
            "cutoff": p.cutoff,
            "cutoffs_tried": [float(value) for value in p.cutoffs],
            # infinite where too little of a short record is left to judge a cut-off by
            "force_error_at_cutoffs": [float(value) for value in p.errors],
            "channels": ["displacement", *p.channels],
            "one_tone": self.band.scales.one_tone,
            "split": self.split.description,
            "held_out_samples": sum(int(mask.sum()) for mask in self.raw.masks),
        }

    def _curves(self, before: Model, after: Model) -> list[RunCurves]:
        curves = []
        for i, run in enumerate(self.whole):
            curves.append(
                RunCurves(
                    run.name,
                    self.split.role(i),
                    run.time,
                    run.displacement,
                    run.velocity,
                    run.acceleration,
                    run.force,
                    force_along(before, run),
                    force_along(after, run),
                    self.full.holdout[i],
                    run.inner,
                )
            )
        return curves
