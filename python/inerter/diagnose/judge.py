"""What models are judged by: force errors on held-out data, and what is large enough to count."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.advantage import advantage_of
from inerter.diagnose.composition import is_shaft
from inerter.diagnose.decision import visible, visible_delay
from inerter.diagnose.statistics import block_squares, blow, taken_away, where_apart
from inerter.identify.fit import Problem, rms
from inerter.identify.model import Model
from inerter.identify.split import Mask, blocks
from inerter.records.motion import NOISE_SEGMENT, force_noise
from inerter.records.preparation import Preparation

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Judge:
    """The held-out data.

    Attributes
    ----------
    band, raw : Problem
        Held-out samples in the fits' band, and at the measured rate with the force as measured.
    weighed : Problem
        Those of the search, whose errors count by the noise of the motion.
    preparation : Preparation
        Tells the noise.
    baseline : Model
        What the user states.
    """

    band: Problem
    raw: Problem
    weighed: Problem
    preparation: Preparation
    baseline: Model

    @cached_property
    def force(self) -> Array:
        """Measured force of the held-out samples [N]."""
        return self.raw.masked([run.force for run in self.raw.runs])

    def rmse(self, model: Model) -> float:
        """Rms force error at the measured rate [N]."""
        return rms(self.raw.errors(model), self.raw.masks)

    def counted(self, model: Model) -> float:
        """The same as it counts: what is far off behind a free play counts little [N]."""
        return rms(self.raw.residual(model), self.raw.masks)

    def calm(self, errors: Sequence[Array]) -> list[Mask]:
        """Held-out samples but for blows: a model with a play meets some at another moment."""
        least = blow(np.concatenate([e[m] for e, m in zip(errors, self.raw.masks, strict=True)]))
        pairs = zip(errors, self.raw.masks, strict=True)
        return [mask & (np.abs(each) <= least) for each, mask in pairs]

    def taken_in_calm(self, simple: Model, rich: Model) -> float:
        """What the richer of two models takes away of the error but for its blows [N]."""
        before, after = self.raw.errors(simple), self.raw.errors(rich)
        calm = self.calm(after)
        return taken_away(rms(before, calm), rms(after, calm))

    def left_in_calm(self, model: Model, noise: float) -> float:
        """What a model leaves above the noise [N] but for blows [N]."""
        errors = self.raw.errors(model)
        return taken_away(rms(errors, self.calm(errors)), noise)

    def difference(self, one: Model, other: Model) -> float:
        """Rms difference of the forces that two models predict in the band [N]."""
        pairs = zip(self.band.residual(one), self.band.residual(other), strict=True)
        return rms([a - b for a, b in pairs], self.band.masks)

    def advantage(self, simple: Model, rich: Model, effect: str) -> float:
        """How surely the model with an effect is the better one, in standard errors."""
        # what a play does is above the band; a shaft that resonates near the band's end makes the
        # noise of the motion larger, which is no fault of the model
        if "backlash" in rich.free:
            problem = self.raw
        else:
            problem = self.weighed if is_shaft(effect) else self.band
        masks = problem.masks
        before, after = (problem.residual(model) for model in (simple, rich))
        # a motion may go through the resonance of a shaft in few places
        stretches = where_apart(before, after, masks) if is_shaft(effect) else blocks(masks)
        # what took away its share where it was found only has to help here
        return advantage_of(before, after, masks, stretches, effect, least=0.0)

    def raw_squares(self, model: Model) -> Array:
        """Squared errors at the measured rate over blocks, shape (blocks,)."""
        return block_squares(self.raw.residual(model), blocks(self.raw.masks))

    def error_squares(self, model: Model) -> Array:
        """The same of the plain errors, of which `rmse` is the root of the mean [N^2]."""
        return block_squares(self.raw.errors(model), blocks(self.raw.masks))

    def visible(self, before: float, after: float, model: Model) -> bool:
        """Whether an error that fell from `before` to `after` [N] is more than no one can tell."""
        force = float(np.sqrt(np.mean(self.force**2)))
        return visible(before, after, self.noise_floor(model), force)

    def delay_visible(self, model: Model) -> bool:
        """Whether a model's delay differs from the stated one by more than samples tell."""
        stated = self.baseline.values.get("delay", 0.0)
        return visible_delay(model.delay - stated, max(run.spacing for run in self.raw.runs))

    def noise_floor(self, model: Model) -> float:
        """Noise of the force, and of the acceleration times the inertance, rms [N]."""
        return self._noise(self.preparation.noise_floor, model)

    def noise_left(self, model: Model) -> float:
        """The same, read off what a good model leaves.

        At a few hundred samples per second friction reaches the band that white noise is read
        from: the force itself seems noisier than it is.
        """
        pairs = zip(self.raw.errors(model), self.raw.runs, strict=True)
        inner = [error[run.inner] for error, run in pairs]
        noise = [force_noise(error) ** 2 for error in inner if error.size >= NOISE_SEGMENT]
        least = float(np.sqrt(np.mean(noise))) if noise else np.inf
        return self._noise(min(self.preparation.noise_floor, least), model)

    def motion_noise(self, model: Model) -> float:
        """The inertance times the noise of the acceleration, rms [N]; 0 where it is not known."""
        if self.preparation.channels:
            # the noise of a fused acceleration is not known
            return 0.0
        variances = [motion.acceleration_noise**2 for motion in self.preparation.motions]
        return float(model.values["inertance"] * np.sqrt(np.mean(variances)))

    def _noise(self, force: float, model: Model) -> float:
        return float(np.hypot(force, self.motion_noise(model)))
