"""Measured and simulated channels of every run, for the report."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.result import RunCurves
from inerter.diagnose.system.model import SystemModel
from inerter.diagnose.system.problem import Problem
from inerter.diagnose.system.simulate import Simulator


def channel_curves(
    simulator: Simulator,
    whole: Problem,
    held: Sequence[NDArray[np.bool_]],
    device: str,
    final: SystemModel,
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
    models = [SystemModel(), final]
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
                    f"{drive.name}: {channel.name.replace('_', ' ')}",
                    "holdout" if held[i].any() else "fit",
                    drive.start + drive.time,
                    motion[:, 0],
                    motion[:, 1],
                    motion[:, 2],
                    drive.measured[:, k],
                    lines[0],
                    lines[1],
                    held[i],
                    mask,
                    quantity=channel.name.replace("_", " "),
                    unit=channel.unit,
                )
            )
    return curves
