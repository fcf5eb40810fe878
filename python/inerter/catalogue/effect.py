"""One effect that a diagnosis can name: what it adds, its words, its traits."""

from __future__ import annotations

from dataclasses import dataclass

from inerter.catalogue.coordinates import COORDINATES


@dataclass(frozen=True, kw_only=True)
class Effect:
    """An effect by its contract name.

    Attributes
    ----------
    name
        As in the contract.
    kind
        "law", a friction law; "level", one that varies; "damper", a viscous damping that is not
        constant; "shaft", elasticity before the flywheel; "play", that with a gap or a clutch;
        "term", whatever else.
    coordinates
        Those that come and go with it.
    reported
        Device parameters that a finding reports; those of the coordinates, where nothing else is
        said.
    telling
        Coordinates whose being zero means that it is absent; the coordinates, where nothing else is
        said, none where that cannot be told so.
    stated_as
        Parameters that a user states for what is searched for in other coordinates.
    rank
        How usual it is: where the data cannot tell two effects apart, the one with the smaller
        number is named.
    local
        Whether it may show in few stretches, or in one run alone.
    far
        Whether one step from a starting point says little: what it cuts off, or remembers.
    unlike_friction
        Whether no friction law can stand in for it.
    on_table
        Whether amplitudes at a list of frequencies can show it.
    smooth
        Whether it is linear in the motion: its force ends where the motion's band does.
    tells_law
        Whether a finding says by which law.
    plain
        The effect in running text.
    meaning, cause
        What it adds to F = b a, and what makes it in a real device.
    taken_for, experiment
        What it is easily taken for, and the experiment that tells them apart.
    rivals
        Effects among those that it is taken for.
    """

    name: str
    plain: str
    meaning: str
    cause: str
    taken_for: str
    experiment: str
    kind: str = "term"
    coordinates: tuple[str, ...] = ()
    reported: tuple[str, ...] = ()
    telling: tuple[str, ...] | None = None
    stated_as: tuple[str, ...] = ()
    rank: int = 0
    local: bool = False
    smooth: bool = False
    far: bool = False
    unlike_friction: bool = False
    on_table: bool = False
    tells_law: bool = False
    rivals: tuple[str, ...] = ()

    @property
    def parameters(self) -> tuple[str, ...]:
        """Device parameters that a finding reports."""
        known = (COORDINATES[name] for name in self.coordinates if name in COORDINATES)
        return self.reported or tuple(dict.fromkeys(name for each in known for name in each.words))

    @property
    def amplitudes(self) -> tuple[str, ...]:
        """Coordinates whose being zero means that it is absent."""
        return self.coordinates if self.telling is None else self.telling
