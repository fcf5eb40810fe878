"""Where the shipped models and records are."""

from __future__ import annotations

from pathlib import Path

# in an installed wheel the models lie inside the package, in a checkout beside `python/`
_FOLDERS = (
    Path(__file__).parent / "mjcf_models",
    Path(__file__).parents[2] / "mjcf_models",
)


def model_names() -> list[str]:
    """Names of the shipped models."""
    return sorted(path.parent.name for path in _folder().glob("*/model.xml"))


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
    folder = _folder() / name
    if not (folder / "model.xml").exists():
        raise ValueError(f"no model {name!r}; the models are {', '.join(model_names())}")
    path = folder / file
    if not path.exists():
        files = ", ".join(sorted(found.name for found in folder.iterdir()))
        raise ValueError(f"model {name!r} has no file {file!r}; it has {files}")
    return path


def data_path(file: str) -> Path:
    """Path of a shipped record."""
    return Path(__file__).parent / "data" / file


def _folder() -> Path:
    for folder in _FOLDERS:
        if folder.exists():
            return folder
    looked = " or ".join(str(folder) for folder in _FOLDERS)
    raise ValueError(
        f"no models in {looked}; reinstall with `pip install --force-reinstall inerter`"
    )
