"""The files of a run: all of them or none."""

from __future__ import annotations

from pathlib import Path

from inerter.folder import json_text, write_files
from inerter.simulate.page import render_page
from inerter.simulate.record import device_csv, device_names, vehicle_csv
from inerter.simulate.run import SimulatedRun
from inerter.simulate.summary import summary


def write_run(run: SimulatedRun, folder: Path) -> list[str]:
    """Write DEVICE.csv per device, vehicle/record.csv, simulation.json and simulation.html.

    Everything is written into a temporary folder first and moved when complete. The vehicle's
    record has a folder of its own, so that a folder can be diagnosed as a whole.

    Returns
    -------
    list of str
        The files, relative to the folder.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    files = {f"{name}.csv": device_csv(run, device)
             for name, device in zip(device_names(run), run.devices, strict=True)}  # fmt: skip
    if run.vehicle:
        files["vehicle/record.csv"] = vehicle_csv(run)
    files["simulation.json"] = json_text(summary(run))
    files["simulation.html"] = render_page(run)
    return write_files(folder, files)
