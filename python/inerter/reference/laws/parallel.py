"""The branches beside inertance and friction: dampers, springs, offset.

    F = (1 + kappa sgn v) (c D(v) + c2 v |v|) + k (x - l0) + k3 (x - l0)^3 + f0
    D(v) = r v + (1 - r) v (1 + |v / v_k|^n)^((alpha - 1) / n), v without a knee; v_k, r by sgn(v)

Symbols: c `viscous` [N s/m], c2 `quadratic_damping` [N s^2/m^2], kappa `damping_asymmetry`,
v_k `damping_knee` [m/s], r `damping_beyond` (v < 0: `damping_knee_back`, `damping_beyond_back`,
where given), n `damping_sharpness`, alpha `damping_exponent`, k `stiffness` [N/m],
k3 `stiffness_cubic` [N/m^3], l0 `rest_length` [m], f0 `force_offset` [N].
Sign: tension positive.
Range: passive for c, c2 >= 0; the offset is work done from outside and counts as neither
stored nor dissipated.
Stored: k (x - l0)^2 / 2 + k3 (x - l0)^4 / 4. Dissipated: (1 + kappa sgn v) (c D(v) v + c2 |v|^3).
Source: elementary; a published set's sigma2, c_d, c0 all are c.
Not modelled: frequency-dependent damping but that of a spring (`damper_spring.py`); end stops and
gas stand in their own files.
"""

from __future__ import annotations

import numpy as np

from .parameters import Quantity


def spring_force(extension: Quantity, stiffness: float, stiffness_cubic: float) -> Quantity:
    """Spring force [N] at the extension x - l0 [m]."""
    return (stiffness + stiffness_cubic * extension * extension) * extension


def spring_energy(extension: Quantity, stiffness: float, stiffness_cubic: float) -> Quantity:
    """Energy [J] in the springs at the extension x - l0 [m]."""
    square = extension * extension
    return (0.5 * stiffness + 0.25 * stiffness_cubic * square) * square


def _bent(
    velocity: Quantity, knee: float, beyond: float, sharpness: float, exponent: float
) -> Quantity:
    """D [m/s] at the velocity [m/s]."""
    if not knee:
        return velocity
    speed = abs(velocity)
    larger, smaller = np.maximum(speed, knee), np.minimum(speed, knee)
    size = larger * (1.0 + (smaller / larger) ** sharpness) ** (1.0 / sharpness)
    return velocity * (beyond + (1.0 - beyond) * (knee / size) ** (1.0 - exponent))


def _bent_slope(
    velocity: Quantity, knee: float, beyond: float, sharpness: float, exponent: float
) -> Quantity:
    """D' [-] at the velocity [m/s]."""
    if not knee:
        return 1.0 + 0.0 * velocity
    speed = abs(velocity)
    larger, smaller = np.maximum(speed, knee), np.minimum(speed, knee)
    ratio = (smaller / larger) ** sharpness
    size = larger * (1.0 + ratio) ** (1.0 / sharpness)
    # d ln(size) / d ln(speed), and what it is short of 1
    share = np.where(np.less(speed, knee), ratio, 1.0) / (1.0 + ratio)
    short = np.where(np.less(speed, knee), 1.0, ratio) / (1.0 + ratio)
    turned = short + exponent * share
    return beyond + (1.0 - beyond) * (knee / size) ** (1.0 - exponent) * turned


def damping_slope(
    velocity: Quantity,
    viscous: float,
    quadratic_damping: float,
    asymmetry: float = 0.0,
    forth: tuple[float, float] = (0.0, 1.0),
    back: tuple[float, float] | None = None,
    sharpness: float = 2.0,
    exponent: float = 0.0,
) -> Quantity:
    """Slope [N s/m] of `damping_force` over the velocity."""
    slope = _bent_slope(velocity, *forth, sharpness, exponent)
    shrinks = np.less(velocity, 0.0)
    if back is not None and back != forth:
        slope = np.where(shrinks, _bent_slope(velocity, *back, sharpness, exponent), slope)
    side = np.where(shrinks, 1.0 - asymmetry, 1.0 + asymmetry)
    return side * (viscous * slope + 2.0 * quadratic_damping * abs(velocity))


def damping_force(
    velocity: Quantity,
    viscous: Quantity,
    quadratic_damping: float,
    asymmetry: float = 0.0,
    forth: tuple[float, float] = (0.0, 1.0),
    back: tuple[float, float] | None = None,
    sharpness: float = 2.0,
    exponent: float = 0.0,
) -> Quantity:
    """Damper force [N] at the velocity [m/s]; knee [m/s] and slope beyond it, forth and back."""
    bent = _bent(velocity, *forth, sharpness, exponent)
    if back is not None and back != forth:
        bent = np.where(np.less(velocity, 0.0), _bent(velocity, *back, sharpness, exponent), bent)
    force = viscous * bent + quadratic_damping * abs(velocity) * velocity
    return force + asymmetry * abs(force)
