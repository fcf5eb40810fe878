"""The files of a diagnosis."""

from __future__ import annotations

import json
from pathlib import Path

from inerter.catalogue.coordinates import CHANNEL_UNITS
from inerter.core import Device
from inerter.device_file import device_text
from inerter.diagnose.result import Diagnosis
from inerter.diagnose.vehicle.outcome import SystemDiagnosis
from inerter.folder import file_names, write_files
from inerter.motion_units import unit
from inerter.report.page import SURE, render_report
from inerter.rig import device_mjcf


def write_outputs(diagnosis: Diagnosis, folder: Path) -> None:
    """Write diagnosis.json, report.html, device.toml and model.xml.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    if isinstance(diagnosis, SystemDiagnosis):
        _write_system(diagnosis, folder)
        return
    device = Device(**diagnosis.written)
    names = ", ".join(record.name for record in diagnosis.records)
    doubt = {
        name: f"; confidence {finding.confidence:.2g}"
        for finding in diagnosis.findings
        for name in finding.parameters
        if finding.confidence < SURE
    }
    comments = {
        name: f"{value.unit} (standard error {value.stderr:.2g}{doubt.get(name, '')})"
        for name, value in diagnosis.parameters.items()
    }
    comments = {name: text.removeprefix("1 ") for name, text in comments.items()}
    comments |= _carried_comment(diagnosis)
    # what the user states, and where a spring was found to rest beside it
    shift = {"rest_length": device.rest_length + diagnosis.rest_length}
    rest_length = shift if diagnosis.rest_length else {}
    toml = device_text(
        device.replace(**rest_length),
        comments,
        diagnosis.extended.delay,
        f"identified by inerter diagnose from {names}{_only_in_the_record(diagnosis)}",
        diagnosis.motion,
        diagnosis.extended.filters,
    )
    before = diagnosis.extended.channels.get("grip_mass", 0.0)
    model = device_mjcf(device, "identified_device", motion=diagnosis.motion, before=before)
    write_files(
        folder,
        {
            "diagnosis.json": json.dumps(diagnosis.json(), indent=2, allow_nan=False) + "\n",
            "device.toml": toml,
            "model.xml": model,
            "report.html": render_report(diagnosis, toml, model),
        },
    )


def _only_in_the_record(diagnosis: Diagnosis) -> str:
    """A line on what was found of the record that no line of a device's file can state, if any."""
    found = [
        f"{name} = {value:.4g} {unit(diagnosis.motion, CHANNEL_UNITS[name])}"
        for name, value in diagnosis.extended.channels.items()
        if name != "delay" and "_filter" not in name
    ]
    if not found:
        return ""
    text = f"\nbeside this device the record shows: {', '.join(found)}"
    if "grip_mass" in diagnosis.extended.channels:
        text += "\n(grip_mass: a second inerter between the same terminals, as in model.xml)"
    return text


def _carried_comment(diagnosis: Diagnosis) -> dict[str, str]:
    """What a file says before the map that a device carries, if it does."""
    kept = diagnosis.unexplained.carried
    if kept is None:
        return {}
    figures = f"{kept['rmse_before']:.3g} -> {kept['rmse_after']:.3g} {unit(diagnosis.motion, 'N')}"
    return {
        "force_map": f"fitted, no cause: {figures} rms on held-out data; the lines force_map... "
        "may be left out"
    }


def _write_system(diagnosis: SystemDiagnosis, folder: Path) -> None:
    """The user's whole model extended, and its devices; the first one is device.toml."""
    names = ", ".join(record.name for record in diagnosis.records)
    tomls = {
        name: device_text(device, {}, 0.0, f"{name}: identified by inerter diagnose from {names}")
        for name, device in diagnosis.devices.items()
    }
    safe = file_names(list(tomls), "unnamed")
    several = {f"device_{name}.toml": text for name, text in zip(safe, tomls.values(), strict=True)}
    toml = next(iter(tomls.values()))
    write_files(
        folder,
        {
            "diagnosis.json": json.dumps(diagnosis.json(), indent=2, allow_nan=False) + "\n",
            "device.toml": toml,
            **(several if len(several) > 1 else {}),
            "model.xml": diagnosis.model_xml,
            "report.html": render_report(diagnosis, toml, diagnosis.model_xml),
        },
    )
