"""Diagnosis of bench records: displacement in, force out, what does the simulation lack?"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from inerter.core import Device
from inerter.diagnose import wording
from inerter.diagnose.band import WORTH_A_BAND, best_band, narrower_band, wider_band
from inerter.diagnose.baseline import baseline_of
from inerter.diagnose.chain import Link, chain_of, tone_link, weakest
from inerter.diagnose.composition import effects_of, has_series, simpler_laws, submodel
from inerter.diagnose.doubt import doubted
from inerter.diagnose.effects import EFFECTS
from inerter.diagnose.engines import simulate_engines
from inerter.diagnose.judge import Judge
from inerter.diagnose.parallel import helped
from inerter.diagnose.play import fit_play, forgiving, from_contact, jackknife, play_of
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
from inerter.diagnose.statistics import gain_interval
from inerter.diagnose.tone import with_tone_above, with_tone_from_raw
from inerter.diagnose.unexplained import unexplained
from inerter.diagnose.values import parameter_values
from inerter.identify.bench import Run, on_clocks, scales, thin, whole
from inerter.identify.channel import channel_values
from inerter.identify.fit import Fit, Problem
from inerter.identify.model import Model
from inerter.identify.prediction import force_along, settled
from inerter.identify.preparation import (
    Preparation,
    prepare,
    refuse_unusable,
    weighed,
)
from inerter.identify.split import Split, split
from inerter.records import Record
from inerter.records.duplicates import repeats_another, without_copies

Array = NDArray[np.float64]
Progress = Callable[[str], None]

# share of the cut-off from which on tones are looked for at the measured rate
TONES_FROM = 0.7
# bands in which the search goes on, each wider than the one before, at most
MORE_BANDS = 2
# effects that take away the rigid drive of the flywheel
SERIES = ("backlash", "series_elasticity")
# rivals that may take the place of an effect, one after another
EXCHANGES = 3


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
    # predictions of models that are only tried may run away
    quiet = np.errstate(over="ignore", invalid="ignore")
    with helped(), threadpool_limits(limits=1, user_api="blas"), quiet:
        return _Bench(records, device, holdout, progress, delay).run()


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
        self.records = without_copies(records, holdout)
        self.progress = progress
        refuse_unusable(self.records)
        progress("smoothing: choosing the cut-off")
        self.holdout = holdout
        self._take(prepare(self.records))
        # what is held out is so from now on, and has no say in the smoothing of what is fitted:
        # its own motion may be faster, and is smoothed as the force that it makes tells
        self.holdout = self.held
        self.plain = prepare(self.records, self.full.fit)
        self.device = device
        self.baseline = baseline_of(device, self.band.scales)
        if delay:
            stated = {**self.baseline.values, "delay": delay}
            self.baseline = replace(self.baseline, values=stated)
        self.weighed = weighed(self.records, self.plain, self.full.fit)
        self.search = self._weighed_search(self.weighed)

    def _take(self, preparation: Preparation) -> None:
        """Runs and splits of smoothed records."""
        self.preparation = preparation
        self.runs: list[Run] = on_clocks([thin(motion) for motion in preparation.motions])
        self.whole: list[Run] = on_clocks([whole(motion) for motion in preparation.motions])
        self.split: Split = split(self.runs, self.holdout)
        self.held = [r.name for i, r in enumerate(self.runs) if self.split.role(i) == "holdout"]
        self.full = split(self.whole, self.held)
        self.band = Problem(self.runs, self.split.holdout, scales(self.runs))
        self.raw = Problem(self.whole, self.full.holdout, self.band.scales)

    @property
    def judge(self) -> Judge:
        """The held-out data."""
        search = self.search
        weighed = Problem(search.runs, search.split.holdout, search.problem.scales)
        return Judge(self.band, self.raw, weighed, self.preparation, self.baseline)

    def _weighed_search(self, preparation: Preparation) -> Search:
        """A search in which errors count by the noise of the motion."""
        runs = [
            replace(run, corner=preparation.corner)
            for run in on_clocks([thin(motion) for motion in preparation.motions])
        ]
        return Search(runs, split(runs, self.held), self.baseline, self.progress)

    def run(self) -> Diagnosis:
        """The whole procedure."""
        final = self._plainest_law(self._searched())
        before = self.search.baseline_fit()
        final, standings = self._settle(final)
        self.progress("measuring the gain of each effect")
        chain = chain_of(self.search, self.judge, final.model)
        while weak := weakest(chain, self.judge, final.model):
            self.progress(f"{weak} is not confirmed on held-out data: dropped")
            rest = [name for name, _ in effects_of(final.model, self.baseline) if name != weak]
            fit = self.search.problem.fit(submodel(final.model, rest, self.baseline))
            final = self.search.score("", None, fit)
            chain = chain_of(self.search, self.judge, final.model)
        # where nothing stands the baseline is left, fitted as it was
        fit = self._with_tone(final.fit if chain else before, chain, standings)
        if "backlash" in fit.model.free:
            self.progress("free play: how far other data would lead")
            spread = jackknife(self.search.problem, self.full.folds, fit.model)
            fit = replace(fit, covariance=fit.covariance + spread)
        findings = self._findings(fit, chain, standings)
        return self._diagnosis(before, fit, findings)

    def _searched(self) -> Scored:
        """What the search ends with.

        Where the model found predicts the force better in a wider band, the search goes on there.
        """
        final = self.search.run(until="backlash")
        for _ in range(MORE_BANDS):
            wider = self._wider(self.weighed, final.model)
            if "backlash" in final.model.free or wider is None:
                break
            self.weighed, self.search = wider, self._weighed_search(wider)
            final = self.search.run(final.model, until="backlash")
        if calmer := self._calmer(final.model):
            final = self.search.run(calmer, until="backlash")
        if "backlash" in final.model.free:
            self.progress("free play: fitting it to the force as measured")
        elif raw := self._wider(self.preparation, final.model):
            self._take(raw)
        if play := self._play(final.model):
            return self._with_play(play)
        before = self.search.baseline_fit().model
        held_out, sizes = self.full.holdout, self.band.scales
        if narrow := narrower_band(
            self.records, self.preparation, held_out, before, final.model, sizes
        ):
            self._take(narrow)
        return final

    def _play(self, model: Model) -> Model | None:
        """The model with free play fitted to the force as measured, if it has one or needs one."""
        starts: list[Model] = []
        if not has_series(self.baseline):
            rigid = submodel(
                model, [n for n, _ in effects_of(model, self.baseline) if n not in SERIES],
                self.baseline,
            )  # fmt: skip
            starts = [rigid] if rigid.free == self.baseline.free else [rigid, self.baseline]
        return play_of(self._followed(), model, starts, self.judge.noise_floor(model))

    def _with_play(self, play: Model) -> Scored:
        """The search from a model with free play on, with the force as measured."""
        for _ in range(MORE_BANDS):
            far = forgiving(self._followed(), play).runs[0].far
            learnt, sizes = self.full.fit, self.band.scales
            band = best_band(self.records, self.preparation, learnt, play, sizes, far)
            if band is self.preparation:
                break
            self._take(band)
            play = fit_play(self._followed(), play)
        self.whole = [from_contact(run) for run in self.whole]
        self.raw = forgiving(Problem(self.whole, self.full.holdout, self.band.scales), play)
        learnt = forgiving(self._learnt(), play)
        self.search = Search(learnt.runs, self.full, self.baseline, self.progress)
        return self.search.run(play)

    def _followed(self) -> Problem:
        """The fit data at the measured rate, each run followed from a contact on."""
        learnt = self._learnt()
        return Problem([from_contact(run) for run in learnt.runs], learnt.masks, learnt.scales)

    def _wider(self, preparation: Preparation, model: Model) -> Preparation | None:
        return wider_band(self.records, preparation, self.full.fit, model, self.band.scales)

    def _calmer(self, model: Model) -> Model | None:
        """A plainer friction law that predicts the fit data better in the band of the plain fits.

        In a wider band the noise of a slow motion turns its velocity about, and a law with memory
        serves as a filter of it. The search is taken back to the narrower band where there is one.
        """
        laws = [] if model.friction == self.baseline.friction else simpler_laws(model)
        if not laws or self.weighed.cutoff <= self.plain.cutoff:
            return None
        narrow = replace(self.plain, corner=self.weighed.corner)
        search = self._weighed_search(narrow)
        masks = search.split.fit
        best = min(map(search.problem.fit, laws), key=lambda fit: fit.rmse(masks))
        if best.rmse(masks) > (1 - WORTH_A_BAND) * search.problem.fit(model).rmse(masks):
            return None
        self.weighed, self.search = narrow, search
        return best.model

    def _learnt(self) -> Problem:
        """The fit data at the measured rate with the force as measured."""
        return Problem(self.whole, self.full.fit, self.band.scales)

    def _with_tone(self, fit: Fit, chain: list[Link], standings: dict[str, Standing]) -> Fit:
        """The fit with its tone as the raw force has it.

        One that the low-pass of the fits hides is added to chain and standings.
        """
        learnt = self._learnt()
        fit = with_tone_from_raw(learnt, fit)
        after = with_tone_above(learnt, fit, TONES_FROM * self.preparation.cutoff)
        if after is None:
            return fit
        link, confidence = tone_link(self.judge, fit, after)
        if not link.stands:
            return fit
        chain.append(link)
        standings[link.effect] = Standing(confidence, [], None)
        return after

    def _plainest_law(self, final: Scored) -> Scored:
        """The simplest friction law from which the one found does not differ visibly."""
        if final.model.friction == self.baseline.friction:
            return final
        for model in simpler_laws(final.model):
            fit = self.search.problem.fit(model)
            apart = self.judge.difference(fit.model, final.model)
            if not self.judge.visible(apart, 0.0, final.model):
                return self.search.score("", None, fit)
        return final

    def _settle(
        self, final: Scored, exchanges: int = EXCHANGES
    ) -> tuple[Scored, dict[str, Standing]]:
        """Compare every effect with its rivals; where they are equal, name the usual one."""
        standings: dict[str, Standing] = {}
        for effect, _ in effects_of(final.model, self.baseline):
            standings[effect] = standing(self.search, final, effect)
            better = standings[effect].better
            if exchanges and better is not None:
                return self._settle(better, exchanges - 1)
        return final, standings

    def _findings(
        self,
        final: Fit,
        chain: list[Link],
        standings: dict[str, Standing],
    ) -> list[Finding]:
        values = self._values(final)
        findings = []
        for link in chain:
            known = standings.get(link.effect)
            named = {n: values[n] for n in EFFECTS[link.effect].parameters if n in values}
            finding = Finding(
                link.effect,
                link.law,
                known.confidence if known else 0.5,
                named,
                link.rmse_before,
                link.rmse_after,
                "",
                [r for r in known.rivals if r.confidence >= 0.005] if known else [],
                link.seen_in_blocks,
                link.interval,
            )
            findings.append(replace(finding, evidence=wording.evidence(finding)))
        return sorted(findings, key=lambda finding: -finding.gain)

    def _values(self, fit: Fit) -> dict[str, ParameterValue]:
        return parameter_values(fit, self.device, self.baseline.values.get("delay", 0.0))

    def _accuracy(self, model: Model) -> Accuracy:
        rmse, spread = self.judge.rmse(model), float(np.std(self.judge.force))
        channels = channel_values(model.values)
        return Accuracy(model.stated(), rmse, rmse / (spread or 1.0), channels)

    def _diagnosis(self, before: Fit, final: Fit, findings: list[Finding]) -> Diagnosis:
        baseline, extended = self._accuracy(before.model), self._accuracy(final.model)
        floor = self.judge.noise_left(final.model)
        remains = unexplained(
            self.runs,
            self.split,
            self.band.residual(final.model),
            floor,
            extended.rmse,
            self.whole,
            self.raw.errors(final.model),
        )
        findings = [doubted(finding, remains.structure) for finding in findings]
        self.progress("simulating the extended device in MuJoCo")
        engines = simulate_engines(final.model, self.whole, self.raw.masks)
        names = [r.name for r in self.records]
        summaries = [
            RecordSummary(
                record.name,
                record.samples,
                record.sample_rate,
                "unused" if repeats_another(record) else self.split.role(names.index(record.name)),
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
            self._values(final),
            self._method(),
            self._curves(before.model, final.model),
            gain_interval=gain_interval(
                *(self.judge.error_squares(fit.model) for fit in (before, final))
            ),
        )
        return replace(diagnosis, verdict=wording.verdict(diagnosis))

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

    def _predicted(self, model: Model, i: int) -> Array:
        run = self.whole[i]
        return run.force - settled(model, run, run.force - force_along(model, run), run.inner)

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
                    self._predicted(before, i),
                    self._predicted(after, i),
                    self.full.holdout[i],
                    run.inner,
                )
            )
        return curves
