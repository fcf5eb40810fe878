"""Diagnosis of bench records: displacement in, force out, what does the simulation lack?"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from inerter.catalogue.effects import EFFECTS
from inerter.core import Device
from inerter.diagnose import wording
from inerter.diagnose.budget.carried import Carrying, carried
from inerter.diagnose.budget.remains import with_ceiling
from inerter.diagnose.budget.repeats import repeats
from inerter.diagnose.clock_rate import on_one_clock
from inerter.diagnose.composition import distinction
from inerter.diagnose.creeping import without_creeping
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.doubt import as_sure_as_its_value, doubted, of_one_sine, with_own_value
from inerter.diagnose.engines import simulate_engines
from inerter.diagnose.everything import errors_of, on_everything
from inerter.diagnose.excerpts import Excerpts, excerpts
from inerter.diagnose.exchangeable import exchanges, with_members
from inerter.diagnose.method import method_of, unused_in_words
from inerter.diagnose.other_runs import (
    badly_missed,
    badly_missed_parts,
    badly_missed_stretches,
    missed_in_words,
    other_split,
    split_in_words,
    swapped_in_words,
)
from inerter.diagnose.quantisation import steps_in_words, steps_of
from inerter.diagnose.remainder.further import further_channels
from inerter.diagnose.result import (
    Accuracy,
    Diagnosis,
    Finding,
    ParameterValue,
    RecordSummary,
    RunCurves,
)
from inerter.diagnose.run_constants import constants_in_words, explained
from inerter.diagnose.run_scales import (
    is_met_better,
    odd_scale,
    scales_in_words,
    together,
    turned_round,
    without_scale,
)
from inerter.diagnose.run_values import RunValues, run_values
from inerter.diagnose.shape_of_stop import as_shape_of_stop
from inerter.diagnose.slope_of_gas import with_stiffness_of_gas
from inerter.diagnose.stages import Confirmed, confirmed, searched, settled
from inerter.diagnose.standstill import without_standstill
from inerter.diagnose.start import Given, prepared
from inerter.diagnose.statistics import gain_interval
from inerter.diagnose.time_limit import TimeLimit
from inerter.diagnose.unexplained import unexplained
from inerter.diagnose.values import parameter_values
from inerter.diagnose.where_losses_act import with_side
from inerter.identify.channel import channel_values
from inerter.identify.channel_filter import CHANNELS, Filter, filter_of, named
from inerter.identify.fit import rms
from inerter.identify.model import Model
from inerter.identify.prediction import force_along
from inerter.identify.prediction import settled as without_nuisances
from inerter.motion_units import force_word, one_motion, unit
from inerter.parallel_steps import helped
from inerter.records import Record
from inerter.records.duplicates import repeats_another

Array = NDArray[np.float64]
Progress = Callable[[str], None]


# of what runs away on the way to a fit nothing has to be told
@np.errstate(over="ignore", invalid="ignore")
def diagnose_bench(
    records: Sequence[Record],
    device: Device | None = None,
    holdout: Sequence[str] = (),
    progress: Progress = lambda text: None,
    delay: float = 0.0,
    filters: Mapping[str, Filter] | None = None,
    carry: Carrying = "any",
    time_limit: float = np.inf,
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
    filters : mapping, optional
        Low-passes that the channels "force" and "displacement" are known to have gone through.
    carry : str
        What the extended device may carry without a name, as a force over displacement and
        velocity: "any", "passive" (nothing that would give energy) or "nothing".
    time_limit : float
        Seconds after which nothing more is searched for: what was found is judged and told. The
        step at hand comes to its end, and judging takes its time.

    Raises
    ------
    ValueError
        Runs that cannot be split or do not move, or some that turn beside others that do not; a
        time limit that is not above 0.
    """
    time = TimeLimit(time_limit)
    one_motion(records)
    channel = {"delay": delay}
    for name, known in (filters or {}).items():
        channel |= named(name, known)
    moving, left_out = without_standstill(records)
    moving, scales = turned_round(moving)
    progress("asking whether both channels have one clock")
    moving, clock = on_one_clock(moving)
    given = Given(
        records=moving, scales=scales, clock=clock, left_out=left_out, device=device,
        holdout=holdout, progress=progress, channel=channel, carry=carry, time=time,
    )  # fmt: skip
    # predictions of models that are only tried may run away
    quiet = np.errstate(over="ignore", invalid="ignore")
    with helped(), threadpool_limits(limits=1, user_api="blas"), quiet:
        stands, long = _stood(given)
        if not long:
            given, stands = _with_scale(given, stands)
            given, stands = without_creeping(given, stands, _searched_once)
        other = None if time.is_over() else other_split_of(stands)
        if other and not long and not given.holdout:
            better = _with_other_split(given, stands, *other)
            if better:
                words = swapped_in_words(stands.data, *other)
                return diagnosis_of(better, None, None, words)
        return diagnosis_of(stands, long, other, split_in_words(stands.data, other))


def _with_other_split(given: Given, stands: Confirmed, name: str, effect: str) -> Confirmed | None:
    """What stands with another run held out, where that meets all runs better.

    What is held out must not take away what it alone tells.
    """
    given.progress(f"{EFFECTS[effect].plain} shows in what is held out: holding out {name} instead")
    again = confirmed(settled(searched(prepared(replace(given, holdout=[name])))))
    before, after = (
        rms(each.data.raw.errors(each.fit.model), [run.inner for run in each.data.whole])
        for each in (stands, again)
    )
    return again if after < (1 - CRITERIA.gain) * before else None


def _with_scale(given: Given, stands: Confirmed) -> tuple[Given, Confirmed]:
    """What stands without another scale of a run's force, where one shows; what was given for it.

    What was found beside it may have made up for a part of it: it is looked for twice.
    """
    for _ in range(2):
        final = stands.fit.model
        errors, noise = stands.data.raw.errors(final), stands.judge.noise_left(final)
        odd = odd_scale(stands.data.whole, errors, noise, final.device().inertance)
        if not odd or given.time.is_over():
            break
        given.progress(f"the force of {next(iter(odd))} has another scale: without that")
        records = without_scale(given.records, odd)
        scaled = replace(given, records=records, scales=together(given.scales, odd))
        again = confirmed(settled(searched(prepared(scaled))))
        after = again.data.raw.errors(again.fit.model)
        before, after = (
            rms(each, [run.inner for run in stands.data.whole]) for each in (errors, after)
        )
        if not is_met_better(before, after, given.scales):
            break
        given, stands = scaled, again
    return given, stands


def _searched_once(given: Given) -> Confirmed:
    return confirmed(settled(searched(prepared(given))))


def _stood(given: Given) -> tuple[Confirmed, Excerpts | None]:
    """What stands; of a long record, what was searched for on stretches of it."""
    found = excerpts(given)
    if found is None:
        return _searched_once(given), None
    stands = _on_stretches(found)
    for _ in range(CRITERIA.more_stretches):
        more = found.with_missed(errors_of(stands))
        if more is None or given.time.is_over():
            break
        found, stands = more, _on_stretches(more)
    return stands, found


def other_split_of(stands: Confirmed) -> tuple[str, str] | None:
    """Another run to hold out, and the effect that would be found then besides, if any."""
    data, final = stands.data, stands.fit.model
    errors, noise = data.raw.errors(final), stands.judge.noise_left(final)
    if rms(errors, [run.inner for run in data.whole]) < CRITERIA.near_noise * noise:
        # no run tells of anything more
        return None
    missed = badly_missed(data, errors, noise)
    return other_split(stands.searched.search, data, final, bool(missed))


def _on_stretches(found: Excerpts) -> Confirmed:
    given = found.given
    return on_everything(confirmed(settled(searched(prepared(given)))), found)


def diagnosis_of(
    stands: Confirmed,
    long: Excerpts | None,
    other: tuple[str, str] | None,
    about_split: str,
) -> Diagnosis:
    """What is said of a model that stands: findings, figures, what remains.

    Of a `long` record what takes time for every sample is read off its stretches. `other`: another
    run to hold out and the effect that it would show; `about_split` says so.
    """
    data, judge, final = stands.data, stands.judge, stands.fit.model
    part = stands.searched.data
    motion = data.whole[0].motion
    given = stands.searched.prepared.given
    baseline, extended = _accuracy(stands, stands.before.model), _accuracy(stands, final)
    floor = judge.noise_left(final)
    given.progress("measuring what repeats, and what more could be predicted")
    errors = data.raw.errors(final)
    of_part = part.raw.errors(final) if long else errors
    remains = unexplained(
        part.runs, part.split, part.band.residual(final), floor, extended.rmse, part.whole,
        of_part, judge.motion_noise(final), further_channels(part.records, part.runs),
    )  # fmt: skip
    remains = with_ceiling(
        part, of_part, floor, remains, judge.motion_noise(final), extended.rmse if long else None
    )
    if "backlash" in final.free:
        # where the model is right, too, it meets some blows of a play at another moment
        calm = judge.left_in_calm(final, floor)
        remains = replace(remains, structure=min(remains.structure, calm))
    remains = replace(remains, summary=given.time.tried(remains.summary))
    kept = None
    if given.carry != "nothing":
        passive = given.carry == "passive"
        noise = floor, judge.motion_noise(final)
        kept = carried(data, final, *noise, passive=passive, learnt=part)
    remains = replace(remains, carried=kept.json() if kept else None)
    steps = steps_of(data, judge, final)
    again = repeats(data.whole, errors)
    missed = badly_missed(data, errors, floor)
    if not long and not missed:
        # how a shaft swung as a record began is read off its beginning, held out or not
        settled_all = data.raw.with_masks([run.inner for run in data.whole]).errors(final)
        missed = badly_missed_parts(data, settled_all, floor)
    if long and not missed:
        missed = badly_missed_stretches(long, errors_of(stands), extended.rmse, floor)
    own = RunValues() if long else run_values(data.whole, errors, floor, final)
    searched = stands.searched
    delay = searched.prepared.baseline.values.get("delay", 0.0)
    scales = searched.search.problem.scales
    values = parameter_values(stands.fit, given.device, delay, motion, scales)
    named = [link.effect for link in stands.chain]
    same = exchanges(searched.search, stands.fit, named, searched.covered)

    def weighed(finding: Finding) -> Finding:
        """A finding with its members, as sure as its own value and what remains let it be."""
        errors = distinction(finding.effect, stands.fit, searched.prepared.baseline)
        told = with_members(
            finding, same.get(finding.effect), searched.search, stands.fit, searched.covered
        )
        told = with_own_value(told, finding.confidence, errors > CRITERIA.own_value)
        told = with_side(as_shape_of_stop(told, final), final)
        told = with_stiffness_of_gas(told, stands.fit, motion)
        return doubted(as_sure_as_its_value(told, errors), remains.structure)

    findings = [weighed(finding) for finding in _findings(stands, values)]
    if data.band.scales.one_tone:
        findings = of_one_sine(findings)
    # a member that the model has not is told by its finding alone
    told = {name: v for each in findings for name, v in each.parameters.items()}
    values = values | {name: told[name] for name in values if name in told}
    given.progress("simulating the extended device: MuJoCo, Exudyn, the reference")
    # behind a play an engine takes many steps for a sample
    followed = part if "backlash" in final.free else data
    squares = [judge.error_squares(fit.model) for fit in (stands.before, stands.fit)]
    diagnosis = Diagnosis(
        records=_summaries(stands),
        baseline=baseline,
        findings=findings,
        extended=extended,
        noise_floor=floor,
        unexplained=remains,
        engines=simulate_engines(final, followed.whole, followed.raw.masks),
        verdict="",
        parameters=values,
        method=method_of(stands)
        | {"run_constants": dict(stands.searched.prepared.constants)}
        | {
            "missed_runs": missed,
            "other_split": other,
            "steps": steps,
            "run_scales": dict(given.scales),
            **own.method,
        },
        notes=[
            note
            for note in (
                constants_in_words(stands.searched.prepared.constants, motion),
                missed_in_words(missed, extended.rmse, motion),
                scales_in_words(given.scales, motion),
                own.in_words(motion),
                about_split,
                steps_in_words(steps, motion, extended.rmse),
                given.left_out,
                unused_in_words(stands),
                given.clock.in_words() if given.clock else "",
                long.in_words() if long else "",
                given.time.in_words(sum(not finding.compared for finding in findings)),
            )
            if note
        ],
        curves=_curves(stands),
        motion=motion,
        gain_interval=gain_interval(*squares),
        repeatability=again.rmse if again else None,
    )
    return replace(diagnosis, verdict=wording.verdict(diagnosis))


def _findings(stands: Confirmed, values: dict[str, ParameterValue]) -> list[Finding]:
    findings = []
    for link in stands.chain:
        known = stands.standings.get(link.effect)
        finding = Finding(
            effect=link.effect,
            law=link.law or _filter(link.effect, stands.fit.model),
            confidence=known.confidence if known else 0.5,
            parameters={n: values[n] for n in EFFECTS[link.effect].parameters if n in values},
            rmse_before=link.rmse_before,
            rmse_after=link.rmse_after,
            evidence="",
            rivals=[
                rival
                for rival in (known.rivals if known else ())
                if rival.confidence >= CRITERIA.rival_kept
            ],
            seen_in_blocks=link.seen_in_blocks,
            gain_interval=link.interval,
            compared=known is None or known.compared,
            takes=link.takes,
            motion=stands.data.whole[0].motion,
        )
        findings.append(replace(finding, evidence=wording.evidence(finding)))
    return sorted(findings, key=lambda finding: -finding.gain)


def _filter(effect: str, model: Model) -> str | None:
    """Channel, kind and order of the low-pass that a finding is about; None for another effect."""
    if effect != "sensor_filter":
        return None
    for channel in CHANNELS:
        if f"{channel}_filter" in model.free and (found := filter_of(model.values, channel)):
            return f"{channel}, {found.words}"
    return None


def _accuracy(stands: Confirmed, model: Model) -> Accuracy:
    judge = stands.judge
    rmse, spread = judge.rmse(model), float(np.std(judge.force))
    return Accuracy(model.stated(), rmse, rmse / (spread or 1.0), channel_values(model.values))


def _summaries(stands: Confirmed) -> list[RecordSummary]:
    data = stands.data
    names, contradiction = [record.name for record in data.records], _contradiction(stands)
    return [
        RecordSummary(
            record.name,
            record.samples,
            record.sample_rate,
            "unused" if repeats_another(record) else data.split.role(names.index(record.name)),
            [vars(w) for w in record.warnings] + contradiction.get(record.name, []),
        )
        for record in stands.searched.prepared.given.records
    ]


def _contradiction(stands: Confirmed) -> dict[str, list[dict[str, str]]]:
    """The warning that a run contradicts the others, by its name."""
    said = stands.searched.prepared.contradicting
    if "backlash" in stands.fit.model.free:
        # impacts that are out of step in one run are no other device
        return {}
    runs, errors = stands.data.runs, stands.data.band.errors(stands.fit.model) if said else []
    return {
        name: [{"code": "contradicts_others", "text": text}]
        for name, text in said.items()
        if not explained(runs, errors, name)
    }


def _curves(stands: Confirmed) -> list[RunCurves]:
    data = stands.data

    def predicted(model: Model, i: int) -> Array:
        run = data.whole[i]
        rest = run.force - force_along(model, run)
        return run.force - without_nuisances(model, run, rest, run.inner)

    return [
        RunCurves(
            name=run.name,
            role=data.split.role(i),
            time=run.time,
            displacement=run.displacement,
            velocity=run.velocity,
            acceleration=run.acceleration,
            force=run.force,
            baseline=predicted(stands.before.model, i),
            extended=predicted(stands.fit.model, i),
            holdout=data.full.holdout[i],
            inner=run.inner,
            quantity=force_word(run.motion),
            unit=unit(run.motion, "N"),
            length=unit(run.motion, "m"),
        )
        for i, run in enumerate(data.whole)
    ]
