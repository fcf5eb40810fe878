"""What the core tells of a device at random states, held against the reference."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from inerter.core import Device
from inerter.reference import ReferenceDevice
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Told(NamedTuple):
    """The device, its states (20, nstate), its motion (20,), and what it tells there."""

    core: Device
    z: Array
    x: Array
    v: Array
    a: Array
    found: dict[str, Array]


def told_alike(rng: np.random.Generator, p: dict[str, Any], sizes: Mapping[str, float]) -> Told:
    """Both tell the same force, energy, heat and rates; `sizes` of states that are not 1 mm."""
    core, reference = Device(**p), ReferenceDevice(**p)
    assert core.state_names == reference.state_names
    z = np.column_stack([rng.normal(0.0, sizes.get(name, 1e-3), 20) for name in core.state_names])
    x, v, a = rng.normal(0, 0.01, 20), rng.normal(0, 0.3, 20), rng.normal(0, 5.0, 20)
    found, state = core.evaluate(x, v, a, z), reference.state_argument(z)
    told = {
        "total": reference.force(x, v, a, state),
        "stored_energy": reference.stored_energy(x, v, state),
        "dissipated_power": reference.dissipated_power(x, v, a, state),
        "state_rate": reference.state_rate(x, v, state, a=a),
    }
    for name, value in told.items():
        mine = found[name].reshape(20, -1)
        size = np.abs(mine).max(axis=0) + 1e-300
        assert np.max(np.abs(np.reshape(value, mine.shape) - mine) / size) < 1e-12, (p, name)
    return Told(core, z, x, v, a, found)
