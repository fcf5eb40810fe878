"""Records of devices that turn: what they are read as, and what does not fit together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from inerter.motion_units import one_motion, parameter_unit, unit, words
from inerter.records import RecordError, read_records
from inerter.records.stated import reading

COUNT = 200
TIME = np.arange(COUNT) / 100
WAVE = np.sin(7 * TIME)


def written(path: Path, header: str) -> Path:
    """A record in which every channel has the amplitude 1, as written."""
    columns = [TIME, *([WAVE] * header.count(","))]
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=header, comments="")
    return path


@pytest.mark.parametrize(
    ("header", "angle", "torque"),
    [
        ("time,displacement[rad],force[N*m]", 1.0, 1.0),
        ("time,displacement[deg],force[Nm]", np.pi / 180, 1.0),
        ("time,displacement[rev],force[N m]", 2 * np.pi, 1.0),
        ("time,displacement[mrad],force[N·m]", 1e-3, 1.0),
        ("time,angle,torque", 1.0, 1.0),
        ("time,angle[deg],torque[mN*m]", np.pi / 180, 1e-3),
        ("time,angle[deg],torque[kNm]", np.pi / 180, 1e3),
        ("time,displacement[rad],force", 1.0, 1.0),
        ("time,displacement,force[lbf*ft]", 1.0, 0.45359237 * 9.80665 * 0.3048),
        ("time,displacement,force[lbf-in]", 1.0, 0.45359237 * 9.80665 * 0.0254),
        ("time,displacement,force[kgf*m]", 1.0, 9.80665),
        ("Zeit [s],Winkel [°],Drehmoment [Nm]", np.pi / 180, 1.0),
        ("time,position[deg],torque[N m]", np.pi / 180, 1.0),
        # beside an angle and a torque a force is another channel
        ("time,angle[deg],torque[Nm],force[N]", np.pi / 180, 1.0),
    ],
)
def test_angles_and_torques_are_read(
    tmp_path: Path, header: str, angle: float, torque: float
) -> None:
    (record,) = read_records(written(tmp_path / "turn.csv", header), "bench")
    assert record.motion == "rotation"
    np.testing.assert_allclose(record.displacement, angle * WAVE, rtol=1e-12)
    np.testing.assert_allclose(record.force, torque * WAVE, rtol=1e-12)


@pytest.mark.parametrize(
    ("header", "metre", "newton"),
    [
        # a millinewton is no metre-newton
        ("time,displacement[mm],force[mN]", 1e-3, 1e-3),
        ("time,displacement[mm],force[kN],angle[deg],torque[Nm]", 1e-3, 1e3),
        ("time,displacement[mm],force[N],speed[rpm]", 1e-3, 1.0),
        ("Zeit [s],Weg [mm],Kraft [kN],Winkel [°],Drehmoment [Nm]", 1e-3, 1e3),
    ],
)
def test_what_moves_along_a_line_stays_so(
    tmp_path: Path, header: str, metre: float, newton: float
) -> None:
    (record,) = read_records(written(tmp_path / "line.csv", header), "bench")
    assert record.motion == "translation"
    np.testing.assert_allclose(record.displacement, metre * WAVE, rtol=1e-12)
    np.testing.assert_allclose(record.force, newton * WAVE, rtol=1e-12)


def test_speeds_of_turning_are_converted(tmp_path: Path) -> None:
    header = "time,displacement[rev],velocity[rpm],acceleration[deg/s^2],torque[Nm]"
    (record,) = read_records(written(tmp_path / "turn.csv", header), "bench", check=False)
    assert record.velocity is not None
    assert record.acceleration is not None
    np.testing.assert_allclose(record.velocity, 2 * np.pi / 60 * WAVE, rtol=1e-12)
    np.testing.assert_allclose(record.acceleration, np.pi / 180 * WAVE, rtol=1e-12)


@pytest.mark.parametrize(
    ("header", "told"),
    [
        (
            "time,displacement[rad],force[N]",
            ["'force[N]' is a force", "'displacement[rad]' is an angle", "write force[N*m]"],
        ),
        (
            "time,displacement[mm],force[N*m]",
            ["'displacement[mm]' is a length", "'force[N*m]' is a torque", "displacement[rad]"],
        ),
        (
            "time,displacement[mm],force[N],velocity[rpm]",
            ["'velocity[rpm]' is an angular velocity", "write velocity[m/s]"],
        ),
        ("time,displacement[rad],force[J]", ["'J' is not a force", "N*m"]),
        ("time,displacement[%],force[N]", ["'%' is not a length", "rad, mrad, deg, rev"]),
        ("time,displacement[rad],velocity[Hz],force[N*m]", ["'Hz' is not a velocity", "rpm"]),
    ],
)
def test_what_does_not_fit_is_named(tmp_path: Path, header: str, told: list[str]) -> None:
    with pytest.raises(RecordError) as refusal:
        read_records(written(tmp_path / "mixed.csv", header), "bench")
    assert str(refusal.value).startswith(str(tmp_path / "mixed.csv"))
    for text in told:
        assert text in str(refusal.value)


def test_calibrations_may_be_those_of_a_torque_and_an_angle(tmp_path: Path) -> None:
    path = written(tmp_path / "volts.csv", "time,a[V],b[V]")
    stated = ["torque=12 N*m/V * b", "angle=30 deg/V * a"]
    with reading(stated):
        (record,) = read_records(path, "bench")
    assert record.motion == "rotation"
    np.testing.assert_allclose(record.force, 12 * WAVE, rtol=1e-12)
    np.testing.assert_allclose(record.displacement, np.pi / 6 * WAVE, rtol=1e-12)


def test_a_displacement_of_a_lead_screw_is_a_length(tmp_path: Path) -> None:
    path = written(tmp_path / "servo.csv", "time,speed[rpm],force[N]")
    with reading(["velocity=20 mm/turn * speed"]):
        (record,) = read_records(path, "bench")
    assert record.motion == "translation"


def test_records_of_both_kinds_are_no_records_of_one_device(tmp_path: Path) -> None:
    written(tmp_path / "a.csv", "time,displacement[mm],force[N]")
    written(tmp_path / "b.csv", "time,angle[deg],torque[Nm]")
    records = read_records(tmp_path, "bench")
    with pytest.raises(ValueError, match=r"a moves along a line .* b turns"):
        one_motion(records)
    assert one_motion(records[1:]) == "rotation"


@pytest.mark.parametrize(
    ("along", "about"),
    [
        ("m", "rad"), ("mm", "mrad"), ("N", "N*m"), ("kg", "kg*m^2"), ("m/s", "rad/s"),
        ("N*s/m", "N*m*s/rad"), ("N*s^2/m^2", "N*m*s^2/rad^2"), ("N/m^3", "N*m/rad^3"),
        ("1/m^2", "1/rad^2"), ("s/m", "s/rad"), ("m^-n", "rad^-n"), ("m^2", "m^3/rad"),
        ("m^3", "m^3"), ("Pa", "Pa"), ("s", "s"), ("1", "1"), ("Hz", "Hz"),
    ],
)  # fmt: skip
def test_units(along: str, about: str) -> None:
    assert unit("translation", along) == along
    assert unit("rotation", along) == about


def test_units_in_texts_and_of_a_fluid() -> None:
    assert words("rotation", "N s/m") == "N m s/rad"
    assert parameter_unit("rotation", "channel_length", "m") == "m"
    assert parameter_unit("rotation", "backlash", "m") == "rad"
