"""What can be predicted and has no name, kept as a force over displacement and velocity.

A restoring-force surface (Masri and Caughey 1979) on what the named causes leave: the device's
`force_map`. It is fitted, and says nothing of a cause. How smooth it is, and whether its columns
are fine near rest, is chosen on folds left out of the fitted data; whether it is carried at all by
held-out data, which had no say.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from inerter.diagnose.budget.ceiling import SURE, Sums, fitted_masks, matters, parts_of
from inerter.diagnose.data import Data
from inerter.diagnose.statistics import Interval, advantage, block_squares, gain_interval
from inerter.identify.fit import rms
from inerter.identify.model import Model
from inerter.identify.prediction import with_late_motion
from inerter.identify.split import blocks

Array = NDArray[np.float64]

Carrying = Literal["any", "passive", "nothing"]
"""What an extended device may carry: anything, nothing that would give energy, nothing at all."""

KIND = "force_map"
# the largest grid that a device holds
ROWS, COLUMNS = 24, 16
# widths within which the columns are even, per largest speed; None: even all over
SCALES = (None, 0.1, 0.02)
# smoothness, per mean square of a value's column; and by what values shrink to 0 where no data are
STIFFNESS = (10.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4)
SHRINK = 1e-6
# samples below this share of the data lie beyond the first and the last row and column
TAIL = 1e-3


@dataclass(frozen=True, kw_only=True)
class Carried:
    """A map that the extended device carries.

    Attributes
    ----------
    model : Model
        The extended model with the map.
    parameters : dict
        What the map adds to the device's parameters.
    rmse_before, rmse_after : float
        Held-out error of the named causes alone, and with the map [N].
    interval : tuple of float, optional
        95 % interval of the gain.
    """

    model: Model
    parameters: dict[str, float | str]
    rmse_before: float
    rmse_after: float
    interval: Interval | None

    def json(self) -> dict[str, Any]:
        """As in the contract, with what is carried."""
        return {
            "kind": KIND,
            "cause": None,
            "rmse_before": self.rmse_before,
            "rmse_after": self.rmse_after,
            "gain": 1.0 - self.rmse_after / self.rmse_before,
            "gain_interval": self.interval,
            "parameters": dict(self.parameters),
        }


def carried(
    data: Data,
    model: Model,
    noise: float,
    motion: float = 0.0,
    *,
    passive: bool = False,
    learnt: Data | None = None,
) -> Carried | None:
    """A map of what a model leaves; None where it does not pay on held-out data.

    Parameters
    ----------
    data
        The runs, and how they are divided.
    model
        The named causes.
    noise, motion
        Of force and motion, and of the motion alone, rms [N]; see `ceiling.matters`.
    passive
        Leave out what of the map would give energy.
    learnt
        What the map is fitted to, where that is not what of `data` is fitted.
    """
    if KIND in model.texts:
        return None
    errors = data.raw.errors(model)
    if learnt is None or learnt is data:
        found = _fitted(data, model, errors)
    else:
        found = _fitted(learnt, model, learnt.raw.errors(model))
    if found is None:
        return None
    found |= {"force_map_passive": 1.0} if passive else {}
    text = str(found.pop(KIND))
    rich = Model(model.friction, {**model.values, **found}, model.free, {**model.texts, KIND: text})
    rest = data.raw.errors(rich)
    counted = blocks(data.raw.masks)
    before, after = block_squares(errors, counted), block_squares(rest, counted)
    total = max(sum(int(mask.sum()) for mask in data.raw.masks), 1)
    takes = float(np.sqrt(max(before.sum() - after.sum(), 0.0) / total))
    if not matters(data.whole, data.raw.masks, takes, noise, motion):
        return None
    if advantage(before, after) < SURE:
        return None
    return Carried(
        model=rich,
        parameters={KIND: text, **found},
        rmse_before=rms(errors, data.raw.masks),
        rmse_after=rms(rest, data.raw.masks),
        interval=gain_interval(before, after),
    )


def _fitted(data: Data, model: Model, errors: Sequence[Array]) -> dict[str, Any] | None:
    """Parameters of the map that predicts folds left out best; None where none does."""
    fit = fitted_masks(data.whole, data.full, errors)
    parts = parts_of(data.full, fit)
    if len(parts) < 2:
        return None
    rest = model.values.get("rest_length", 0.0)
    runs = [with_late_motion(model, run)[0] for run in data.whole]
    motions = [(run.displacement - rest, run.velocity) for run in runs]
    inside = [(x[mask], v[mask]) for (x, v), mask in zip(motions, fit, strict=True)]
    places, speeds = (np.concatenate(each) for each in zip(*inside, strict=True))
    lower, upper = np.quantile(places, [TAIL, 1 - TAIL])
    fastest = float(np.quantile(np.abs(speeds), 1 - TAIL))
    if not (upper > lower and fastest > 0.0):
        return None
    best, chosen = np.inf, None
    for share in SCALES:
        scale = None if share is None else share * fastest
        grid = _Grid(float(lower), float(upper), fastest, scale)
        sums = Sums([_products(grid, motions, errors, part) for part in parts])
        last = np.inf
        for stiffness in STIFFNESS:
            penalty = grid.penalty(stiffness)
            error = sums.left_out(grid.everything, penalty)
            if error < min(best, sums.square):
                best = error
                chosen = grid, sums.weights(grid.everything, penalty)
            if error > last:
                break
            last = error
    if chosen is None:
        return None
    grid, weights = chosen
    return grid.parameters(weights)


@dataclass(frozen=True)
class _Grid:
    """Where the values of a map stand."""

    lower: float
    upper: float
    speed: float
    scale: float | None

    @property
    def everything(self) -> NDArray[np.intp]:
        return np.arange(ROWS * COLUMNS)

    def columns(self, x: Array, v: Array) -> sparse.csr_array:
        """The map's force per coefficient, (n, ROWS * COLUMNS)."""
        s = (x - self.lower) / (self.upper - self.lower)
        t = 0.5 * (1.0 + self._stretched(v) / self._stretched(self.speed))
        down, across = _weights(s, ROWS), _weights(t, COLUMNS)
        count = np.arange(x.size)
        index = (down[0][:, :, None] * COLUMNS + across[0][:, None, :]).reshape(x.size, 16)
        share = (down[1][:, :, None] * across[1][:, None, :]).reshape(x.size, 16)
        row = np.repeat(count, 16)
        made = sparse.coo_array(
            (share.ravel(), (row, index.ravel())), shape=(x.size, ROWS * COLUMNS)
        )
        return made.tocsr()

    def penalty(self, stiffness: float) -> Array:
        """What bends, and, little, what is not 0, as a square form of the coefficients."""
        down, across = (np.diff(np.eye(n), 2, axis=0) for n in (ROWS, COLUMNS))
        bends = np.kron(down.T @ down, np.eye(COLUMNS)) + np.kron(np.eye(ROWS), across.T @ across)
        return stiffness * bends + SHRINK * np.eye(ROWS * COLUMNS)

    def parameters(self, coefficients: Array) -> dict[str, Any]:
        """The device's parameters: values at rows and columns in place of coefficients."""
        grid = coefficients.reshape(ROWS, COLUMNS)
        values = _through(ROWS) @ grid @ _through(COLUMNS).T
        # what a force is written with, no more
        size = float(np.max(np.abs(values), initial=0.0)) or 1.0
        digits = 5 - int(np.floor(np.log10(size)))
        found: dict[str, Any] = {
            KIND: " ".join(repr(round(float(each), digits) + 0.0) for each in values.ravel()),
            "force_map_columns": float(COLUMNS),
            "force_map_lower": self.lower,
            "force_map_upper": self.upper,
            "force_map_speed": self.speed,
        }
        return found | ({} if self.scale is None else {"force_map_scale": self.scale})

    def _stretched(self, v: Any) -> Any:
        return v if self.scale is None else np.arcsinh(v / self.scale)


def _weights(share: Array, count: int) -> tuple[NDArray[np.intp], Array]:
    """Which four coefficients count at a place, as a share of the axis, and how much: (n, 4) each.

    Those beyond an edge mirror those within, as the map is level there.
    """
    at = np.clip(share, 0.0, 1.0) * (count - 1)
    first = np.minimum(at.astype(np.intp), count - 2)
    u = at - first
    w = 1.0 - u
    weight = np.column_stack([w**3, 3 * u**3 - 6 * u**2 + 4, 3 * (u**2 - u**3 + u) + 1, u**3])
    index = np.abs(first[:, None] + np.arange(-1, 3))
    return np.where(index >= count, 2 * (count - 1) - index, index), weight / 6.0


def _through(count: int) -> Array:
    """Values at the places per coefficient."""
    matrix = (4.0 * np.eye(count) + np.eye(count, k=1) + np.eye(count, k=-1)) / 6.0
    matrix[0, 1] = matrix[-1, -2] = 2.0 / 6.0
    return matrix


def _products(
    grid: _Grid,
    motions: Sequence[tuple[Array, Array]],
    errors: Sequence[Array],
    part: Sequence[NDArray[np.bool_]],
) -> tuple[Array, Array, float]:
    gram = np.zeros((ROWS * COLUMNS, ROWS * COLUMNS))
    right, square = np.zeros(ROWS * COLUMNS), 0.0
    for (x, v), error, mask in zip(motions, errors, part, strict=True):
        rows, y = grid.columns(x[mask], v[mask]), error[mask]
        gram += (rows.T @ rows).toarray()
        right += rows.T @ y
        square += float(y @ y)
    return gram, right, square
