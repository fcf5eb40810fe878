"""The budget of the held-out error in figures and in a sentence."""

from __future__ import annotations

from dataclasses import dataclass

from inerter.motion_units import TRANSLATION, Kind, words

# share of the error below which a part is not worth a word
LEAST = 0.005
# share of what is left from which on a part of it is told all the same
TOLD = 0.05
# share of an error that sums in another order make
ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True)
class Budget:
    """The held-out error of the baseline [N] and its parts, whose sum it is.

    Attributes
    ----------
    baseline : float
        Rms error before.
    named : float
        What the findings take away.
    carried : float
        What the extended device carries without a name takes away besides.
    predictable : float
        What a flexible predictor takes away besides: predictable, and without a name.
    rest : float
        What it leaves: not predicted by anything that was tried.
    repeatability : float, optional
        What differs between strokes that repeat, over all runs; None where too few repeat.
    motion : str
        What the device does; in rotation read N m for N.
    foretold : float
        What tests, one by one, foretell of the rest.
    source : str
        What could tell the predictable part.
    """

    baseline: float
    named: float
    carried: float = 0.0
    predictable: float
    rest: float
    repeatability: float | None = None
    motion: Kind = TRANSLATION
    foretold: float = 0.0
    source: str = "the motion"

    def parts(self) -> list[tuple[str, str, float]]:
        """Key, words and size [N] of each part."""
        kept = [("carried", "carried, fitted without a cause", self.carried)]
        return [
            ("named", "named", self.named),
            *(kept if self.carried else []),
            ("predictable", "predictable, without a name", self.predictable),
            ("rest", "not predictable by anything tried", self.rest),
        ]

    @property
    def sentence(self) -> str:
        """The budget in a sentence."""
        whole = self.baseline or 1.0
        newton = words(self.motion, "N")
        named = "nothing is named"
        if self.named > LEAST * whole:
            named = f"{self.named:.3g} {newton} is named"
        if self.carried:
            named += (
                f", {self.carried:.3g} {newton} is carried in the extended device as a force over "
                "displacement and velocity, fitted and without a cause"
            )
        more = (
            f"{self.predictable:.3g} {newton} more could be predicted from {self.source} but has "
            "no name"
            if self.predictable > min(LEAST * whole, TOLD * self.rest)
            else "nothing more was predictable"
            if self.foretold <= LEAST * whole
            else "a flexible predictor took nothing more away on data left out (though tests, one "
            f"by one, foretell {self.foretold:.3g} {newton} of it)"
        )
        text = (
            f"Of {self.baseline:.3g} {newton} rms, {named}, {more}, and {self.rest:.3g} {newton} "
            "was not predicted by anything tried."
        )
        if self.repeatability is not None:
            text += f" Strokes that repeat differ by {self.repeatability:.3g} {newton}."
        return text


def budget_of(
    baseline: float,
    extended: float,
    ceiling: float,
    repeatability: float | None,
    motion: Kind = TRANSLATION,
    carried: float | None = None,
    foretold: float = 0.0,
    source: str = "the motion",
) -> Budget:
    """The budget of a held-out error [N] of the baseline, the extended model and the predictor.

    carried: that of the extended device with what it carries; None where it carries nothing.
    foretold: what tests, one by one, foretell of what is left [N]. source: what could tell the
    predictable part.
    """
    kept = extended if carried is None else carried
    # a ceiling that is the extended model's own error differs from it by rounding
    least = kept if ceiling > (1 - ROUNDING) * kept else ceiling
    return Budget(
        baseline=baseline,
        named=baseline - extended,
        carried=extended - kept,
        predictable=kept - least,
        rest=least,
        repeatability=repeatability,
        motion=motion,
        foretold=foretold,
        source=source,
    )
