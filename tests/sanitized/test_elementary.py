"""exp, exp - 1, tanh, sin and cos of the core to fifty digits, alike on every processor."""

import ctypes
import platform
from collections.abc import Callable
from decimal import Decimal, localcontext
from pathlib import Path

import numpy as np
import pytest
from building import HERE, build
from numpy.typing import NDArray

Array = NDArray[np.float64]
FUNCTIONS = ("exp", "expm1", "tanh", "sin", "cos")
GROWING = FUNCTIONS[:3]
PORTABLE = ("-O3", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math")


def loaded(folder: Path, name: str, *flags: str) -> Callable[[str, Array], Array]:
    """The functions over arrays, compiled with some flags."""
    made = build(
        folder / name, [HERE / "elementary.c"], *PORTABLE, *flags, link=["-shared"], with_core=False
    )  # fmt: skip
    over = ctypes.CDLL(str(made)).over_array
    pointer = np.ctypeslib.ndpointer(dtype=np.float64, flags="C_CONTIGUOUS")
    over.argtypes, over.restype = [ctypes.c_int, ctypes.c_int, pointer, pointer], None

    def call(function: str, x: Array) -> Array:
        y = np.empty_like(x)
        over(FUNCTIONS.index(function), x.size, x, y)
        return y

    return call


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str, Array], Array]:
    return loaded(tmp_path_factory.mktemp("elementary"), "plain.so")


def arguments(rng: np.random.Generator, count: int) -> Array:
    """Of all sizes: near 0, of the size of 1, near multiples of ln 2, up to the ends."""
    sides = rng.choice([-1.0, 1.0], count)
    sizes = np.concatenate(
        [10 ** rng.uniform(-18, 2.8, count // 2), rng.uniform(0, 3, count - count // 2)]
    )
    halves = np.log(2) * (np.arange(-40, 41) / 2) * (1 + 1e-9 * rng.standard_normal(81))
    return np.concatenate([sides * sizes, halves, [0.0, 700.0, -700.0]])


def exactly(function: str, x: float) -> Decimal:
    """To fifty digits."""
    grown = Decimal(x).exp()
    if function == "exp":
        return grown
    if function == "expm1":
        # where both are near 1 its first terms say it
        near = Decimal(x)
        return grown - 1 if abs(x) > 1e-12 else near + near**2 / 2 + near**3 / 6
    twice = exactly("expm1", -2 * abs(x))
    size = -twice / (2 + twice)
    return size if x >= 0 else -size


@pytest.mark.parametrize("function", GROWING)
def test_errors_are_below_three_units_in_the_last_place(
    function: str, compiled: Callable[[str, Array], Array], effects_seed: int
) -> None:
    x = arguments(np.random.default_rng(effects_seed), 4000)
    found = compiled(function, x)
    with localcontext() as context:
        context.prec = 50
        exact = [exactly(function, float(each)) for each in x]
        error = np.array(
            [float(abs(Decimal(float(y)) - e)) for y, e in zip(found, exact, strict=True)]
        )
    assert np.max(error / np.spacing(np.abs(np.array([float(e) for e in exact])))) < 3.0


def test_sines_are_those_of_the_library_up_to_a_million(
    compiled: Callable[[str, Array], Array], effects_seed: int
) -> None:
    # those of the C library are right to the last place
    rng = np.random.default_rng(effects_seed)
    turns, far = np.pi / 4 * np.arange(-3000, 3000), 1e6 * rng.uniform(-1, 1, 20_000)
    x = np.asarray(np.concatenate([arguments(rng, 20_000), turns, far]), dtype=np.float64)
    for function, library in (("sin", np.sin), ("cos", np.cos)):
        np.testing.assert_allclose(compiled(function, x), library(x), rtol=0, atol=3e-16)
    np.testing.assert_array_equal(compiled("sin", np.array([0.0, 1e-300])), [0.0, 1e-300])
    assert np.isnan(compiled("sin", np.array([np.nan, np.inf]))).all()


@pytest.mark.parametrize("function", GROWING)
def test_far_out_they_end_and_no_number_stays_none(
    function: str, compiled: Callable[[str, Array], Array]
) -> None:
    far = compiled(function, np.array([-np.inf, -1e4, 1e4, np.inf, np.nan, 0.0]))
    least = {"exp": 0.0, "expm1": -1.0, "tanh": -1.0}[function]
    assert far[:2] == pytest.approx([least, least], abs=1e-300)
    assert (far[2:4] == 1.0).all() if function == "tanh" else (far[2:4] > 1e300).all()
    assert np.isnan(far[4])
    assert far[5] == (1.0 if function == "exp" else 0.0)


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="AVX2 is of x86-64")
@pytest.mark.parametrize("function", FUNCTIONS)
def test_one_or_four_at_once_give_the_same_bits(
    function: str, compiled: Callable[[str, Array], Array], tmp_path: Path, effects_seed: int
) -> None:
    cpu = Path("/proc/cpuinfo")
    if not cpu.exists() or " avx2 " not in cpu.read_text(encoding="utf-8"):
        pytest.skip("needs a processor with AVX2")
    x = arguments(np.random.default_rng(effects_seed), 20_000)
    alone = loaded(tmp_path, "alone.so", "-fno-tree-vectorize")
    several = loaded(tmp_path, "several.so", "-mavx2")
    for other in (alone, several):
        np.testing.assert_array_equal(other(function, x), compiled(function, x))
