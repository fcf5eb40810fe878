"""Where the shipped models and records are."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

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
            '`pip install "inerter[exudyn]"`'
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
    raise ValueError(
        f"no models in {looked}; reinstall with `pip install --force-reinstall inerter`"
    )
