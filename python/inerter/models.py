"""Where the shipped models and records are."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from inerter.exudyn.engine import installed

# in an installed wheel the models lie inside the package, in a checkout beside `python/`
_PLACES = (Path(__file__).parent, Path(__file__).parents[2])


def model_names() -> list[str]:
    """Names of the shipped models."""
    return sorted(path.parent.name for path in _folder("mjcf_models").glob("*/model.xml"))


def model_path(name: str, file: str = "model.xml") -> Path:
    """Path of a file of a shipped model.

    Parameters
    ----------
    name : str
        A model, see `model_names()`.
    file : str
        A file in its folder, such as "scene.xml".

    Raises
    ------
    ValueError
        There is no such model or file; the message lists what there is.
    """
    folder = _folder("mjcf_models") / name
    if not (folder / "model.xml").exists():
        raise ValueError(f"no model {name!r}; the models are {', '.join(model_names())}")
    path = folder / file
    if not path.exists():
        files = ", ".join(sorted(found.name for found in folder.iterdir()))
        raise ValueError(f"model {name!r} has no file {file!r}; it has {files}")
    return path


def model_file(given: str | Path) -> Path:
    """A model file as it is given, or the scene of a shipped model of that name."""
    path = Path(given)
    if path.exists() or path.suffix or len(path.parts) != 1:
        return path
    try:
        names = model_names()
    except ValueError:
        return path
    if str(path) not in names:
        raise ValueError(
            f"{path}: no such file, and no model of that name is shipped; give a .xml file, or one "
            f"of {', '.join(names)}"
        )
    scene = _folder("mjcf_models") / str(path) / "scene.xml"
    return scene if scene.exists() else model_path(str(path))


def title_of(path: Path) -> str:
    """What a model is called: a shipped one by its name, any other by its file."""
    folder = path.resolve().parent
    return folder.name if folder.parent == models_folder() else path.name


def model_list() -> list[dict[str, Any]]:
    """Name, file, keyframes and devices of each shipped model."""
    import mujoco

    from inerter.plugin import load_plugin

    load_plugin()
    found = []
    for name in model_names():
        path = model_file(name)
        model = mujoco.MjModel.from_xml_path(str(path))
        plugins = [i for i in range(model.nu) if model.actuator_plugin[i] >= 0]
        found.append(
            {
                "name": name,
                "file": str(path),
                "keyframes": [model.key(i).name or str(i) for i in range(model.nkey)],
                "devices": [model.actuator(i).name or str(i) for i in plugins],
            }
        )
    return found


def models_folder() -> Path:
    """The folder of the shipped MJCF models, without links in its path."""
    return _folder("mjcf_models").resolve()


def exudyn_model_names() -> list[str]:
    """Names of the shipped models that are there for Exudyn."""
    return sorted(path.parent.name for path in _folder("exudyn_models").glob("*/model.py"))


def exudyn_model(name: str) -> ModuleType:
    """The module `exudyn_models/<name>/model.py`; its `build(mbs, ...)` makes the model.

    Parameters
    ----------
    name : str
        A model, see `exudyn_model_names()`.

    Raises
    ------
    ValueError
        There is no such model; the message lists what there is.
    ImportError
        Exudyn is not installed.
    """
    path = _folder("exudyn_models") / name / "model.py"
    if not path.exists():
        there = ", ".join(exudyn_model_names())
        raise ValueError(f"no Exudyn model {name!r}; the models are {there}")
    if not installed():
        raise ImportError(
            f"the model {name!r} needs Exudyn, which is not installed: "
            "`pip install exudyn` (the extra `exudyn`)"
        )
    known = f"inerter_exudyn_model_{name}"
    if known not in sys.modules:
        spec = importlib.util.spec_from_file_location(known, path)
        if spec is None or spec.loader is None:
            raise ImportError(f"{path} cannot be imported; reinstall inerter")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        sys.modules[known] = module
    return sys.modules[known]


def data_path(file: str) -> Path:
    """Path of a shipped record."""
    return Path(__file__).parent / "data" / file


def _folder(kind: str) -> Path:
    folders = [place / kind for place in _PLACES]
    for folder in folders:
        if folder.is_dir():
            return folder
    looked = " or ".join(str(folder) for folder in folders)
    raise ValueError(f"no models in {looked}; install inerter again")
