"""The device as an element of Exudyn: `CreateInerter`, in the manner of its Create functions.

A telling of its own: the laws here share no code with the C core or the reference equations. From
the core come only the table of parameters and the checks of what is given.
"""

from __future__ import annotations

from inerter.exudyn.create import CreateInerter
from inerter.exudyn.inerter import Inerter

__all__ = ["CreateInerter", "Inerter"]
