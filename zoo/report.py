"""What a campaign found, as text: figures, refusals with their reasons, the worst, failures."""

from __future__ import annotations

import re
from collections import Counter
from typing import Any

import numpy as np

from zoo.checks import LIMITS

Result = dict[str, Any]


def failures_of(result: Result) -> list[str]:
    """What is wrong with a case, one line each."""
    if result["status"] in ("crashed", "error"):
        return [f"{result['status']}: {result['reason']}"]
    if result["status"] == "refused" and not result["good"]:
        return [f"refused: {result['reason']}"]
    figures = result.get("figures", {})
    found = [
        f"{name} {figures[name]:.2g} (up to {limit:g})"
        for name, limit in LIMITS.items()
        if name in figures and not figures[name] <= limit
    ]
    return found


def text(results: list[Result]) -> str:
    """The whole report."""
    real = [each for each in results if each["status"] != "no_model"]
    ran = [each for each in real if each["status"] == "ran"]
    models = {each["path"] for each in real}
    unused = {each["path"] for each in results if each["status"] == "no_model"} - models
    packages = Counter(each["package"] for each in real)
    lines = [
        f"{len(real)} cases in {len(models)} models; {len(unused)} files are no model",
        "cases: " + ", ".join(f"{name} {count}" for name, count in sorted(packages.items())),
        "",
        *_figures(ran),
        "",
        *_refusals(real),
        "",
        *_failures(real),
    ]
    return "\n".join(lines)


def _figures(ran: list[Result]) -> list[str]:
    lines = [f"{'figure':<14}{'cases':>7}{'median':>10}{'90 %':>10}{'worst':>10}{'up to':>10}"]
    for name in [*LIMITS, "cost"]:
        values = [each["figures"][name] for each in ran if name in each["figures"]]
        if values:
            middle, high, worst = np.percentile(values, [50, 90, 100])
            limit = f"{LIMITS[name]:g}" if name in LIMITS else "-"
            lines.append(
                f"{name:<14}{len(values):>7}{middle:>10.2g}{high:>10.2g}{worst:>10.2g}{limit:>10}"
            )
    dear = sorted((e for e in ran if "cost" in e["figures"]), key=lambda e: -e["figures"]["cost"])
    lines += ["", "dearest, over the bare model's step:"]
    lines += [f"  {e['figures']['cost']:6.1f}  {label(e)}" for e in dear[:5]]
    return lines


def _refusals(real: list[Result]) -> list[str]:
    refused = [each for each in real if each["status"] == "refused"]
    kinds = Counter((_kind(each["reason"]), each["good"]) for each in refused)
    lines = [f"refused: {len(refused)}"]
    for (reason, good), count in kinds.most_common():
        lines.append(f"  {count:4d}  {'for a reason' if good else 'A FAILURE'}: {reason}")
    return lines


def _kind(reason: str) -> str:
    """A reason without names and numbers."""
    reason = re.sub(r".*?inerter\.device, [a-z]+ \"[^\"]*\": ", "", reason, count=1)
    return re.sub(r"-?\d+(\.\d+)?(e[-+]?\d+)?", "#", re.sub(r"([\"']).*?\1", "...", reason))[:150]


def _failures(real: list[Result]) -> list[str]:
    found = [(each, failures_of(each)) for each in real]
    failed = [(each, wrong) for each, wrong in found if wrong]
    kinds = Counter(name for _, wrong in failed for name in {text.split()[0] for text in wrong})
    lines = [f"failed: {len(failed)} of {len(real)} cases"]
    lines += [f"  {count:4d}  {name}" for name, count in kinds.most_common()]
    for each, wrong in failed:
        lines += ["", label(each)]
        lines += [f"    {reason}" for reason in wrong]
        lines += [f"    said: {said}" for said in each.get("warnings", [])]
        for device in each.get("devices", []):
            lines.append("    " + ", ".join(f"{k} {_short(v)}" for k, v in device.items()))
    return lines


def _short(value: Any) -> str:
    return value if isinstance(value, str) else f"{value:.4g}"


def label(each: Result) -> str:
    """Which case it is, and what repeats it."""
    file = "/".join(each["path"].split("/")[-3:])
    return f"{each['package']}: {file}, number {each['number']}, {each.get('integrator', '')}"
