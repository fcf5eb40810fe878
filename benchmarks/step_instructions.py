"""Whose instructions a step of a car is made of, counted by callgrind.

A Python process makes a car and takes steps under valgrind; what `mj_step` does is counted. Three
parts: what the device's library does itself, what it lets the engine do (`mj_...` called from it),
and the engine's own, with what it does because there is an actuator with a plugin: slots of states,
transmission, callbacks. The last is what no device could do without, whatever it computes: `least`
is that, and the instructions of the law itself counted by hand, over the step that is held against.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from inerter.benchmark.cars import PLUGIN
from inerter.benchmark.rows import Row
from inerter.benchmark.step import BRANCH_QUESTIONS, IDEAL, LUGRE, NESTED_QUESTIONS

from benchmarks.instructions import LEAST, costs, lacking

CASES = (
    ("quarter-car", "Euler"),
    ("quarter-car", "implicitfast"),
    ("quarter-car", "discrete"),
    ("quarter-car", "RK4"),
    ("full-car", "Euler"),
)
"""Cars and integrators, the quickest first."""
STEPS = 400

# arguments: car, how its device is made, integrator, whether in branches, steps
_SCRIPT = """
import sys
import mujoco
from inerter.benchmark.cars import car_xml, jolt
from inerter.plugin import load_plugin

load_plugin()
car, made, integrator, branches, steps = sys.argv[1:]
model = mujoco.MjModel.from_xml_string(car_xml(car, made, integrator, branches=branches == "True"))
data = mujoco.MjData(model)
data.qvel[:] = jolt(car)
mujoco.mj_step(model, data, int(steps))
"""


@dataclass(frozen=True)
class Share:
    """Instructions of a step: the engine's own, those it does for the device, the device's."""

    engine: float
    for_device: float
    device: float

    @property
    def total(self) -> float:
        """All of them."""
        return self.engine + self.for_device + self.device


def notes() -> list[str]:
    """What is missing here."""
    reason = lacking()
    return [reason] if reason else []


def run(quick: bool = False) -> list[Row]:
    """One row for each question, car and integrator; none without valgrind."""
    if lacking():
        return []
    return [row for case in (CASES[:1] if quick else CASES) for row in _rows(*case)]


def _rows(car: str, integrator: str) -> Iterator[Row]:
    for branches, questions in ((False, NESTED_QUESTIONS), (True, BRANCH_QUESTIONS)):
        known: dict[str, Share] = {}
        for question, variant, against, aim in questions:
            if variant not in (IDEAL, LUGRE) or against not in ("armature", "native lugre"):
                continue
            for made in {variant, against} - known.keys():
                known[made] = counted(car, made, integrator, branches=branches)
            mine, other = known[variant], known[against]
            law = LEAST[variant.removeprefix("plugin ")]
            yield {
                "car": car,
                "topology": "branches" if branches else "nested",
                "integrator": integrator,
                "question": question,
                "variant": variant,
                "against": against,
                "engine": mine.engine,
                "for_device": mine.for_device,
                "device": mine.device,
                "other": other.total,
                "over": mine.total / other.total,
                "least": (mine.engine + law) / other.total,
                "aim_of_time": aim,
            }


def counted(car: str, made: str, integrator: str, *, branches: bool) -> Share:
    """Instructions of a step, the mean of many.

    Raises
    ------
    RuntimeError
        valgrind failed.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "counts"
        command = [
            "valgrind", "--tool=callgrind", f"--callgrind-out-file={file}",
            "--toggle-collect=mj_step", sys.executable, "-c", _SCRIPT,
            car, made, integrator, str(branches), str(STEPS),
        ]  # fmt: skip
        steady = {**os.environ, "PYTHONHASHSEED": "0"}
        done = subprocess.run(command, capture_output=True, text=True, check=False, env=steady)
        if done.returncode:
            raise RuntimeError(f"valgrind failed: {done.stderr[-500:]}")
        found = by_owner(file.read_text(encoding="utf-8"))
    # MuJoCo's own friction law and armature are the engine's
    each = [count / STEPS for count in found]
    return Share(*each) if made in PLUGIN else Share(sum(each), 0.0, 0.0)


def by_owner(profile: str, device: str = "inerter") -> tuple[int, int, int]:
    """Instructions of the engine, of the engine for the device, and of the device, from callgrind.

    The device are libraries whose name has `device`; what it calls counts for it, in whatever
    library that is.
    """
    total = own = caused = 0
    for library, called, cost in costs(profile):
        if called is None:
            total += cost
            own += cost if device in library else 0
        elif device in called and device not in library:
            caused += cost
    return total - caused, caused - own, own
