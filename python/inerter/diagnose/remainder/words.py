"""What was found, in words that an engineer uses."""

from __future__ import annotations

from collections.abc import Sequence

from inerter.diagnose.statistics import taken_away
from inerter.motion_units import TRANSLATION, Kind, force_word, shown_as, words

WORDS = {
    "displacement": "the position along the stroke",
    "velocity": "the velocity",
    "acceleration": "the acceleration",
    "force": "the size of the force itself",
    "displacement and direction": "the position, differently for each direction of motion",
    "displacement (periodic)": "the position, repeating along the stroke",
    "displacement (periodic) and direction": "the position, as friction that repeats along the "
    "stroke",
    "time": "time: something changes during the record",
    "amplitude": "how large the motion is at the time",
    "events": "the time since the last reversal or rest",
    "history": "what went before, more than what is now",
    "state": "position, velocity and acceleration together",
    "frequency": "a frequency of its own",
    "harmonics": "multiples of the motion's frequency",
    "bursts": "certain moments, in bursts",
}

# what is added to a frequency that is none of its own
OF_MOTION = ", which the motion has too"

# times the noise from which on it is said that more remains
MORE = 1.2


def no_noise(raw: float, floor: float) -> str:
    """That what remains [N] holds more than noise, whose estimate [N] may be larger."""
    return "is not noise" if raw > floor else "is not noise alone"


def summary(
    depends: Sequence[str],
    details: dict[str, str],
    shares: dict[str, float],
    raw: float,
    floor: float,
    structure: float,
    excess: bool,
    proposal: str | None,
    usual: float | None = None,
    motion: Kind = TRANSLATION,
    above: tuple[float, float, float] | None = None,
    beyond: tuple[float, float] | None = None,
    predicted: float | None = None,
    too_small: tuple[str, float] | None = None,
) -> str:
    """One paragraph.

    Parameters
    ----------
    depends, details, shares
        Names of what was found; what is known more closely; share of the power of what remains that
        each takes away.
    raw, floor
        Rms of what remains and of the noise [N].
    structure
        Rms of what was found to be no noise [N].
    excess
        Far more remains than noise, but it goes with nothing that was tested.
    proposal
        A formula.
    usual
        What half of the errors are below [N], where few large ones make the rms.
    motion
        What the device does; in rotation read N m for N.
    above
        Frequency [Hz] and rms [N] of a tone in what remains, and the end of the motion's band [Hz],
        above which it lies.
    beyond
        Rms of what remains up to the end of the motion's band [N], and that end [Hz], where most
        lies above it.
    predicted
        Rms of what the other data predict, value for value [N]; all of the structure if not given.
    too_small
        The test that predicts something for sure, though too little to count, and how much [N].
    """
    newton, force = words(motion, "N"), force_word(motion)
    blows = "" if usual is None else f" in blows, half of the time below {usual:.2g} {newton}"
    noise = f"noise of {force} and motion {floor:.3g} {newton}"
    start = f"What remains ({raw:.3g} {newton} rms{blows}; {noise})"
    if excess:
        return (
            f"{start} is far more than noise, but goes with nothing that was tested: position, "
            f"velocity, acceleration, {force}, time, frequency, amplitude, history, reversals."
        )
    if not depends:
        more = "is more than this noise, but " if raw > MORE * floor else ""
        if above:
            frequency, size, end = above
            more = (
                f"is more than this noise: {size:.3g} {newton} rms of it is a tone of "
                f"{frequency:.3g} Hz, above the {end:.3g} Hz up to which the motion is told from "
                "noise, a ringing of the drive for example. Else it "
            )
        elif more and beyond:
            size, end = beyond
            more = (
                f"is more than this noise: most of it lies above the {end:.3g} Hz up to which "
                "the motion is told from noise, where nothing can be told of it. Below, "
                f"{size:.3g} {newton} rms are left, and that "
            )
        return (
            f"{start} {more}shows no dependence on position, velocity, acceleration, time, "
            f"frequency or what went before that is of any size{_small(too_small, motion)}."
        )
    parts = []
    for name in depends:
        detail = f", {details[name]}" if name in details else ""
        word = "one frequency" if detail.endswith(OF_MOTION) else WORDS.get(name, name)
        named = shown_as(motion, word)
        part = f" ({100 * shares[name]:.0f} %)" if name in shares else ""
        # of time the detail is of another channel, with a share of its own
        parts.append(named + part + detail if name == "time" else named + detail + part)
    # of bursts it is known when they come, not what they are
    if predicted is None:
        predicted = 0.0 if list(depends) == ["bursts"] else structure
    told = []
    if predicted > 0:
        left = taken_away(raw, predicted)
        told.append(
            f"{predicted:.3g} {newton} rms can be predicted from the other data, which leaves "
            f"{left:.3g} {newton}"
        )
    if "bursts" in depends:
        come = taken_away(structure, predicted)
        told.append(f"{come:.3g} {newton} rms come and go as the other data tell")
    text = (
        f"{start} {no_noise(raw, floor)}: {'; '.join(told)}. It "
        f"goes with {'; and with '.join(parts)}. No effect that is known here explains it."
    )
    if proposal:
        text += f" A formula that fits, proposed by regression and no cause: {proposal}."
    return text


def _small(too_small: tuple[str, float] | None, motion: Kind) -> str:
    if too_small is None:
        return ""
    name, size = too_small
    return (
        f" ({size:.2g} {words(motion, 'N')} rms of it go with "
        f"{shown_as(motion, WORDS.get(name, name))}, no more than noise of the motion and "
        "smoothing leave)"
    )
