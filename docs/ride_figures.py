"""The ride of the how-to page on semi-active devices, drawn with the page's own code."""

from __future__ import annotations

import re
import runpy
import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure


def drawn_ride() -> Figure:
    """Body acceleration and damping over time, for the best constant damping and for skyhook."""
    page = (Path(__file__).parent / "how_to" / "semi_active.md").read_text(encoding="utf-8")
    (car,) = re.findall(r"^```xml\n(.*?)^```", page, re.S | re.M)
    code = re.findall(r"^```python\n(.*?)^```", page, re.S | re.M)[0]
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "car.xml"
        place.write_text(car, encoding="utf-8")
        program = Path(folder) / "ride.py"
        program.write_text(code.replace('"car.xml"', repr(str(place))), encoding="utf-8")
        names = runpy.run_path(str(program))
    figure = Figure(figsize=(9, 4.5), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    ride, shown = names["ride"], slice(2000, 5000)
    t = 1e-3 * np.arange(10000)[shown]
    best = min(names["passive"], key=names["passive"].get)
    for label, law in (
        (f"{best} N s/m, the best constant damping", lambda body, travel: best),
        ("skyhook", names["skyhook"]),
    ):
        rows = ride(law)
        size = names["rms"](rows)
        above.plot(t, rows[shown, 0], label=f"{label}: {size:.2f} m/s$^2$ rms", linewidth=1)
        below.plot(t, rows[shown, 1], linewidth=1)
    above.set(ylabel="body acceleration [m/s$^2$]")
    above.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    below.set(xlabel="time [s]", ylabel="damping [N s/m]")
    return figure
