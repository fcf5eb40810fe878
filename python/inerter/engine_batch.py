"""`mujoco.batch`: many simulations on threads. MuJoCo before 3.17 has none, and this says so."""

from __future__ import annotations

import mujoco

try:
    import mujoco.batch as batch
except ImportError:
    raise ImportError(
        "this needs mujoco.batch, which is in MuJoCo 3.17 and newer; installed is MuJoCo "
        f"{mujoco.mj_versionString()}: run `pip install 'mujoco>=3.17'`"
    ) from None

__all__ = ["batch"]
