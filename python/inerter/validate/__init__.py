"""`inerter validate`: the same cases in every engine and integrator, against the reference ODE.

`laws.py`, `inputs.py`, `models.py`: what is compared. `case.py`, `plan.py`: which cases there are.
`truth.py`: the reference. `mujoco_engine.py`, `exudyn_engine.py`: the engines, in the words of
`run.py`. `bounds.py`: how far off a run may be, and why. `task.py`, `pool.py`: one case, and all of
them on several processes. `result.py`, `output.py`, `table.py`, `picture.py`: what is written.
"""

from __future__ import annotations

from inerter.validate.plan import Selection, SelectionError
from inerter.validate.pool import validate
from inerter.validate.result import Validation

__all__ = ["Selection", "SelectionError", "Validation", "validate"]
