"""What a finding could be in a real device, read off its figures: clauses of its evidence."""

from __future__ import annotations

import math

from inerter.catalogue.along_stroke import PERIODS
from inerter.diagnose.result import Finding
from inerter.diagnose.tone import of_mains
from inerter.motion_units import TRANSLATION, words


def what_it_could_be(finding: Finding) -> str:
    """Clauses that begin with a semicolon each; empty where the figures say nothing more."""
    guesses = (
        _of_the_mains, _of_a_gear, _of_a_weight, _of_what_goes_slack, _of_a_stop_at_rest,
        _of_a_power, _of_a_loop, _of_a_push, _of_a_mass,
    )  # fmt: skip
    return "".join(guess(finding) for guess in guesses)


def _of_a_power(finding: Finding) -> str:
    """What damping that goes with a power of the speed is far beyond its knee."""
    names = ("viscous", "damping_knee", "damping_exponent")
    if not {*names} <= finding.parameters.keys() or "damping_beyond" in finding.parameters:
        return ""
    viscous, knee, power = (finding.parameters[name].value for name in names)
    newton, speed = words(finding.motion, "N"), words(finding.motion, "m/s")
    level = viscous * knee ** (1 - power)
    falls = " (an eddy-current brake has -1)" if power < 0 else ""
    return (
        f"; far beyond the knee it is {level:.3g} {newton} at 1 {speed} and goes with the speed to "
        f"the power of {power:.3g}{falls}"
    )


def _of_a_gear(finding: Finding) -> str:
    """What a length that the ratio repeats with could be."""
    length = finding.parameters.get("inertance_period_1")
    if length is None:
        return ""
    if finding.motion != TRANSLATION:
        turns = 2 * math.pi / length.value
        if abs(turns - round(turns)) > 0.02 * turns or turns < 0.9:
            return ""
        if round(turns) == 1:
            return "; once a turn: a gear that is not centred, a crank"
        what = "a universal joint at an angle, or " if round(turns) == 2 else ""
        return f"; {round(turns)} times a turn: {what}so many teeth or lobes"
    millimetres = 1e3 * length.value
    return (
        f"; {millimetres:.3g} mm is one turn of a gear of {millimetres / (2 * math.pi):.3g} mm "
        "radius or of a screw of that lead, or the pitch of its teeth"
    )


def _of_a_weight(finding: Finding) -> str:
    """What a torque that is told to repeat with every turn could be."""
    told = finding.parameters.keys()
    turns = (
        f"force_amplitude_{i}" in told and f"force_period_{i}" not in told
        for i in range(1, PERIODS + 1)
    )
    if any(turns):
        return "; once a turn: a weight that is out of balance about the axis"
    return ""


def _of_what_goes_slack(finding: Finding) -> str:
    """That a force with a limit at 0 is no end of a channel's range."""
    limits = [finding.parameters.get(name) for name in ("force_minimum", "force_maximum")]
    if any(limit is not None and abs(limit.value) < 3 * limit.stderr for limit in limits):
        return (
            "; a limit at no force is no end of a channel's range: the device goes slack, or a "
            "contact opens"
        )
    return ""


def _of_a_stop_at_rest(finding: Finding) -> str:
    """That a stop where nothing is deflected is a spring that differs between the directions."""
    places = [finding.parameters.get(name) for name in ("stop_lower", "stop_upper")]
    there = [place for place in places if place is not None]
    if len(there) == 1 and abs(there[0].value) < 3 * there[0].stderr:
        return (
            "; a stop at no displacement is a spring that is stiffer one way than the other: a "
            "crack that closes, a joint without preload"
        )
    return ""


def _of_the_mains(finding: Finding) -> str:
    """That a tone is hum, where it lies at a multiple of the frequency of the mains."""
    tone = finding.parameters.get("disturbance_frequency")
    found = of_mains(tone.value) if tone else None
    if found is None:
        return ""
    times, mains = found
    what = "the frequency" if times == 1 else f"{times} times the frequency"
    return f"; this is {what} of the mains ({mains:g} Hz): hum, and no part of the device"


def _of_a_loop(finding: Finding) -> str:
    """Where a Bouc-Wen loop yields, which its parameters tell together and none of them alone."""
    values = {name: each.value for name, each in finding.parameters.items()}
    names = ("bw_stiffness", "bw_beta", "bw_gamma")
    if not {*names} <= values.keys():
        return ""
    stiffness, beta, gamma = (values[name] for name in names)
    exponent, ratio = values.get("bw_exponent", 1.0), values.get("bw_ratio", 0.0)
    if beta + gamma <= 0.0 or not 0.0 <= ratio < 1.0:
        return ""
    distance = (beta + gamma) ** (-1.0 / exponent)
    metre, newton = words(finding.motion, "m"), words(finding.motion, "N")
    return (
        f"; these together say that it yields at {(1.0 - ratio) * stiffness * distance:.3g} "
        f"{newton}, over {distance:.2g} {metre}"
    )


def _of_a_push(finding: Finding) -> str:
    """What a spring that pushes away from its middle could be."""
    stiffness = finding.parameters.get("stiffness")
    if finding.effect != "parallel_stiffness" or finding.members or stiffness is None:
        return ""
    if stiffness.value > -3 * stiffness.stderr:
        return ""
    return (
        "; below zero: it pushes away from its middle, as a spring that snaps through, magnets or "
        "a weight above its pivot do"
    )


def _of_a_mass(finding: Finding) -> str:
    """Whose a mass before a shaft may be."""
    if finding.effect != "grip_mass":
        return ""
    return (
        "; no record tells whose this is: weigh the grip and what else is between load cell and "
        "device. The rest is the device's own (a nut, a coupling), in a model a second inerter "
        "beside it"
    )
