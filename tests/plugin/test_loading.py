"""Is the plugin there without a line of Python, and does it say what is wrong when it is not?"""

from __future__ import annotations

import importlib.metadata
import shutil
import subprocess
import sys
from pathlib import Path

import inerter
import inerter.plugin
import mujoco
import pytest
from plugin_models import ENGINE, plugin_actuator, quarter_car_xml

XML = quarter_car_xml(plugin_actuator({"inertance": 113}))


def fresh(code: str, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    import os

    return subprocess.run(
        [sys.executable, "-c", code, XML, *arguments],
        capture_output=True, text=True, env={**os.environ, **environment}, check=False,
    )  # fmt: skip


def test_importing_mujoco_is_enough() -> None:
    if ENGINE < (4,):
        pytest.skip("MuJoCo 3 has no entry points for plugins: `import inerter` makes it known")
    if not importlib.metadata.entry_points(group="mujoco.plugins", name="inerter"):
        pytest.skip("inerter is not installed, only importable")
    result = fresh("import sys, mujoco; print(mujoco.MjModel.from_xml_string(sys.argv[1]).nu)")
    assert result.stdout.strip() == "1", result.stderr


def test_loading_again_is_harmless(tmp_path: Path) -> None:
    inerter.load_plugin()
    path = inerter.plugin_path()
    second = tmp_path / path.name
    shutil.copy(path, second)
    # the same file again, and a second copy of it, which has other addresses
    result = fresh(
        "import sys, mujoco, inerter; inerter.load_plugin(); inerter.load_plugin()\n"
        "for path in sys.argv[2:]: mujoco.mj_loadPluginLibrary(path)\n"
        "print(mujoco.MjModel.from_xml_string(sys.argv[1]).nu)",
        str(path),
        str(second),
    )
    assert result.stdout.strip() == "1", result.stderr


def test_another_mujoco_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inerter.plugin, "_loaded", False)
    monkeypatch.setattr(mujoco, "mj_versionString", lambda: "4.1.0")
    with pytest.raises(ImportError) as caught:
        inerter.load_plugin()
    for word in (mujoco.__version__, "4.1.0", "pip install mujoco=="):
        assert word in str(caught.value)


def test_a_missing_library_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr("inerter.core_library.LIBRARY_FOLDER", tmp_path)
    with pytest.raises(ImportError, match="reinstall"):
        inerter.plugin_path()


def test_the_library_itself_refuses_another_mujoco(tmp_path: Path) -> None:
    # the version function of another release in front of the real one
    compiler = shutil.which("cc")
    if compiler is None or sys.platform != "linux":
        pytest.skip("needs a C compiler and LD_PRELOAD")
    source, shim = tmp_path / "shim.c", tmp_path / "shim.so"
    source.write_text(
        "int mj_version(void) { return 4001000; }\n"
        'const char* mj_versionString(void) { return "4.1.0"; }\n'
    )
    subprocess.run([compiler, "-shared", "-fPIC", "-o", shim, source], check=True)
    result = fresh(
        "import ctypes, glob, os, sys\n"
        "from importlib.util import find_spec\n"
        "folder = find_spec('mujoco').submodule_search_locations[0]\n"
        "ctypes.CDLL(glob.glob(os.path.join(folder, 'libmujoco.so.*'))[0], ctypes.RTLD_GLOBAL)\n"
        "ctypes.CDLL(sys.argv[2])\n",
        str(inerter.plugin_path()),
        LD_PRELOAD=str(shim),
    )
    version = mujoco.__version__
    for word in (version, "4.1.0", f"pip install mujoco=={version}", "plugin-path --mujoco 4.1.0"):
        assert word in result.stdout + result.stderr
