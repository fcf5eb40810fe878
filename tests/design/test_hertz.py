"""Elliptical contact: closed forms for spheres, Boussinesq's integral, an approximate formula."""

import math

import numpy as np
import pytest
from inerter.design.hertz import axis_ratio, contact, contact_modulus
from scipy.integrate import dblquad, quad

MODULUS = contact_modulus(206e9, 0.3)


@pytest.mark.parametrize(("radius", "load"), [(3e-3, 5.0), (0.2, 1e4)])
def test_sphere_on_plane(radius: float, load: float) -> None:
    found = contact(1 / radius, 1 / radius, load, MODULUS)
    a = (3 * load * radius / (4 * MODULUS)) ** (1 / 3)
    assert (found.major, found.minor) == pytest.approx((a, a), rel=1e-12)
    assert found.approach == pytest.approx(a**2 / radius, rel=1e-12)
    peak = (6 * load * MODULUS**2 / (math.pi**3 * radius**2)) ** (1 / 3)
    assert found.pressure == pytest.approx(peak, rel=1e-12)
    assert found.spin_moment(0.2) == pytest.approx(3 * math.pi / 16 * 0.2 * load * a, rel=1e-12)


def pressed(found, x: float, y: float) -> float:
    """Depth [m] of the half-space at a point of the ellipse: Boussinesq in polar coordinates."""

    def along(turn: float) -> float:
        c, s = math.cos(turn), math.sin(turn)
        # pressure along the ray is p0 sqrt(free - 2 mixed r - square r^2)
        square = (c / found.major) ** 2 + (s / found.minor) ** 2
        mixed = x * c / found.major**2 + y * s / found.minor**2
        free = 1 - (x / found.major) ** 2 - (y / found.minor) ** 2
        top = free + mixed**2 / square
        start = math.asin(min(1.0, mixed / math.sqrt(square * top)))
        swept = math.pi / 2 - start - math.sin(2 * start) / 2
        return 0.5 * top / math.sqrt(square) * swept

    return found.pressure * quad(along, 0, 2 * math.pi, epsrel=1e-11)[0] / (math.pi * MODULUS)


@pytest.mark.parametrize("other", [330.0, 900.0, 6000.0])
def test_surfaces_meet_inside_the_ellipse(other: float) -> None:
    curvature, load = 300.0, 40.0
    found = contact(curvature, other, load, MODULUS)
    assert found.load == pytest.approx(2 / 3 * math.pi * found.major * found.minor * found.pressure)
    for x, y in ((0.0, 0.0), (0.7, 0.0), (0.0, 0.6), (0.5, -0.5)):
        x, y = x * found.major, y * found.minor
        gap = 0.5 * curvature * x**2 + 0.5 * other * y**2
        # approach less gap is 1e-6 m: digits are lost in neither
        assert pressed(found, x, y) == pytest.approx(found.approach - gap, rel=1e-8)


@pytest.mark.parametrize("ratio", [1.2, 3.0, 20.0])
def test_close_to_hamrock_and_brewe(ratio: float) -> None:
    # their fit holds for ellipses up to ten times as long as wide
    assert 1 / axis_ratio(ratio) == pytest.approx(1.0339 * ratio**0.6360, rel=0.04)


def test_moment_is_the_integral_over_the_ellipse() -> None:
    found = contact(200.0, 2000.0, 10.0, MODULUS)

    def traction(r: float, turn: float) -> float:
        x, y = found.major * r * math.cos(turn), found.minor * r * math.sin(turn)
        area = found.major * found.minor * r
        return 0.1 * found.pressure * math.sqrt(max(0.0, 1 - r * r)) * math.hypot(x, y) * area

    whole = dblquad(traction, 0, 2 * math.pi, 0, 1, epsabs=0, epsrel=1e-8)[0]
    assert found.spin_moment(0.1) == pytest.approx(whole, rel=1e-6)


def test_size_grows_with_the_cube_root() -> None:
    loads = np.array([1.0, 8.0, 1000.0])
    sizes = [contact(200.0, 500.0, load, MODULUS).major for load in loads]
    assert sizes == pytest.approx(sizes[0] * np.cbrt(loads), rel=1e-12)
    assert contact(200.0, 500.0, 0.0, MODULUS).spin_moment(0.1) == 0.0


def test_a_line_is_refused() -> None:
    with pytest.raises(ValueError, match="not an ellipse"):
        axis_ratio(1e30)
