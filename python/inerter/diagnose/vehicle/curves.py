"""Measured and simulated channels of every run, for the report."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.result import RunCurves
from inerter.diagnose.vehicle.model import VehicleModel
from inerter.diagnose.vehicle.problem import DrivenProblem
from inerter.diagnose.vehicle.simulate import VehicleSimulator


def channel_curves(
    simulator: VehicleSimulator,
    whole: DrivenProblem,
    held: Sequence[NDArray[np.bool_]],
    device: str,
    final: VehicleModel,
) -> list[RunCurves]:
    """Every channel of every run, beside the motion of one device.

    Parameters
    ----------
    simulator, whole
        All runs.
    held
        Samples of every run that are held out.
    device
        Name of the device whose motion is shown.
    final
        The extended model.
    """
    models = [VehicleModel(), final]
    residuals = whole.residuals(models)
    curves = []
    for i, drive in enumerate(whole.drives):
        x, v = simulator.device_motion(final, drive)[device]
        a = np.gradient(v, drive.step)
        motion = drive.at_samples(np.column_stack([x, v, a]))
        simulated = simulator.outputs(models, drive)
        mask = whole.masks[i]
        for k, channel in enumerate(whole.channels):
            lines = []
            for m in range(2):
                fitted = drive.measured[:, k] - residuals[m][i][:, k] * channel.spread
                zero = np.mean((fitted - simulated[m][:, k])[mask])
                lines.append(np.where(mask, fitted, simulated[m][:, k] + zero))
            curves.append(
                RunCurves(
                    name=f"{drive.name}: {channel.name.replace('_', ' ')}",
                    role="holdout" if held[i].any() else "fit",
                    time=drive.start + drive.time,
                    displacement=motion[:, 0],
                    velocity=motion[:, 1],
                    acceleration=motion[:, 2],
                    force=drive.measured[:, k],
                    baseline=lines[0],
                    extended=lines[1],
                    holdout=held[i],
                    inner=mask,
                    quantity=channel.name.replace("_", " "),
                    unit=channel.unit,
                )
            )
    return curves
