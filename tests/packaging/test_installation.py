"""What `pip install inerter` promises: the plugin is there, imports are light, errors help."""

import ast
import importlib.metadata
import os
import re
import runpy
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import inerter
import inerter.core_library
import inerter.plugin
import mujoco
import pytest
from falling_model import MODEL

ROOT = Path(__file__).resolve().parents[2]


def run(script: str, *flags: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a script in a fresh interpreter, away from the checkout."""
    return subprocess.run(
        [sys.executable, *flags, "-c", script],
        capture_output=True, text=True, check=False, cwd=Path(sys.prefix), timeout=120,
        env={**os.environ, **environment},
    )  # fmt: skip


@pytest.fixture(scope="module")
def project() -> dict[str, Any]:
    with (ROOT / "pyproject.toml").open("rb") as file:
        return tomllib.load(file)


# ------------------------------ the plugin ------------------------------


def test_importing_mujoco_is_enough() -> None:
    done = run(
        f"import mujoco, sys\nmodel = mujoco.MjModel.from_xml_string('''{MODEL}''')\n"
        "assert model.nplugin == 1\n"
        "assert 'scipy' not in sys.modules\n",
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""


def test_the_entry_point_is_registered_once() -> None:
    (entry,) = importlib.metadata.entry_points(group="mujoco.plugins", name="inerter")
    assert entry.value == "inerter.plugin:load_plugin"
    assert entry.load() is inerter.load_plugin


def test_loading_again_does_nothing() -> None:
    done = run("import inerter, mujoco\ninerter.load_plugin()\ninerter.load_plugin()\n")
    assert done.returncode == 0, done.stderr


def test_the_library_is_where_it_is_said_to_be() -> None:
    path = inerter.plugin_path()
    assert path.is_file()
    # one folder, or two where it is installed in place
    assert any(path.is_relative_to(folder) for folder in inerter.__path__)


# ------------------------------ light imports ------------------------------

HEAVY = (
    "scipy", "polars", "pyarrow", "plotly", "matplotlib", "typer", "rich", "jinja2",
    "pint", "tomlkit", "exudyn",
)  # fmt: skip


@pytest.mark.parametrize("module", ["inerter", "inerter.plugin", "inerter.core", "mujoco"])
def test_the_lab_is_imported_only_where_it_is_used(module: str) -> None:
    # every MuJoCo process of the machine pays for what the plugin imports
    done = run(f"import sys, {module}\nprint(*sys.modules)\n")
    assert done.returncode == 0, done.stderr
    assert "inerter.plugin" in done.stdout.split()
    assert not set(HEAVY) & set(done.stdout.split())


def test_the_core_works_without_the_lab() -> None:
    # as after `pip install inerter` without extras: the lab's packages cannot be imported
    done = run(
        "import sys\n"
        f"sys.modules.update(dict.fromkeys({HEAVY!r}))\n"
        "import numpy as np, inerter\n"
        "device = inerter.Device(inertance=2.0, friction='coulomb', coulomb_force=1.0)\n"
        "x = np.zeros(3)\n"
        "assert device.along(0.1, x, x, x + 3.0)['total'].tolist() == [6.0] * 3\n"
    )
    assert done.returncode == 0, done.stderr


def test_no_warning_on_import() -> None:
    done = run("import inerter, inerter.plugin", "-W", "error")
    assert done.returncode == 0, done.stderr


# ------------------------------ versions ------------------------------


def test_the_versions_of_mujoco_are_stated_once(project: dict[str, Any]) -> None:
    stated = runpy.run_path(str(ROOT / "plugin_c" / "packaging" / "engines.py"))
    assert stated["REQUIREMENT"] in project["project"]["dependencies"]
    required = importlib.metadata.requires("inerter") or []
    assert {canonical(each) for each in required if "extra" not in each} == {"mujoco", "numpy"}
    # built for the engine that is installed, or for all of them
    versions = inerter.plugin.plugin_versions()
    assert mujoco.mj_versionString() in versions
    assert set(versions) <= set(stated["ENGINES"])
    header = (ROOT / "plugin_c" / "mujoco" / "engine.h").read_text(encoding="utf-8")
    oldest = [int(number) for number in next(iter(stated["ENGINES"])).split(".")]
    assert f"mjVERSION_HEADER < {oldest[0]}{oldest[1]:03}{oldest[2]:03}" in header
    # the pages that list them, and those that say what was run with which
    *others, newest = engines = list(stated["ENGINES"])
    pinned = pinned_engine(project)
    for page, sentences in {
        "README.md": [f"MuJoCo {', '.join(engines)}: the wheel"],
        "plugin_c/README.md": [f"{', '.join(engines)}: a library", f"Tests run against {pinned};"],
        "docs/limits.md": [f"MuJoCo {', '.join(others)} and {newest}."],
        "docs/neighbours.md": [f"development stays on {pinned}."] if newest != pinned else [],
    }.items():
        text = (ROOT / page).read_text(encoding="utf-8")
        for sentence in sentences:
            assert sentence in text, f"{page}: no {sentence!r}; ENGINES of engines.py has the list"
        majors = "|".join(sorted({version.split(".")[0] for version in engines}))
        named = set(re.findall(rf"(?<![\d.=])(?:{majors})\.\d+\.\d+(?![\d.])", text))
        assert named <= set(engines), f"{page} names {named - set(engines)}, not in engines.py"


def pinned_engine(project: dict[str, Any]) -> str:
    """The version that development uses."""
    wanted = " ".join(project["project"]["optional-dependencies"]["dev"])
    (version,) = re.findall(r"mujoco\[\w+\]==(\S+)", wanted)
    return version


def test_one_header_includes_the_engines() -> None:
    """What differs between its versions has one place only where every file goes through it."""
    folder = ROOT / "plugin_c" / "mujoco"
    texts = {path.name: path.read_text(encoding="utf-8") for path in folder.glob("*.[ch]")}
    assert len(texts) > 40
    direct = [name for name, text in texts.items() if re.search(r"#include\s*<mujoco/", text)]
    assert direct == ["engine.h"], "include mujoco/engine.h, where the versions' differences stand"

    def reached(name: str, seen: set[str]) -> set[str]:
        for other in re.findall(r'#include "mujoco/([^"]+)"', texts[name]):
            if other not in seen:
                seen.add(other)
                reached(other, seen)
        return seen

    for name, text in texts.items():
        if re.search(r"\bmj[A-Z]|\bmju?_", text) and name != "engine.h":
            assert "engine.h" in reached(name, set()), f"{name} does not include mujoco/engine.h"


def test_one_version_of_the_package(project: dict[str, Any]) -> None:
    version = project["project"]["version"]
    assert inerter.__version__ == version
    assert importlib.metadata.version("inerter") == version


@pytest.mark.parametrize("found", ["3.9.1", "4.0.7", "4.1.0", "5.0.0"])
def test_another_mujoco_is_refused(monkeypatch: pytest.MonkeyPatch, found: str) -> None:
    monkeypatch.setattr(mujoco, "mj_versionString", lambda: found)
    monkeypatch.setattr(inerter.plugin, "_loaded", False)
    with pytest.raises(ImportError) as caught:
        inerter.load_plugin()
    message, there = str(caught.value), inerter.plugin.plugin_versions()
    assert f"no library for MuJoCo {found}" in message
    for version in there:
        assert version in message
    assert f"pip install mujoco=={there[-1]}" in message
    assert "pip install --force-reinstall" in message


# ------------------------------ a broken installation ------------------------------


def test_a_missing_plugin_is_an_import_error(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(inerter.core_library, "LIBRARY_FOLDER", tmp_path)
    monkeypatch.setattr(inerter.plugin, "_loaded", False)
    for call in (inerter.plugin_path, inerter.load_plugin):
        with pytest.raises(ImportError, match=r"inerter_mujoco.* is missing .*reinstall with `pip"):
            call()


def test_a_missing_core_is_an_import_error() -> None:
    # in a fresh interpreter: this one has the library loaded
    done = run(
        "import pathlib, inerter.core as core, inerter.core_library as core_library\n"
        "core_library.LIBRARY_FOLDER = pathlib.Path('nowhere')\n"
        "core_library.library.cache_clear()\n"
        "try:\n"
        "    core.Device(inertance=1.0)\n"
        "except ImportError as error:\n"
        "    print(error)\n"
    )
    assert "inerter_core" in done.stdout, done.stderr
    assert "is missing: reinstall with `pip" in done.stdout


# ------------------------------ what is shipped ------------------------------


@pytest.mark.skipif(not (ROOT / "mjcf_models").is_dir(), reason="the checkout has no models")
def test_every_model_of_the_checkout_is_installed() -> None:
    from inerter.models import model_names, model_path

    folders = sorted(path.parent.name for path in (ROOT / "mjcf_models").glob("*/model.xml"))
    assert model_names() == folders
    for name in folders:
        for file in (ROOT / "mjcf_models" / name).iterdir():
            installed = model_path(name, file.name)
            assert installed.read_bytes() == file.read_bytes(), installed


def test_the_libraries_of_an_installation_in_place_are_found(tmp_path: Path) -> None:
    """`pip install -e .`: the package is two folders, modules in one, libraries in the other."""
    from inerter.core_library import LIBRARY_FOLDER

    source, built = tmp_path / "source" / "inerter", tmp_path / "built" / "inerter"
    left_out = shutil.ignore_patterns("lib", "data", "__pycache__")
    shutil.copytree(Path(inerter.__file__).parent, source, ignore=left_out)
    shutil.copytree(LIBRARY_FOLDER, built / "lib")
    done = run(
        "import sys\n"
        "from importlib.util import module_from_spec, spec_from_file_location\n"
        f"places = {[str(built), str(source)]}\n"
        "spec = spec_from_file_location(\n"
        "    'inerter', places[1] + '/__init__.py', submodule_search_locations=places\n"
        ")\n"
        "sys.modules['inerter'] = package = module_from_spec(spec)\n"
        "spec.loader.exec_module(package)\n"
        "assert package.__file__.startswith(places[1])\n"
        "assert package.Device(inertance=2.0).inertance == 2.0\n"
        "import mujoco\n"
        "assert str(package.plugin_path()).startswith(places[0])\n",
        "-W",
        "error",
    )
    assert done.returncode == 0, done.stderr


def test_every_source_file_of_the_package_is_installed() -> None:
    source, installed = ROOT / "python" / "inerter", Path(inerter.__file__).parent
    for file in sorted(source.rglob("*")):
        if file.is_dir() or "__pycache__" in file.parts or file.parent.name == "lib":
            continue
        assert (installed / file.relative_to(source)).is_file(), file.name


def test_the_command_is_installed() -> None:
    scripts = importlib.metadata.entry_points(group="console_scripts", name="inerter")
    (command,) = scripts
    assert callable(command.load())


def test_every_import_is_a_declared_dependency(project: dict[str, Any]) -> None:
    # a package that only some other package brings along may be gone tomorrow
    extras = project["project"]["optional-dependencies"]
    stated = [*project["project"]["dependencies"], *extras["lab"], *extras["exudyn"]]
    stated += [*extras["cluster"], *extras["gymnasium"], *extras["files"]]
    declared = {canonical(requirement) for requirement in stated} | {"inerter"}
    providers = importlib.metadata.packages_distributions()
    undeclared: dict[str, list[str]] = {}
    for file in sorted((ROOT / "python" / "inerter").rglob("*.py")):
        for module in imported(file) - set(sys.stdlib_module_names):
            names = {canonical(name) for name in providers.get(module, [module])}
            if not names & declared:
                undeclared.setdefault(module, []).append(file.name)
    assert undeclared == {}


def canonical(requirement: str) -> str:
    """Name of a distribution in its canonical spelling."""
    found = re.match(r"[A-Za-z0-9._-]+", requirement)
    assert found
    return re.sub(r"[-_.]+", "-", found.group()).lower()


def imported(file: Path) -> set[str]:
    """Top-level modules that a file imports, wherever in it."""
    names: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level and node.module:
            names.add(node.module.split(".")[0])
    return names
