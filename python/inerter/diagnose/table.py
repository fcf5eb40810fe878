"""Diagnosis of a bench table: amplitudes of force and acceleration at a list of frequencies.

A model's amplitude is that of the fundamental of its force along x = X sin(w t) in steady state.
The errors of such tables grow with the force, so fits and decisions use relative errors; a constant
force and a delay leave no trace in amplitudes and cannot be found.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import NUISANCES
from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.scales import Scales
from inerter.core import Device, parameters
from inerter.diagnose import wording
from inerter.diagnose.baseline import baseline_model
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import effects_of
from inerter.diagnose.decision import CRITERIA
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
from inerter.diagnose.statistics import win_shares
from inerter.diagnose.values import parameter_values
from inerter.estimation.least_squares import Tolerances, minimise
from inerter.estimation.variables import Variables
from inerter.identify.fit import Fit
from inerter.identify.model import Model
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
    """States in which a shaft that is linear swings steadily already, others at zero."""
    state = np.zeros(device.nstate)
    if device.series_stiffness:
        s = 2j * np.pi * frequency
        shaft = device.series_stiffness + device.series_damping * s
        flywheel = device.inertance * s**2 + device.flywheel_viscous * s
        terminal = acceleration / abs(s) ** 2
        turned = terminal * shaft / (shaft + flywheel)
        # a sine is the imaginary part
        state[-2:] = -turned.imag, (s * turned).imag
    return state


def _engine(device: Device, frequency: float, acceleration: float) -> Array:
    """The same force from MuJoCo."""
    periods, _ = _steady(device, frequency, acceleration)
    state = _first_state(device, frequency, acceleration)
    return simulate_along(device, *_sine(frequency, acceleration, periods), state)["total"]


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


class _Table:
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
    table = _Table(without_copies(tables))
    fit_mask = ~table.holdout
    start = float(np.mean(table.force / table.acceleration))
    transition = parameters()["transition_velocity"].initial
    baseline = baseline_model(device, start, transition)
    before = table.fit(baseline, fit_mask)
    fit, squares = before, table.left_out(before.model)
    findings: list[Finding] = []
    while len(findings) < CRITERIA.most_on_tables:
        progress(f"effect {len(findings) + 1}: trying every candidate")
        step = _best(table, baseline, fit, squares)
        if step is None:
            break
        effect, after, after_squares, confidence, rivals = step
        rmse_before, rmse_after = table.rmse(fit.model), table.rmse(after.model)
        if rmse_after >= rmse_before:
            break
        fit, squares = after, after_squares
        findings.append(
            Finding(
                effect=effect,
                law=None,
                confidence=confidence,
                parameters={},
                rmse_before=rmse_before,
                rmse_after=rmse_after,
                evidence="",
                rivals=rivals,
            )
        )
    values = parameter_values(fit, device)
    findings = [
        replace(f, parameters={n: values[n] for n in EFFECTS[f.effect].parameters if n in values})
        for f in findings
    ]
    findings = [replace(f, evidence=wording.evidence(f)) for f in findings]
    findings.sort(key=lambda finding: -finding.gain)
    return _diagnosis(tables, table, before, fit, findings, values)


def _best(
    table: _Table, baseline: Model, fit: Fit, squares: Array
) -> tuple[str, Fit, Array, float, list[Rival]] | None:
    tried = []
    for candidate in candidates(fit.model, table.scales):
        present = [name for name, _ in effects_of(fit.model, baseline)]
        if EFFECTS[candidate.effect].on_table and candidate.effect not in present:
            fits = []
            for start in candidate.starts:
                free = tuple(name for name in start.free if name not in NUISANCES)
                fits.append(table.fit(replace(start, free=free), ~table.holdout))
            after = min(fits, key=lambda each: each.cost)
            tried.append((candidate.effect, after, table.left_out(after.model)))
    good = [
        one
        for one in tried
        if squares.size >= len(one[1].model.free) + CRITERIA.spare_points
        and squares.size * np.log(squares.sum() / one[2].sum()) > CRITERIA.evidence
    ]
    if not good:
        return None
    effect, after, best = min(good, key=lambda one: one[2].sum())
    others = [one for one in tried if one[0] != effect]
    shares = win_shares([best, squares, *(one[2] for one in others)])
    rivals = [
        Rival(one[0], float(share))
        for one, share in zip(others, shares[2:], strict=True)
        if share > CRITERIA.rival_kept
    ]
    return effect, after, best, float(shares[0]), sorted(rivals, key=lambda r: -r.confidence)


def _diagnosis(
    tables: Sequence[BenchTable],
    table: _Table,
    before: Fit,
    fit: Fit,
    findings: list[Finding],
    values: dict[str, ParameterValue],
) -> Diagnosis:
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
                _fundamental(_engine(device, f, a))
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
        findings=findings,
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
    )
    return replace(diagnosis, verdict=wording.verdict(diagnosis))
