"""The files of an identification, and its summary in the terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from inerter.device_file import device_text
from inerter.folder import json_text as finite_json
from inerter.folder import write_files
from inerter.identify.figures import picture
from inerter.identify.result import Estimate, Identification
from inerter.motion_units import force_word, words
from inerter.rig import device_mjcf


def json_text(result: Identification) -> str:
    """What --json prints."""
    return finite_json(result.json())


def write_identification(result: Identification, folder: Path) -> list[str]:
    """Write identification.json, identification.png, device.toml and model.xml; their names.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    best = result.best
    comments = {
        name: f"{each.unit} (standard error {each.stderr:.2g})".removeprefix("1 ")
        for name, each in best.parameters.items()
    }
    names = ", ".join(record.name for record in result.used)
    title = f"identified by inerter identify from {names}: {best.law}"
    return write_files(
        folder,
        {
            "identification.json": json_text(result),
            "identification.png": picture(result),
            "device.toml": device_text(
                best.device,
                comments,
                best.delay,
                title,
                result.motion,
                {name: each.text for name, each in best.filters.items()},
            ),
            "model.xml": device_mjcf(best.device, "identified_device", motion=result.motion),
        },
    )


def print_identification(result: Identification, out: Console) -> None:
    """Laws by their held-out error, then the parameters of the best one."""
    newton, metre = words(result.motion, "N"), words(result.motion, "m")
    laws = Table(
        title=f"{force_word(result.motion)} error on held-out data ({result.split.description})"
    )
    for column in ("law", f"rms error [{newton}]", "95 % interval", "on fitted data", "seconds"):
        left = column == "law"
        laws.add_column(column, justify="left" if left else "right", overflow="fold")
    for each in result.results:
        name = each.law if each.converged else f"{each.law} (not converged)"
        laws.add_row(
            name, f"{each.rmse:.4g}", f"{each.low:.4g} ... {each.high:.4g}",
            f"{each.fit_rmse:.4g}", f"{each.seconds:.1f}",
        )  # fmt: skip
    out.print(laws)
    for text in doubts(result):
        out.print(f"Note: {text}.")
    best = result.best
    if best.motion:
        out.print(
            f"simulated from the measured force, the displacement is off by {best.motion.rmse:.3g} "
            f"{metre} rms on held-out data ({100 * best.motion.relative:.2g} % of its variation), "
            f"{best.motion.fit_rmse:.3g} {metre} on fitted data"
        )
    values = Table(title=f"parameters of {best.law}")
    for column in ("parameter", "value", "standard error", "95 % interval", "unit"):
        values.add_column(column, justify="left" if column in ("parameter", "unit") else "right")
    for name, each in best.parameters.items():
        values.add_row(name, f"{each.value:.5g}", f"{each.stderr:.2g}", _interval(each), each.unit)
    out.print(values)
    for group in best.undetermined:
        out.print(left_open(group, best.parameters))
    for each in best.combinations:
        out.print(
            f"  known: {each.expression} = {each.value:.5g} (+- {100 * each.relative_error:.2g} %)"
        )
    for note in best.notes:
        out.print(f"Note: {note}.")
    for record in result.records:
        for warning in record.warnings:
            out.print(f"Warning, {record.name}: {warning.text}")


def doubts(result: Identification) -> list[str]:
    """Sentences on laws whose figures are not the best there could be."""
    found = [
        f"the fit of {each.law} has not converged: more --starts may find a better one"
        for each in result.results
        if not each.converged and each.ends
    ]
    behind: dict[tuple[str, ...], list[str]] = {}
    for each in result.results:
        if each.worse_than:
            behind.setdefault(each.worse_than, []).append(each.law)
    for simpler, laws in behind.items():
        verb = "explains" if len(laws) == 1 else "explain"
        found.append(
            f"{', '.join(laws)} {verb} the fitted data less well than {', '.join(simpler)}: near "
            "as they can come, they differ at speeds near 0 or above the band that is fitted"
        )
    return found


def left_open(group: Sequence[str], estimates: Mapping[str, Estimate]) -> str:
    """That the data do not determine one parameter, or do not tell several apart."""
    if len(group) > 1:
        return f"These data cannot tell apart: {', '.join(group)}."
    (name,) = group
    each, known = estimates.get(name), ""
    if each and each.low is None and each.high is not None:
        known = f", only that it is below {each.high:.3g} {each.unit}"
    if each and each.high is None and each.low is not None:
        known = f", only that it is above {each.low:.3g} {each.unit}"
    return f"These data do not determine {name}{known.removesuffix(' 1')}."


def _interval(each: Estimate) -> str:
    low = "no end" if each.low is None else f"{each.low:.5g}"
    high = "no end" if each.high is None else f"{each.high:.5g}"
    return f"{low} ... {high}"
