"""A car as its file states it, over roads: any layout, damper tables, stops, bars, a full car.

The model is that of `inerter.cars.mjcf`, stepped by RK4 with the road held over each step. On a
random road means are over one whole period, after what the slowest mode (of the model made linear
at rest) needs to settle; roads are as fine as that mode asks for, see `resolution.py`. Of a full
car the left and the right road are sums of two independent ones with the car's correlation.

| figure | |
| --- | --- |
| J1, J1w [m/s^2] | rms acceleration of the body above the wheels, plain and weighted by Wk |
| pitch, roll [rad/s^2] | rms angular acceleration of the body |
| J3 [N], travel [m] | rms over wheels and struts |
| *_peak | largest: acceleration at a point, force that presses a tyre, travel |
| lift_off | share of time that a tyre is off the road, mean of the wheels |

What a road does at once (to the tyre, and through a rigid inerter to the body) is put right at each
instant with the road's own height there; of what is faster than the steps can follow that part is
added in closed form. Over a `Profile` the figures are those from the first metre until the car is
at rest again, and rms is over that time.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from typing import Any

import mujoco
import numpy as np
from mujoco import rollout
from numpy.typing import NDArray

from inerter.cars.mjcf import NODES, car_mjcf
from inerter.cars.parts import CarParts
from inerter.plugin import load_plugin
from inerter.suspension.car_options import linear_car
from inerter.suspension.indices import INDICES
from inerter.suspension.study import refuse_turning
from inerter.suspension.time_domain.model import step_matrix
from inerter.suspension.time_domain.profile import Profile
from inerter.suspension.time_domain.resolution import ERROR, LONGEST
from inerter.suspension.time_domain.road import PeriodicRoad, track
from inerter.suspension.time_domain.samples import interval
from inerter.suspension.time_domain.signals import gain_of, index_of, parts_of, signal_of
from inerter.suspension.time_domain.simulate import FADE, RunSettings

Array = NDArray[np.float64]

UNITS = {
    "J1": "m/s^2", "J1w": "m/s^2", "pitch": "rad/s^2", "roll": "rad/s^2", "J3": "N", "travel": "m",
    "lift_off": "", "acceleration_peak": "m/s^2", "tyre_peak": "N", "travel_peak": "m",
}  # fmt: skip
"""Figures of a run, with their units; an index that is asked for beside has its own."""

TYRE = "a tyre is"
"""How a note on tyres that leave the road begins."""

_SLOWEST = 1e-3


@dataclass(frozen=True)
class OwnFigure:
    """One figure: `value` with its 95 % interval, equal over a profile; `linear` beside or None."""

    name: str
    value: float
    low: float
    high: float
    linear: float | None = None


@dataclass(frozen=True)
class OwnEvaluation:
    """`figures` by name; `roads` driven, how long the road is [s], `settle` [s], `notes`."""

    figures: tuple[OwnFigure, ...]
    roads: int
    road_period: float
    settle: float
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Model:
    """The compiled car: corners as (control, place of the wheel, its velocity's, kt, load, ct,
    behind, x, y), places in the state of the engine.
    """

    model: mujoco.MjModel
    corners: tuple[tuple[int, int, int, float, float, float, float, float, float], ...]
    tyres: tuple[int, ...]
    travels: tuple[int, ...]
    at_once: Array
    one_sided: bool


def evaluate_own(
    car: CarParts,
    road: PeriodicRoad | Profile,
    seeds: int,
    settings: RunSettings,
    *,
    one_sided: bool = True,
    keep_settle: bool = False,
    indices: tuple[str, ...] = (),
    progress: Callable[[float], None] = lambda share: None,
) -> OwnEvaluation:
    """Every figure of a car with the struts of its file.

    Parameters
    ----------
    car
        Of a file, see `inerter.cars.read`.
    road
        Random, or a profile, which is driven once.
    seeds
        How many random roads, 2 or more.
    settings
        `step` [s], `settle` [s] at least, `jobs`.
    one_sided
        A tyre pulls by at most its static load.
    keep_settle
        The settling time of the settings, whatever the modes ask for.
    indices
        Of `INDICES`, told beside the figures if they are not among them.
    progress
        Called with the share that is done.

    Raises
    ------
    ValueError
        Fewer than two seeds, a layout that has no model, or a step that diverges.
    """
    from inerter.suspension.time_domain.own_linear import bound_by_band, linear_figures

    if "J5" in indices:
        raise ValueError("index J5: a car as its file states it has none; give a --layout")
    refuse_turning(indices, linear_car(car))
    more = tuple(name for name in indices if name not in UNITS)
    parts = parts_of(more)
    built = _build(car, settings.step, one_sided)
    slowest = _slowest(built.model)
    faded = math.log(2.0 / ERROR) / max(slowest, _SLOWEST)
    notes: list[str] = []
    if isinstance(road, Profile):
        after = min(faded, LONGEST)
        found = [_over_profile(built, road, settings.step, after, parts)]
        period, settle, count = road.duration + after, 0.0, 1
        linear: dict[str, float] = {}
        missing = 0.0
    else:
        if seeds < 2:
            raise ValueError(f"seeds is {seeds}: give 2 or more, for an interval")
        if faded > LONGEST:
            notes.append(
                f"the slowest mode rings for more than {LONGEST:g} s, the longest road here"
            )
            faded = LONGEST
        road = road.refined(max(1, math.ceil(faded / road.period - 1e-9)))
        needed = FADE + 0.5 * faded
        settle = settings.settle if keep_settle else max(settings.settle, needed)
        if settle < needed:
            notes.append(
                f"--settle {settle:g}: the slowest mode needs {needed:.3g} s; what is left of the "
                "start is in the means"
            )
        run = partial(_over_random, built, car, road, settings.step, settle, parts)
        found = []
        with ThreadPoolExecutor(settings.jobs or os.cpu_count() or 1) as pool:
            for n, one in enumerate(pool.map(run, range(seeds))):
                found.append(one)
                progress((n + 1) / seeds)
        period, count = road.period, seeds
        linear = linear_figures(car, road, more)
        lines = linear_figures(car, road, more, on_sinusoids=True)
        missing = max(abs(lines[name] / linear[name] - 1.0) for name in linear)
        bound = bound_by_band(car, tuple(linear))
        if bound:
            notes.append(
                f"{', '.join(bound)}: with tyre_damping the value depends on where the road ends, "
                f"here at {road.limits[1]:g} Hz; it grows with that end without limit"
            )
    found = [{**one, **{name: _index(name, one) for name in more}} for one in found]
    names = [name for name in (*UNITS, *more) if name in found[0]]
    figures = []
    for name in names:
        values = np.array([each[name] for each in found])
        if name.endswith("_peak"):
            top = float(values.max())
            figures.append(OwnFigure(name, top, top, top))
            continue
        mean, low, high = interval(values)
        # what a finite road misses of its density
        wider = missing * mean
        figures.append(OwnFigure(name, mean, low - wider, high + wider, linear.get(name)))
    lifted = next(each.value for each in figures if each.name == "lift_off")
    if lifted > 0.0:
        what = "off the road" if one_sided else "pulled on the road, where a real one would lift,"
        notes.append(f"{TYRE} {what} for {100.0 * lifted:.2g} % of the time")
    return OwnEvaluation(tuple(figures), count, period, settle, tuple(notes))


def _build(car: CarParts, step: float, one_sided: bool) -> _Model:
    load_plugin()
    for axle in car.axles.values():
        shaft = {"series_stiffness", "series_damping"} & set(dict(axle.strut.device))
        if shaft and axle.strut.layout in NODES:
            raise ValueError(
                f"layout {axle.strut.layout} with the shaft of its device: RK4 cannot step the "
                f"node between them; take --layout {axle.strut.layout} --device in place of own"
            )
    spec: Any = mujoco.MjSpec.from_string(car_mjcf(car))
    spec.option.timestep = step
    # there are no contacts; looking for them takes time
    spec.option.disableflags = int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    roads = [a.name for a in spec.actuators if a.name == "road" or a.name.startswith("road_")]
    if not one_sided:
        for name in roads:
            spec.actuator(name).forcelimited = False
    model = spec.compile()
    wheelbase = car.front.distance + car.rear.distance if car.rear else 0.0
    corners, tyres, travels = [], [], []
    for name in roads:
        place = name.removeprefix("road")
        rear = car.rear if "rear" in place and car.rear else None
        axle = rear or car.front
        x = -axle.distance if rear else axle.distance
        y = {"left": 0.5, "right": -0.5}.get(place.rpartition("_")[2], 0.0) * car.track
        load = car.static_loads["rear" if rear else "front"]
        # time stands first
        joint = model.joint(f"wheel{place}")
        at, rate = 1 + int(joint.qposadr[0]), 1 + model.nq + int(joint.dofadr[0])
        control = int(model.actuator_ctrladr[model.actuator(name).id])
        behind = wheelbase if rear else 0.0
        tyre = (axle.tyre_stiffness, load, axle.tyre_damping)
        corners.append((control, at, rate, *tyre, behind, x, y))
        tyres.append(int(model.sensor(f"tyre_force{place}").adr[0]))
        travels.append(int(model.sensor(f"suspension_travel{place}").adr[0]))
    return _Model(
        model, tuple(corners), tuple(tyres), tuple(travels), _at_once(model, corners), one_sided
    )


def _at_once(model: mujoco.MjModel, corners: Sequence[tuple]) -> Array:
    """Sensors per force of each tyre at rest, (wheels, sensors)."""
    data, rows = mujoco.MjData(model), []
    mujoco.mj_forward(model, data)
    rest = data.sensordata.copy()
    for control, _, _, stiffness, *_ in corners:
        data.ctrl[:] = 0.0
        data.ctrl[control] = 1.0 / stiffness
        mujoco.mj_forward(model, data)
        rows.append(data.sensordata - rest)
    return np.array(rows)


def _slowest(model: mujoco.MjModel) -> float:
    """Rate [1/s] at which the slowest mode fades that the car has at rest and that is seen."""
    matrix = step_matrix(model)
    rates = -np.log(np.abs(np.linalg.eigvals(matrix)).clip(1e-12)) / model.opt.timestep
    # an inerter in series with a damper may stand anywhere: that mode does not fade, nor is it felt
    seen = rates[rates > _SLOWEST]
    return float(seen.min()) if seen.size else _SLOWEST


def _run(built: _Model, held: Array, heights: Array, skip: int) -> tuple[Array, Array]:
    """Sensors (n, sensors) and dynamic tyre forces (n, wheels) after `skip` steps, put right.

    `held`, `heights`: what stands over a step, and the road at its beginning, (n, wheels), both
    with its rate times the tyre's lead.
    """
    model = built.model
    data = mujoco.MjData(model)
    control = np.zeros((1, len(held), model.nu))
    control[0][:, [corner[0] for corner in built.corners]] = held
    start = np.zeros((1, mujoco.mj_stateSize(model, mujoco.mjtState.mjSTATE_FULLPHYSICS)))
    mujoco.mj_getState(model, data, start[0], mujoco.mjtState.mjSTATE_FULLPHYSICS)
    states, sensors = rollout.rollout(model, data, start, control)
    # sensors are those of the beginning of a step, states those of its end
    before = np.vstack([start[0], states[0][:-1]])[skip:]
    sensed = sensors[0][skip:]
    wheels = before[:, [corner[1] for corner in built.corners]]
    rates = before[:, [corner[2] for corner in built.corners]]
    if not np.isfinite(sensed).all() or abs(wheels).max(initial=0.0) > 100.0:
        raise ValueError(f"the car diverges with steps of {model.opt.timestep:g} s: shorten --step")
    stiffness, loads, damping = (np.array([c[n] for c in built.corners]) for n in (3, 4, 5))
    forces = stiffness * (heights[skip:] - wheels) - damping * rates
    if built.one_sided:
        forces = np.maximum(forces, -loads)
    return sensed + (forces - sensed[:, built.tyres]) @ built.at_once, forces


def _over_random(
    built: _Model,
    car: CarParts,
    road: PeriodicRoad,
    step: float,
    settle: float,
    parts: tuple[str, ...],
    seed: int,
) -> dict[str, float]:
    """The figures of one road; `step` is that of the model, a period a whole number of them."""
    count = round(road.period / step)
    if not math.isclose(count * step, road.period, rel_tol=1e-9):
        raise ValueError(
            f"--step {step:g}: {road.period:g} s of road are no whole number of such steps; "
            "take 1e-3 or 5e-4"
        )
    lead = round(settle / step)
    times = (np.arange(lead + count) - lead) % count
    fade = np.clip((np.arange(lead + count) + 0.5) * step / FADE, 0.0, 1.0)
    held, heights = [], []
    leads = [corner[5] / corner[3] for corner in built.corners]
    for ahead, (*_, behind, _, y) in zip(leads, built.corners, strict=True):
        side = round(math.copysign(1.0, y)) if car.kind == "full" else 0
        own = road.led(ahead)
        for f, into, rising in ((own.held, held, fade), (own.instants, heights, 1.0)):
            into.append(track(f, seed, count, behind, side, car.correlation)[times] * rising)
    sensed, forces = _run(built, np.array(held).T, np.array(heights).T, lead)
    # what the steps cannot follow acts on the tyre, and through a rigid inerter on the body
    stiffness = np.array([corner[3] for corner in built.corners])

    def missed(part: str) -> Array:
        gain = partial(gain_of, part)
        squares = [road.left_out(count, gain=gain, leads=(ahead,))[0, 0] for ahead in leads]
        return np.array(squares) * stiffness**2

    return _figures(built, sensed, forces, step, parts, missed)


def _over_profile(
    built: _Model, profile: Profile, step: float, after: float, parts: tuple[str, ...]
) -> dict[str, float]:
    wheelbase = max(corner[6] for corner in built.corners)
    seconds = profile.duration + wheelbase / profile.speed + after
    times = step * np.arange(math.ceil(seconds / step), dtype=np.float64)

    def at(shift: float) -> Array:
        shifted: Array = np.asarray(times + shift, dtype=np.float64)
        after, before = shifted + 0.5 * step, shifted - 0.5 * step
        tracks = []
        for _, _, _, kt, _, ct, behind, _, y in built.corners:
            rise = profile.height(after, behind, y) - profile.height(before, behind, y)
            tracks.append(profile.height(shifted, behind, y) + ct / kt * rise / step)
        return np.array(tracks).T

    sensed, forces = _run(built, at(0.5 * step), at(0.0), 0)
    return _figures(built, sensed, forces, step, parts)


def _figures(
    built: _Model,
    sensed: Array,
    forces: Array,
    step: float,
    parts: tuple[str, ...],
    missed: Callable[[str], Array] | None = None,
) -> dict[str, float]:
    """See the module, and rms values of `parts`.

    `missed`: mean square of each tyre's force, filtered as a part is, that the steps did not
    follow. A run with it is a whole period, one without is followed by rest.
    """
    model = built.model
    place = int(model.sensor("body_acceleration").adr[0]) + 2
    columns = [sensed[:, place]] * len(built.corners)
    rows = [built.at_once[:, place]] * len(built.corners)
    names = {model.sensor(n).name for n in range(model.nsensor)}
    turning: dict[str, tuple[Array, Array]] = {}
    if "body_angular_acceleration" in names:
        roll = int(model.sensor("body_angular_acceleration").adr[0])
        arms = [(y, -x) for *_, x, y in built.corners]
        turned = [sensed[:, roll + n] for n in range(2)]
        columns = [columns[0] + a * turned[0] + b * turned[1] for a, b in arms]
        hit = [built.at_once[:, roll + n] for n in range(2)]
        rows = [rows[0] + a * hit[0] + b * hit[1] for a, b in arms]
        turning["pitch"] = turned[1][None], hit[1][None]
        if len(built.corners) == 4:
            turning["roll"] = turned[0][None], hit[0][None]
    points = np.array(columns)
    travel = sensed[:, built.travels]
    # each signal, and its rows per force of each tyre
    signals = {
        "J1": (points, np.array(rows)),
        "J3": (forces.T, np.eye(len(built.corners))),
        "travel": (travel.T, np.zeros((1, len(built.corners)))),
        **turning,
    }
    found = {}
    for part in dict.fromkeys((*signals, "J1w", *parts)):
        series, per_force = signals[signal_of(part)]
        felt = INDICES[part].filter
        if felt is not None:
            size = series.shape[1] * (1 if missed is not None else 2)
            f = np.fft.rfftfreq(size, step)
            filtered = np.fft.irfft(np.fft.rfft(series, size) * felt(2j * np.pi * f), size)
            series = filtered[:, : series.shape[1]]
        extra = 0.0 if missed is None else float(np.mean(per_force**2 @ missed(part)))
        found[part] = math.sqrt(_rms(series) ** 2 + extra)
    loads = np.array([corner[4] for corner in built.corners])
    return {
        **found,
        "lift_off": float(np.mean(forces <= -loads)),
        "acceleration_peak": float(abs(points).max()),
        "tyre_peak": float(forces.max()),
        "travel_peak": float(abs(travel).max()),
    }


def _index(name: str, found: Mapping[str, float]) -> float:
    return float(index_of(name, {part: np.asarray(value) for part, value in found.items()}))


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
