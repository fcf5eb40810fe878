"""Two files of one test on two clocks, and motion from what was measured in its place."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from inerter.records import RecordError, read_records
from inerter.records.stated import reading


def moved(time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Displacement and velocity of strokes that are not alike, at rest outside."""
    t = np.clip(time - 1.0, 0.0, 8.0)
    window, rate = np.sin(np.pi * t / 8) ** 2, np.pi / 8 * np.sin(np.pi * t / 4)
    phase, speed = 4 * t + 0.5 * t**2, 4 + t
    x = 0.03 * window * np.sin(phase)
    v = 0.03 * (rate * np.sin(phase) + window * speed * np.cos(phase))
    return x, np.where((time > 1.0) & (time < 9.0), v, 0.0)


def card(path: Path, noise: float = 2e-6) -> Path:
    time = np.arange(0, 10, 1 / 2000)
    random = np.random.default_rng(1)
    x = moved(time)[0] + noise * random.standard_normal(time.size)
    columns = np.column_stack([time, 1e3 * x, np.sin(time)])
    np.savetxt(path, columns, delimiter=",", header="t,x [mm],F [N]", comments="", fmt="%.9g")
    return path


def servo(path: Path, lag: float, sign: float = 1.0, drift: float = 0.0) -> Path:
    """A servo's file at 100 Hz; its clock is behind the card's by `lag`."""
    time = np.arange(0, 9.5, 0.01)
    v = moved(time + lag + drift * time)[1] + 2e-4 * np.random.default_rng(2).standard_normal(950)
    columns = np.column_stack([1e3 * time, sign * 1e3 * v])
    np.savetxt(path, columns, delimiter=";", header="Time_ms;Speed [mm/s]", comments="", fmt="%.6g")
    return path


@pytest.mark.parametrize("lag", [0.2345, -0.4128])
def test_two_files_are_brought_together(lag: float, tmp_path: Path) -> None:
    first, second = card(tmp_path / "card.csv"), servo(tmp_path / "servo.csv", lag)
    with reading(partner=second):
        (record,) = read_records(first, "bench")
    assert record.velocity is not None
    found, error = (
        float(part) for part in record.reading.split("its clock ")[1].split(" s,")[0].split(" s ± ")
    )
    assert error < 1e-3
    assert abs(found - lag) < 4 * error + 1e-5
    true = moved(record.time)[1]
    assert np.std(record.velocity - true) < 2e-3 * np.ptp(true)


def test_an_accelerometer_that_begins_in_the_motion_is_brought_together(tmp_path: Path) -> None:
    """Its velocity is known up to a constant: how fast it moved when the card began."""
    later = np.arange(2.0, 3.5, 0.001)
    begun = float(later[np.argmax(np.abs(moved(later)[1]))])
    time = np.arange(0, 6.0, 1 / 1000)
    v = moved(time + begun)[1]
    assert abs(v[0]) > np.sqrt(np.mean(v**2))
    a = np.gradient(v, time) + 1e-3 * np.random.default_rng(2).standard_normal(time.size)
    second = tmp_path / "sensor.csv"
    np.savetxt(second, np.column_stack([time, a]), delimiter=",", header="time,acceleration",
               comments="", fmt="%.9g")  # fmt: skip
    with reading(partner=second):
        (record,) = read_records(card(tmp_path / "card.csv"), "bench")
    assert record.acceleration is not None
    found = float(record.reading.split("its clock ")[1].split(" s ±")[0])
    assert found == pytest.approx(begun, abs=2e-3)


def test_the_partner_of_a_folder_is_no_record(tmp_path: Path) -> None:
    card(tmp_path / "card.csv")
    servo(tmp_path / "servo.csv", 0.1)
    (tmp_path / "records.toml").write_text('[[files]]\nmatch = "card.csv"\nwith = "servo.csv"\n')
    records = read_records(tmp_path, "bench")
    assert [record.name for record in records] == ["card"]
    assert records[0].velocity is not None


def test_clocks_that_drift_apart_are_told(tmp_path: Path) -> None:
    first, second = card(tmp_path / "card.csv"), servo(tmp_path / "servo.csv", 0.1, drift=1e-3)
    with reading(partner=second):
        (record,) = read_records(first, "bench")
    said = record.reading.split("drift apart by ")[1].split(" ppm")[0]
    assert abs(float(said.split(" ± ")[0]) - 1000) < 200


def test_the_opposite_sign_is_told(tmp_path: Path) -> None:
    first, second = card(tmp_path / "card.csv"), servo(tmp_path / "servo.csv", 0.1, sign=-1.0)
    with pytest.raises(RecordError, match="opposite sign"), reading(partner=second):
        read_records(first, "bench")


def test_a_motion_that_repeats_is_asked_for(tmp_path: Path) -> None:
    time = np.arange(0, 20, 0.002)
    first, second = tmp_path / "a.csv", tmp_path / "b.csv"
    for path, values, head in (
        (first, (np.sin(6 * time), np.cos(6 * time)), "t,x [mm],F [N]"),
        (second, (6 * np.cos(6 * time + 1),), "t,v [mm/s]"),
    ):
        np.savetxt(path, np.column_stack([time, *values]), delimiter=",", header=head, comments="")
    with (
        pytest.raises(RecordError, match=r"say --lag -?[\d.]+ or --lag -?[\d.]+"),
        reading(partner=second),
    ):
        read_records(first, "bench")
    with reading(partner=second, lag=1 / 6):
        (record,) = read_records(first, "bench")
    assert record.velocity is not None
    np.testing.assert_allclose(record.velocity, 6e-3 * np.cos(6 * record.time), atol=2e-6)


@pytest.mark.parametrize("kind", ["velocity", "acceleration", "two accelerometers"])
def test_a_displacement_is_integrated(kind: str, tmp_path: Path) -> None:
    """With an offset and noise: what is left of the drift is small beside the motion."""
    time = np.arange(0, 10, 1e-3)
    x, v = moved(time)
    a = np.gradient(v, time)
    noise = np.random.default_rng(3).standard_normal((3, time.size))
    columns, head = {
        "velocity": ([v + 0.003 + 1e-3 * noise[0]], "v [m/s]"),
        "acceleration": ([a + 0.05 + 0.02 * noise[0]], "a [m/s^2]"),
        "two accelerometers": (
            [0.3 * a + 0.02 + 0.02 * noise[0], 1.3 * a - 0.03 + 0.02 * noise[1]],
            "acceleration_1,acceleration_2",
        ),
    }[kind]
    path = tmp_path / "a.csv"
    table = np.column_stack([time, *columns, np.sin(time)])
    np.savetxt(path, table, delimiter=",", header=f"t,{head},F [N]", comments="", fmt="%.9g")
    (record,) = read_records(path, "bench")
    assert record.acceleration is None
    assert "drift of up to" in record.reading
    error = record.displacement - x
    assert np.std(error) < 0.06 * np.std(x)
    # what counts: the acceleration is that of the device
    again = np.gradient(np.gradient(record.displacement, time), time)
    from scipy.ndimage import gaussian_filter1d

    smooth = [gaussian_filter1d(values, 20)[200:-200] for values in (again, a)]
    assert np.std(smooth[0] - smooth[1]) < 0.02 * np.std(smooth[1])


@pytest.mark.parametrize("offset", [0.0, 0.02])
def test_slow_motions_stay_in_the_integral_of_a_quiet_velocity(
    offset: float, tmp_path: Path
) -> None:
    """Noise that walks some 50 um takes no 40 mm of slow motion away; an offset is seen, too."""
    time = np.arange(0, 40, 2e-3)
    slow, fast = 2 * np.pi * 0.1, 2 * np.pi * 3.0
    x = 0.02 * np.sin(slow * time) + 0.004 * np.sin(fast * time)
    v = 0.02 * slow * np.cos(slow * time) + 0.004 * fast * np.cos(fast * time)
    v += offset + 2e-4 * np.random.default_rng(5).standard_normal(time.size)
    path = tmp_path / "a.csv"
    np.savetxt(
        path, np.column_stack([time, v, np.sin(time)]), delimiter=",", header="t,v [m/s],F [N]",
        comments="", fmt="%.9g",
    )  # fmt: skip
    (record,) = read_records(path, "bench")
    assert ("constant offset" in record.reading) == bool(offset)
    assert np.std(record.displacement - x) < (0.25 if offset else 0.01) * np.std(x)
