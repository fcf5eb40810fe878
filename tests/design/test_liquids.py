"""Liquids against values that others publish."""

import math

import pytest
from inerter.design import DesignError, design_fluid
from inerter.design.fluid import water
from inerter.design.fluid.liquids import LIQUIDS, properties
from inerter.design.fluid.oils import OILS

ZERO = 273.15


def test_water_at_fixed_points() -> None:
    # accepted values: largest density at 3.98 degC, 998.207 kg/m^3 at 20 degC
    assert water.density(ZERO + 3.98) == pytest.approx(999.975, abs=5e-3)
    assert water.density(ZERO + 20) == pytest.approx(998.207, abs=5e-3)
    # 1.0016 mPa s at 20 degC, ISO/TR 3666
    assert water.viscosity(ZERO + 20) == pytest.approx(1.0016e-3, rel=5e-4)
    # triple point, normal boiling point
    assert water.vapour_pressure(273.16) == pytest.approx(611.657, rel=2e-4)
    assert water.vapour_pressure(373.124) == pytest.approx(101325.0, rel=2e-4)
    # 1482.35 m/s at 20 degC
    speed = math.sqrt(water.bulk_modulus(ZERO + 20) / water.density(ZERO + 20))
    assert speed == pytest.approx(1482.35, abs=0.1)


def test_oils_at_the_temperatures_that_define_them() -> None:
    for grade, hot in ((32, 5.4), (46, 6.8), (68, 8.7)):
        oil = OILS[f"hydraulic_oil_{grade}"]
        assert oil.kinematic(ZERO + 40) == pytest.approx(grade, rel=1e-9)
        assert oil.kinematic(ZERO + 100) == pytest.approx(hot, rel=1e-9)
    silicone = OILS["silicone_oil_100"]
    assert silicone.kinematic(ZERO + 25) == pytest.approx(100.0, rel=1e-12)
    # viscosity-temperature coefficient of data sheets: 1 - nu(98.9 degC) / nu(37.8 degC) = 0.60
    coefficient = 1 - silicone.kinematic(ZERO + 98.9) / silicone.kinematic(ZERO + 37.8)
    assert coefficient == pytest.approx(0.60, abs=0.015)


@pytest.mark.parametrize("name", list(LIQUIDS))
def test_warmer_is_thinner_and_lighter(name: str) -> None:
    liquid = LIQUIDS[name]
    cold, warm = (properties(name, t) for t in (ZERO + 10, ZERO + 60))
    assert warm.density < cold.density
    assert warm.viscosity < cold.viscosity
    for edge in (liquid.lowest, liquid.highest):
        properties(name, edge)
        beyond = edge + math.copysign(1e-6, edge - (ZERO + 50))
        with pytest.raises(DesignError, match="out of the range"):
            properties(name, beyond)


def test_a_plain_number_is_in_kelvin() -> None:
    with pytest.raises(DesignError, match='in kelvin, write "20 degC"'):
        design_fluid(temperature=20)
    one, other = design_fluid(temperature=293.15), design_fluid(temperature="20 degC")
    assert one.value("density") == pytest.approx(other.value("density"), rel=1e-14)
