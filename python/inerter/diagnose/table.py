"""Diagnosis of a bench table: amplitudes of force and acceleration at a list of frequencies.

A model's amplitude is that of the fundamental of its force along x = X sin(w t) in steady state.
The errors of such tables grow with the force, so fits and decisions use relative errors; a constant
force and a delay leave no trace in amplitudes and cannot be found.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import NUISANCES
from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.scales import Scales
from inerter.core import Device, parameters
from inerter.diagnose import wording
from inerter.diagnose.baseline import baseline_model
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import effects_of
from inerter.diagnose.decision import CRITERIA, plainest
from inerter.diagnose.result import (
    Accuracy,
    Diagnosis,
    Finding,
    ParameterValue,
    RecordSummary,
    Rival,
    TablePoints,
    Unexplained,
)
from inerter.diagnose.stated import stated_candidates
from inerter.diagnose.statistics import win_shares
from inerter.diagnose.values import parameter_values
from inerter.diagnose.where_losses_act import with_side
from inerter.estimation.least_squares import Tolerances, minimise
from inerter.estimation.variables import Variables
from inerter.identify.fit import Fit
from inerter.identify.model import Model
from inerter.motion_units import Kind, one_motion
from inerter.records import BenchTable
from inerter.records.duplicates import repeats_another, without_copies
from inerter.rig import quiet, simulate_along

Array = NDArray[np.float64]
Progress = Callable[[str], None]

SAMPLES_PER_PERIOD = 400
# a state forgets how it began: until periods in a row differ by no more than this share
FEWEST_PERIODS, MOST_PERIODS = 3, 768
SETTLED = 1e-4
HELD_OUT_EVERY = 4


def amplitude(device: Device, frequency: float, acceleration: float) -> float:
    """Amplitude of the force's fundamental [N] at a frequency [Hz] and acceleration [m/s^2]."""
    return _fundamental(_steady(device, frequency, acceleration)[1])


def _steady(device: Device, frequency: float, acceleration: float) -> tuple[int, Array]:
    """Periods until the force repeats, and the force along them; at most `MOST_PERIODS`."""
    periods = FEWEST_PERIODS
    while True:
        motion = _sine(frequency, acceleration, periods)
        force = device.along(*motion, _first_state(device, frequency, acceleration))["total"]
        # of a quarter of the periods, for a swing that dies out comes and goes
        last = force.reshape(periods, -1)[-max(2, periods // 4) :]
        waves = np.fft.rfft(last, axis=1)[:, 1]
        change = np.max(np.abs(waves - waves[-1]))
        if not change > SETTLED * np.abs(waves[-1]) or periods >= MOST_PERIODS:
            return periods, force
        periods *= 2


def _first_state(device: Device, frequency: float, acceleration: float) -> Array:
    """States in which a shaft that is linear swings steadily already, or a bristle.

    Of a bristle a period maps the state on another one, linearly but for laws with a varying
    exponent: three in a row tell the one that comes back. A soft one takes hundreds of periods.
    """
    state = np.zeros(device.nstate)
    if device.nstate == 1:
        motion = _sine(frequency, acceleration, FEWEST_PERIODS)
        z = device.along(*motion, state)["state"][::SAMPLES_PER_PERIOD]
        bent = z[2] - 2 * z[1] + z[0]
        return np.array([z[0] - (z[1] - z[0]) ** 2 / bent if bent else z[1]])
    if device.series_stiffness:
        s = 2j * np.pi * frequency
        shaft = device.series_stiffness + device.series_damping * s
        flywheel = device.inertance * s**2 + device.flywheel_viscous * s
        terminal = acceleration / abs(s) ** 2
        turned = terminal * shaft / (shaft + flywheel)
        # a sine is the imaginary part
        state[-2:] = -turned.imag, (s * turned).imag
    return state


def _engine(device: Device, frequency: float, acceleration: float, motion: Kind) -> Array:
    """The same force from MuJoCo."""
    periods, _ = _steady(device, frequency, acceleration)
    state = _first_state(device, frequency, acceleration)
    along = _sine(frequency, acceleration, periods)
    return simulate_along(device, *along, state, motion)["total"]


def _sine(frequency: float, acceleration: float, periods: int) -> tuple[float, Array, Array, Array]:
    omega = 2 * np.pi * frequency
    phase = 2 * np.pi * np.arange(periods * SAMPLES_PER_PERIOD) / SAMPLES_PER_PERIOD
    size = acceleration / omega**2
    return (
        1 / (frequency * SAMPLES_PER_PERIOD),
        size * np.sin(phase),
        size * omega * np.cos(phase),
        -acceleration * np.sin(phase),
    )


def _fundamental(force: Array) -> float:
    last = force[-SAMPLES_PER_PERIOD:]
    return float(2 / SAMPLES_PER_PERIOD * np.abs(np.fft.rfft(last)[1]))


class Table:
    """Points of one or several tables."""

    def __init__(self, tables: Sequence[BenchTable]) -> None:
        join = np.concatenate
        order = np.argsort(join([table.frequency for table in tables]), kind="stable")
        self.frequency = join([table.frequency for table in tables])[order]
        self.force = join([table.force_amplitude for table in tables])[order]
        self.acceleration = join([table.acceleration_amplitude for table in tables])[order]
        if np.any(self.frequency <= 0) or np.any(self.force <= 0) or np.any(self.acceleration <= 0):
            raise ValueError(
                f"{tables[0].name}: a table needs frequencies and amplitudes above 0; "
                "remove the rows that are 0"
            )
        omega = 2 * np.pi * self.frequency
        self.scales = Scales(
            force=float(np.sqrt(np.mean(self.force**2) / 2)),
            displacement=float(np.sqrt(np.mean((self.acceleration / omega**2) ** 2) / 2)),
            velocity=float(np.sqrt(np.mean((self.acceleration / omega) ** 2) / 2)),
            acceleration=float(np.sqrt(np.mean(self.acceleration**2) / 2)),
        )
        self.motion: Kind = one_motion(tables)
        self.holdout = np.zeros(self.force.size, bool)
        self.holdout[HELD_OUT_EVERY // 2 :: HELD_OUT_EVERY] = True

    def predict(self, model: Model) -> Array:
        """Force amplitudes of a model [N], shape (n,)."""
        device = model.device()
        return np.array(
            [
                amplitude(device, f, a)
                for f, a in zip(self.frequency, self.acceleration, strict=True)
            ]
        )

    def error(self, model: Model) -> Array:
        """Relative errors, measured minus model, shape (n,)."""
        return (self.force - self.predict(model)) / self.force

    def fit(self, model: Model, mask: NDArray[np.bool_]) -> Fit:
        """Least squares of the relative errors over masked points."""
        if not model.free:
            return Fit(model, [self.error(model)], np.zeros((0, 0)), 1)
        variables = Variables.of(model.free, self.scales)

        def at(point: Array) -> Model:
            return replace(model, values={**model.values, **variables.decode(point)})

        found = minimise(
            lambda point: self.error(at(point))[mask],
            variables.encode(model.values),
            variables.bounds,
            tolerances=Tolerances(gradient=1e-8),
        )
        best = at(found.variables)
        freedom = max(int(mask.sum()) - len(variables), 1)
        size = variables.units(best.values)
        covariance = np.linalg.pinv(found.jacobian.T @ found.jacobian) * np.outer(size, size)
        covariance *= 2 * found.cost / freedom
        return Fit(best, [self.error(best)], covariance, found.evaluations, found.cost)

    def left_out(self, model: Model) -> Array:
        """Squared relative errors of every fit point when it is left out, shape (points,)."""
        squares = []
        for i in np.flatnonzero(~self.holdout):
            mask = ~self.holdout
            mask[i] = False
            squares.append(float(self.fit(model, mask).residual[0][i] ** 2))
        return np.array(squares)

    def rmse(self, model: Model) -> float:
        """Rms force error on held-out points [N]."""
        residual = (self.force - self.predict(model))[self.holdout]
        return float(np.sqrt(np.mean(residual**2)))


@dataclass(frozen=True, kw_only=True)
class Step:
    """An effect that a table shows: the fit with it, and the figures of the finding."""

    effect: str
    law: str | None
    fit: Fit
    squares: Array
    confidence: float
    rivals: list[Rival]


@dataclass(frozen=True, kw_only=True)
class Prepared:
    """Points of tables, the device as stated, and the baseline fitted."""

    tables: Sequence[BenchTable]
    table: Table
    device: Device | None
    before: Fit


@dataclass(frozen=True, kw_only=True)
class Searched:
    """The effects that a table shows, one on top of the other."""

    prepared: Prepared
    steps: tuple[Step, ...]

    @property
    def fit(self) -> Fit:
        """The extended model."""
        return self.steps[-1].fit if self.steps else self.prepared.before


def diagnose_table(
    tables: Sequence[BenchTable],
    device: Device | None = None,
    progress: Progress = lambda text: None,
) -> Diagnosis:
    """What a simulation lacks, from amplitudes at a list of frequencies.

    Raises
    ------
    ValueError
        Amplitudes or frequencies that are not above zero.
    """
    return diagnosis_of(searched(prepared(tables, device), progress))


def prepared(tables: Sequence[BenchTable], device: Device | None) -> Prepared:
    """The points, and the device as stated or the ideal inerter fitted to them.

    Raises
    ------
    ValueError
        Amplitudes or frequencies that are not above zero.
    """
    table = Table(without_copies(tables))
    start = float(np.mean(table.force / table.acceleration))
    baseline = baseline_model(device, start, parameters()["transition_velocity"].initial)
    before = table.fit(baseline, ~table.holdout)
    return Prepared(tables=tables, table=table, device=device, before=before)


def searched(start: Prepared, progress: Progress = lambda text: None) -> Searched:
    """What predicts the points left out best, as long as it helps at those held out."""
    table, steps = start.table, list[Step]()
    fit, squares = start.before, table.left_out(start.before.model)
    while len(steps) < CRITERIA.most_on_tables:
        progress(f"effect {len(steps) + 1}: trying every candidate")
        step = _best(table, start.before.model, fit, squares)
        if step is None or table.rmse(step.fit.model) >= table.rmse(fit.model):
            break
        steps.append(step)
        fit, squares = step.fit, step.squares
    return Searched(prepared=start, steps=tuple(steps))


def _tried(table: Table, baseline: Model, model: Model) -> list[Candidate]:
    """What amplitudes can show; of a stated friction law, which they can contradict, all of it."""
    present = [name for name, _ in effects_of(model, baseline)]
    stated = {
        each.key
        for each in stated_candidates(model, table.scales)
        if EFFECTS[each.effect].kind == "law"
    }
    return [
        each
        for each in candidates(model, table.scales)
        if (EFFECTS[each.effect].on_table or each.key in stated) and each.effect not in present
    ]


def _best(table: Table, baseline: Model, fit: Fit, squares: Array) -> Step | None:
    tried: list[Tried] = []
    for candidate in _tried(table, baseline, fit.model):
        fits = []
        for start in candidate.starts:
            free = tuple(name for name in start.free if name not in NUISANCES)
            if squares.size >= len(free) + CRITERIA.spare_points:
                fits.append(table.fit(replace(start, free=free), ~table.holdout))
        if fits:
            after = min(fits, key=lambda each: each.cost)
            tried.append(Tried(candidate, after, table.left_out(after.model)))
    good = [one for one in tried if _evidence(squares, one.squares) > CRITERIA.evidence]
    if not good:
        return None
    least = min((one.squares for one in good), key=np.sum)
    # a whole law has to do better than its level alone as surely as this has to do better than none
    best = plainest([e for e in good if _evidence(e.squares, least) <= CRITERIA.evidence])
    others = [one for one in tried if one.candidate.effect != best.candidate.effect]
    shares = win_shares([best.squares, squares, *(one.squares for one in others)])
    rivals = [
        Rival(one.candidate.effect, float(share))
        for one, share in zip(others, shares[2:], strict=True)
        if share > CRITERIA.rival_kept
    ]
    return Step(
        effect=best.candidate.effect,
        law=best.candidate.law,
        fit=best.fit,
        squares=best.squares,
        confidence=float(shares[0]),
        rivals=sorted(rivals, key=lambda r: -r.confidence),
    )


@dataclass(frozen=True)
class Tried:
    """A fitted candidate and its squared errors at points left out."""

    candidate: Candidate
    fit: Fit
    squares: Array

    @property
    def complexity(self) -> int:
        """Number of free coordinates that say something."""
        return self.fit.model.complexity


def _evidence(before: Array, after: Array) -> float:
    """Twice the log-likelihood ratio of errors at points left out."""
    return float(before.size * np.log(before.sum() / after.sum()))


def _findings(found: Searched, values: dict[str, ParameterValue]) -> list[Finding]:
    """In order of gain; each is measured on top of those before it."""
    rmse = found.prepared.table.rmse
    models = [found.prepared.before.model, *(step.fit.model for step in found.steps)]
    findings = []
    for step, before in zip(found.steps, models[:-1], strict=True):
        names = EFFECTS[step.effect].parameters
        finding = Finding(
            effect=step.effect, law=step.law, confidence=step.confidence,
            parameters={name: values[name] for name in names if name in values},
            rmse_before=rmse(before), rmse_after=rmse(step.fit.model), evidence="",
            rivals=step.rivals, motion=found.prepared.table.motion,
        )  # fmt: skip
        told = replace(finding, evidence=wording.evidence(finding))
        findings.append(with_side(told, step.fit.model))
    return sorted(findings, key=lambda finding: -finding.gain)


def diagnosis_of(found: Searched) -> Diagnosis:
    """What is said of it: findings, figures, what remains."""
    tables, table, before = found.prepared.tables, found.prepared.table, found.prepared.before
    fit = found.fit
    values = parameter_values(fit, found.prepared.device, motion=table.motion)
    spread = float(np.sqrt(np.mean(table.force**2)))

    def accuracy(model: Model) -> Accuracy:
        rmse = table.rmse(model)
        return Accuracy(model.stated(), rmse, rmse / spread)

    extended = accuracy(fit.model)
    relative = float(np.sqrt(np.mean(fit.residual[0] ** 2)))
    text = (
        f"The amplitudes scatter by {100 * relative:.1f} % about the model; a table cannot tell "
        "noise from structure further, a time record can."
    )
    points, needed = int((~table.holdout).sum()), len(before.model.free) + 1 + CRITERIA.spare_points
    if points < needed:
        text += (
            f" Of {points} fitted points no effect can be tried; {needed} are needed, and every "
            f"{HELD_OUT_EVERY}th more is held out."
        )
    remains = Unexplained(significant=False, fraction=0.0, depends_on=[], summary=text)
    device = fit.model.device()
    with quiet():
        engine = np.array(
            [
                _fundamental(_engine(device, f, a, table.motion))
                for f, a in zip(table.frequency, table.acceleration, strict=True)
            ]
        )
    mujoco = float(np.sqrt(np.mean((table.force - engine)[table.holdout] ** 2)))
    shown = TablePoints(
        frequency=table.frequency,
        acceleration=table.acceleration,
        force=table.force,
        baseline=table.predict(before.model),
        extended=table.predict(fit.model),
        holdout=table.holdout,
        motion=table.motion,
    )
    held = ", ".join(f"{f:g}" for f in table.frequency[table.holdout])
    diagnosis = Diagnosis(
        records=[
            RecordSummary(
                t.name,
                t.samples,
                0.0,
                "unused" if repeats_another(t) else "fit",
                [vars(w) for w in t.warnings],
            )
            for t in tables
        ],
        baseline=accuracy(before.model),
        findings=_findings(found, values),
        extended=extended,
        noise_floor=relative * float(np.mean(table.force)),
        unexplained=remains,
        engines={"mujoco": mujoco, "exudyn": None, "reference": None},
        verdict="",
        parameters=values,
        method={
            "split": f"held out: the points at {held} Hz",
            "held_out_samples": int(table.holdout.sum()),
        },
        curves=[],
        points=shown,
        motion=table.motion,
    )
    return replace(diagnosis, verdict=wording.verdict(diagnosis))
