"""Steps of the converter in the channels, and how much of the noise they are.

A channel in steps q has a noise of q / sqrt(12) (rms), taken for white and apart from the rest;
that of the displacement becomes one of the acceleration times the inertance.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from inerter.diagnose.data import Data
from inerter.diagnose.judge import Judge
from inerter.identify.model import Model
from inerter.motion_units import TRANSLATION, Kind, words
from inerter.records.motion import white_noise
from inerter.records.steps import converter_step

Steps = dict[str, dict[str, float]]

TOLD = 0.1
"""Share of the noise's power from which on steps are told."""


def steps_of(data: Data, judge: Judge, model: Model) -> Steps:
    """Of each channel in steps: "step" [m, N], "noise" on the force [N], "share" of the noise.

    The coarsest steps of all runs; the share is that of the power of the noise floor.
    """
    floor, found = judge.noise_left(model), {}
    for name in ("force", "displacement"):
        channels = [getattr(record, name) for record in data.records]
        steps = [step for step in map(converter_step, channels) if step is not None]
        if not steps:
            continue
        step = max(steps)
        noise = step / np.sqrt(12)
        if name == "displacement":
            white = np.sqrt(np.mean([white_noise(channel) ** 2 for channel in channels]))
            # of the acceleration's noise the part that the steps are
            noise = judge.motion_noise(model) * min(1.0, noise / white) if white > 0 else 0.0
        share = min(1.0, noise**2 / floor**2) if floor > 0 else 1.0
        found[name] = {"step": step, "noise": float(noise), "share": float(share)}
    return found


def steps_in_words(
    found: Mapping[str, Mapping[str, float]], motion: Kind = TRANSLATION, left: float = 0.0
) -> str:
    """A sentence about steps that are a good part of the noise, and of what is `left` [N].

    Empty where there are none.
    """
    told = {
        name: each
        for name, each in found.items()
        if each["share"] >= TOLD and each["noise"] ** 2 >= TOLD * left**2
    }
    if not told:
        return ""
    unit = {"force": words(motion, "N"), "displacement": words(motion, "m")}
    parts = [
        f"the {name} in steps of {each['step']:.3g} {unit[name]} ({100 * each['share']:.0f} % of "
        "the noise)"
        for name, each in told.items()
    ]
    text = " and ".join(parts)
    return f"The converter wrote {text}: a finer range would lower what remains."
