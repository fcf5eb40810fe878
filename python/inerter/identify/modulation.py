"""Parameters that go with a third channel: seals against pressure, a damper against its voltage.

    F = sum over k of (p_k + s_k (q - q_0)) phi_k(x, v, a)
    phi = 1, tanh(v / w), v, x, a   for `force_offset`, `coulomb_force`, `viscous`, `stiffness`,
                                    `inertance`

q the channel in its own unit, q_0 its mean; F [N], tension positive. Linear least squares on the
moving samples of all runs, the motion smoothed; the width w of the sign is a hundredth of the rms
speed. A parameter is scaled where its s_k differs from 0 by four standard errors, and the runs left
out one after another are predicted better with it. The inertance is sought where the acceleration
is no multiple of the displacement. A parameter that is known is fixed. Standard errors: sandwich
over stretches, runs apart.
Not modelled: a parameter that bends with the channel (a residual of each run beside it shows that),
hysteresis of the channel, friction with memory.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from inerter.identify.runs import ONE_TONE, BenchRun, whole
from inerter.records import Record
from inerter.records.preparation import prepare, refuse_unusable

Array = NDArray[np.float64]

# sign(v): its width, and the speed below which friction may be anything, per rms speed
WIDTH, SLOW = 0.01, 0.1
STRETCHES = 12
SURE = 4.0
# share of the force that has to differ between q's for there to be anything to find
LEAST_CHANGE = 0.02
NOTHING: Mapping[str, float] = MappingProxyType({})
PARAMETERS = {
    "force_offset": "N",
    "coulomb_force": "N",
    "viscous": "N*s/m",
    "stiffness": "N/m",
    "inertance": "kg",
}


@dataclass(frozen=True, kw_only=True)
class Scaled:
    """A parameter: at the channel's mean, and its change per unit of the channel (0: none).

    own: what each run by itself has, by name; NaN where a run does not tell.
    """

    name: str
    unit: str
    value: float
    stderr: float
    slope: float
    slope_stderr: float
    own: dict[str, float]


@dataclass(frozen=True, kw_only=True)
class Modulation:
    """How parameters go with a channel.

    Attributes
    ----------
    channel, unit
        The channel's name and unit as written in the records.
    middle
        Its mean q_0.
    means
        Its mean in each run.
    parameters
        All of them.
    fixed
        Parameters that were known, in their units.
    left_out, constant, own
        Rms error [N] of each run: predicted from the others with the scaled parameters, from the
        others with constant ones, and by constants of its own. Of a single run, of its quarters.
    """

    channel: str
    unit: str
    middle: float
    means: dict[str, float]
    parameters: list[Scaled]
    fixed: dict[str, float]
    left_out: dict[str, float]
    constant: dict[str, float]
    own: dict[str, float]

    @property
    def notes(self) -> list[str]:
        """What cannot be taken for a device."""
        known = {each.name: each for each in self.parameters}
        mass, damper = known.get("inertance"), known.get("viscous")
        if mass is None or not mass.value < -SURE * mass.stderr:
            return []
        felt = damper is not None and damper.value
        late = f", here by about {-1e3 * mass.value / felt:.2g} ms" if felt else ""
        return [
            f"inertance is {mass.value:.3g} kg, which no device has: a force channel that is late "
            f"looks like that{late}"
        ]


@dataclass(frozen=True)
class _Part:
    """Moving samples: columns (n, m), channel (n,), force (n,) [N]."""

    name: str
    columns: Array
    channel: Array
    force: Array

    def terms(self, names: Sequence[int], middle: float) -> Array:
        """Columns, and those that are scaled."""
        scaled = self.columns[:, list(names)] * (self.channel - middle)[:, None]
        return np.column_stack([self.columns, scaled])


def modulation(
    records: Sequence[Record], channel: str, fixed: Mapping[str, float | str] = NOTHING
) -> Modulation:
    """Which parameters go with a channel of the records, and how.

    Parameters
    ----------
    records
        Runs on a bench with further columns (`Record.extra`); a channel that changes between runs
        or within them.
    channel
        Its name as in the header, with or without its unit.
    fixed
        Values of parameters that are known, and go with no channel.

    Raises
    ------
    ValueError
        A run without the channel, a channel that does not change, or a fixed parameter that this
        law has not.
    """
    known = _known(fixed)
    headers = [_header(record, channel) for record in records]
    refuse_unusable(records)
    motions = prepare(list(records)).motions
    # at the measured rate: a low-pass would blur the force at reversals, and not the sign
    runs = [whole(motion) for motion in motions]
    names, parts = _parts(runs, records, headers, known)
    everything = np.concatenate([part.channel for part in parts])
    middle, spread = float(everything.mean()), float(np.ptp(everything))
    if not spread > LEAST_CHANGE * max(abs(middle), float(np.abs(everything).max())):
        raise ValueError(
            f"--scaled-by {channel}: it is {middle:.4g} in all runs, so nothing can be seen to go "
            "with it; give runs at different values"
        )
    scaled = _chosen(parts, len(names), middle)
    values, errors = _fitted(parts, scaled, middle)
    each = {part.name: _solved([part], (), middle) for part in parts}
    count = len(names)
    slopes = {k: count + i for i, k in enumerate(scaled)}
    found = [
        Scaled(
            name=name,
            unit=PARAMETERS[name],
            value=float(values[k]),
            stderr=float(errors[k]),
            slope=float(values[slopes[k]]) if k in slopes else 0.0,
            slope_stderr=float(errors[slopes[k]]) if k in slopes else 0.0,
            own={part: float(solved[k]) for part, solved in each.items()},
        )
        for k, name in enumerate(names)
    ]
    plain, _, bracket = headers[0].partition("[")
    return Modulation(
        channel=plain.strip(),
        unit=bracket.rstrip("] "),
        middle=middle,
        means={part.name: float(part.channel.mean()) for part in parts},
        parameters=found,
        fixed=known,
        left_out=_left_out(parts, scaled, middle),
        constant=_left_out(parts, (), middle),
        own={part.name: _error(part, each[part.name], (), middle) for part in parts},
    )


def _header(record: Record, channel: str) -> str:
    """The header of a channel in a record."""
    for header in record.beside():
        if channel.strip().lower() in (header.lower(), header.partition("[")[0].strip().lower()):
            return header
    known = ", ".join(record.beside()) or "none"
    raise ValueError(
        f"--scaled-by {channel}: {record.name} has no such column; its further columns: {known}"
    )


def _known(fixed: Mapping[str, float | str]) -> dict[str, float]:
    known = {name: float(value) for name, value in fixed.items() if name in PARAMETERS}
    wrong = [name for name in fixed if name not in PARAMETERS]
    if wrong or len(known) == len(PARAMETERS):
        what = f"--fix {wrong[0]}={fixed[wrong[0]]}" if wrong else "--fix of every parameter"
        raise ValueError(
            f"{what}: with --scaled-by the law has {', '.join(PARAMETERS)}; fix some of these"
        )
    if bad := [name for name, value in known.items() if not np.isfinite(value)]:
        raise ValueError(f"--fix {bad[0]}={known[bad[0]]}: give a finite number")
    return known


def _parts(
    runs: Sequence[BenchRun],
    records: Sequence[Record],
    headers: Sequence[str],
    known: Mapping[str, float],
) -> tuple[list[str], list[_Part]]:
    """Parameters that are looked for; each run, or the quarters of a single one."""
    inner = [run.velocity[run.inner] for run in runs]
    speed = float(np.sqrt(np.mean(np.concatenate(inner) ** 2)))
    x, a = (np.concatenate([getattr(run, n)[run.inner] for run in runs])
            for n in ("displacement", "acceleration"))  # fmt: skip
    with_mass = np.corrcoef(x, a)[0, 1] ** 2 < ONE_TONE
    # an inertance that is known is none to be told from a spring
    every = list(PARAMETERS)[: 5 if with_mass or "inertance" in known else 4]
    names, parts = [name for name in every if name not in known], []
    for run, record, header in zip(runs, records, headers, strict=True):
        q = np.interp(run.time, record.time, record.beside()[header])
        moving = run.inner & (np.abs(run.velocity) > SLOW * speed) & np.isfinite(q)
        columns = [np.ones(q.size), np.tanh(run.velocity / (WIDTH * speed)), run.velocity]
        columns = dict(zip(PARAMETERS, [*columns, run.displacement, run.acceleration], strict=True))
        force = run.force - sum(value * columns[name] for name, value in known.items())
        cut = np.array_split(np.flatnonzero(moving), 4 if len(runs) == 1 else 1)
        for number, index in enumerate(cut):
            name = run.name if len(runs) > 1 else f"{run.name}, quarter {number + 1}"
            rows = np.column_stack([columns[each] for each in names])[index]
            parts.append(_Part(name, rows, q[index], force[index]))
    return names, parts


def _chosen(parts: Sequence[_Part], count: int, middle: float) -> tuple[int, ...]:
    """Which parameters are scaled: the surest first, as long as the parts left out gain by it."""
    chosen: tuple[int, ...] = ()
    error = _mean(_left_out(parts, chosen, middle))
    while len(chosen) < count:
        trials = []
        for k in sorted(set(range(count)) - set(chosen)):
            tried = (*chosen, k)
            values, errors = _fitted(parts, tried, middle)
            if abs(values[-1]) > SURE * errors[-1]:
                trials.append((_mean(_left_out(parts, tried, middle)), tried))
        if not trials or min(trials)[0] >= error:
            return chosen
        error, chosen = min(trials)
    return chosen


def _solved(parts: Sequence[_Part], scaled: Sequence[int], middle: float) -> Array:
    matrix = np.concatenate([part.terms(scaled, middle) for part in parts])
    size = np.sqrt(np.mean(matrix**2, axis=0))
    size = np.where(size > 0, size, 1.0)
    force = np.concatenate([part.force for part in parts])
    return np.linalg.lstsq(matrix / size, force, rcond=1e-9)[0] / size


def _fitted(parts: Sequence[_Part], scaled: Sequence[int], middle: float) -> tuple[Array, Array]:
    """Values and their standard errors, by the sandwich over stretches."""
    values = _solved(parts, scaled, middle)
    matrices = [part.terms(scaled, middle) for part in parts]
    whole = np.concatenate(matrices)
    size = np.sqrt(np.mean(whole**2, axis=0))
    size = np.where(size > 0, size, 1.0)
    bread = np.linalg.pinv((whole / size).T @ (whole / size), rcond=1e-12)
    scores = []
    for part, matrix in zip(parts, matrices, strict=True):
        rest = part.force - matrix @ values
        for stretch in np.array_split(np.arange(rest.size), STRETCHES):
            scores.append((matrix[stretch] / size).T @ rest[stretch])
    meat = np.array(scores).T @ np.array(scores)
    # few stretches are fitted better than they scatter
    freed = len(scores) / max(len(scores) - values.size, 1)
    covariance = freed * bread @ meat @ bread
    return values, np.sqrt(np.maximum(np.diag(covariance), 0.0)) / size


def _left_out(parts: Sequence[_Part], scaled: Sequence[int], middle: float) -> dict[str, float]:
    """Rms error of each part, predicted from the others [N]."""
    found = {}
    for i, part in enumerate(parts):
        others = [other for j, other in enumerate(parts) if j != i]
        found[part.name] = _error(part, _solved(others, scaled, middle), scaled, middle)
    return found


def _error(part: _Part, values: Array, scaled: Sequence[int], middle: float) -> float:
    return float(np.sqrt(np.mean((part.force - part.terms(scaled, middle) @ values) ** 2)))


def _mean(errors: dict[str, float]) -> float:
    return float(np.mean(list(errors.values())))
