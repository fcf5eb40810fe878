"""Inputs with and without units, of every calculator."""

import math

import pint
import pytest
from inerter.design.ball_screw.inputs import INPUTS as BALL_SCREW
from inerter.design.fluid.inputs import INPUTS as FLUID
from inerter.design.inputs import DesignError, Input, read_inputs
from inerter.design.rack_pinion.inputs import INPUTS as RACK_PINION
from inerter.design.rack_pinion.inputs import STAGE

EVERY = [item for table in (BALL_SCREW, FLUID, RACK_PINION, STAGE) for item in table]
NUMBERS = [item for item in EVERY if isinstance(item, Input)]
OTHER_UNITS = {
    "m": "inch", "m^2": "cm^2", "m^3": "litre", "kg": "pound", "kg*m^2": "g*cm^2", "rad": "deg",
    "N": "kN", "Pa": "bar", "K": "degF", "Hz": "1/min", "m/s": "km/hour", "N*m/rad": "N*mm/deg",
    "Pa*s": "cP", "kg/m^3": "g/cm^3", "": "percent",
}  # fmt: skip


@pytest.mark.parametrize("item", NUMBERS, ids=lambda item: item.name)
def test_round_trip_through_another_unit(item: Input) -> None:
    value = item.default or item.lower + 0.25 * (min(item.upper, item.lower + 4) - item.lower)
    value = max(1.0, round(value)) if item.whole else value
    registry = pint.get_application_registry()
    other = registry.Quantity(value, item.unit or "dimensionless").to(OTHER_UNITS[item.unit])
    text = f"{other.magnitude!r} {OTHER_UNITS[item.unit]}"
    if item.whole:
        text = str(int(value))
    assert item.read(text) == pytest.approx(value, rel=1e-12)
    assert item.read(value) == item.read(repr(value)) == value


@pytest.mark.parametrize("item", NUMBERS, ids=lambda item: item.name)
def test_defaults_can_be_and_have_a_source(item: Input) -> None:
    if item.default is not None:
        assert item.read(item.default) == item.default
        assert item.source
    assert f"[{item.unit or '-'}]" in item.help


LENGTH = Input(name="lead", unit="m", meaning="lead")


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("10 kg", "whose unit is not that of lead"),
        ("10 flurb", "whose unit is not that of lead"),
        ("10 m**", "whose unit is not that of lead"),
        ("ten", "not a number"),
        ("", "not a number"),
        ("1e400", "above 0 m"),
        (math.nan, "above 0 m"),
        (-1, "lead is -1"),
        (0, "above 0 m"),
        (True, "give a number"),
        (None, "give a number"),
    ],
)
def test_what_is_no_length(given, words: str) -> None:
    with pytest.raises(DesignError, match="lead is") as caught:
        LENGTH.read(given)
    assert words in str(caught.value)


def test_a_length_of_metres_needs_its_unit() -> None:
    """Who writes 10 for a lead means millimetres; who writes "10 m" was asked."""
    for given in (10, 10.0, "10", " 1.001 "):
        with pytest.raises(DesignError, match="above 1 m write the unit") as caught:
            LENGTH.read(given)
        assert "without a unit, which is" in str(caught.value)
    assert LENGTH.read("10 m") == 10
    assert LENGTH.read("1001 mm") == pytest.approx(1.001)
    assert LENGTH.read(1) == LENGTH.read("1") == 1
    # of all lengths only a channel is metres long
    long = [item.name for item in NUMBERS if item.unit == "m" and item.longest_bare > 1]
    assert long == ["channel_length"]
    assert read_inputs(FLUID, {"channel_length": 1.7}).number("channel_length") == 1.7


def test_names_are_checked() -> None:
    with pytest.raises(DesignError, match="did you mean 'lead'"):
        read_inputs([LENGTH], {"leed": 1})
    # what the command line passes for options that were not given
    assert read_inputs([LENGTH], {"lead": None}).given == {}


def test_values_say_where_they_come_from() -> None:
    values = read_inputs(BALL_SCREW, {"lead": "5 mm"}).derived("fitted to a table", inertia=1e-4)
    found = values.json()
    assert found["lead"] == {
        "value": 0.005, "unit": "m", "meaning": "lead of the screw, P", "source": "given",
    }  # fmt: skip
    assert found["inertia"]["source"] == "fitted to a table"
    assert found["ball_radius"]["source"].startswith("default, paper")
