"""Both routes to each norm against each other, quadrature, closed forms and the reference model."""

import math
from fractions import Fraction

import numpy as np
import pytest
from inerter.reference import QuarterCar as ReferenceCar
from inerter.reference import ReferenceDevice
from inerter.suspension.h2_norm import h2_norm, h2_norm_lyapunov
from inerter.suspension.h_infinity_norm import gain_squared, h_infinity_norm, largest_gain
from inerter.suspension.indices import comfort_function, ride_comfort, tyre_function, tyre_load
from inerter.suspension.layouts import HARD, LAYOUTS, SOFT, SeriesPair
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.rational import Rational
from scipy.integrate import quad
from scipy.linalg import solve_continuous_lyapunov

CAR, ROAD = QuarterCar(), Road()
MS, MU, KT = 181.75, 25.0, 120e3
PAIRS = (None, SOFT, HARD)


def struts(count: int) -> list[tuple[str, Rational]]:
    """Struts over the range in which a designer looks, every layout and series pair."""
    draw = np.random.default_rng(5)
    found = []
    for n in range(count):
        name = f"S{1 + n % 6}"
        c, b, kb = 10.0 ** draw.uniform([2.0, 0.5, 4.0], [5.0, 3.5, 7.0])
        k = 10.0 ** draw.uniform(4.0, 5.5)
        found.append((name, LAYOUTS[name].stiffness(k, c, b, kb, pair=PAIRS[n // 6 % 3])))
    return found


def fourth_order(a: list[float], b: list[float]) -> float:
    """The integral I4 of Newton, Gould and Kaiser; coefficients of s^0 ... s^4 and s^0 ... s^3."""
    a0, a1, a2, a3, a4 = a
    b0, b1, b2, b3 = b
    top = b3**2 * (a0 * a1 * a2 - a0**2 * a3) + (b2**2 - 2 * b1 * b3) * a0 * a1 * a4
    top += (b1**2 - 2 * b0 * b2) * a0 * a3 * a4 + b0**2 * (a2 * a3 * a4 - a1 * a4**2)
    return top / (2 * a0 * a4 * (a1 * a2 * a3 - a0 * a3**2 - a1**2 * a4))


def least_damping(function: Rational) -> float:
    """Damping ratio of the least damped pole."""
    poles = np.roots(function.denominator[::-1])
    return float((-poles.real / np.abs(poles)).min())


def rational_norm(function: Rational) -> float:
    """H2 norm without a rounding error: continued fraction of the coefficients as they are."""
    a = [Fraction(float(x)) for x in function.denominator[::-1]]
    b = [Fraction(float(x)) for x in function.numerator[::-1]]
    b = [Fraction(0)] * (len(a) - 1 - len(b)) + b
    total = Fraction(0)
    while len(a) > 1:
        alpha, beta = a[0] / a[1], b[0] / a[1]
        total += beta * beta / (2 * alpha)
        # the odd part times alpha s comes off the denominator, beta times it off the numerator
        odd = [x if n % 2 else Fraction(0) for n, x in enumerate(a)]
        b = [x - beta * y for x, y in zip(b, odd[1:], strict=True)][1:]
        a = [x - alpha * y for x, y in zip(a, [*odd[1:], Fraction(0)], strict=True)][1:]
    return math.sqrt(total)


@pytest.mark.parametrize("b", [0.0, 7.0, 128.57])
@pytest.mark.parametrize("c", [800.0, 3705.4, 30e3])
@pytest.mark.parametrize("k", [15e3, 120e3])
def test_fourth_order_integral(k: float, c: float, b: float) -> None:
    both = MS + MU
    a = [k * KT, c * KT, MS * KT + k * both + b * KT, c * both, MS * MU + b * both]
    strut = LAYOUTS["S2" if b else "S1"].stiffness(k, c, b)
    body = [0.0, KT * k, KT * c, KT * b]
    tyre = [0.0, KT * k * both, KT * c * both, KT * (MS * MU + b * both)]
    for value, numerator in (
        (ride_comfort(CAR, ROAD, strut), body),
        (tyre_load(CAR, ROAD, strut), tyre),
    ):
        exact = ROAD.slope * np.sqrt(fourth_order(a, numerator))
        assert float(value) == pytest.approx(exact, rel=1e-10)


def test_recursion_and_gramian_agree() -> None:
    compared = 0
    for name, strut in struts(180):
        for function in (comfort_function(CAR, strut), tyre_function(CAR, strut)):
            # a Gramian loses digits with the damping ratio, the recursion does not (see below)
            if least_damping(function) > 1e-4:
                recursion, gramian = float(h2_norm(function)), h2_norm_lyapunov(function)
                assert recursion == pytest.approx(gramian, rel=1e-10), name
                compared += 1
    assert compared > 300


def test_recursion_in_floating_point_is_that_in_rational_numbers() -> None:
    for name, strut in struts(180):
        function = comfort_function(CAR, strut)
        assert float(h2_norm(function)) == pytest.approx(rational_norm(function), rel=1e-10), name


def test_h2_norm_is_the_integral_over_frequency() -> None:
    for name, strut in struts(18):
        function = comfort_function(CAR, strut)

        # over the logarithm of frequency, so that no resonance is narrow
        def density(y: float, function: Rational = function) -> float:
            return float(gain_squared(function, np.exp(2.0 * y))) * np.exp(y)

        pieces = [quad(density, y, y + 1.0, epsrel=1e-11, limit=500)[0] for y in range(-12, 18)]
        found = np.sqrt(sum(pieces) / np.pi)
        assert float(h2_norm(function)) == pytest.approx(found, rel=1e-6), name


@pytest.mark.parametrize(
    ("layout", "pair"), [("S1", None), ("S2", None), ("S3", None), ("S2", SOFT), ("S2", HARD)]
)
def test_white_noise_through_the_reference_model(layout: str, pair: SeriesPair | None) -> None:
    k, c, b = 120e3, 3705.4, 128.57
    device = ReferenceDevice(inertance=0.0 if layout == "S1" else b)
    if pair is not None:
        device = ReferenceDevice(
            inertance=b, series_stiffness=pair.stiffness, series_damping=pair.damping
        )
    car = ReferenceCar(layout=layout, stiffness=k, damping=c, device=device)
    rest = np.zeros(car.nstate)
    matrix = np.column_stack([car.rates(state, 0.0) - car.rates(rest, 0.0)
                              for state in np.eye(car.nstate)])  # fmt: skip
    # a road that rises lifts the whole car: body and wheel measured from it see its velocity
    lift = np.zeros(car.nstate)
    lift[:2] = 1.0
    np.testing.assert_allclose(matrix @ lift, -(car.rates(rest, 1.0)), atol=1e-6)
    # in S3 the inerter's own displacement drifts and acts on nothing
    felt = np.abs(matrix).sum(axis=0) > 0.0
    matrix, lift = matrix[np.ix_(felt, felt)], lift[felt]
    covariance = solve_continuous_lyapunov(matrix, -np.outer(lift, lift))
    acceleration = ROAD.slope * np.sqrt(matrix[2] @ covariance @ matrix[2])
    force = ROAD.slope * KT * np.sqrt(covariance[1, 1])
    strut = LAYOUTS[layout].stiffness(k, c, b, pair=pair)
    assert float(ride_comfort(CAR, ROAD, strut)) == pytest.approx(acceleration, rel=1e-8)
    assert float(tyre_load(CAR, ROAD, strut)) == pytest.approx(force, rel=1e-8)


def test_roots_and_hamiltonian_agree() -> None:
    for name, strut in struts(180):
        function = CAR.body_per_load(strut)
        assert float(largest_gain(function)) == pytest.approx(
            h_infinity_norm(function), rel=1e-10
        ), name


def test_h_infinity_norm_is_reached_and_never_exceeded() -> None:
    dense = np.concatenate([[0.0], np.geomspace(1e-2, 1e5, 200_000)])
    for name, strut in struts(36):
        function = CAR.body_per_load(strut)
        # no grid of frequencies sees a needle; the two exact routes do, above and below
        if least_damping(function) < 1e-5:
            continue
        norm = h_infinity_norm(function)
        gain = gain_squared(function, dense**2)
        near = dense[np.argmax(gain)] * np.linspace(0.999, 1.001, 200_001)
        highest = np.sqrt(max(gain.max(), gain_squared(function, near**2).max()))
        assert highest <= norm * (1.0 + 1e-12), name
        assert highest >= norm * (1.0 - 1e-6), name


def test_a_needle_beside_a_broad_peak_is_found() -> None:
    # damping ratio 1e-6 at 50 rad/s, far narrower than any grid; its peak is 5 and the other's 1
    needle = np.array([2500.0, 1e-4, 1.0])
    broad = np.array([1.0, 1.0, 1.0])
    below = np.convolve(needle, broad)
    top = np.convolve(0.86 * np.array([1.0]), needle)
    top = np.append(top, 0.0) + 5.0 * 5e-3 * np.append(0.0, np.convolve([1.0], broad)) / 0.999
    function = Rational(top, below)
    exact = np.sqrt(gain_squared(function, 2500.0 * np.linspace(1 - 1e-5, 1 + 1e-5, 20001)).max())
    assert exact > 100.0
    assert h_infinity_norm(function) == pytest.approx(exact, rel=1e-6)
    assert float(largest_gain(function)) == pytest.approx(exact, rel=1e-6)


def test_gains_agree_with_the_complex_response() -> None:
    for name, strut in struts(12):
        function = CAR.body_per_load(strut)
        w = 7.3
        assert float(np.sqrt(gain_squared(function, w * w))) == pytest.approx(
            abs(complex(function(1j * w))), rel=1e-12
        ), name


def test_transfer_functions_solve_the_equations_of_motion() -> None:
    s = 3.0 + 20.0j
    for name, strut in struts(12):
        stiffness = complex(strut(s))
        matrix = np.array(
            [[MS * s * s + stiffness, -stiffness], [-stiffness, MU * s * s + stiffness + KT]]
        )
        body, wheel = np.linalg.solve(matrix, [0.0, KT])
        load, _ = np.linalg.solve(matrix, [1.0, 0.0])
        assert complex(CAR.body_per_road(strut)(s)) == pytest.approx(body, rel=1e-10), name
        assert complex(CAR.body_per_load(strut)(s)) == pytest.approx(load, rel=1e-10), name
        # the sign of a tyre force is in no index
        tyre = complex(CAR.tyre_force_per_road(strut)(s))
        assert tyre == pytest.approx(-KT * (wheel - 1.0), rel=1e-9), name


def test_what_is_not_stable_has_no_norm() -> None:
    backwards = LAYOUTS["S1"].stiffness(120e3, -10.0)
    assert np.isinf(h2_norm(comfort_function(CAR, backwards)))
    assert np.isinf(h_infinity_norm(CAR.body_per_load(backwards)))
    with pytest.raises(ValueError, match="not stable"):
        h2_norm_lyapunov(comfort_function(CAR, backwards))


def test_what_is_not_strictly_proper_is_refused() -> None:
    with pytest.raises(ValueError, match="strictly proper"):
        h2_norm(Rational(np.array([1.0, 1.0]), np.array([1.0, 1.0])))


@pytest.mark.parametrize("layout", ["S2", "S3", "S4", "S5", "S6"])
def test_a_rigid_pair_is_the_ideal_inerter(layout: str) -> None:
    rigid = SeriesPair(1e12, 1e7)
    ideal, behind = (LAYOUTS[layout].stiffness(120e3, 4e3, 100.0, 1e5, pair=p)
                     for p in (None, rigid))  # fmt: skip
    for index in (ride_comfort, tyre_load):
        assert float(index(CAR, ROAD, behind)) == pytest.approx(
            float(index(CAR, ROAD, ideal)), rel=2e-5
        )


def test_degenerate_layouts() -> None:
    plain = float(ride_comfort(CAR, ROAD, LAYOUTS["S1"].stiffness(120e3, 4e3)))
    for pair in PAIRS:
        none = LAYOUTS["S2"].stiffness(120e3, 4e3, 0.0, pair=pair)
        assert float(ride_comfort(CAR, ROAD, none)) == pytest.approx(plain, rel=1e-12)
    # in series an inerter that does not move leaves the damper
    held = LAYOUTS["S3"].stiffness(120e3, 4e3, 1e9)
    assert float(ride_comfort(CAR, ROAD, held)) == pytest.approx(plain, rel=1e-5)
