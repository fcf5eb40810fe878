"""Which cases a blind test has; each follows from its own seed alone."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from zlib import crc32

import numpy as np

from inerter.reference import (
    EFFECTS,
    HYSTERETIC_LAWS,
    UNKNOWN,
    VEHICLE_EFFECTS,
    VEHICLE_UNKNOWN,
    NoiseLevels,
    compatible,
    compatible_in_vehicles,
)

BENCHES = ("ideal", "realistic")
VEHICLE = "vehicle"
VEHICLE_LAWS = ("dahl", "lugre")


def effects_on(bench: str) -> tuple[str, ...]:
    """Effects that can be hidden on a bench or in a vehicle."""
    return VEHICLE_EFFECTS if bench == VEHICLE else EFFECTS


@dataclass(frozen=True, kw_only=True)
class Task:
    """One case: `effects` that are hidden, empty for "clean"; for "unknown" its `kind`.

    group: "single", "clean", "pairs", "triples" or "unknown"; bench: one of `BENCHES`, or
    `VEHICLE`.
    """

    group: str
    seed: int
    noise: float
    effects: tuple[str, ...] = ()
    law: str | None = None
    kind: str | None = None
    bench: str = BENCHES[0]

    @property
    def name(self) -> str:
        """What tells it from every other case, as a file's name."""
        what = self.kind or "+".join(self.effects) or "nothing"
        bench = [self.bench] if self.bench != BENCHES[0] else []
        law = [self.law] if self.law else []
        return "-".join([*bench, self.group, what, *law, str(self.seed)])

    @property
    def levels(self) -> NoiseLevels:
        """Noise: a share of the force rms; a micrometre of displacement for 1 %."""
        return NoiseLevels(0.0, self.noise, 1e-4 * self.noise)


@dataclass(frozen=True, kw_only=True)
class Plan:
    """A blind test: how many cases of what.

    Attributes
    ----------
    effects
        The effects that are hidden singly, and of which pairs and triples are made; none: all of
        the bench.
    count
        Cases of each effect.
    clean, pairs, triples, unknown
        Cases with nothing hidden, with two and with three effects, with one that has no name.
    noise
        White noise of the force per its rms; the displacement's is 1 micrometre for 0.01.
    seed
        Everything follows from it.
    bench
        "ideal": white noise and nothing else; "realistic": motion and measuring chain of a bench
        as it is, drawn for each case; "vehicle": vehicle, road and sensors drawn for each case.

    Raises
    ------
    ValueError
        An unknown effect, a number out of range, or no pair that goes together.
    """

    effects: tuple[str, ...] = ()
    count: int = 40
    clean: int = 0
    pairs: int = 0
    triples: int = 0
    unknown: int = 0
    noise: float = 0.01
    seed: int = 0
    bench: str = BENCHES[0]

    def __post_init__(self) -> None:
        """See Raises."""
        known_here = effects_on(self.bench)
        object.__setattr__(self, "effects", self.effects or known_here)
        for name in self.effects:
            if name not in known_here:
                known = ", ".join(known_here)
                raise ValueError(f"--effects: '{name}' is not one of {known}")
        if len(set(self.effects)) < len(self.effects):
            raise ValueError("--effects: one is given twice; give each once")
        for name in ("count", "clean", "pairs", "triples", "unknown", "seed"):
            if getattr(self, name) < 0:
                raise ValueError(f"--{name}: {getattr(self, name)} is below 0")
        if self.bench not in (*BENCHES, VEHICLE):
            raise ValueError(f"--bench: '{self.bench}' is not one of {', '.join(BENCHES)}")
        if not 0.0 <= self.noise <= 1.0:
            raise ValueError(f"--noise: {self.noise:g} is a share of the force rms, from 0 to 1")
        for name, size in (("pairs", 2), ("triples", 3)):
            if getattr(self, name) and not self._sets(size):
                raise ValueError(
                    f"--{name}: of {', '.join(self.effects)} no {size} go together; give more "
                    "--effects"
                )
        if not self.tasks():
            raise ValueError("--count: no case is asked for; give a number above 0")

    def tasks(self) -> list[Task]:
        """All cases; the number of one kind does not change the seeds of another.

        The effects take turns, so that a test that is broken off has some of each.
        """
        found: list[Task] = []
        in_vehicle = self.bench == VEHICLE
        laws = VEHICLE_LAWS if in_vehicle else HYSTERETIC_LAWS
        unknown = VEHICLE_UNKNOWN if in_vehicle else UNKNOWN
        for i in range(self.count):
            for effect in self.effects:
                # the laws take turns
                hysteretic = effect == "hysteretic_friction"
                law = laws[i % len(laws)] if hysteretic else None
                found.append(self._task("single", effect, i, effects=(effect,), law=law))
        found += [self._task("clean", "clean", i) for i in range(self.clean)]
        for group, number, size in (("pairs", self.pairs, 2), ("triples", self.triples, 3)):
            found += [
                self._task(group, group, i, effects=effects)
                for i, effects in enumerate(self._drawn(group, size, number))
            ]
        for i in range(self.unknown):
            kind = unknown[i % len(unknown)]
            found.append(self._task("unknown", kind, i, kind=kind))
        return found

    def _task(
        self,
        group: str,
        label: str,
        number: int,
        effects: tuple[str, ...] = (),
        law: str | None = None,
        kind: str | None = None,
    ) -> Task:
        sequence = np.random.SeedSequence([self.seed, crc32(label.encode()), number])
        seed = int(sequence.generate_state(1)[0])
        return Task(
            group=group, seed=seed, noise=self.noise, effects=effects, law=law, kind=kind,
            bench=self.bench,
        )  # fmt: skip

    def _drawn(self, group: str, size: int, number: int) -> list[tuple[str, ...]]:
        """Sets of effects that go together, none twice before each had its turn."""
        if not number:
            return []
        sets = self._sets(size)
        draw = np.random.default_rng([self.seed, crc32(group.encode())])
        found: list[tuple[str, ...]] = []
        while len(found) < number:
            found += [sets[i] for i in draw.permutation(len(sets))]
        return found[:number]

    def _sets(self, size: int) -> list[tuple[str, ...]]:
        together = compatible_in_vehicles if self.bench == VEHICLE else compatible
        return [chosen for chosen in combinations(self.effects, size) if together(chosen)]
