"""What the pages show and code makes: pictures, the gallery, scenes, what the laws leave out.

Everything goes into docs/figures, which git does not know, and is made again only when the code
that makes it has changed. The page builder runs this; `python docs/generated.py` does it by hand,
and writes the parameter table of plugin_c/README.md from the core.
"""

from __future__ import annotations

import json
import math
import re
from hashlib import sha256
from pathlib import Path

import figures
from inerter.core import library_path, parameters
from inerter.diagnose.decision import CRITERIA
from inerter.models import model_names, model_path
from inerter.plugin import plugin_path

HERE = Path(__file__).parent
FOLDER = figures.FOLDER
CORE = HERE.parent / "plugin_c" / "core"
KEPT = FOLDER / "made_of.json"
README = HERE.parent / "plugin_c" / "README.md"
OPENS, CLOSES = "<!-- parameters -->\n", "<!-- /parameters -->"


def make() -> str | None:
    """Make what is out of date. The reason where scenes could not be rendered."""
    FOLDER.mkdir(exist_ok=True)
    kept = json.loads(KEPT.read_text()) if KEPT.exists() else {}
    drawn = fingerprint(
        [HERE / "figures.py", HERE / "strut_figures.py", library_path("inerter_core")]
    )
    if kept.get("drawn") != drawn:
        kept["pictures"], kept["drawn"] = figures.draw(), drawn
    seen = fingerprint([plugin_path(), *model_path("quarter_car").parents[1].rglob("*.xml")])
    if kept.get("seen") != seen:
        kept["missing"] = render_scenes()
        # where OpenGL is missing now, it may be there the next time
        kept["seen"] = None if kept["missing"] else seen
    KEPT.write_text(json.dumps(kept, indent=2))
    (FOLDER / "gallery.md").write_text(gallery(kept["pictures"]), encoding="utf-8")
    (FOLDER / "scenes.md").write_text(scenes(kept["missing"]), encoding="utf-8")
    (FOLDER / "not_modelled.md").write_text(not_modelled(), encoding="utf-8")
    (FOLDER / "criteria.md").write_text(criteria(), encoding="utf-8")
    return kept["missing"]


def fingerprint(files: list[Path]) -> str:
    """Of the content of files, and of this one."""
    found = sha256(Path(__file__).read_bytes())
    for path in sorted(files):
        found.update(path.read_bytes())
    return found.hexdigest()


def render_scenes() -> str | None:
    """A picture of every model's scene, a moment after its start; why not, where it cannot be."""
    import matplotlib.image
    import mujoco
    from inerter.engine_errors import SimulationError
    from inerter.simulate.load import load_model, start
    from inerter.view.picture import render

    for name in model_names():
        model = load_model(model_path(name, "scene.xml"))
        data = start(model, "0")
        for _ in range(round(0.05 / model.opt.timestep)):
            mujoco.mj_step(model, data)
        try:
            picture = render(model, data)
        except SimulationError as error:
            return str(error)
        matplotlib.image.imsave(FOLDER / f"scene_{name}.png", picture)
    return None


def gallery(pictures: dict[str, list[str]]) -> str:
    """The pictures of `figures.py`, each with the function that draws it."""
    parts = []
    for function, names in pictures.items():
        title = (getattr(figures, function).__doc__ or "").strip()
        shown = "\n".join(
            f":::{{figure}} figures/{name}.svg\n{name.replace('_', ' ')}\n:::" for name in names
        )
        parts.append(
            f"## {title.rstrip('.')}\n::::{{container}} thumbnails\n{shown}\n::::\n\n"
            "```{raw} html\n<details><summary>the code</summary>\n```\n"
            f"```{{literalinclude}} figures.py\n:pyobject: {function}\n```\n"
            "```{raw} html\n</details>\n```\n"
        )
    return "\n".join(parts)


def scenes(missing: str | None) -> str:
    """A picture and the first words of every model, or a note that pictures are missing."""
    note = f":::{{note}}\nThe scenes were not rendered in this build: {missing}\n:::\n\n"
    parts = [note if missing else ""]
    for name in model_names():
        text = model_path(name).with_name("README.md").read_text(encoding="utf-8")
        title, first = re.match(r"# (.*?)\n\n(.*?)\n\n", text, re.S).groups()  # type: ignore
        picture = "" if missing else f"![{title}](figures/scene_{name}.png)\n\n"
        parts.append(f"## {title}\n{picture}{first}\nFolder: `mjcf_models/{name}`.\n\n")
    return "".join(parts)


def not_modelled() -> str:
    """What each law's file says that it leaves out."""
    rows = ["| file | not modelled |", "| --- | --- |"]
    for path in sorted(CORE.glob("*.c")):
        if path.stem.startswith(("series_", "over_step")):
            continue  # how a step is taken, not a law
        # the words up to the end of the comment, or of its paragraph
        text = re.sub(r"\n// ?", "\n", path.read_text(encoding="utf-8"))
        found = re.search(r"Not\s+modelled: (.*?)(?:\n\n|\n#)", text, re.S)
        if found:
            rows.append(f"| `{path.name}` | {' '.join(found[1].split())} |")
    return "\n".join(rows) + "\n"


def criteria() -> str:
    """The bounds that a diagnosis decides by, with their reasons."""
    rows = ["| bound | value | of | reason |", "| --- | ---: | --- | --- |"]
    for name, value, unit, reason in CRITERIA.rows():
        rows.append(f"| `{name}` | {value:g} | {unit} | {reason} |")
    return "\n".join(rows) + "\n"


def parameter_table() -> str:
    """The parameters as the core declares them."""
    rows = [
        "| name | unit | default | range | friction laws | meaning |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for name, each in parameters().items():
        default = "unset" if math.isnan(each.initial) else f"{each.initial:g}"
        bounds = []
        if math.isfinite(each.lower):
            bounds.append(f"{'>' if each.lower_open else '>='} {each.lower:g}")
        if math.isfinite(each.upper):
            bounds.append(f"<= {each.upper:g}")
        allowed, laws = " ".join(bounds) or "any", " ".join(each.laws) or "-"
        cells = (f"`{name}`", each.unit, default, allowed, laws, each.meaning)
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows) + "\n"


def write_parameter_table(path: Path = README) -> None:
    """The table between the marks of a document."""
    before, rest = path.read_text(encoding="utf-8").split(OPENS, 1)
    after = rest[rest.index(CLOSES) :]
    path.write_text(before + OPENS + parameter_table() + after, encoding="utf-8")


if __name__ == "__main__":
    write_parameter_table()
    print(make() or "everything is there")
