"""The sentences of a diagnosis: evidence for a finding, and the verdict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from inerter.catalogue.along_stroke import FORMS, node_of
from inerter.catalogue.coordinates import NUISANCES, PARAMETER_WORDS
from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.friction import FRICTION
from inerter.diagnose.cannot_tell import (
    FEW,
    FEW_IN_WORDS,
    IN_WORDS,
    ONE_WAY_IN_WORDS,
    RUN_UP_IN_WORDS,
    SWEEP,
    SWEEP_IN_WORDS,
)
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.doubt import by_weight, descriptions, note, stand_ins, warning
from inerter.diagnose.guesses import what_it_could_be
from inerter.diagnose.result import (
    Diagnosis,
    Finding,
    ParameterValue,
    RecordSummary,
    Rival,
    StatedValue,
)
from inerter.identify.channel_filter import USUAL_ORDER
from inerter.measured_text import measured
from inerter.motion_units import Kind, force_word, words
from inerter.printable import in_digits

# members of a finding that its name lists
_LISTED = 2


def quantity(value: ParameterValue) -> str:
    """Such as "113.0 ± 0.2 kg": three digits at least, and as many as the standard error tells."""
    unit = "" if value.unit == "1" else f" {value.unit}"
    return measured(value.value, value.stderr, least=3) + unit


def value_in_words(name: str, value: ParameterValue) -> str:
    """Such as "b = 92.3 ± 0.02 kg (stated 100, -7.7 kg, -7.7 %)"."""
    off = departure(value)
    return f"{name} = {quantity(value)}" + (f" ({off})" if off else "")


def departure(value: ParameterValue) -> str:
    """What is stated and how far off it is, in its unit and per cent; empty where nothing is."""
    if not isinstance(value, StatedValue) or value.stated is None or value.difference is None:
        return ""
    unit = "" if value.unit == "1" else f" {value.unit}"
    text = f"stated {value.stated:.4g}, {value.difference:+.3g}{unit}"
    if not value.stated:
        return text
    percent = 100 * value.difference / value.stated
    return f"{text}, {percent:{'+.0f' if abs(percent) >= 10 else '+.2g'}} %"


def _contradicts(value: ParameterValue) -> bool:
    """Whether a value is another than stated, by more than its error leaves open."""
    off = value.difference if isinstance(value, StatedValue) else None
    return off is not None and abs(off) > CRITERIA.contradiction * value.stderr


def effect_in_words(finding: Finding) -> str:
    """Such as "friction with memory (Dahl)", "viscous friction other than stated"."""
    law = _law(finding.law)
    other = finding.effect != "inertance_error" and _is_stated(finding)
    if _is_level_at_least(finding):
        # what more it may be is said beside its value
        return EFFECTS[finding.effect].plain
    if _is_level_and_more(finding):
        return "Coulomb friction, larger one way or beside a constant force"
    if len(finding.members) > _LISTED:
        # which they are is said beside their values
        first, others = finding.members[0], len(finding.members) - 1
        return f"{EFFECTS[first].plain} or one of {others} others that do the same here"
    if finding.members:
        between = ", with or without " if _is_filter_at_least(finding) else " or "
        return between.join(EFFECTS[member].plain for member in finding.members)
    return EFFECTS[finding.effect].plain + law + (" other than stated" if other else "")


def _is_filter_at_least(finding: Finding) -> bool:
    """Whether a low-pass is there in any case, and beside another one perhaps a delay."""
    return finding.effect == "sensor_filter" and finding.members[1:] == ("sensor_delay",)


def _is_level_at_least(finding: Finding) -> bool:
    """Whether a friction level is there in any case, which perhaps goes with the speed."""
    return finding.members[1:] == ("rate_state_friction",)


def _is_level_and_more(finding: Finding) -> bool:
    """Whether a friction level is there in any case, with something that differs one way."""
    pair = ("asymmetric_friction", "force_offset")
    return finding.members[:2] == pair and "coulomb_force" in finding.parameters


def _is_stated(finding: Finding) -> bool:
    """Whether the user states all that a finding says."""
    values = finding.parameters.values()
    return bool(values) and all(isinstance(v, StatedValue) and v.stated for v in values)


def is_missing(finding: Finding) -> bool:
    """Whether the data show nothing of what is stated: no value that they leave can be told."""
    values = [v for v in finding.parameters.values() if isinstance(v, StatedValue)]
    unknown = [v for v in values if v.stated and v.stderr > max(abs(v.value), abs(v.stated))]
    return bool(unknown) and not any(_contradicts(v) for v in values)


def rival_in_words(rival: Rival) -> str:
    """Another effect that the data may mean, with its law."""
    return EFFECTS[rival.effect].plain + _law(rival.law)


def _law(name: str | None) -> str:
    """A friction law in brackets, or of which channel and kind a filter is, where it is one."""
    if name and " order " in name:
        return f" ({name})"
    if name and name in FORMS:
        return f" ({FORMS[name]})"
    return f" ({FRICTION[name].words})" if name and name in FRICTION else ""


def _told_apart(effect: str, rival: Rival) -> str:
    """The experiment that tells two effects apart, in brackets, where one is known."""
    for one, other in ((effect, rival.effect), (rival.effect, effect)):
        if other in EFFECTS[one].rivals:
            return f" ({EFFECTS[one].experiment})"
    return ""


def amount_in_words(effect: str, value: float, motion: Kind) -> str:
    """Such as "a delay of 3.8 ms", of an effect that one number describes."""
    if effect == "sensor_delay":
        return f"a delay of {1e3 * value:.3g} ms"
    if effect == "hardening_stiffness":
        return f"a stiffness of {value:.3g} {words(motion, 'N/m^3')} x^3"
    if effect == "variable_inertance":
        return f"an inertance that changes with the place, as 1 {value:+.3g} x^2"
    if effect == "inertance_error":
        return f"an inertance of {value:.4g} {words(motion, 'kg')}"
    if effect == "sensor_filter":
        return f"a low-pass of one channel, such as one of order {USUAL_ORDER} at {value:.3g} Hz"
    if effect == "asymmetric_friction":
        return f"friction that is {100 * abs(value):.3g} % larger one way, and smaller the other"
    if effect == "viscoelasticity":
        return f"{EFFECTS[effect].plain}, of {value:.3g} {words(motion, 'N/m')} or more"
    if effect == "sensor_coupling":
        return f"{EFFECTS[effect].plain}, with a corner of {value:.3g} Hz"
    unit = {"parallel_stiffness": "N/m", "force_offset": "N"}.get(effect, "N s/m")
    return f"{EFFECTS[effect].plain} of {value:.3g} {words(motion, unit)}"


def curves_in_words(
    parameters: Mapping[str, ParameterValue],
) -> tuple[dict[str, str], dict[str, ParameterValue]]:
    """Curves along the stroke in words, by name, and the parameters that are no nodes of one."""
    nodes: dict[str, list[ParameterValue]] = {}
    others = {}
    for name, value in parameters.items():
        if quantity := node_of(name):
            back = "_back" if name in quantity.back_nodes else ""
            nodes.setdefault(f"{quantity.name}{back}_curve", []).append(value)
        else:
            others[name] = value
    curves = {}
    for name, values in nodes.items():
        least, most = (each([v.value for v in values]) for each in (min, max))
        unit = "" if values[0].unit == "1" else f" {values[0].unit}"
        error = max(v.stderr for v in values)
        curves[name] = in_digits(
            f"a curve through {len(values)} places from {least:.3g} to {most:.3g}{unit} "
            f"(each ± {error:.1g}{unit} at most)"
        )
    return curves, others


def either_in_words(finding: Finding) -> str:
    """Such as "viscous friction of 120 N s/m or a delay of 3.8 ms": what members would be."""
    one = {
        "variable_inertance": "inertance_curvature",
        "asymmetric_friction": "friction_asymmetry",
    }
    if _is_filter_at_least(finding):
        found = next(n for n in finding.parameters if n.endswith("_filter"))
        delay = amount_in_words("sensor_delay", finding.parameters["delay"].value, finding.motion)
        return (
            f"a low-pass of {finding.parameters[found].value:.3g} Hz ({finding.law}), or one of "
            f"another order with {delay} beside it"
        )
    if finding.effect == "sensor_filter" and "leak" in finding.members:
        cutoff, leak = (finding.parameters[n].value for n in ("force_filter", "leak_damping"))
        late = ", with a delay beside it or without," if "delay" in finding.parameters else ""
        return (
            f"a low-pass of {cutoff:.3g} Hz ({finding.law}){late} or "
            f"{amount_in_words('leak', leak, finding.motion)}, perhaps behind a spring"
        )
    if _is_level_at_least(finding):
        level = value_in_words(EFFECTS[finding.effect].plain, finding.parameters["coulomb_force"])
        return f"{level}, which may go with the speed (rate-and-state friction)"
    if finding.members[:2] == ("variable_inertance", "position_force"):
        others = " or ".join(EFFECTS[each].plain for each in finding.members[2:])
        return (
            f"{EFFECTS[finding.effect].plain}, or a force of the place that is the same along this "
            f"stroke, such as {others}"
        )
    beside = ""
    if _is_level_and_more(finding):
        level = value_in_words("Coulomb friction", finding.parameters["coulomb_force"])
        beside = f"{level}, and beside it "
    coordinates = {each: one.get(each, EFFECTS[each].parameters[0]) for each in finding.members}
    if "displacement_filter" in finding.parameters:
        coordinates["sensor_filter"] = "displacement_filter"
    if finding.members == ("leak", "sensor_filter"):
        leak, cutoff = (finding.parameters[n] for n in ("leak_damping", "force_filter"))
        return (
            f"{amount_in_words('leak', leak.value, finding.motion)} or a low-pass of the force, "
            f"such as one of order 1 at {cutoff.value:.3g} Hz"
        )
    return beside + " or ".join(
        amount_in_words(member, finding.parameters[name].value, finding.motion)
        for member, name in coordinates.items()
    )


def _teller(finding: Finding) -> str:
    """What would tell the members of a finding apart."""
    if "force_offset" in finding.members:
        return "the device turned round"
    if _is_level_at_least(finding):
        return "steady strokes at speeds a hundred times apart"
    if "leak" in finding.members:
        return "another record"
    if "sensor_coupling" in finding.members:
        return "a known constant force"
    late = finding.members == ("sensor_delay", "sensor_filter")
    if late or _is_filter_at_least(finding):
        return "quicker motion, up to the filter's cut-off,"
    return "a second frequency"


def evidence(finding: Finding) -> str:
    """One sentence: values, and what the effect does to the error on held-out data."""
    curves, others = curves_in_words(finding.parameters)
    values = ", ".join(
        [
            *(value_in_words(PARAMETER_WORDS.get(n, n), v) for n, v in others.items()),
            *curves.values(),
        ]
    )
    if finding.members:
        values = f"{either_in_words(finding)}; this motion cannot tell, {_teller(finding)} would"
    elif is_missing(finding):
        values = f"{EFFECTS[finding.effect].plain} as stated is not in these data"
    where = (
        "blocks left out of the fit (what is held out does not reach it)"
        if finding.seen_in_blocks
        else "held-out data"
    )
    newton = words(finding.motion, "N")
    rises = finding.rmse_after > finding.rmse_before
    text = (
        f"{values}: the rms {force_word(finding.motion)} error on {where} "
        f"{'rises' if rises else 'falls'} from "
        f"{finding.rmse_before:.3g} {newton} to {finding.rmse_after:.3g} {newton} "
        f"({100 * finding.gain:.0f} %)"
    )
    if rises:
        # it was chosen by errors as they count
        text += (
            ", for an impact that is predicted too early or too late errs by all of its force; "
            "without what is so far off the error falls"
            if finding.effect == "backlash"
            else ", and falls as errors count against the noise of the motion"
        )
    likely = [r for r in finding.other_rivals if r.confidence >= CRITERIA.rival_told]
    if likely:
        names = dict.fromkeys(
            "another form of it"
            if (rival.effect, rival.law) == (finding.effect, None)
            else rival_in_words(rival)
            for rival in likely
        )
        others = " or ".join([*names][:2])
        text += f"; {others} would explain these data nearly as well"
    return in_digits(f"{text}{what_it_could_be(finding)}.")


def is_right(diagnosis: Diagnosis) -> bool:
    """Whether nothing speaks against the simulation, noise apart; no run that it misses either."""
    # the floor of a table is its own scatter, which says nothing for the model
    noise = 0.0 if diagnosis.points else 2 * diagnosis.noise_floor
    missed = diagnosis.unexplained.significant or diagnosis.method.get("missed_runs")
    return not missed and (
        diagnosis.baseline.nrmse < CRITERIA.right or diagnosis.baseline.rmse < noise
    )


def verdict(diagnosis: Diagnosis) -> str:
    """One paragraph in plain words."""
    tone = IN_WORDS if diagnosis.method.get("one_tone") else ""
    tone += ONE_WAY_IN_WORDS if diagnosis.method.get("one_way") else ""
    tone += RUN_UP_IN_WORDS if diagnosis.method.get("runs_up") else ""
    tone += FEW_IN_WORDS if FEW in diagnosis.cannot_tell else ""
    drifts = any(finding.effect in SWEEP.effects for finding in diagnosis.findings)
    tone += SWEEP_IN_WORDS if drifts and SWEEP in diagnosis.cannot_tell else ""
    notes = "".join(f" {note}" for note in diagnosis.notes)
    budget = f" {diagnosis.budget.sentence}" if diagnosis.budget else ""
    said = tone + _verdict(diagnosis) + budget + notes
    return doubts_of_records(diagnosis.records) + in_digits(said)


# warnings that turn a verdict into nonsense: what they say comes first
_GRAVE = ("sign_flip", "unit_suspect", "contradicts_others")


def doubts_of_records(records: Sequence[RecordSummary]) -> str:
    """What has to be looked at before anything else; empty where there is nothing."""
    # the first of each record, whose others follow from it
    doubts = [
        f"{record.name}: {texts[0]}"
        for record in records
        if (texts := [each["text"] for each in record.warnings if each["code"] in _GRAVE])
    ]
    more = f" (and {len(doubts) - 1} more like it)" if len(doubts) > 1 else ""
    end = "" if doubts and doubts[0].endswith("?") and not more else "."
    return f"Look at the records first: {doubts[0]}{more}{end} " if doubts else ""


def _less(before: float, after: float) -> str:
    """What is gained, where it is more than nothing."""
    percent = 100 * (1 - after / before)
    return f", {percent:.0f} % less" if percent >= 0.5 else ""


def seems(finding: Finding) -> str:
    """What stands before the name of the main cause."""
    if finding.looks_like:
        return "looks like"
    return "is perhaps" if is_doubtful(finding) else "is"


def how_surely(finding: Finding) -> str:
    """What stands before the name of a finding in a sentence on what is lacking."""
    if is_doubtful(finding):
        return "perhaps "
    return "what looks like " if finding.looks_like else ""


def is_doubtful(finding: Finding) -> bool:
    """Whether a finding is more likely not there than there."""
    # what its members share is sure, and each of two has half of the confidence
    return finding.confidence < (0.25 if finding.members else 0.5)


def _share(error: float) -> str:
    """An error per standard deviation of the force in words: no per cent where it is more."""
    if error < 1.0:
        return f"{100 * error:.1f} % of its variation"
    return "all of its variation" if error < 1.5 else f"{error:.2g} times its variation"


def _verdict(diagnosis: Diagnosis) -> str:
    before, after = diagnosis.baseline, diagnosis.extended
    force, newton = force_word(diagnosis.motion), words(diagnosis.motion, "N")
    if not diagnosis.findings and not is_right(diagnosis):
        warnings = [
            f"{record.name}: {warning['text']}".rstrip(".?!")
            for record in diagnosis.records
            for warning in record.warnings
            if warning["code"] not in _GRAVE
        ]
        hint = " Mind the warnings: " + "; ".join(warnings) + "." if warnings else ""
        return (
            f"The simulation misses the {force} by {before.rmse:.3g} {newton} rms "
            f"({_share(before.nrmse)}) on held-out data, and no effect tried "
            f"explains that. {diagnosis.unexplained.summary}{hint}"
        )
    if not diagnosis.findings:
        return (
            f"The simulation is right as far as these data can tell: it misses the {force} by "
            f"{before.rmse:.3g} {newton} rms ({_share(before.nrmse)}) on "
            f"held-out data, and no effect tried improves that. {diagnosis.unexplained.summary}"
        )
    first, *rest = by_weight(diagnosis.findings)
    others = [how_surely(each) + effect_in_words(each) for each in rest]
    text = (
        f"The simulation misses the measured {force} by {before.rmse:.3g} {newton} rms "
        f"({_share(before.nrmse)}) on held-out data. The main cause "
        f"{seems(first)} {effect_in_words(first)}"
    )
    if others:
        text += "; it also lacks " + ", ".join(others[:-1])
        text += (" and " if others[:-1] else "") + others[-1]
    text += (
        f". With {'these' if others else 'this'} the error is {after.rmse:.3g} {newton} rms"
        f"{_less(before.rmse, after.rmse)}. {diagnosis.unexplained.summary}"
    )
    unseen = [effect_in_words(finding) for finding in diagnosis.findings if finding.seen_in_blocks]
    if unseen:
        text += (
            f" What is held out does not reach {' and '.join(unseen)}, which shows in the other "
            "data alone: see its evidence."
        )
    doubtful = stand_ins(diagnosis.findings, diagnosis.unexplained.structure)
    text += warning([effect_in_words(finding) for finding in doubtful])
    described = descriptions(diagnosis.findings, diagnosis.unexplained.structure)
    text += note([effect_in_words(finding) for finding in described])
    contradicted = [
        value_in_words(PARAMETER_WORDS.get(name, name), value)
        for name, value in diagnosis.parameters.items()
        if name not in NUISANCES and _contradicts(value)
    ]
    contradicted += [
        f"{EFFECTS[finding.effect].plain}, of which they show nothing"
        for finding in diagnosis.findings
        if is_missing(finding)
    ]
    laws = [str(each.device.get("friction", "none")) for each in (before, after)]
    if laws[0] not in ("none", laws[1]):
        contradicted.append(f"friction = {laws[0]} (found: {laws[1]})")
    if contradicted:
        text += f" The data contradict what is stated: {'; '.join(contradicted)}."
    doubts = [
        f"{effect_in_words(finding)} can hardly be told from "
        f"{rival_in_words(finding.rivals[0])}" + _told_apart(finding.effect, finding.rivals[0])
        for finding in diagnosis.findings
        if finding.rivals
        and finding.rivals[0].confidence >= CRITERIA.rival_told
        and finding.rivals[0].effect not in (finding.effect, *finding.members)
    ]
    for finding in diagnosis.findings:
        if finding.members and not _is_level_at_least(finding):
            asked = {"leak": "sensor_filter", "sensor_coupling": "sensor_coupling"}
            told = next((asked[m] for m in finding.members if m in asked), finding.members[0])
            text += (
                f" It is {either_in_words(finding)}: this motion cannot tell; {_teller(finding)} "
                f"would ({EFFECTS[told].experiment})."
            )
    if doubts:
        text += " In these data " + "; ".join(doubts) + "."
    return text
