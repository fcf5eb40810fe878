"""A strut as a spring, a damper, an inerter and what is left, which has states of its own.

The dynamic stiffness of a layout is D(s) = k + s Z(s): a spring beside a network whose impedance
Z = m s + d + R(s), R strictly proper, follows from it by division of polynomials. The spring is set
to 0 before the division, so nothing is left of it to cancel.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.suspension.layouts import Layout, SeriesPair
from inerter.suspension.rational import Coefficients, Rational, add, evaluate


@dataclass(frozen=True)
class VehicleStrut:
    """`stiffness` k [N/m], `damping` c [N s/m], `inertance` b [kg] of the struts of one axle.

    `relaxation_stiffness` k_b [N/m] (inf: rigid), `centring_share`, `centring_ratio` where the
    layout has them.
    """

    stiffness: float
    damping: float
    inertance: float = 0.0
    relaxation_stiffness: float | None = None
    centring_share: float | None = None
    centring_ratio: float | None = None

    def layout_values(self) -> dict[str, float]:
        """What `branch` takes beside stiffness, by name."""
        return {name: x for name, x in vars(self).items() if x is not None and name != "stiffness"}


@dataclass(frozen=True)
class Branch:
    """Struts of one axle for arrays of designs: force k x + m x'' + d x' + R x'.

    Attributes
    ----------
    stiffness, mass, damping
        k [N/m], m [kg], d [N s/m], shape of the designs.
    rest
        R(s) [N s/m], strictly proper, its denominator monic; none where its order is 0.
    """

    stiffness: NDArray[Any]
    mass: NDArray[Any]
    damping: NDArray[Any]
    rest: Rational

    @property
    def order(self) -> int:
        """Number of states of R."""
        return self.rest.denominator.shape[-1] - 1

    def dynamic_stiffness(self, s: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """D(s) [N/m] and its derivative in s, which has a last axis more than the designs."""
        k, m, d = (x[..., None] for x in (self.stiffness, self.mass, self.damping))
        top, slope = _with_slope(self.rest.numerator[..., None, :], s)
        below, incline = _with_slope(self.rest.denominator[..., None, :], s)
        rest = top / below
        impedance = m * s + d + rest
        change = m + (slope - rest * incline) / below
        return k + s * impedance, impedance + s * change

    def parameter_slopes(self, s: NDArray[Any], step: float) -> NDArray[Any]:
        """Derivative of D(s) in each of the variables in which entries 1 ... have a complex step.

        The first axis of this branch is a design, then the same with an imaginary `step` in each
        variable; the answer has shape (variables, len(s)).
        """

        def change(x: NDArray[Any]) -> NDArray[Any]:
            return np.imag(x[1:]) / step

        top, below = self.rest.numerator, self.rest.denominator
        k, m, d = (change(x)[..., None] for x in (self.stiffness, self.mass, self.damping))
        under = evaluate(np.real(below[0]), s)
        rest = evaluate(np.real(top[0]), s) / under if self.order else 0.0
        up = evaluate(change(top)[..., None, :], s) if self.order else 0.0
        down = evaluate(change(below)[..., None, :], s)
        return k + s * (m * s + d + (up - rest * down) / under)


def branch(
    layout: Layout,
    stiffness: ArrayLike,
    damping: ArrayLike,
    inertance: ArrayLike = 0.0,
    relaxation_stiffness: ArrayLike = 1.0,
    *,
    centring_share: ArrayLike = 0.0,
    centring_ratio: ArrayLike = 1.0,
    pair: SeriesPair | None = None,
) -> Branch:
    """The struts of a layout, divided; parameters as in `Layout.stiffness`."""
    network = layout.stiffness(
        0.0,
        damping,
        inertance,
        relaxation_stiffness,
        centring_share=centring_share,
        centring_ratio=centring_ratio,
        total_stiffness=stiffness,
        pair=pair,
    )
    top, below = _trimmed(network.numerator), _trimmed(network.denominator)
    # what of the network is a spring at rest; none of the layouts has any
    static = top[..., :1] / below[..., :1]
    if static.any() and not layout.centred:
        top = add(top, -static * below)
    shape = np.broadcast_shapes(top.shape[:-1], below.shape[:-1], np.shape(stiffness))
    below, top = below / below[..., -1:], (top / below[..., -1:])[..., 1:]
    order = below.shape[-1] - 1
    if top.shape[-1] > order + 2:
        raise ValueError(f"layout {layout.name}: its stiffness grows faster than s^2")
    missing = order + 2 - top.shape[-1]
    top = np.concatenate([top, np.zeros((*top.shape[:-1], missing))], axis=-1)
    # two steps of division
    mass = top[..., order + 1]
    rest = top[..., : order + 1].copy()
    rest[..., 1:] -= mass[..., None] * below[..., :order]
    damping_left = rest[..., order]
    remainder = rest[..., :order] - damping_left[..., None] * below[..., :order]
    return Branch(
        np.broadcast_to(np.asarray(stiffness) + (0.0 if layout.centred else static[..., 0]), shape),
        np.broadcast_to(mass, shape),
        np.broadcast_to(damping_left, shape),
        Rational(
            np.broadcast_to(remainder, (*shape, order)),
            np.broadcast_to(below, (*shape, order + 1)),
        ),
    )


def _with_slope(p: Coefficients, s: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """A polynomial and its derivative at s (Horner)."""
    value, slope = 0.0 * s, 0.0 * s
    for k in range(p.shape[-1] - 1, -1, -1):
        slope = slope * s + value
        value = value * s + p[..., k]
    return value, slope


def _trimmed(p: Coefficients) -> Coefficients:
    """Without highest powers that no design has."""
    while p.shape[-1] > 1 and not p[..., -1].any():
        p = p[..., :-1]
    return p
