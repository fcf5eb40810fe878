"""The sentences of a diagnosis of a user's model."""

from __future__ import annotations

from inerter.catalogue.vehicle import KNOWN
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.doubt import descriptions, explained, note, stand_ins, warning
from inerter.diagnose.result import Finding, Unexplained
from inerter.diagnose.vehicle.outcome import SystemAccuracy
from inerter.diagnose.wording import how_surely, seems, value_in_words

# the same force between the same bodies: no record of the vehicle can tell these apart
EQUIVALENT = {"spring_hardening": "hardening_stiffness"}

_OF_CHANNELS = {
    "sensor_delay": "a delay",
    "sensor_filter": "a low-pass filter",
    "sensor_gain_error": "a wrong scale",
}
"""Words that on a bench are those of its force and displacement."""
CHANNEL_NOTES = {
    "sensor_delay": {
        "meaning": "a channel is late of all others by a constant time, early where it is "
        "negative; every channel: of what drives",
        "cause": "loggers with a clock each, a filter; a road or a GPS of another clock",
        "rival": "a low-pass filter, a sensor that swings on its bracket",
        "experiment": "a blow that both loggers see",
    },
    "sensor_filter": {
        "meaning": "what is fast is smaller in a channel, and late: a low-pass of second order",
        "cause": "the amplifier or the logger",
        "rival": "a delay",
        "experiment": "record once without the filter",
    },
}
"""What a report says of effects whose words on a bench are those of its two channels."""
_NOTES = {
    "force_offset": "; a sensor whose zero is displaced may look the same: check it at rest",
    "tyre_damping": "; in model.xml its actuator is driven by the rate of the road [m/s]",
    "tyre_enveloping": "; model.xml has no road: feed it the mean over this length",
    "sensor_compliance": "; what a sensor shows is in no model: correct the record or the bracket",
    "sensor_gain_error": "; what a channel shows is in no model: correct the record",
    "mounting_angle": "; what a sensor shows is in no model: turn it, or correct the record",
    "sensor_filter": "; what a sensor shows is in no model: state the filter, or record without it",
}
"""What follows for who uses the extended model."""


def in_words(effect: str, law: str | None = None) -> str:
    """An effect in running text."""
    plain = KNOWN[effect].plain if effect in KNOWN else effect.replace("_", " ")
    text = _OF_CHANNELS.get(effect, plain)
    return f"{text} ({law})" if law else text


def finding_in_words(finding: Finding) -> str:
    """What was found, or everything that it may be."""
    if finding.members:
        return " or ".join(in_words(member) for member in finding.members)
    return in_words(finding.effect, finding.law)


def evidence(finding: Finding, place: str) -> str:
    """One sentence: values, stated ones beside them, and what the effect does to the error."""
    values = ", ".join(
        value_in_words(name.replace("_", " "), value) for name, value in finding.parameters.items()
    )
    where = f" in {place}" if place else ""
    unseen = "data left out of the fit (what is held out does not reach it)"
    text = (
        f"{values}{where}: the error on {unseen if finding.seen_in_blocks else 'held-out data'} "
        "falls from "
        f"{100 * finding.rmse_before:.3g} % of the channels' spread to "
        f"{100 * finding.rmse_after:.3g} %"
    )
    twin = EQUIVALENT.get(finding.effect)
    if twin:
        text += (
            f"; {in_words(twin)} would be the same force between the same bodies, which these "
            "records cannot tell apart: test the device alone"
        )
    text += _NOTES.get(finding.effect, "")
    likely = [r for r in finding.rivals if r.confidence >= CRITERIA.rival_told and r.effect != twin]
    if likely:
        others = " or ".join(in_words(r.effect, r.law) for r in likely[:2])
        text += f"; {others} would explain these data nearly as well"
    return text + "."


def verdict(
    before: SystemAccuracy,
    after: SystemAccuracy,
    findings: list[Finding],
    places: list[str],
    remains: Unexplained,
    unknown: list[str],
) -> str:
    """One paragraph in plain words.

    places: of each finding, empty where there is no doubt; unknown: what was not tried.
    """
    error = (
        f"{100 * before.rmse:.3g} % of the channels' spread on held-out data ({_channels(before)})"
    )
    if not findings:
        start = "The simulation is right as far as these records can tell"
        if before.rmse > 0.1 or remains.significant:
            start = "No effect that was tried explains what the simulation misses"
        text = f"{start}: its error is {error}. {remains.summary}"
    else:
        weighed = sorted(
            zip(findings, places, strict=True), key=lambda pair: explained(pair[0]), reverse=True
        )
        names = [finding_in_words(f) + (f" in {place}" if place else "") for f, place in weighed]
        surely = [how_surely(f) for f, _ in weighed]
        rest = " and ".join(sure + name for sure, name in zip(surely[1:], names[1:], strict=True))
        others = f"; it also lacks {rest}" if rest else ""
        text = (
            f"The simulation misses the records by {error}. The main cause {seems(weighed[0][0])} "
            f"{names[0]}{others}. "
            f"With {'these' if names[1:] else 'this'} the error is {100 * after.rmse:.3g} %, "
            f"{100 * (1 - after.rmse / before.rmse):.0f} % less. {remains.summary}"
        )
        unseen = [finding_in_words(finding) for finding in findings if finding.seen_in_blocks]
        if unseen:
            text += (
                f" What is held out does not reach {' and '.join(unseen)}, which shows in the "
                "other runs alone: see its evidence."
            )
        doubtful = stand_ins(findings, remains.structure)
        text += warning([in_words(finding.effect, finding.law) for finding in doubtful])
        described = descriptions(findings, remains.structure)
        text += note([in_words(finding.effect, finding.law) for finding in described])
    if unknown:
        text += " Not tried: " + "; ".join(unknown) + "."
    return text


def _channels(accuracy: SystemAccuracy) -> str:
    return ", ".join(
        f"{name.replace('_', ' ')} {error.rmse:.3g} {error.unit}".rstrip()
        for name, error in accuracy.channels.items()
    )
