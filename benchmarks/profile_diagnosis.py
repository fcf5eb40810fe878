"""Where the time of a diagnosis goes.

    python -m benchmarks.profile_diagnosis OUT.png [EARLIER.json]

Made records are diagnosed on one processor under Python's profiler, which stretches what is in
Python by a third or so; its functions are sorted into a handful of kinds. OUT.json has the numbers,
which a later run draws beside its own.
"""

from __future__ import annotations

import cProfile
import json
import os
import pstats
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from inerter.diagnose import diagnose_bench

from benchmarks.diagnosis import made
from benchmarks.picture import figure, save

CASES = ("viscous friction", "LuGre friction", "series elasticity", "backlash")
# kinds of work, by a part of "file:function"
KINDS = {
    "core: forces along a motion": ("core.py:along_checked", "core.py:force_checked"),
    "low-passes, Fourier transforms": ("_pocketfft.py", "motion.py:filtered_and_thinned"),
    "linear algebra": ("_decomp_svd.py", "_linalg.py", "linalg", "method 'dot'", "outer"),
    "making devices": ("core.py:__init__", "coordinates.py", "along_stroke.py", "parameter_text"),
}
REST = "Python"


def seconds_by_kind(profile: cProfile.Profile) -> dict[str, float]:
    """Own time of the functions of a profile [s], by kind."""
    found = dict.fromkeys((*KINDS, REST), 0.0)
    for (file, _, name), row in pstats.Stats(profile).stats.items():  # pyright: ignore
        where = f"{Path(file).name}:{name}"
        kind = next((k for k, parts in KINDS.items() if any(p in where for p in parts)), REST)
        found[kind] += row[2]
    return found


def profiled(name: str) -> dict[str, float]:
    """Seconds by kind of the diagnosis of a made record."""
    # of the processor, so that other programs lengthen it little
    records, profile = made(name), cProfile.Profile(time.process_time)
    profile.runcall(diagnose_bench, records)
    return seconds_by_kind(profile)


def draw(profiles: Mapping[str, Mapping[str, Mapping[str, float]]], path: Path) -> None:
    """Stacked bars, one for each case and each of some times of measurement."""
    made_figure = figure(9.0, 0.5 + 0.42 * len(profiles) * len(CASES))
    axes = made_figure.subplots()
    kinds = (*KINDS, REST)
    colours = ("#2f6f9f", "#d4641c", "#c9b458", "#8d97a3", "#d9dde2")
    rows = [(case, when) for case in CASES for when in profiles]
    for i, (kind, colour) in enumerate(zip(kinds, colours, strict=True)):
        lefts = [sum(profiles[when][case][k] for k in kinds[:i]) for case, when in rows]
        widths = [profiles[when][case][kind] for case, when in rows]
        axes.barh(range(len(rows)), widths, 0.75, lefts, color=colour, label=kind)
    labels = [f"{case}, {when}" if len(profiles) > 1 else case for case, when in rows]
    axes.set_yticks(range(len(rows)), labels, fontsize=9)
    axes.invert_yaxis()
    axes.set_xlabel("seconds of one processor under the profiler", fontsize=9)
    axes.legend(frameon=False, fontsize=8, loc="upper right")
    save(made_figure, path)


def main(arguments: Sequence[str]) -> None:
    """Profile and draw."""
    out, *earlier = (Path(each) for each in arguments)
    profiles = {each.stem: json.loads(each.read_text(encoding="utf-8")) for each in earlier}
    now = {name: profiled(name) for name in CASES}
    out.with_suffix(".json").write_text(json.dumps(now, indent=1) + "\n", encoding="utf-8")
    draw({**profiles, "now" if profiles else out.stem: now}, out)


if __name__ == "__main__":
    os.environ["LOKY_MAX_CPU_COUNT"] = "1"
    main(sys.argv[1:])
