"""Arrays that are worked out once."""

from __future__ import annotations

import numpy as np
from inerter.identify.kept import Array, Kept, last_kept


def test_what_is_missing_of_several_is_worked_out_at_once() -> None:
    kept, asked = Kept(10_000), []

    def squares(missing: list[int]) -> list[Array]:
        asked.append(missing)
        return [np.full(3, float(i) ** 2) for i in missing]

    np.testing.assert_array_equal(kept.all_found(["0", "1"], squares)[:, 0], [0.0, 1.0])
    np.testing.assert_array_equal(kept.all_found(["0", "1", "2"], squares)[:, 0], [0.0, 1.0, 4.0])
    kept.all_found(["2", "0"], squares)
    assert asked == [[0, 1], [2]]
    assert kept.found("1", lambda: np.zeros(3))[0] == 1.0


def test_what_takes_too_much_memory_is_worked_out_anew() -> None:
    kept = Kept(100)
    for value in range(8):
        found = kept.all_found([value, -1], lambda new, v=value: [np.full(8, v) for _ in new])
        assert found.shape == (2, 8)
        assert found[0, 0] == value
        assert kept.size <= 100 + 2 * 64


def test_the_last_point_is_worked_out_once() -> None:
    asked: list[float] = []

    @last_kept
    def square(point: np.ndarray) -> float:
        asked.append(float(point[0]))
        return float(point @ point)

    points = [np.array([x, 1.0]) for x in (2.0, 2.0, 3.0, 2.0, 2.0)]
    assert [square(point) for point in points] == [5.0, 5.0, 10.0, 5.0, 5.0]
    assert asked == [2.0, 3.0, 2.0]
