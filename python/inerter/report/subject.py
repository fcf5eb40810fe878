"""What a page is about in words: the force of a device on a bench, or the channels of a model."""

from __future__ import annotations

from dataclasses import dataclass, replace

from inerter.diagnose.result import Diagnosis
from inerter.diagnose.vehicle.outcome import SystemDiagnosis
from inerter.motion_units import ROTATION, unit
from inerter.report import text


@dataclass(frozen=True, kw_only=True)
class Subject:
    """The words of a page that differ between devices and models.

    kind: of page; error, noise: what the figures are; quantity: what is drawn; engines: about the
    table of engines; glossary: meaning of the error; share: figures are shares of a spread; newton:
    unit of the error where they are not.
    """

    kind: str
    error: str
    noise: str
    quantity: str
    engines: str
    glossary: str
    share: bool
    newton: str = "N"

    def figure(self, value: float | None, digits: int = 3) -> str:
        """An error with its unit."""
        if value is None or not self.share:
            return f"{text.number(value, digits)} {self.newton}"
        return f"{text.number(100 * value, digits)} %"


_BENCH = Subject(
    kind="simulation against bench data",
    error="rms force error",
    noise="expected of the noise of force and motion",
    quantity="Force",
    engines="The same device, following the measured motion anew in each engine. Figures "
    "that agree mean "
    "that the finding does not hang on one implementation.",
    glossary="Root of the mean square of measured minus simulated force over the held-out "
    "samples, the "
    "simulation following the measured motion. For runs that were fitted, over their own samples.",
    share=False,
)
_TURNING = replace(
    _BENCH, error="rms torque error", noise="expected of the noise of torque and motion",
    quantity="Torque", newton=text.unit(unit(ROTATION, "N")),
)  # fmt: skip
_MODEL = Subject(
    kind="a model against records of the whole system",
    error="rms error of the channels, per their spread,",
    noise="expected of the noise of the channels",
    quantity="Channel",
    engines="The extended model as written below, simulated once more. The other engines do "
    "not run MJCF.",
    glossary="Root of the mean square of measured minus simulated channels over the held-out "
    "samples, each "
    "channel per its noise-free spread; the model is driven by the recorded inputs.",
    share=True,
)


def subject(diagnosis: Diagnosis) -> Subject:
    """The words for a diagnosis."""
    if isinstance(diagnosis, SystemDiagnosis):
        return _MODEL
    return _TURNING if diagnosis.motion == ROTATION else _BENCH
