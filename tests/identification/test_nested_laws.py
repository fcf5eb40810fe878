"""A law that contains a simpler one explains the data it is fitted to no worse."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.identify.estimate import identify
from inerter.models import data_path
from inerter.records import Record, read_records


@pytest.fixture(scope="module")
def shipped() -> list[Record]:
    """Coulomb friction, with slow turns in which the velocity is within its noise."""
    return read_records([str(data_path("bench_record.csv"))], "bench")


def test_the_bias_of_noise_is_taken_out_only_where_it_is_known(shipped: list[Record]) -> None:
    """The shape of a hysteresis that is all but a jump hangs on nothing but noise."""
    result = identify(shipped, ["ideal", "bouc_wen"], intervals="normal", starts=16)
    errors = {each.law: each.fit_rmse for each in result.results}
    assert errors["bouc_wen"] < 0.2 * errors["ideal"]
    assert result.best.law == "bouc_wen"
    assert np.isclose(result.best.device.inertance, 113, rtol=0.01)
