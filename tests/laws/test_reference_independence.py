"""The reference is a second telling: it must not lean on any other part of the package.

One module of the package it may read: the published numbers of the models, which are data.
"""

import ast
import sys
from pathlib import Path

import inerter.model_parameters
import inerter.reference

FOLDER = Path(inerter.reference.__file__).parent
DATA = "inerter.model_parameters"
ALLOWED = {
    "__future__", "collections", "dataclasses", "difflib", "functools", "importlib", "itertools",
    "pathlib", "types", "typing", "numpy", "scipy",
}  # fmt: skip


def imports(path: Path) -> list[tuple[int, str]]:
    """Every imported module of a file as (level of relative import, name)."""
    found: list[tuple[int, str]] = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [(0, alias.name) for alias in node.names]
        if isinstance(node, ast.ImportFrom):
            found.append((node.level, node.module or ""))
    return found


def test_reference_imports_nothing_of_the_core() -> None:
    files = sorted(FOLDER.rglob("*.py"))
    assert len(files) > 10
    for path in files:
        depth = len(path.relative_to(FOLDER).parts)
        for level, name in imports(path):
            if level:
                assert level <= depth, f"{path.name} imports from outside reference/: {name}"
            else:
                assert name == DATA or name.split(".")[0] in ALLOWED, f"{path.name} imports {name}"
        # what is imported by a name that is put together lies beside it
        text = path.read_text(encoding="utf-8")
        assert text.count("import_module(") == text.count('import_module(f".{name}", __name__)')


def test_the_shared_numbers_are_data() -> None:
    """Frozen records and constants: nothing imported but the standard library, no law within."""
    path = Path(inerter.model_parameters.__file__)
    found = imports(path)
    assert found
    for level, name in found:
        assert level == 0, f"{path.name} imports from the package: {name}"
        assert name.split(".")[0] in sys.stdlib_module_names, f"{path.name} imports {name}"
    tree = ast.parse(path.read_text(encoding="utf-8"))
    allowed = (ast.ImportFrom, ast.ClassDef, ast.Assign, ast.Expr)
    assert all(isinstance(node, allowed) for node in tree.body)
