"""Numbers, units and names as people write them."""

from __future__ import annotations

import math
import re

from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.vehicle import KNOWN
from inerter.core import parameters
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.result import Finding, ParameterValue, Rival
from inerter.diagnose.vehicle.wording import CHANNEL_NOTES, finding_in_words
from inerter.diagnose.wording import effect_in_words, rival_in_words
from inerter.measured_text import NOTHING, decimals_told
from inerter.motion_units import TRANSLATION, Kind
from inerter.motion_units import parameter_unit as unit_in

_SUPERSCRIPT = str.maketrans("-0123456789n", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹ⁿ")
UNKNOWN = "–"
# an eighth of a turn [rad]: a phase is known where its error is less
_KNOWN_PHASE = 0.8
_POWER_OF_TEN = re.compile(r"(?<![\w.])(\d(?:\.\d+)?)e([+-]?\d+)(?!\w)")

# of a friction level that may go with the speed
_OF_THE_SPEED = ("rate_effect", "age_effect")


def number(value: float | None, digits: int = 3) -> str:
    """Such as "68.8", "65 600" or "1.2 × 10⁻⁵"; a dash where there is no finite number."""
    if value is None or not math.isfinite(value):
        return UNKNOWN
    if value == 0:
        return "0"
    # the power of ten after rounding: 999.99 is 1000
    magnitude = int(f"{value:.{digits - 1}e}".partition("e")[2])
    if magnitude < -3 or magnitude > 6:
        return _scientific(value, magnitude, digits - 1)
    return _plain(value, digits - 1 - magnitude)


def count(value: int) -> str:
    """A whole number with spaces between its thousands."""
    return _plain(value, 0)


def percent(share: float | None) -> str:
    """Such as "87 %", kept on one line."""
    if share is None or not math.isfinite(share):
        return UNKNOWN
    return f"{100 * share:.0f}\u00a0%".replace("-", "−")


def between(interval: tuple[float, float] | None) -> str:
    """Such as " (95 % interval 84 to 89 %)"; nothing where there is none."""
    if interval is None:
        return ""
    low, high = (f"{100 * end:.0f}".replace("-", "−") for end in interval)
    return f" (95\u00a0% interval {low} to {high}\u00a0%)"


def confidence(share: float) -> str:
    """A percentage that never claims certainty."""
    if share > 0.995:
        return ">\u00a099\u00a0%"
    return "<\u00a01\u00a0%" if share < 0.005 else percent(share)


def unit(name: str) -> str:
    """A unit in print: "N·s/m", "1/m²"; nothing for a pure number."""
    if name in ("1", ""):
        return ""
    parts = name.replace("*", "·").split("^")
    text = parts[0]
    for part in parts[1:]:
        power = part[: len(part) - len(part.lstrip("-0123456789n"))]
        text += power.translate(_SUPERSCRIPT) + part[len(power) :]
    return text


def size_told(name: str, value: ParameterValue) -> float:
    """What the error of a value counts against: its size, of a phase, which has none, of a turn."""
    return _KNOWN_PHASE if "phase" in name else abs(value.value)


def with_error(value: ParameterValue) -> str:
    """A value to the last digit that its standard error allows, such as "65 600 ± 17 800 N/m"."""
    suffix = f" {unit(value.unit)}" if unit(value.unit) else ""
    error = value.stderr
    if not math.isfinite(value.value):
        return UNKNOWN
    # an error of nothing is an error that the fit could not find
    if not math.isfinite(error) or error <= 1e-9 * abs(value.value):
        return f"{number(value.value)}{suffix} (error not known)"
    top = math.floor(math.log10(max(abs(value.value), error)))
    power = top if top < -3 or top > 6 else 0
    scaled, scaled_error = value.value / 10.0**power, error / 10.0**power
    decimals = decimals_told(scaled, scaled_error, digits=2)
    if value.value and not round(scaled, decimals):
        # so uncertain that no digit of the value counts: not shown as 0, which it may not be
        shown = value.value if abs(value.value) > NOTHING * error else 0.0
        return f"{number(shown, 2)} ± {number(error, 2)}{suffix}"
    pair = f"{_plain(scaled, decimals)} ± {_plain(scaled_error, decimals)}"
    if power:
        return f"({pair}) × 10{str(power).translate(_SUPERSCRIPT)}{suffix}"
    return pair + suffix


def tidy(sentence: str) -> str:
    """A text whose numbers stay on one line with their units, powers of ten written out."""
    units = r"(?<=\d) (?=(?:%|[A-Za-z]{1,3})(?:[^A-Za-z]|$))"
    return _POWER_OF_TEN.sub(_written_out, re.sub(units, "\u00a0", sentence))


def _written_out(found: re.Match[str]) -> str:
    return f"{found[1]} × 10{str(int(found[2])).translate(_SUPERSCRIPT)}"


def effect_name(effect: str) -> str:
    """An effect in words; the contract's name with spaces where there are none yet."""
    return KNOWN[effect].plain if effect in KNOWN else effect.replace("_", " ")


def rival_name(rival: Rival) -> str:
    """Another effect that the data may mean, in words, with its law where it is one of a bench."""
    return rival_in_words(rival) if rival.effect in EFFECTS else effect_name(rival.effect)


def finding_name(finding: Finding) -> str:
    """An effect in words, with its law; everything that it may be, where data cannot tell."""
    if place := _vehicle_channel(finding):
        return f"{finding_in_words(finding)} in {place}"
    if finding.effect in EFFECTS:
        return effect_in_words(finding)
    if finding.members:
        return " or ".join(effect_name(member) for member in finding.members)
    law = f" ({finding.law})" if finding.law else ""
    return effect_name(finding.effect) + law


def _vehicle_channel(finding: Finding) -> str:
    """The channel of a vehicle that a finding is in; "" where it is in none, or on a bench."""
    if finding.members or finding.effect not in CHANNEL_NOTES:
        return ""
    return next((name.rpartition(".")[0] for name in finding.parameters), "")


def effect_notes(finding: Finding) -> dict[str, str]:
    """What an effect adds, its physical cause, what it is taken for and how to tell."""
    if _vehicle_channel(finding):
        return dict(CHANNEL_NOTES[finding.effect])
    known = KNOWN.get(finding.effect)
    if known is None:
        return {}
    return {
        "meaning": known.meaning,
        "cause": known.cause,
        "rival": known.taken_for,
        "experiment": known.experiment,
    }


def parameter_meaning(name: str) -> str:
    """The core's one-line meaning of a parameter."""
    if name == "delay":
        return "lateness of the force channel"
    if name in ("force_filter", "displacement_filter"):
        return f"cut-off of the {name.split('_')[0]} channel's low-pass, -3 dB"
    if name == "force_coupling":
        return "corner of the force channel's high-pass, -3 dB"
    if name == "settling_time":
        return "time in which the zero settles to 37 %"
    known = parameters().get(name)
    return known.meaning if known else ""


def parameter_unit(name: str, motion: Kind = TRANSLATION) -> str:
    """The core's unit of a parameter, in rotation where the device turns."""
    if name == "delay":
        return "s"
    known = parameters().get(name)
    return unit_in(motion, name, known.unit) if known else ""


def listed(items: list[str]) -> str:
    """Such as "a, b and c"."""
    return " and ".join(filter(None, [", ".join(items[:-1]), items[-1] if items else ""]))


def _plain(value: float, decimals: int) -> str:
    # thin spaces between thousands, a true minus sign
    text = f"{round(value, decimals):,.{max(decimals, 0)}f}"
    whole = text.split(".")[0].replace("-", "").replace(",", "")
    text = text.replace(",", "\u202f" if len(whole) > 4 else "")
    return text.replace("-", "−")


def _scientific(value: float, power: int, decimals: int) -> str:
    mantissa = _plain(value / 10.0**power, decimals)
    return f"{mantissa} × 10{str(power).translate(_SUPERSCRIPT)}"


def _may_be_none(value: ParameterValue) -> bool:
    return abs(value.value) < CRITERIA.distinction * value.stderr


def told_values(finding: Finding) -> dict[str, ParameterValue]:
    """Parameters of a finding that are told in a table.

    By how much a friction level may go with the speed is said in words, where it may not at all.
    """
    may_change = finding.members[1:] == ("rate_state_friction",)
    return {
        name: value
        for name, value in finding.parameters.items()
        if not (may_change and name in _OF_THE_SPEED and _may_be_none(value))
    }
