"""The parameter table that users read is the one that the core runs on.

Whatever document has one holds it between `<!-- parameters -->` and `<!-- /parameters -->`: a
Markdown table with a row per parameter, its first cell the name in backticks. Columns headed unit,
default and meaning are compared where they stand.

"""

import math
import re
from pathlib import Path

import pytest
from inerter.core import Parameter, friction_laws, parameters

ROOT = Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^<!--\s*parameters\s*-->(.*?)(?:<!--\s*/parameters\s*-->|\Z)", re.S | re.M)


def blocks() -> dict[str, str]:
    """What documents hold between the marks, by their paths."""
    found = {}
    for folder in ("", "docs", "docs/how_to", "plugin_c"):
        for path in sorted((ROOT / folder).glob("*.md")):
            if block := BLOCK.search(path.read_text(encoding="utf-8")):
                found[path.relative_to(ROOT).as_posix()] = block.group(1)
    return found


def rows(block: str) -> list[dict[str, str]]:
    """Rows of the tables in a block by column heading, in lower case."""
    table: list[dict[str, str]] = []
    heading: list[str] = []
    for line in block.splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]
        if not line.strip().startswith("|"):
            heading = []
        elif not heading:
            heading = [cell.lower() for cell in cells]
        elif not all(re.fullmatch(r":?-+:?", cell) for cell in cells):
            table.append({"name": cells[0], **dict(zip(heading, cells, strict=False))})
    return table


def same_number(text: str, value: float) -> bool:
    try:
        return float(text) == value
    except ValueError:
        # words, for a default that is derived from others
        return math.isnan(value)


def in_words(parameter: Parameter) -> str:
    """Bounds such as ">= 0 <= 1", "> 0", "any"."""
    lower, upper = parameter.lower, parameter.upper
    words = [f"{'>' if parameter.lower_open else '>='} {lower:g}"] if math.isfinite(lower) else []
    return " ".join([*words, *([f"<= {upper:g}"] if math.isfinite(upper) else [])]) or "any"


def test_the_readme_of_the_plugin_has_a_table() -> None:
    assert "plugin_c/README.md" in blocks()


def test_the_readme_of_the_plugin_names_every_law() -> None:
    text = (ROOT / "plugin_c" / "README.md").read_text(encoding="utf-8")
    (named,) = re.findall(r"^`friction` names the law: (.*)\.", text, re.M)
    assert re.findall(r"`(\w+)`", named.split(". ")[0]) == list(friction_laws())


@pytest.mark.parametrize("document", sorted(blocks()))
def test_table_equals_the_core(document: str) -> None:
    table = rows(blocks()[document])
    known = parameters()
    named = [re.sub(r"`", "", row["name"]) for row in table]
    assert sorted(named) == sorted([*known])
    for name, row in zip(named, table, strict=True):
        parameter = known[name]
        if "unit" in row:
            assert row["unit"].strip("`").replace("\\", "") == parameter.unit, name
        if "default" in row:
            assert same_number(row["default"].strip("`"), parameter.initial), name
        if "range" in row:
            assert row["range"] == in_words(parameter), name
        if "friction laws" in row:
            assert row["friction laws"].strip("-").split() == list(parameter.laws), name
        if "meaning" in row:
            assert row["meaning"].replace("\\", "").replace("`", "") == parameter.meaning, name


def test_the_reader_of_tables() -> None:
    text = """
    | parameter | unit | default | meaning |
    | --- | --- | ---: | --- |
    | `inertance` | kg | 0 | force per a \\| b |
    """
    (row,) = rows(text)
    assert row["name"] == "`inertance`"
    assert row["unit"] == "kg"
    assert row["meaning"] == "force per a \\| b"
    assert same_number("1e-2", 0.01)
    assert not same_number("", 0.01)
