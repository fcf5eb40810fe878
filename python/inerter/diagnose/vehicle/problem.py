"""What is minimised: measured less simulated channels, each per its spread, nuisances taken out.

Nuisances are linear in the residual and say nothing about physics: the zero of an accelerometer or
a length and the static part of a tyre's force (a constant per run), and the state in which a run
begins (what a small change of it does, worked out once at the user's model).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.scales import Range
from inerter.diagnose.vehicle.drive import RecordedDrive
from inerter.diagnose.vehicle.model import VehicleModel
from inerter.diagnose.vehicle.simulate import Start, VehicleSimulator
from inerter.estimation.least_squares import in_step
from inerter.estimation.variables import Variables

Array = NDArray[np.float64]
# the first part of a run in which what came before it decays is not used
_DECAYED = 0.03
_LONGEST_SETTLING = 0.2
# beyond this many degrees of freedom the initial state is not fitted, only faded out
_MOST_DOFS = 8


@dataclass(frozen=True)
class ComparedChannel:
    """An output's name, unit and noise-free spread over the runs (SI units)."""

    name: str
    unit: str
    spread: float


@dataclass(kw_only=True)
class DrivenProblem:
    """Runs with what was measured and how it is compared.

    Attributes
    ----------
    drives : list of RecordedDrive
        The runs.
    masks : list of ndarray (n,)
        Samples that are compared.
    nuisance : list of ndarray (n * outputs, q)
        Orthonormal on the masked samples, zero elsewhere; rows by sample, then output.
    """

    simulator: VehicleSimulator
    drives: list[RecordedDrive]
    channels: list[ComparedChannel]
    masks: list[NDArray[np.bool_]] = field(default_factory=list)
    nuisance: list[Array] = field(default_factory=list)
    waves: list[Array] = field(default_factory=list, repr=False)

    def __post_init__(self) -> None:
        self.spreads = np.array([channel.spread for channel in self.channels])
        if not self.masks:
            self._settle()

    def _settle(self) -> None:
        """Masks and nuisance columns of every run."""
        for drive in self.drives:
            waves = self._initial_state(drive)
            settled = _settling_samples(waves, drive)
            mask = np.arange(drive.time.size) >= settled
            self.masks.append(mask)
            self.waves.append(waves)
            self.nuisance.append(self._columns(waves, mask))

    def restricted(self, masks: Sequence[NDArray[np.bool_]]) -> DrivenProblem:
        """The runs and samples that are in masks too; runs without any are left out."""
        both = [own & wanted for own, wanted in zip(self.masks, masks, strict=True)]
        used = [i for i, mask in enumerate(both) if mask.any()]
        return DrivenProblem(
            simulator=self.simulator,
            drives=[self.drives[i] for i in used],
            channels=self.channels,
            masks=[both[i] for i in used],
            nuisance=[self._columns(self.waves[i], both[i]) for i in used],
            waves=[self.waves[i] for i in used],
        )

    def _initial_state(self, drive: RecordedDrive) -> Array:
        """What small changes of the initial state do, (count, n, outputs), per spread."""
        base = VehicleModel()
        model = self.simulator.user.model
        if model.nv > _MOST_DOFS or model.nq != model.nv:
            return np.empty((0, drive.time.size, len(self.channels)))
        start = self.simulator.start(model, drive)
        moves = []
        for i in range(model.nv):
            for velocity in (False, True):
                move = np.zeros(model.nv)
                move[i] = 1e-2 if velocity else 1e-4
                moves.append((move * (not velocity), move * velocity))
        starts = [start, *(Start(start.qpos + q, v) for q, v in moves)]
        run = self.simulator.outputs([base] * len(starts), drive, starts)
        waves = (run[1:] - run[0]) / self.spreads
        return waves[np.isfinite(waves).all(axis=(1, 2))]

    def _columns(self, waves: Array, mask: NDArray[np.bool_]) -> Array:
        outputs = self.simulator.channels.outputs
        rows = np.repeat(mask, len(outputs))
        columns = [wave.ravel() * rows for wave in waves]
        for i, output in enumerate(outputs):
            if output.floating or output.load:
                constant = np.zeros((mask.size, len(outputs)))
                constant[mask, i] = 1.0
                columns.append(constant.ravel())
        if not columns:
            return np.empty((rows.size, 0))
        table = np.column_stack(columns)
        size = np.linalg.norm(table, axis=0)

        # what has died away by now is no nuisance any more
        table = table[:, size > 1e-6 * np.sqrt(mask.sum())]
        u, s, _ = np.linalg.svd(table / np.linalg.norm(table, axis=0), full_matrices=False)
        return u[:, s > 1e-6 * s[0]] if s.size else np.empty((rows.size, 0))

    def residuals(self, models: Sequence[VehicleModel]) -> list[list[Array]]:
        """Per model and run: measured less simulated per spread, (n, outputs), 0 where unmasked."""
        found: list[list[Array]] = [[] for _ in models]
        for drive, mask, basis in zip(self.drives, self.masks, self.nuisance, strict=True):
            simulated = self.simulator.outputs(models, drive)
            for k in range(len(models)):
                rest = (drive.measured - simulated[k]) / self.spreads
                rest[~mask] = 0.0
                flat = rest.ravel()
                found[k].append((flat - basis @ (basis.T @ flat)).reshape(rest.shape))
        return found

    def stacked(self, models: Sequence[VehicleModel]) -> Array:
        """The residuals of every run in one row per model, (models, samples * outputs)."""
        rows = self.residuals(models)
        return np.array([np.concatenate([r.ravel() for r in row]) for row in rows])

    @property
    def count(self) -> int:
        """Samples that are compared."""
        return int(sum(mask.sum() for mask in self.masks))

    def error(self, residual: Array) -> float:
        """Root of the mean over channels of the squared error per spread."""
        return float(np.sqrt(np.sum(residual**2) / (self.count * len(self.channels))))

    def noise(self, residual: Array) -> float:
        """White noise in a stacked residual, as `error` counts it: from its third differences.

        Structure that is smooth over a few samples does not count.
        """
        square, at = 0.0, 0
        for mask in self.masks:
            size = mask.size * len(self.channels)
            rest = residual[at : at + size].reshape(mask.size, -1)[mask]
            at += size
            if len(rest) > 8:
                square += len(rest) * float(np.sum(np.mean(np.diff(rest, 3, axis=0) ** 2, 0) / 20))
        return float(np.sqrt(square / (self.count * len(self.channels))))

    def part(self, seconds: float) -> DrivenProblem:
        """The first seconds of every run, after settling."""
        drives: list[RecordedDrive] = []
        masks: list[NDArray[np.bool_]] = []
        columns: list[Array] = []
        for drive, mask, basis in zip(self.drives, self.masks, self.nuisance, strict=True):
            first = float(drive.time[int(np.argmax(mask))])
            drives.append(drive.part(first + seconds))
            size = drives[-1].time.size
            masks.append(mask[:size])
            cut = basis[: size * len(self.channels)]
            columns.append(np.linalg.qr(cut)[0] if cut.size else cut)
        return DrivenProblem(
            simulator=self.simulator,
            drives=drives,
            channels=self.channels,
            masks=masks,
            nuisance=columns,
        )


def _settling_samples(waves: Array, drive: RecordedDrive) -> int:
    """Samples until the initial state is all but forgotten, at most a share of the run."""
    most = int(_LONGEST_SETTLING * drive.time.size)
    if not len(waves):
        return most // 2
    size = np.linalg.norm(waves, axis=2)
    late = np.maximum.accumulate(size[:, ::-1], axis=1)[:, ::-1]
    gone = np.all(late < _DECAYED * size.max(axis=1, keepdims=True), axis=0)
    return min(int(np.argmax(gone)), most) if gone.any() else most


# --- least squares -----------------------------------------------------------------------------


@dataclass(frozen=True)
class VehicleFit:
    """A fitted model: residual (m,), Jacobian (m, p) in search variables, error per spread."""

    model: VehicleModel
    residual: Array
    jacobian: Array
    error: float
    sizes: Mapping[str, Range]

    def units(self) -> Array:
        """Coordinate per search variable, (p,)."""
        return Variables.among(self.model.free, self.sizes).units(self.model.values)


def fit_all(
    problem: DrivenProblem,
    models: Sequence[tuple[VehicleModel, Mapping[str, Range]]],
    iterations: int = 6,
    enough: float = 1e-3,
    last: bool = True,
) -> list[VehicleFit]:
    """Fit several models at once; every derivative's simulations are in one batch.

    Parameters
    ----------
    problem : DrivenProblem
        Runs and masks.
    models : sequence of (VehicleModel, sizes)
        With starting values, and how each free coordinate is searched.
    iterations : int
        Most steps of each.
    enough : float
        Relative fall of the error below which a search stops.
    last : bool
        Whether the Jacobian is worked out at the end again; else it is that of the last step.
    """
    searches = [Variables.among(model.free, sizes) for model, sizes in models]

    def at(number: int, point: Array) -> VehicleModel:
        return models[number][0].at(searches[number].decode(point))

    found = in_step(
        lambda jobs: problem.stacked([at(number, point) for number, point in jobs]),
        [
            (search.encode(model.values), search.bounds)
            for search, (model, _) in zip(searches, models, strict=True)
        ],
        iterations,
        enough,
        last,
    )
    return [
        VehicleFit(
            at(i, each.variables), each.residual, each.jacobian, problem.error(each.residual),
            models[i][1],
        )
        for i, each in enumerate(found)
    ]  # fmt: skip
