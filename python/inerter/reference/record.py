"""Writing a synthetic run as a bench record: `time,displacement,force` in s, m, N."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray


def write_record(
    path: str | Path,
    time: NDArray[np.float64],
    displacement: NDArray[np.float64],
    force: NDArray[np.float64],
    comments: Iterable[str] = (),
) -> Path:
    """Write one run as CSV, `#` comments before the header; arrays of shape (n,).

    Returns the path. Raises OSError where the file cannot be written.
    """
    target = Path(path)
    lines = [f"# {comment}" for comment in comments]
    lines.append("time,displacement,force")
    rows = np.column_stack((time, displacement, force))
    lines += [f"{t:.9g},{x:.9e},{f:.9e}" for t, x, f in rows]
    target.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return target
