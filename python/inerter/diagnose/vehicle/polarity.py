"""Channels that run against their simulation, or are a usual factor times it: signs and units."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.vehicle.drive import RecordedDrive
from inerter.diagnose.vehicle.mapping import Output
from inerter.records.record import RecordWarning

Array = NDArray[np.float64]
# a channel that runs against its simulation as surely as this has another sign
_OPPOSITE = -0.5
# from this correlation on a channel follows its simulation, and its scale tells its unit
_ALIKE, _NEAR = 0.8, 0.2
_FACTORS = {
    1 / 9.80665: "is it in g", 9.80665: "is it in m/s^2, not in g",
    1e3: "is it in milli-units, such as mm", 1e-3: "is it in kilo-units, such as kN",
    57.2958: "is it in degrees", 1 / 57.2958: "is it in radians, not in degrees",
    1 / 0.0254: "is it in inches",
}  # fmt: skip


def polarity(
    outputs: Sequence[Output], drives: Sequence[RecordedDrive], simulated: Sequence[Array]
) -> tuple[Array, list[str], list[RecordWarning]]:
    """Signs by which the measured outputs count, what was turned, and what is doubtful.

    A tyre's force is counted with the sign that fits; any other is only warned of.
    simulated: of each run (n, outputs).
    """
    signs = np.ones(len(outputs))
    notes: list[str] = []
    warnings: list[RecordWarning] = []
    for i, output in enumerate(outputs):
        measured = np.concatenate([d.measured[:, i] - d.measured[:, i].mean() for d in drives])
        model = np.concatenate([s[:, i] - s[:, i].mean() for s in simulated])
        size = float(np.linalg.norm(measured) * np.linalg.norm(model))
        if not size:
            continue
        alike = float(measured @ model) / size
        if alike > _OPPOSITE:
            pass
        elif output.load:
            signs[i] = -1.0
            notes.append(f"{output.column} counted with the other sign")
        else:
            text = f"{output.column!r} runs against the simulation: another sign convention?"
            warnings.append(RecordWarning("sign_flip", text))
        ratio = float(np.linalg.norm(measured) / np.linalg.norm(model))
        factor = next((f for f in _FACTORS if abs(ratio / f - 1) < _NEAR), None)
        if factor is not None and abs(alike) > _ALIKE:
            warnings.append(
                RecordWarning(
                    "unit_suspect",
                    f"{output.column!r} is {ratio:.3g} times its simulation: {_FACTORS[factor]}? "
                    "Write its unit in brackets behind its name",
                )
            )
    return signs, notes, warnings
