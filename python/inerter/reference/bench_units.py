"""Effects of unit size on an ideal inerter: the shape of each is drawn, its size follows.

See `bench_devices`, which sizes them by their share of the force.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from .bench_channel import Channel, Situation
from .bench_motions import is_free_of
from .device import ReferenceDevice
from .sizes import rms, rounded


@dataclass(frozen=True, kw_only=True)
class Unit:
    """An effect of unit size; `scaling` lists what grows with it, `share` bounds what is drawn."""

    device: ReferenceDevice
    channel: Channel
    scaling: tuple[str, ...]
    names: tuple[str, ...]
    share: tuple[float, float] = (0.05, 0.40)
    largest: float = np.inf


def travel_of(runs: list[Situation]) -> float:
    """The largest displacement [m] of all runs."""
    return max(float(np.max(abs(run.drive.displacement))) for run in runs)


def _stribeck(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    drives = [run.drive for run in runs]
    speed = float(np.median([rms(np.asarray(d.motion.velocity(d.time))) for d in drives]))
    unit = replace(
        ideal,
        friction="stribeck",
        coulomb_force=1.0,
        static_force=rounded(draw.uniform(1.5, 2.5)),
        stribeck_velocity=rounded(speed * draw.uniform(0.1, 0.4)),
    )
    scaling = ("coulomb_force", "static_force")
    return Unit(
        device=unit, channel=Channel(), scaling=scaling, names=(*scaling, "stribeck_velocity")
    )


def _asymmetric(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    asymmetry = rounded(draw.uniform(0.2, 0.6) * draw.choice([-1.0, 1.0]))
    unit = replace(ideal, friction="coulomb", coulomb_force=1.0, friction_asymmetry=asymmetry)
    return Unit(
        device=unit,
        channel=Channel(),
        scaling=("coulomb_force",),
        names=("coulomb_force", "friction_asymmetry"),
    )


def _uneven_damper(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    asymmetry = rounded(draw.uniform(0.2, 0.6) * draw.choice([-1.0, 1.0]))
    return Unit(
        device=replace(ideal, viscous=1.0, damping_asymmetry=asymmetry),
        channel=Channel(),
        scaling=("viscous",),
        names=("viscous", "damping_asymmetry"),
    )


def _digressive(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    drives = [run.drive for run in runs]
    speed = float(np.median([rms(np.asarray(d.motion.velocity(d.time))) for d in drives]))
    unit = replace(
        ideal,
        viscous=1.0,
        damping_knee=rounded(speed * draw.uniform(0.3, 1.0)),
        damping_beyond=rounded(draw.uniform(0.1, 0.4)),
    )
    names = ("viscous", "damping_knee", "damping_beyond")
    if draw.random() < 1.0 / 4.0:
        # oil that thins, or an eddy-current brake
        power = draw.choice([-1.0, rounded(draw.uniform(0.25, 0.6))])
        unit = replace(unit, damping_beyond=0.0, damping_exponent=float(power))
        names = ("viscous", "damping_knee", "damping_exponent")
        return Unit(device=unit, channel=Channel(), scaling=("viscous",), names=names)
    if draw.random() < 1.0 / 3.0:
        # the valve of the other direction opens at another speed
        ratio = draw.uniform(1.6, 2.5) ** draw.choice([-1.0, 1.0])
        unit = replace(unit, damping_knee_back=rounded(unit.damping_knee * ratio))
        names += ("damping_knee_back",)
    if draw.random() < 1.0 / 3.0:
        unit = replace(unit, damping_sharpness=rounded(draw.uniform(4.0, 20.0)))
    return Unit(device=unit, channel=Channel(), scaling=("viscous",), names=names)


def _position(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    if draw.integers(0, 4) == 3:
        row = _draw_period(draw, runs, rounded(draw.uniform(0.3, 0.8)))
        bent = replace(ideal, friction="coulomb", coulomb_force=1.0, friction_periods=row)
        names = ("coulomb_force",)
        return Unit(device=bent, channel=Channel(), scaling=names, names=names)
    gradient, curvature = _draw_level(draw, travel_of(runs))
    unit = replace(
        ideal,
        friction="coulomb",
        coulomb_force=1.0,
        friction_gradient=gradient,
        friction_curvature=curvature,
    )
    names = ("coulomb_force", "friction_gradient", "friction_curvature")
    return Unit(device=unit, channel=Channel(), scaling=("coulomb_force",), names=names)


def _friction_drift(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    # 30 to 100 % over the whole set; a level that falls keeps a twentieth
    change = draw.uniform(0.3, 1.0) * draw.choice([-1.0, 1.0])
    whole = runs[-1].start + float(runs[-1].drive.time[-1])
    channel = Channel(friction_drift=rounded(max(change, -0.95) / whole))
    unit = replace(ideal, friction="coulomb", coulomb_force=1.0)
    return Unit(
        device=unit,
        channel=channel,
        scaling=("coulomb_force",),
        names=("coulomb_force", "friction_drift"),
    )


def _viscous_drift(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    # 30 to 100 % over the whole set; a damping that falls keeps a twentieth
    change = draw.uniform(0.3, 1.0) * draw.choice([-1.0, 1.0])
    whole = runs[-1].start + float(runs[-1].drive.time[-1])
    return Unit(
        device=replace(ideal, viscous=1.0),
        channel=Channel(viscous_drift=rounded(max(change, -0.95) / whole)),
        scaling=("viscous",),
        names=("viscous", "viscous_drift"),
    )


def _relaxing(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    # relaxes between a tenth and twice the time in which the motion turns by one radian
    x, v = (
        np.concatenate([np.asarray(getattr(r.drive.motion, name)(r.drive.time)) for r in runs])
        for name in ("displacement", "velocity")
    )
    time = float(np.std(x)) / rms(v) * float(np.exp(draw.uniform(np.log(0.1), np.log(2.0))))
    names = ("branch_stiffness_1", "branch_damping_1")
    unit = replace(ideal, branch_stiffness_1=1.0, branch_damping_1=rounded(time))
    return Unit(device=unit, channel=Channel(), scaling=names, names=names)


def _rate_state(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    unit = replace(
        ideal,
        friction="rate_state",
        coulomb_force=1.0,
        rate_effect=rounded(draw.uniform(0.01, 0.06)),
        age_effect=rounded(draw.uniform(0.01, 0.06)),
        age_distance=rounded(travel_of(runs) * np.exp(draw.uniform(np.log(2e-3), np.log(2e-2)))),
    )
    names = ("coulomb_force", "rate_effect", "age_effect", "age_distance")
    return Unit(device=unit, channel=Channel(), scaling=names[:1], names=names, share=(0.15, 0.40))


def _cogging(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    row = _draw_period(draw, runs, 1.0)
    unit = replace(ideal, force_periods=row)
    return Unit(device=unit, channel=Channel(), scaling=("force_periods",), names=())


def _draw_period(draw: Generator, runs: list[Situation], amplitude: float) -> tuple[float, ...]:
    """Length [m], amplitude and phase [rad] of a sine of the place: 3 to 12 along the stroke."""
    x = np.concatenate([run.drive.displacement for run in runs])
    length = float(np.ptp(x)) / draw.uniform(3.0, 12.0)
    return rounded(length), amplitude, rounded(draw.uniform(-np.pi, np.pi))


def _gas(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    area = rounded(np.exp(draw.uniform(np.log(1e-4), np.log(2e-3))))
    # at the end of the stroke half to a fifth of the gas is compressed away
    reach = travel_of(runs) * draw.uniform(1.5, 4.0)
    unit = replace(
        ideal,
        gas_pressure=1.0 / area,
        gas_area=area,
        gas_volume=rounded(area * reach),
        gas_exponent=rounded(draw.uniform(1.05, 1.38)),
    )
    names = ("gas_pressure", "gas_area", "gas_volume", "gas_exponent")
    return Unit(device=unit, channel=Channel(), scaling=("gas_pressure",), names=names)


def _end_stop(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    x = np.concatenate([run.drive.displacement for run in runs])
    v = np.concatenate([np.asarray(run.drive.motion.velocity(run.drive.time)) for run in runs])
    time = draw.uniform(0.03, 0.20)
    side = str(draw.choice(["upper", "lower", "both"]))
    within = 0.5 * time if side == "both" else time
    stops: dict[str, float] = {}
    if side != "lower":
        stops["stop_upper"] = rounded(float(np.quantile(x, 1.0 - within)))
    if side != "upper":
        stops["stop_lower"] = rounded(float(np.quantile(x, within)))
    damping = rounded(draw.uniform(0.1, 0.5) / float(np.max(abs(v))))
    unit = replace(ideal, **stops, stop_stiffness=1.0, stop_damping=damping)
    scaling: tuple[str, ...] = ("stop_stiffness",)
    # one of three is of rubber, two to six times as stiff where it is deepest
    stiffer = draw.uniform(1.0, 5.0)
    if draw.integers(0, 3) == 2:
        beyond = [side * (place - end) for side, place, end in (
            (1.0, float(np.max(x)), stops.get("stop_upper", np.inf)),
            (-1.0, float(np.min(x)), stops.get("stop_lower", -np.inf)),
        )]  # fmt: skip
        unit = replace(unit, stop_stiffness_cubic=rounded(stiffer / max(beyond) ** 2))
        scaling = (*scaling, "stop_stiffness_cubic")
    names = (*stops, *scaling, "stop_damping")
    return Unit(device=unit, channel=Channel(), scaling=scaling, names=names, share=(0.10, 0.40))


def _variable(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    kind = int(draw.integers(0, 5))
    sign = float(draw.choice([-1.0, 1.0]))
    if kind == 4:
        # a tooth's error or an eccentric gear
        unit = replace(ideal, inertance_periods=_draw_period(draw, runs, 0.02))
        return Unit(
            device=unit, channel=Channel(), scaling=("inertance_periods",), names=(),
            share=(0.05, 0.30), largest=7.0,
        )  # fmt: skip
    names = (
        ("inertance_gradient",),
        ("inertance_curvature",),
        ("inertance_gradient", "inertance_curvature"),
        ("inertance_speed_gradient",),
    )[kind]
    travel = travel_of(runs)
    fastest = max(float(np.max(abs(r.drive.motion.velocity(r.drive.time)))) for r in runs)
    ends = {
        "inertance_gradient": travel,
        "inertance_curvature": travel**2,
        "inertance_speed_gradient": fastest,
    }
    # the factor changes by 0.1 at the end of the stroke or of the speed; seven times that at most
    part = 0.1 / len(names)
    signs = [sign, float(draw.choice([-1.0, 1.0]))]
    values = {n: s * part / ends[n] for n, s in zip(names, signs, strict=False)}
    return Unit(
        device=replace(ideal, **values),
        channel=Channel(),
        scaling=names,
        names=names,
        share=(0.05, 0.30),
        largest=7.0,
    )


def _tone(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    drives = [run.drive for run in runs]
    frequency = 45.0
    for _ in range(100):
        frequency = rounded(np.exp(draw.uniform(np.log(0.5), np.log(45.0))))
        if is_free_of(drives, frequency):
            break
    channel = Channel(disturbance_amplitude=1.0, disturbance_frequency=frequency)
    names = ("disturbance_amplitude", "disturbance_frequency")
    return Unit(device=ideal, channel=channel, scaling=names[:1], names=names)


def _force_drift(draw: Generator, ideal: ReferenceDevice, runs: list[Situation]) -> Unit:
    names = ("force_drift",)
    return Unit(
        device=ideal,
        channel=Channel(force_drift=float(draw.choice([-1.0, 1.0]))),
        scaling=names,
        names=names,
    )


def plain(draw: Generator, effect: str, ideal: ReferenceDevice) -> Unit:
    """One parameter in proportion to the force."""
    key = _SIZES[effect]
    sign = float(draw.choice([-1.0, 1.0])) if effect == "force_offset" else 1.0
    friction = "coulomb" if effect == "coulomb_friction" else "none"
    # load friction is linear only up to 1, so its unit stays below
    size = 0.5 if effect == "load_dependent_friction" else sign
    return Unit(
        device=replace(ideal, friction=friction, **{key: size}),
        channel=Channel(),
        scaling=(key,),
        names=(key,),
    )


_SIZES = {
    "viscous_friction": "viscous",
    "coulomb_friction": "coulomb_force",
    "load_dependent_friction": "load_friction",
    "parallel_stiffness": "stiffness",
    "hardening_stiffness": "stiffness_cubic",
    "force_offset": "force_offset",
    "quadratic_damping": "quadratic_damping",
}

UNITS: dict[str, Callable[[Generator, ReferenceDevice, list[Situation]], Unit]] = {
    "stribeck_friction": _stribeck,
    "asymmetric_friction": _asymmetric,
    "asymmetric_damping": _uneven_damper,
    "digressive_damping": _digressive,
    "position_dependent_friction": _position,
    "friction_drift": _friction_drift,
    "viscous_drift": _viscous_drift,
    "viscoelasticity": _relaxing,
    "rate_state_friction": _rate_state,
    "position_force": _cogging,
    "gas_spring": _gas,
    "end_stop": _end_stop,
    "variable_inertance": _variable,
    "periodic_disturbance": _tone,
    "force_drift": _force_drift,
}


def _draw_level(draw: Generator, travel: float) -> tuple[float, float]:
    """Gradient [1/m] and curvature [1/m^2] that keep the level within 0.1 .. 1.9 of its middle."""
    slope = draw.uniform(0.3, 0.8) * draw.choice([-1.0, 1.0])
    bend = draw.uniform(0.3, 0.8) * draw.choice([-1.0, 1.0])
    kind = int(draw.integers(0, 3))
    if kind == 0:
        bend = 0.0
    elif kind == 1:
        slope = 0.0
    else:
        slope, bend = 0.5 * slope, 0.5 * bend
    return rounded(slope / travel), rounded(bend / travel**2)


def hysteresis(
    draw: Generator, law: str, ideal: ReferenceDevice, travel: float
) -> tuple[ReferenceDevice, tuple[str, ...], tuple[str, ...]]:
    """A law that saturates at unit force after 5 to 50 % of the smallest run's travel [m]."""
    reach = float(np.exp(draw.uniform(np.log(0.05), np.log(0.5)))) * travel
    if law == "bouc_wen":
        exponent = rounded(draw.uniform(1.0, 2.0))
        narrowing = reach**-exponent
        shape = draw.uniform(0.5, 0.9)
        unit = replace(
            ideal,
            friction=law,
            bw_beta=rounded(shape * narrowing),
            bw_gamma=rounded((1.0 - shape) * narrowing),
            bw_exponent=exponent,
            bw_ratio=rounded(draw.uniform(0.0, 0.1)),
            bw_stiffness=1.0 / reach,
        )
        names = ("bw_alpha", "bw_beta", "bw_gamma", "bw_exponent", "bw_stiffness", "bw_ratio")
        return unit, ("bw_stiffness",), names
    scaling: tuple[str, ...] = ("coulomb_force", "bristle_stiffness")
    if law == "dahl":
        unit = replace(ideal, friction=law, coulomb_force=1.0, bristle_stiffness=1.0 / reach)
        return unit, scaling, scaling
    unit = replace(
        ideal,
        friction=law,
        coulomb_force=1.0,
        bristle_stiffness=1.0 / reach,
        static_force=rounded(draw.uniform(1.3, 2.0)),
        stribeck_velocity=rounded(np.exp(draw.uniform(np.log(3e-3), np.log(3e-2)))),
        bristle_damping=draw.uniform(0.2e-3, 1e-3) / reach,
    )
    scaling = (*scaling, "static_force", "bristle_damping")
    return unit, scaling, (*scaling, "stribeck_velocity")
