"""The colours of the report: declared once, for the page, its plots and the pictures.

Measured data are neutral, the simulation so far is warm, the extended simulation is cool; the two
differ in lightness too, so that they can be told apart in grey print. Plots are built in the light
colours; the page exchanges each for its dark partner by value, which is why no two light colours
may be equal.
"""

from __future__ import annotations

LIGHT = {
    "page": "#ffffff",
    "panel": "#f6f7f9",
    "line": "#dfe3e8",
    "grid": "#e6e9ee",
    "text": "#1d232b",
    "soft": "#5b6571",
    "measured": "#8d97a3",
    "before": "#d4641c",
    "after": "#0a6fa0",
    "shade": "#9fb2c4",
    "warn": "#8a5a00",
}

DARK = {
    "page": "#14181d",
    "panel": "#1d232a",
    "line": "#333c47",
    "grid": "#2b333d",
    "text": "#e7ebf0",
    "soft": "#a3aeba",
    "measured": "#c3ccd6",
    "before": "#ff9a57",
    "after": "#45b8ea",
    "shade": "#56687a",
    "warn": "#e8b64c",
}
