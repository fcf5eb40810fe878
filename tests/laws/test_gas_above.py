"""A gas on the other side of the piston is the mirror image of one below it, in every program."""

from __future__ import annotations

import math

import numpy as np
import pytest
from inerter.core import Device, DeviceError
from inerter.reference import ReferenceDevice
from inerter.reference.laws import gas

LAWS = [
    {"gas_volume": 2.2e-5},
    {"gas_volume": 5e-5, "gas_exponent": 1.0},
    {"gas_volume": 2.2e-5, "gas_law": "expanded"},
    {"gas_volume": 5e-5, "gas_law": "expanded", "gas_exponent": 1.2},
]
BELOW, ABOVE = 1e-3, -1e-3
H = 1e-3


def devices(law: dict) -> tuple[dict, dict]:
    """The same below and above."""
    given = dict(inertance=10.0, gas_pressure=1e5, **law)
    return {**given, "gas_area": BELOW}, {**given, "gas_area": ABOVE}


def motion() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Past both edges of the law."""
    t = np.arange(2000) * H
    x = 0.021 * np.sin(9 * t) + 0.004 * np.sin(31 * t)
    v = 0.021 * 9 * np.cos(9 * t) + 0.004 * 31 * np.cos(31 * t)
    return x, v, -0.021 * 81 * np.sin(9 * t) - 0.004 * 961 * np.sin(31 * t)


@pytest.mark.parametrize("law", LAWS)
def test_the_core_mirrors_it(law: dict) -> None:
    x, v, a = motion()
    below, above = (Device(**each) for each in devices(law))
    force = below.along(H, x, v, a)["total"]
    np.testing.assert_array_equal(above.along(H, -x, -v, -a)["total"], -force)
    stored = below.evaluate(x, v, a, 0.0)["stored_energy"]
    np.testing.assert_array_equal(above.evaluate(-x, -v, -a, 0.0)["stored_energy"], stored)


@pytest.mark.parametrize("law", LAWS)
def test_core_and_reference_agree(law: dict) -> None:
    x, _, _ = motion()
    _, given = devices(law)
    core, reference = Device(**given), ReferenceDevice(**given)
    still = np.zeros_like(x)
    forces = np.asarray(core.along(H, x, still, still)["total"])
    np.testing.assert_allclose(forces, gas.force(reference, x), rtol=1e-12, atol=1e-9)
    energy = np.asarray(core.evaluate(x, still, still, 0.0)["stored_energy"])
    np.testing.assert_allclose(energy, gas.stored_energy(reference, x), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_its_energy_is_the_integral_of_its_force(law: dict) -> None:
    reference = ReferenceDevice(**devices(law)[1])
    places = np.linspace(-0.025, 0.025, 20001)
    laws = gas.force, gas.stored_energy
    forces, energy = (np.asarray(law(reference, places)) for law in laws)
    work = np.concatenate([[0], np.cumsum(0.5 * (forces[1:] + forces[:-1]) * np.diff(places))])
    work -= np.interp(0.0, places, work)
    np.testing.assert_allclose(energy, work, atol=1e-6 * np.max(energy))


@pytest.mark.parametrize("law", LAWS)
def test_exudyn_has_the_same(law: dict) -> None:
    flywheel = pytest.importorskip("inerter.exudyn.flywheel")
    functions = pytest.importorskip("inerter.exudyn.functions").NUMBERS
    parameters = pytest.importorskip("inerter.exudyn.parameters")
    _, given = devices(law)
    known = parameters.Parameters.of(Device(**given))
    reference = ReferenceDevice(**given)
    for place in np.linspace(-0.025, 0.025, 21):
        force = flywheel._gas(functions, known, float(place))
        assert force == pytest.approx(float(gas.force(reference, place)), rel=1e-9, abs=1e-9)
        energy = flywheel._gas_energy(functions, known, float(place))
        assert energy == pytest.approx(float(gas.stored_energy(reference, place)), abs=1e-9)


def test_where_it_is_no_gas_any_more() -> None:
    below, above = (Device(**each) for each in devices(LAWS[0]))
    assert below.validity(0.03) is None
    problem = above.validity(0.03)
    assert problem
    assert "set stop_upper" in problem
    assert "set stop_lower" in (below.validity(-0.03) or "")
    _, expanded = devices(LAWS[2])
    assert "-0.0091" in (Device(**expanded).validity(-0.02) or "")


def test_no_area_is_refused() -> None:
    with pytest.raises(DeviceError, match="a gas_area other than 0 m"):
        Device(inertance=1.0, gas_pressure=1e5, gas_area=0.0, gas_volume=1e-5)
    with pytest.raises(ValueError, match="gas_area"):
        ReferenceDevice(inertance=1.0, gas_pressure=1e5, gas_area=0.0, gas_volume=1e-5)
    assert math.isnan(ReferenceDevice(inertance=1.0).gas_area)
