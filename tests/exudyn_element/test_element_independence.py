"""The element is a telling of its own: from the core it takes parameters and checks, no law."""

from __future__ import annotations

import ast
import importlib.util
import sys
from pathlib import Path

import inerter
from inerter.core import Device

FOLDER = Path(inerter.__file__).parent / "exudyn"
OUTSIDE = {"numpy", *sys.stdlib_module_names}
UNITS = "inerter.motion_units"  # what a column of the rig is called
FROM_CORE = {"WORDS", "Device", "DeviceError", "library_path", "lists", "names", "parameters"}
DATA = {
    "given", "friction", "gas_law", "friction_side", "control", "has_load_friction", "nstate",
    "state_names", "replace",
}  # fmt: skip


def trees() -> dict[str, ast.Module]:
    """The element's files; those of the shipped models (model_*.py) are not part of it."""
    files = [p for p in FOLDER.rglob("*.py") if not p.name.startswith("model_")]
    found = {p.name: ast.parse(p.read_text(encoding="utf-8")) for p in files}
    assert len(found) > 8
    return found


def test_imports() -> None:
    """Of inerter nothing but itself and few names of the core; no reference, no plugin."""
    for name, tree in trees().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                assert {alias.name.split(".")[0] for alias in node.names} <= OUTSIDE, name
            if isinstance(node, ast.ImportFrom):
                module = node.module or ""
                assert node.level == 0, name
                names = {alias.name for alias in node.names}
                if module == "inerter.core":
                    assert names <= FROM_CORE, f"{name} takes {names} from the core"
                elif module.split(".")[0] == "inerter" and module != UNITS:
                    assert (module + ".").startswith("inerter.exudyn."), f"{name}: {module}"
                else:
                    assert module == UNITS or module.split(".")[0] in OUTSIDE, f"{name}: {module}"


def test_no_law_of_the_core_is_called() -> None:
    """Everything that a device of the core can do, beside telling its parameters, stays unused."""
    laws = {name for name in vars(Device) if not name.startswith("_")} - DATA
    assert {"evaluate", "step", "along", "over_step", "state_of_force", "validity"} <= laws
    for name, tree in trees().items():
        used = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}
        assert not used & laws, f"{name} uses {used & laws}"


def test_exudyn_is_imported_late() -> None:
    """`import inerter.exudyn` works where Exudyn is not installed: nothing imports it on top."""
    assert importlib.util.find_spec("inerter.exudyn") is not None
    for name, tree in trees().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                assert all(alias.name.split(".")[0] != "exudyn" for alias in node.names), name
