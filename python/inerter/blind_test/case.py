"""One case of a blind test: effects are hidden, the records diagnosed, the outcome compared."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any
from warnings import catch_warnings, simplefilter

import numpy as np

from inerter.blind_test.plan import Task
from inerter.blind_test.vehicle import (
    diagnose_vehicle,
    name_in_vehicle,
    vehicle_gain,
    vehicle_parameters,
)
from inerter.core import Device
from inerter.diagnose import Diagnosis, diagnose_bench
from inerter.identify.channel_filter import Filter
from inerter.parallel_steps import serial
from inerter.records import Record
from inerter.reference import (
    HiddenCase,
    HiddenVehicle,
    hide_effect,
    hide_in_vehicle,
    hide_unknown,
)

# Bouc-Wen's parameters are redundant: other values draw the same loop
UNCOUNTED_LAWS = ("bouc_wen",)
# of a gas spring the data see the force p0 A and the reach V0 / A
GAS = ("gas_pressure", "gas_area", "gas_volume")

_LEVEL, _UNEVEN = "coulomb_friction", "asymmetric_friction"


@dataclass(frozen=True)
class Named:
    """A finding: its effect, law and confidence; effects that these data cannot tell from it.

    looks_like: it describes what is there, and is not claimed to be it.
    """

    effect: str
    law: str | None
    confidence: float
    members: tuple[str, ...] = ()
    looks_like: bool = False


@dataclass(frozen=True)
class ParameterError:
    """A hidden parameter of an effect: true value, what was found, its standard error."""

    effect: str
    name: str
    true: float
    found: float | None
    stderr: float | None

    @property
    def relative(self) -> float:
        """|found - true| / |true|; infinite for one that was not reported."""
        return np.inf if self.found is None else abs(self.found - self.true) / abs(self.true)

    @property
    def covered(self) -> bool | None:
        """Within 2 standard errors; None where there is none."""
        if self.found is None or self.stderr is None or not 0.0 < self.stderr < np.inf:
            return None
        return abs(self.found - self.true) <= 2.0 * self.stderr

    @property
    def near(self) -> bool:
        """Within 5 %, or within 3 standard errors."""
        if self.found is None:
            return False
        spread = self.stderr if self.stderr is not None and np.isfinite(self.stderr) else 0.0
        return abs(self.found - self.true) <= max(0.05 * abs(self.true), 3.0 * spread)


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """What was hidden and what was said; `error` where the diagnosis did not come to an end.

    law: of hysteretic friction, also where it was drawn; gain: share of the rms error against the
    noise-free force that is taken away on held-out data; seconds: of the diagnosis alone, on the
    wall and of the processor, which says more where others use the machine; brings: effects that
    the bench adds by itself, or that are a plainer form of what was hidden (`plainer_forms`), which
    are right where they are named and need not be; cannot_tell: effects of which the diagnosis says
    that the motion cannot tell them.
    """

    task: Task
    law: str | None = None
    named: tuple[Named, ...] = ()
    parameters: tuple[ParameterError, ...] = ()
    unexplained: bool = False
    gain: float | None = None
    verdict: str = ""
    seconds: float = 0.0
    processor_seconds: float = 0.0
    share: float | None = None
    error: str | None = None
    brings: tuple[str, ...] = ()
    cannot_tell: tuple[str, ...] = ()

    def json(self) -> dict[str, Any]:
        """As a JSON object."""
        return asdict(self)

    @classmethod
    def of_json(cls, data: Mapping[str, Any]) -> Outcome:
        """From what `json` gave.

        Raises
        ------
        KeyError, TypeError
            It is no such object.
        """
        task = Task(**{**data["task"], "effects": tuple(data["task"]["effects"])})
        named = tuple(
            Named(**{**each, "members": tuple(each.get("members", ()))}) for each in data["named"]
        )
        errors = tuple(ParameterError(**each) for each in data["parameters"])
        also = {name: tuple(data.get(name, ())) for name in ("brings", "cannot_tell")}
        return cls(**{**data, "task": task, "named": named, "parameters": errors, **also})

    truth: dict[str, float] = field(default_factory=dict)

    @property
    def effects(self) -> tuple[str, ...]:
        """Effects that were named, the first first."""
        return tuple(named.effect for named in self.named)

    def is_right(self, named: Named) -> bool:
        """Whether a finding, or one that it cannot be told from, was hidden or the bench's own."""
        there = {*self.task.effects, *self.brings}
        if _UNEVEN in there and any(_UNEVEN in each.members for each in self.named):
            # the level, and what differs between the directions or is a constant force
            there.add(_LEVEL)
        return named.effect in there or any(name in there for name in named.members)

    @property
    def missed(self) -> tuple[str, ...]:
        """What was hidden and not named, nor anything that it cannot be told from."""
        said = {name for each in self.named for name in (each.effect, *each.members)}
        return tuple(name for name in self.task.effects if name not in said)

    @property
    def found(self) -> bool:
        """Whether everything hidden was named, or something that it cannot be told from."""
        return self.error is None and not self.missed

    @property
    def is_beyond_the_motion(self) -> bool:
        """Whether something was missed, nothing but what the motion cannot tell, as was said."""
        return self.error is None and not self.found and {*self.missed} <= {*self.cannot_tell}

    @property
    def nothing_false(self) -> bool:
        """Whether every finding is right."""
        return self.error is None and all(map(self.is_right, self.named))

    @property
    def first(self) -> str:
        """The effect named first, "none", or "failed" where the diagnosis did not end."""
        if self.error is not None:
            return "failed"
        return self.effects[0] if self.named else "none"


def hide(task: Task) -> HiddenCase | HiddenVehicle:
    """The records of a case."""
    if task.bench == "vehicle":
        return hide_in_vehicle(
            task.seed, task.effects, law=task.law, noise=task.noise, unknown=task.kind
        )
    realistic = task.bench == "realistic"
    if task.group == "unknown":
        return hide_unknown(task.seed, task.kind, task.levels, realistic=realistic)
    first, *also = task.effects or ("none",)
    return hide_effect(
        task.seed, first, law=task.law, noise=task.levels, also=also, realistic=realistic
    )


def records_of(case: HiddenCase) -> list[Record]:
    """What a bench would have measured of a case."""
    return [
        Record(name=run.name, time=run.time, displacement=run.displacement, force=run.force)
        for run in case.runs
    ]


def solve(task: Task) -> Outcome:
    """Hide, diagnose, compare; whatever goes wrong is told in the outcome."""
    case: HiddenCase | HiddenVehicle | None = None
    start = time.perf_counter(), time.process_time()
    try:
        case = hide(task)
        said = _diagnosis_of(case)
        start = time.perf_counter(), time.process_time()
        with np.errstate(all="ignore"), catch_warnings(), serial():
            simplefilter("ignore", RuntimeWarning)
            diagnosis = said()
        outcome = compare(task, case, diagnosis)
    except Exception as error:
        text = " ".join(f"{type(error).__name__}: {error}".split())
        outcome = Outcome(task=task, law=task.law, error=text)
        if case is not None:
            outcome = replace(outcome, law=case.law, share=case.share, truth=case.parameters)
    wall, busy = time.perf_counter() - start[0], time.process_time() - start[1]
    return replace(outcome, seconds=wall, processor_seconds=busy)


def _diagnosis_of(case: HiddenCase | HiddenVehicle) -> Callable[[], Diagnosis]:
    """What diagnoses a case's records."""
    if isinstance(case, HiddenVehicle):
        return functools.partial(diagnose_vehicle, case)
    device = None if case.stated is None else Device(**case.stated)
    return functools.partial(diagnose_bench, records_of(case), device)


def compare(task: Task, case: HiddenCase | HiddenVehicle, diagnosis: Diagnosis) -> Outcome:
    """A diagnosis against the truth."""
    if isinstance(case, HiddenVehicle):
        names = tuple(name_in_vehicle(case, finding) for finding in diagnosis.findings)
        errors = [ParameterError(*each) for each in vehicle_parameters(case, diagnosis.findings)]
        gain, brings = vehicle_gain(case, diagnosis), ()
    else:
        names = tuple(finding.effect for finding in diagnosis.findings)
        errors = parameter_errors(case, diagnosis)
        gain = gain_on_truth(case, diagnosis)
        brings = (*case.chain.brings, *plainer_forms(case)) if case.chain else ()
    return Outcome(
        task=task,
        law=case.law,
        named=tuple(
            Named(name, f.law, f.confidence, f.members, f.looks_like)
            for name, f in zip(names, diagnosis.findings, strict=True)
        ),
        brings=brings,
        cannot_tell=tuple(name for each in diagnosis.cannot_tell for name in each.effects),
        parameters=tuple(errors),
        unexplained=diagnosis.unexplained.significant,
        gain=gain,
        verdict=diagnosis.verdict,
        share=case.share,
        truth=case.parameters,
    )


def parameter_errors(case: HiddenCase, diagnosis: Diagnosis) -> list[ParameterError]:
    """The hidden parameters of the effects that were found, in the law that was hidden.

    A combination stands for parameters that the data cannot tell apart: `gas_force` p0 A [N] and
    `gas_reach` V0 / A [m]. Bouc-Wen's parameters are left out.
    """
    found: list[ParameterError] = []
    if case.chain and "grip_mass" in diagnosis.extended.channels:
        # told from the inertance, which it is a part of elsewhere
        case = replace(case, chain=replace(case.chain, grip_mass=0.0))
    shown = shown_parameters(case)
    for effect in case.effects:
        finding = next((f for f in diagnosis.findings if f.effect == effect), None)
        if finding is None:
            continue
        if effect == "hysteretic_friction" and (
            finding.law != case.law or case.law in UNCOUNTED_LAWS
        ):
            continue
        reported = {name: (v.value, v.stderr) for name, v in diagnosis.parameters.items()}
        reported |= {name: (v.value, v.stderr) for name, v in finding.parameters.items()}
        hidden = {n: shown[n] for n in case.names[effect] if n in shown}
        if effect == "gas_spring":
            hidden = _gas(hidden)
            stated = {n: v for n, v in diagnosis.extended.device.items() if isinstance(v, float)}
            reported |= _gas_reported(stated, reported)
        for name, true in hidden.items():
            value, stderr = reported.get(name, (None, None))
            found.append(ParameterError(effect, name, true, value, stderr))
    return found


# what the inertance gains per that of the device
_OF_INERTANCE = (
    "inertance_gradient", "inertance_curvature", "inertance_speed_gradient", "inertance_amplitude",
)  # fmt: skip


def shown_parameters(case: HiddenCase) -> dict[str, float]:
    """The hidden parameters as the records of a bench show them, whoever reads them.

    A mass m between load cell and device is inertance, the drift of the cell adds to one that is
    hidden, and friction mu |b a| is mu b / (b + m) of the inertance force that is measured, as what
    the inertance gains along the stroke is. Behind a shaft b^2 / k is what bends it: where the mass
    is not told from b, k and c are larger by (1 + m / b)^2 (to third order in the frequency). Of a
    tone a filter of the force leaves less, whether the displacement has the same one or not. What
    the bench does to the same channel as a hidden delay or filter, and a drift to a constant
    force, has no value of its own in such a sum, and is left out.
    """
    shown, chain = dict(case.parameters), case.chain
    if chain is None:
        return shown
    inertance = case.device.inertance
    more = {"inertance": chain.grip_mass, "force_drift": chain.drift}
    shown |= {name: shown[name] + value for name, value in more.items() if name in shown}
    if "disturbance_amplitude" in shown and chain.force_filter:
        kind = "bessel" if chain.is_bessel else "butterworth"
        low_pass = Filter(kind, int(chain.order), chain.force_filter)
        gain = low_pass.response(np.array([shown["disturbance_frequency"]]))
        shown["disturbance_amplitude"] *= float(np.abs(gain[0]))
    share = inertance / (inertance + chain.grip_mass)
    for name in shown:
        if name == "load_friction" or name.startswith(_OF_INERTANCE):
            shown[name] *= share
        elif name in ("series_stiffness", "series_damping") and not case.device.backlash:
            shown[name] /= share**2
    mixed = {"force_offset"} if chain.drift else set()
    if chain.force_filter != chain.displacement_filter:
        mixed |= {"delay", "force_filter"}
    return {name: value for name, value in shown.items() if name not in mixed}


def plainer_forms(case: HiddenCase) -> tuple[str, ...]:
    """Coulomb friction, where hidden friction is no more along the motion but for the noise.

    A Stribeck peak within speeds that the motion hardly has, or an ageing of a few per cent of the
    level: to find Coulomb friction there is right, though not all that was hidden. Friction that
    differs between the directions is that and a constant force.
    """
    pieces = []
    for truth in (run.truth for run in case.runs):
        x, v, a = truth.displacement, truth.velocity, truth.acceleration
        states = case.device.state_argument(truth.states)
        friction = np.asarray(case.device.total_friction(x, v, a, states), dtype=float)
        pieces.append(np.column_stack([friction, np.sign(v), np.ones_like(v)]))
    rows = np.concatenate(pieces)
    columns = rows[:, 1:] if case.device.friction_asymmetry else rows[:, 1:2]
    level = np.linalg.lstsq(columns, rows[:, 0], rcond=None)[0]
    left = float(np.sqrt(np.mean((rows[:, 0] - columns @ level) ** 2)))
    return ("coulomb_friction",) if rows[:, 0].any() and left < case.noise["force"] else ()


def _gas(values: dict[str, float]) -> dict[str, float]:
    rest = {name: value for name, value in values.items() if name not in GAS}
    pressure, area, volume = (values[name] for name in GAS)
    return {**rest, "gas_force": pressure * area, "gas_reach": volume / area}


def _gas_reported(
    device: dict[str, float], errors: dict[str, tuple[float, float]]
) -> dict[str, tuple[float, float]]:
    """Both combinations of the device found, errors as if its parameters' were independent."""
    if not all(device.get(name) for name in GAS):
        return {}
    combined = _gas({name: device[name] for name in GAS})
    relative = {n: errors[n][1] / abs(device[n]) if n in errors else 0.0 for n in GAS}
    area = relative["gas_area"]
    spread = {
        "gas_force": np.hypot(relative["gas_pressure"], area),
        "gas_reach": np.hypot(relative["gas_volume"], area),
    }
    return {n: (v, float(abs(v) * spread[n])) for n, v in combined.items()}


def gain_on_truth(case: HiddenCase, diagnosis: Diagnosis) -> float | None:
    """1 - after / before: rms errors against the channel's force without noise, held-out samples.

    What the channel adds (a filter, hum) is in it: the diagnosis has it for a cause, too.
    """
    before = after = 0.0
    runs = {run.name: run for run in case.runs}
    for curve in diagnosis.curves:
        run = runs[curve.name]
        judged = curve.inner & curve.holdout
        truth = np.interp(curve.time, run.time, run.shown)[judged]
        before += float(np.sum((curve.baseline[judged] - truth) ** 2))
        after += float(np.sum((curve.extended[judged] - truth) ** 2))
    return 1.0 - float(np.sqrt(after / before)) if before > 0.0 else None
