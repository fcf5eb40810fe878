"""Measured records of others: read without a warning. Skipped where they are not at hand."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from inerter.records import check_records, read_records, share_one_clock

SHARED = Path(__file__).resolve().parents[2].parent / "shared" / "data"

pytestmark = pytest.mark.skipif(
    not SHARED.is_dir(), reason="the measured records (../shared/data) are not on this machine"
)

# number of runs and of samples per second in each folder
FOLDERS = {
    "boucwen": (1, 750.0),
    "emps": (1, 1000.0),
    "friction_damper": (4, 1024.0),
    "rack_inerter": (8, 1000.0),
}


@pytest.mark.parametrize("folder", FOLDERS)
def test_read_without_a_warning(folder: str) -> None:
    runs, rate = FOLDERS[folder]
    records = read_records(SHARED / folder, "bench")
    assert len(records) == runs
    for record in records:
        assert record.warnings == (), record.name
        assert record.sample_rate == pytest.approx(rate, rel=1e-3)
    assert share_one_clock(records) is (runs == 1)


def test_further_column_of_emps() -> None:
    (record,) = read_records(SHARED / "emps", "bench")
    assert list(record.extra) == ["reference_displacement"]


@pytest.mark.parametrize("folder", ["emps", "rack_inerter"])
def test_a_planted_sign_flip_is_seen(folder: str) -> None:
    for record in read_records(SHARED / folder, "bench"):
        (checked,) = check_records([dataclasses.replace(record, force=-record.force)])
        assert [w.code for w in checked.warnings] == ["sign_flip"], record.name


@pytest.mark.parametrize("folder", ["emps", "friction_damper", "rack_inerter"])
def test_planted_clipping_and_spikes_are_seen(folder: str) -> None:
    for record in read_records(SHARED / folder, "bench"):
        low, high = np.quantile(record.force, (0.05, 0.95))
        spiked = record.force.copy()
        spiked[[200, 700, 1200]] += 2.0 * (high - low)
        for force, code in ((np.clip(record.force, low, high), "clipping"), (spiked, "outliers")):
            (checked,) = check_records([dataclasses.replace(record, force=force)])
            assert [w.code for w in checked.warnings] == [code], record.name
