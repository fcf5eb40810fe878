"""Random devices: an ideal inerter plus one effect of a drawn size.

The effect's size follows from its share of the force, rms(F - b a) / rms(F), drawn from 5 to
40 %; with the friction law's shape fixed the effect is linear in one size p, so p solves

    p^2 <e e> (1 - s^2) - 2 s^2 p <i e> - s^2 <i i> = 0,   i = b a, e the effect at p = 1.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from .bench_motions import Drive
from .device import ReferenceDevice
from .motion import response


def draw_device(
    draw: Generator, effect: str, law: str | None, ideal: ReferenceDevice, drives: list[Drive]
) -> tuple[ReferenceDevice, tuple[str, ...]]:
    """The device with its effect sized, and the names of the parameters that were hidden."""
    travels = [float(np.max(abs(drive.displacement))) for drive in drives]
    travel = max(travels)
    speed = float(np.median([rms(np.asarray(d.motion.velocity(d.time))) for d in drives]))
    names: tuple[str, ...]

    # a device whose effect has unit size; `scaling` lists what grows with the size
    if effect in ("none", "sensor_delay"):
        return ideal, ()
    if effect == "hysteretic_friction":
        unit, scaling, names = _unit_hysteresis(draw, str(law), ideal, min(travels))
    elif effect == "stribeck_friction":
        unit = replace(
            ideal,
            friction="stribeck",
            coulomb_force=1.0,
            static_force=rounded(draw.uniform(1.5, 2.5)),
            stribeck_velocity=rounded(speed * draw.uniform(0.1, 0.4)),
        )
        scaling = ("coulomb_force", "static_force")
        names = (*scaling, "stribeck_velocity")
    elif effect == "asymmetric_friction":
        asymmetry = rounded(draw.uniform(0.2, 0.6) * draw.choice([-1.0, 1.0]))
        unit = replace(ideal, friction="coulomb", coulomb_force=1.0, friction_asymmetry=asymmetry)
        scaling, names = ("coulomb_force",), ("coulomb_force", "friction_asymmetry")
    elif effect == "position_dependent_friction":
        gradient, curvature = _draw_level(draw, travel)
        unit = replace(
            ideal,
            friction="coulomb",
            coulomb_force=1.0,
            friction_gradient=gradient,
            friction_curvature=curvature,
        )
        scaling = ("coulomb_force",)
        names = ("coulomb_force", "friction_gradient", "friction_curvature")
    else:
        key = _SIZES[effect]
        sign = float(draw.choice([-1.0, 1.0])) if effect == "force_offset" else 1.0
        friction = "coulomb" if effect == "coulomb_friction" else "none"
        # load friction is linear only up to 1, so its unit stays below
        size = 0.5 if effect == "load_dependent_friction" else sign
        unit = replace(ideal, friction=friction, **{key: size})
        scaling, names = (key,), (key,)

    share = draw.uniform(0.05, 0.40)
    size = _size_for_share(share, ideal, unit, drives)
    sized = {key: rounded(getattr(unit, key) * size) for key in scaling}
    return replace(unit, **sized), names


_SIZES = {
    "viscous_friction": "viscous",
    "coulomb_friction": "coulomb_force",
    "load_dependent_friction": "load_friction",
    "parallel_stiffness": "stiffness",
    "force_offset": "force_offset",
    "quadratic_damping": "quadratic_damping",
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


def _unit_hysteresis(
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


def _size_for_share(
    share: float, ideal: ReferenceDevice, unit: ReferenceDevice, drives: list[Drive]
) -> float:
    """The factor on `unit`'s effect that makes it `share` of the force rms over all runs."""
    bare = np.concatenate([ideal.inertance * drive.acceleration for drive in drives])
    full = np.concatenate(
        [response(unit, drive.motion, drive.time, rtol=1e-6).force for drive in drives]
    )
    extra = full - bare
    square = share * share
    roots = np.roots(
        [
            np.mean(extra * extra) * (1.0 - square),
            -2.0 * square * np.mean(bare * extra),
            -square * np.mean(bare * bare),
        ]
    )
    return float(np.max(roots.real))


def rms(signal: NDArray[np.float64]) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(signal * signal)))


def rounded(value: float) -> float:
    """Four significant digits: numbers a person could have set."""
    return float(f"{float(value):.4g}")
