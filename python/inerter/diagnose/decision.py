"""What is decided by: every bound in one place, and the decisions that read them.

A model is judged by its squared errors over blocks of samples that it was not fitted to. `won` and
`lost` are t values over paired blocks (`statistics.advantage`), gains and losses shares of the rms
error. The same decisions hold for a bench, a vehicle and a table of amplitudes; what differs is how
their errors come about.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def _bound(value: float, unit: str, reason: str) -> Any:
    return field(default=value, metadata={"unit": unit, "reason": reason})


ERRORS, SHARE, RATIO = "standard errors", "share of the rms error", "ratio"
COUNT, SAMPLES = "number", "samples"


@dataclass(frozen=True, kw_only=True)
class Criteria:
    """The bounds of a diagnosis, each with its unit and reason; `rows` tells them all."""

    # to be added
    advantage: float = _bound(
        4.0,
        ERRORS,
        "what a richer model wins by: about one false alarm in 30,000 candidates on noise alone",
    )
    gain: float = _bound(0.01, SHARE, "the least that an effect takes away to be added")
    large_advantage: float = _bound(
        2.0, ERRORS, "what it wins by where it gains much: guards against one lucky stretch"
    )
    large_gain: float = _bound(
        0.05, SHARE, "much: many times the least gain, which noise does not make"
    )
    distinction: float = _bound(
        3.0,
        ERRORS,
        "by which its own parameter differs from none, correlation allowed for",
    )
    rate_that_matters: float = _bound(
        0.01,
        RATIO,
        "of a friction level that it changes by per e-fold of the speed: less is none",
    )
    known: float = _bound(
        0.5,
        "standard error per value",
        "of a bristle's stiffness: beyond, it may have no end, and friction no memory",
    )
    late_enough: float = _bound(
        1.2,
        "the least error of a candidate",
        "that of a delay from which low-passes are tried, too",
    )
    filters_kept: int = _bound(2, "filters", "the best low-passes, which are checked further")
    local_gain: float = _bound(
        0.5,
        SHARE,
        "what an effect that shows in few places takes away there: peaks, where such effects lie, "
        "are where a slightly wrong model errs most",
    )
    refit_reach: float = _bound(
        10.0,
        ERRORS,
        "how far a refit without a fold may move what shows in few places: it may leave them all",
    )
    foothold: float = _bound(
        0.1, SHARE, "what one that is not sure alone takes away to be tried with a second one"
    )
    likely: float = _bound(
        0.7, "share of the least gain", "what one step of Gauss and Newton foretells of a candidate"
    )
    shortlist: int = _bound(5, COUNT, "of candidates that are checked on data left out")
    most_effects: int = _bound(8, COUNT, "of effects on a bench")
    most_in_vehicles: int = _bound(5, COUNT, "of effects in a vehicle: each costs simulations")
    most_on_tables: int = _bound(3, COUNT, "of effects that a table of amplitudes may show")

    # the plainer of two
    tolerated_advantage: float = _bound(
        3.0, ERRORS, "what a simpler candidate may lose to the best and still be taken"
    )
    large_tolerated_advantage: float = _bound(6.0, ERRORS, "the same where it loses little")
    tolerated_loss: float = _bound(0.01, SHARE, "little")
    too_much: float = _bound(
        0.25, SHARE, "a loss that is never small, though the best may show in few places"
    )
    exchange_loss: float = _bound(
        0.005, SHARE, "what a plainer friction law may lose where it takes a richer one's place"
    )

    # to be taken out again
    keeping_advantage: float = _bound(2.0, ERRORS, "an effect worth less goes")
    keeping_gain: float = _bound(0.005, SHARE, "the same: half of what it needed to come")
    needed: float = _bound(
        2.0,
        RATIO,
        "error without an effect per error with it: it stays, though its parameter may be none",
    )

    # rivals
    equal_advantage: float = _bound(2.0, ERRORS, "within which two models do as well")
    equal_loss: float = _bound(0.005, SHARE, "the same")
    preferred: float = _bound(
        0.5, "share of resamples", "in which a rival is the best to be named instead"
    )
    beaten: float = _bound(
        1.25, RATIO, "one that misses so much more, fitted to all, is the best in no resample"
    )
    handicap: float = _bound(
        0.03,
        SHARE,
        "what a rival with more parameters does better by chance",
    )
    rivals_checked: int = _bound(3, COUNT, "of rivals that are checked on data left out")
    exchanges: int = _bound(3, COUNT, "of rivals that take an effect's place, one after another")
    rival_kept: float = _bound(0.005, "confidence", "from which a rival stands in the result")
    rival_told: float = _bound(0.05, "confidence", "from which the text names it")

    # held-out data
    confirming_advantage: float = _bound(2.0, ERRORS, "by which an effect helps on held-out data")
    noise_share: float = _bound(
        0.005,
        "share of the noise",
        "an effect of a tenth of the noise, rms, adds sqrt(1 + 0.1^2) - 1 of it to the error",
    )
    force_share: float = _bound(
        3e-4,
        "share of the rms force",
        "combined error of a good load cell: less is not known to anyone",
    )
    spacing_share: float = _bound(
        0.02,
        "share of the sample spacing",
        "of a delay; a choice without a source: sample times that are off by less count as even, "
        "and the error of interpolating a force is that of such a delay at 6.5 samples in a period",
    )

    # what smoothed data make of any reversal
    narrow_peak: float = _bound(
        4.0,
        "times the narrowest searched for",
        "a fall of the friction within it may be blur: in 43 cases of plain friction up to 3.1",
    )
    blur: float = _bound(
        0.04,
        "share of the level",
        "what such blur explains at most: up to 1.4 % in those cases, true peaks 13 to 31 %",
    )
    bristle_seen: float = _bound(
        0.02,
        "of what the place of a reversal is known to",
        "below this distance a bristle that yields is not told from friction without memory",
    )
    losing: float = _bound(
        0.1,
        "beta per gamma of a Bouc-Wen law",
        "without beta nothing is lost: it is a spring with any zero, and stands in for others",
    )

    near_noise: float = _bound(
        1.2,
        "noise of the force in the band",
        "an error below which no other effects are tried in the place of those found: a choice, "
        "which saves their time",
    )

    exchanged_of: int = _bound(
        3,
        COUNT,
        "of effects up to which others are tried in the place of each: of more each takes what the "
        "others leave, and a measured axis with four was foretold worse on held-out data after it",
    )

    drawn_beside: int = _bound(
        3,
        COUNT,
        "of effects beside a curve along the stroke up to which the search is done once more "
        "without curves: a choice, which saves time where real machines have more",
    )

    # bands
    band_gain: float = _bound(0.1, SHARE, "what another band takes away to be taken")
    more_bands: int = _bound(2, COUNT, "of wider bands in which a search goes on")
    long_record: int = _bound(
        100_000, SAMPLES, "of all runs, from which on causes are searched for on stretches of them"
    )
    searched_samples: int = _bound(60_000, SAMPLES, "in all stretches")
    missed_stretch: float = _bound(
        2.0,
        RATIO,
        "of the error of a stretch that was not searched to the largest of those that were, from "
        "which something happens there alone, and it is searched too",
    )
    more_stretches: int = _bound(2, COUNT, "of searches more, each with more such stretches")
    tone_of_motion: float = _bound(
        0.5,
        "share of a tone's power",
        "that is left beside an inertance along the displacement as measured, below which the tone "
        "is the motion's own",
    )
    tone_hidden: float = _bound(
        0.25, "share of a tone's power", "of the displacement's noise, which may hide such a motion"
    )
    share_beyond: float = _bound(
        0.5,
        "share of the power",
        "of what is missed, above the motion's band, from which on forces are compared "
        "in a wider one",
    )
    loud_beyond: float = _bound(3.0, "noise of the force", "the least rms of that")
    kept_beyond: float = _bound(
        0.9, "share of the power", "of what is missed that the wider band has"
    )
    widest_force_band: float = _bound(8.0, "cut-offs of the motion", "the widest such band")
    tones_from: float = _bound(
        0.7, "of the cut-off", "from where tones are looked for at the measured rate"
    )

    # tables
    evidence: float = _bound(
        10.0,
        "twice the log-likelihood ratio",
        "of points left out: about one false alarm in 600",
    )
    spare_points: int = _bound(2, COUNT, "of points beyond a fit's parameters")

    # what is said
    contradiction: float = _bound(3.0, ERRORS, "by which a stated value is contradicted")
    right: float = _bound(
        0.1, "share of the force's variation", "a simulation that misses less can be called right"
    )
    even_doubt: float = _bound(
        1.0,
        "times what stays unexplained",
        "an effect that explains so much is there in half of the cases: 43 findings in 40 cases",
    )
    own_value: float = _bound(
        1.0,
        ERRORS,
        "what other choices of the analysis would change among them, by which its own value "
        "differs from none; below, an effect is as likely not there",
    )
    effects_of_one_sine: int = _bound(
        3, COUNT, "of effects that one closed curve of the force tells"
    )
    doubt_told: float = _bound(0.8, "trust", "below which a verdict doubts an effect")
    looks_like: float = _bound(
        20.0,
        "times what stays unexplained",
        "an effect that explains less looks like what is there, and is not claimed to be it: of 47 "
        "sure findings beside something unexplained 10 were wrong (six of them, measured, explain "
        "3.6 to 8.5 times as much), of 506 others 6",
    )

    def rows(self) -> Iterator[tuple[str, float, str, str]]:
        """Name, value, unit and reason of every bound."""
        for each in fields(self):
            yield (
                each.name,
                getattr(self, each.name),
                each.metadata["unit"],
                each.metadata["reason"],
            )


CRITERIA = Criteria()
"""The bounds that hold."""


class Judged(Protocol):
    """A fitted model with its squared errors over blocks that it has not seen."""

    @property
    def squares(self) -> Array:
        """Squared errors (blocks,)."""
        ...

    @property
    def complexity(self) -> int:
        """Number of free coordinates that say something."""
        ...


J = TypeVar("J", bound=Judged)


def loss(one: Judged, other: Judged) -> float:
    """Share of the rms error by which one model is worse than another; negative: better."""
    return float(np.sqrt(one.squares.sum() / other.squares.sum()) - 1)


def better(simple: Judged, rich: Judged, won: float) -> bool:
    """Whether a richer model predicts what it has not seen better than chance allows."""
    c, gain = CRITERIA, 1 - np.sqrt(rich.squares.sum() / simple.squares.sum())
    share = np.clip((gain - c.gain) / (c.large_gain - c.gain), 0, 1)
    required = c.advantage + share * (c.large_advantage - c.advantage)
    return bool(gain > c.gain and won > required)


def as_good(simple: Judged, best: Judged, lost: float) -> bool:
    """Whether a candidate loses so little against the best that fewer parameters decide."""
    c, little = CRITERIA, loss(simple, best) < CRITERIA.tolerated_loss
    tolerated = c.large_tolerated_advantage if little else c.tolerated_advantage
    return simple.complexity < best.complexity and lost < tolerated


def plainest(judged: Sequence[J]) -> J:
    """The one with the fewest parameters, of several the best."""
    return min(judged, key=lambda s: (s.complexity, s.squares.sum()))


def not_needed(without: Judged, whole: Judged, lost: float) -> bool:
    """Whether a model does without an effect."""
    return lost < CRITERIA.keeping_advantage or loss(without, whole) < CRITERIA.keeping_gain


def does_as_well(one: Judged, other: Judged, lost: float) -> bool:
    """Whether the errors of a model are hardly larger than those of another."""
    return loss(one, other) < CRITERIA.equal_loss and lost < CRITERIA.equal_advantage


def visible(before: float, after: float, noise_floor: float, force: float) -> bool:
    """Whether an effect takes away more error than a measurement leaves in doubt.

    On records without noise every test of significance succeeds: the last digits of a simulated
    force, the steps of its integrator and the corners of its motion are as certain as any effect.

    before, after: rms error on held-out data without and with it [N]; noise_floor and force: rms
    noise and rms of the measured force there [N].
    """
    c = CRITERIA
    return before - after > max(c.noise_share * noise_floor, c.force_share * force)


def visible_delay(delay: float, spacing: float) -> bool:
    """Whether a delay [s] can be told from the treatment of samples `spacing` [s] apart."""
    return abs(delay) > CRITERIA.spacing_share * spacing
