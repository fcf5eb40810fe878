"""Records smoothed at one cut-off, and what of them is fitted and held out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from inerter.diagnose.play import forgiving, from_contact
from inerter.diagnose.tone import Witness
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, on_clocks, scales, thin, whole
from inerter.identify.split import Split, split
from inerter.records import Record
from inerter.records.motion import uniform
from inerter.records.preparation import Preparation


@dataclass(frozen=True, kw_only=True)
class Data:
    """Records as a diagnosis works on them; another band of the motion is another object.

    Attributes
    ----------
    records, preparation
        What was smoothed, and how.
    runs, split
        In the band of the motion, thinned, and how they are divided.
    whole, full
        At the measured rate with the force as measured, and how they are divided.
    band, raw
        The held-out samples of each.
    """

    records: Sequence[Record]
    preparation: Preparation
    runs: list[BenchRun]
    split: Split
    whole: list[BenchRun]
    full: Split
    band: Problem
    raw: Problem

    @property
    def held(self) -> list[str]:
        """Names of the runs that are held out."""
        return [r.name for i, r in enumerate(self.runs) if self.split.role(i) == "holdout"]

    @property
    def learnt(self) -> Problem:
        """The fit data at the measured rate with the force as measured."""
        return Problem(self.whole, self.full.fit, self.band.scales)

    @property
    def witness(self) -> Witness:
        """What the displacements as measured say of a tone in the fit data."""
        told = [uniform(record)[1]["displacement"] for record in self.records]
        return Witness(self.learnt, told)

    @property
    def followed(self) -> Problem:
        """The same, each run followed from a contact on."""
        learnt = self.learnt
        return Problem([from_contact(run) for run in learnt.runs], learnt.masks, learnt.scales)

    def in_band(self, preparation: Preparation) -> Data:
        """The same records, smoothed otherwise."""
        return divided(self.records, preparation, self.held, self.split.in_blocks)

    def with_play(self, play: Model) -> Data:
        """Runs followed from contacts on, where what is far off behind a play counts little."""
        followed = [from_contact(run) for run in self.whole]
        raw = Problem(followed, self.full.holdout, self.band.scales)
        return replace(self, whole=followed, raw=forgiving(raw, play))


def divided(
    records: Sequence[Record],
    preparation: Preparation,
    holdout: Sequence[str],
    in_blocks: bool | None = None,
) -> Data:
    """Runs and splits of smoothed records; the last two as in `identify.split.split`."""
    force_band = preparation.force_band
    runs = on_clocks([thin(motion, force_band=force_band) for motion in preparation.motions])
    raw = on_clocks([whole(motion) for motion in preparation.motions])
    parted = split(runs, holdout, in_blocks)
    held = [run.name for i, run in enumerate(runs) if parted.role(i) == "holdout"]
    full = split(raw, held, parted.in_blocks)
    sizes = scales(runs)
    # noise of a wide band may hide that there is one line
    sizes = replace(sizes, one_tone=sizes.one_tone or preparation.one_line)
    band = Problem(runs, parted.holdout, sizes)
    return Data(
        records=records, preparation=preparation, runs=runs, split=parted, whole=raw, full=full,
        band=band, raw=Problem(raw, full.holdout, band.scales),
    )  # fmt: skip
