"""What a diagnosis says, and its JSON."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.budget.words import Budget, budget_of
from inerter.diagnose.cannot_tell import (
    FEW,
    FEW_STROKES,
    ONE_SINE,
    ONE_WAY,
    RUN_UP,
    SWEEP,
    CannotTell,
    of_a_tone,
)
from inerter.diagnose.remainder.further import channels_of
from inerter.identify.channel_filter import filters_of
from inerter.motion_units import TRANSLATION, Kind

Array = NDArray[np.float64]
SCHEMA = "inerter.diagnosis/1"


@dataclass(frozen=True)
class ParameterValue:
    """An identified value with its standard error; at_limit: as far as it may go."""

    value: float
    stderr: float
    unit: str
    at_limit: bool = field(default=False, kw_only=True)

    def json(self) -> dict[str, Any]:
        """As in the contract; that it is at its limit is said where it is."""
        told = dict(vars(self))
        if not told.pop("at_limit"):
            return told
        return told | {"at_limit": True}


@dataclass(frozen=True)
class StatedValue(ParameterValue):
    """An identified value beside the one that the user states; None: there is none."""

    stated: float | None = None

    @property
    def difference(self) -> float | None:
        """How far the value is from the one stated."""
        return None if self.stated is None else self.value - self.stated


@dataclass(frozen=True)
class Rival:
    """Another effect that could explain the same data, and how likely it is."""

    effect: str
    confidence: float
    law: str | None = None


@dataclass(frozen=True, kw_only=True)
class Finding:
    """An effect that the simulation lacks.

    rmse_before, rmse_after: rms force error on held-out data [N] before and after adding it (on
    blocks left out of the fit where the held-out data do not reach the effect: seen_in_blocks);
    confidence: share of resamples of the data in which it does better than without it and better
    than every rival; gain_interval: 95 % interval of the gain, None where there are too few data;
    members: effects that these data cannot tell apart, this one among them; none where they can;
    side: of friction, where it acts: "terminals", "flywheel" (behind an elasticity) or "both"; else
    empty;
    compared: False where a time limit left no time to ask what else could explain the data;
    takes: what it takes away of the error but for blows of a play [N]; None where all count;
    remark: what the model says of it beside its figures, in sentences, at the end of the evidence;
    motion: what the device does, in rotation read N m for N.
    """

    effect: str
    law: str | None
    confidence: float
    parameters: dict[str, ParameterValue]
    rmse_before: float
    rmse_after: float
    evidence: str
    rivals: list[Rival]
    seen_in_blocks: bool = False
    gain_interval: tuple[float, float] | None = None
    members: tuple[str, ...] = ()
    looks_like: bool = False
    compared: bool = True
    takes: float | None = None
    remark: str = ""
    side: str = ""
    motion: Kind = TRANSLATION

    def remarked(self, remark: str) -> Finding:
        """The finding with a remark."""
        evidence = f"{self.evidence} {remark}"
        return replace(self, remark=f"{self.remark} {remark}".strip(), evidence=evidence)

    @property
    def other_rivals(self) -> list[Rival]:
        """Rivals that are none of its members, which are told already."""
        return [rival for rival in self.rivals if rival.effect not in self.members]

    @property
    def gain(self) -> float:
        """Share of the held-out rms error that it takes away."""
        return 1 - self.rmse_after / self.rmse_before if self.rmse_before > 0 else 0.0

    def json(self) -> dict[str, Any]:
        """As in the contract."""
        members = {"members": list(self.members)} if self.members else {}
        describes = {"looks_like": True} if self.looks_like else {}
        alone = {} if self.compared else {"compared": False}
        side = {"side": self.side} if self.side else {}
        return (
            members
            | describes
            | alone
            | side
            | {
                "effect": self.effect,
                "law": self.law,
                "confidence": round(self.confidence, 4),
                "parameters": {name: value.json() for name, value in self.parameters.items()},
                "rmse_before": self.rmse_before,
                "rmse_after": self.rmse_after,
                "gain": self.gain,
                "gain_interval": self.gain_interval,
                "evidence": self.evidence,
                "rivals": [
                    {"effect": r.effect, "law": r.law, "confidence": round(r.confidence, 4)}
                    for r in self.rivals
                ],
            }
        )


@dataclass(frozen=True)
class Accuracy:
    """A device and its force error on held-out data [N]; nrmse: per standard deviation of force.

    channels: what is fitted beside the device, such as a delay (see `identify.channel`).
    """

    device: dict[str, float | str]
    rmse: float
    nrmse: float
    channels: dict[str, float] = field(default_factory=dict)

    @property
    def delay(self) -> float:
        """Time by which the force channel is late [s]."""
        return self.channels.get("delay", 0.0)

    @property
    def filters(self) -> dict[str, str]:
        """Low-passes of the channels as they are stated, by the channel's name."""
        return {channel: each.text for channel, each in filters_of(self.channels).items()}

    def json(self) -> dict[str, Any]:
        """As in the contract."""
        device: dict[str, float | str] = dict(self.device)
        result: dict[str, Any] = {"device": device, "rmse": self.rmse, "nrmse": self.nrmse}
        if self.channels:
            result["channels"] = dict(self.channels)
        return result


@dataclass(frozen=True)
class RecordSummary:
    """One record, and how it was used."""

    name: str
    samples: int
    sample_rate: float
    role: str
    warnings: list[dict[str, str]]

    def json(self) -> dict[str, Any]:
        """As in the contract; a rate without what rounding of the times adds."""
        return {**vars(self), "sample_rate": float(f"{self.sample_rate:.10g}")}


@dataclass(frozen=True, kw_only=True)
class Unexplained:
    """What remains after the extension.

    Attributes
    ----------
    significant : bool
        Something remains that is no noise, and of a size that matters.
    fraction : float
        Share of the held-out residual's power that is not noise.
    depends_on : list of str
        What it goes with, the most important first; see `unexplained.ORDER`.
    summary : str
        The same in words.
    structure : float
        Rms of what was found to be no noise [N]: what the tests predict of the residual, or all
        beyond the noise where that is too much for any.
    tests : list of dict
        Every test: {"goes_with", "share" and "share_held_out" (of the residual's power, both out of
        sample; the first over all data), "rms" [N], "p"}.
    false_alarm_rate : float
        Share of diagnoses in which noise alone passes for more, all tests together.
    proposal : dict, optional
        A formula: {"text", "terms": [{"term", "coefficient", "stderr", "unit"}], "share", "note"}.
    ceiling : dict, optional
        Held-out error of the best flexible predictor, {"rmse"} [N]; None where there is none.
    carried : dict, optional
        What is taken into the extended device without a name, see `budget.carried`; None where
        nothing is.
    predicted : float
        Rms of what the tests predict of the residual on held-out data [N].
    tone_above : float, optional
        Frequency [Hz] of a tone that remains above the band of the motion.
    """

    significant: bool
    fraction: float
    depends_on: list[str]
    summary: str
    structure: float = 0.0
    tests: list[dict[str, Any]] = field(default_factory=list)
    false_alarm_rate: float = 0.0
    proposal: dict[str, Any] | None = None
    ceiling: dict[str, float] | None = None
    carried: dict[str, Any] | None = None
    predicted: float = 0.0
    tone_above: float | None = None

    def json(self) -> dict[str, Any]:
        """As in the contract."""
        own = ("predicted", "tone_above")
        return {name: value for name, value in vars(self).items() if name not in own}


@dataclass(frozen=True, kw_only=True)
class RunCurves:
    """Measured and simulated force of one run, for the report; arrays (n,), NaN-free.

    inner: False near the ends where the motion is uncertain and nothing is judged. quantity, unit:
    what `force`, `baseline` and `extended` are where a channel of another kind is shown; length:
    the unit of the displacement.
    """

    name: str
    role: str
    time: Array
    displacement: Array
    velocity: Array
    acceleration: Array
    force: Array
    baseline: Array
    extended: Array
    holdout: NDArray[np.bool_]
    inner: NDArray[np.bool_]
    quantity: str = "force"
    unit: str = "N"
    length: str = "m"


@dataclass(frozen=True, kw_only=True)
class TablePoints:
    """A bench table with the amplitudes of both models, arrays (n,)."""

    frequency: Array
    acceleration: Array
    force: Array
    baseline: Array
    extended: Array
    holdout: NDArray[np.bool_]
    motion: Kind = TRANSLATION


@dataclass(frozen=True, kw_only=True)
class Diagnosis:
    """The outcome of a diagnosis."""

    records: list[RecordSummary]
    baseline: Accuracy
    findings: list[Finding]
    extended: Accuracy
    noise_floor: float
    unexplained: Unexplained
    engines: dict[str, float | None]
    verdict: str
    parameters: dict[str, ParameterValue] = field(default_factory=dict)
    method: dict[str, Any] = field(default_factory=dict)
    curves: list[RunCurves] = field(default_factory=list)
    points: TablePoints | None = None
    motion: Kind = TRANSLATION
    """What the device does; in rotation read rad for m, N m for N, kg m^2 for kg."""
    rest_length: float = 0.0
    """As stated [m]; the displacement of records counts from it, so that no law reads it here."""
    gain_interval: tuple[float, float] | None = None
    """95 % interval of `gain`, None where there are too few data."""
    notes: list[str] = field(default_factory=list)
    """Sentences of the verdict about runs that are missed, splits, and what cannot be told."""
    repeatability: float | None = None
    """What differs between strokes that repeat, rms [N]; None where too few do."""

    @property
    def cannot_tell(self) -> tuple[CannotTell, ...]:
        """What the motion cannot tell, whatever is found."""
        sine = ONE_SINE if self.method.get("one_tone") else ()
        way = (ONE_WAY,) if self.method.get("one_way") else ()
        way += (RUN_UP,) if self.method.get("runs_up") else ()
        few = (FEW,) if self.method.get("strokes", FEW_STROKES) < FEW_STROKES else ()
        few += (SWEEP,) if self.method.get("sweeps") else ()
        tone = self.unexplained.tone_above
        return (*sine, *way, *few, *(() if tone is None else (of_a_tone(tone),)))

    @property
    def budget(self) -> Budget | None:
        """The parts of the held-out error; None where no ceiling was looked for."""
        if self.unexplained.ceiling is None:
            return None
        kept = self.unexplained.carried
        return budget_of(
            self.baseline.rmse,
            self.extended.rmse,
            self.unexplained.ceiling["rmse"],
            self.repeatability,
            self.motion,
            carried=kept["rmse_after"] if kept else None,
            foretold=self.unexplained.predicted if self.unexplained.depends_on else 0.0,
            source=" and ".join(["the motion", *channels_of(self.unexplained.depends_on)]),
        )

    @property
    def written(self) -> dict[str, Any]:
        """The device as it is written: with what it carries without a name."""
        kept = self.unexplained.carried
        return self.extended.device | (kept["parameters"] if kept else {})

    @property
    def gain(self) -> float:
        """Share of the held-out rms error that the extension takes away."""
        before = self.baseline.rmse
        return 1 - self.extended.rmse / before if before > 0 else 0.0

    def json(self) -> dict[str, Any]:
        """The contract's diagnosis.json; null for a number that is not finite."""
        return _finite(
            {
                "schema": SCHEMA,
                "motion": self.motion,
                "records": [record.json() for record in self.records],
                "baseline": self.baseline.json(),
                "findings": [finding.json() for finding in self.findings],
                "extended": self.extended.json(),
                "parameters": {name: value.json() for name, value in self.parameters.items()},
                "gain": {"value": self.gain, "interval": self.gain_interval},
                "noise": {"rmse_floor": self.noise_floor, "repeatability": self.repeatability},
                "unexplained": self.unexplained.json(),
                "engines": {name: {"rmse": rmse} for name, rmse in self.engines.items()},
                "cannot_tell": [each.json() for each in self.cannot_tell],
                "method": self.method,
                "verdict": self.verdict,
            }
        )


def _finite(value: Any) -> Any:
    """The same with None for numbers that are not finite, for which JSON has no word."""
    if isinstance(value, dict):
        return {key: _finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value
