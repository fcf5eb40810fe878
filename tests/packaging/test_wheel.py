"""What `make wheel` makes runs elsewhere, without a compiler, and can be built from its sources."""

from __future__ import annotations

import runpy
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

import pytest
from falling_model import MODEL

pytestmark = pytest.mark.long

ROOT = Path(__file__).resolve().parents[2]
# 1 kg and 2 kg of inertance fall for 0.2 s
FALLS = f"""
import mujoco
model = mujoco.MjModel.from_xml_string('''{MODEL}''')
data = mujoco.MjData(model)
mujoco.mj_step(model, data, 100)
print(abs(data.qvel[0] + 9.81 * 0.2 / 3) < 1e-9)
"""


def run(*command: str | Path, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        list(map(str, command)), capture_output=True, text=True, check=False, timeout=600,
        **options,  # type: ignore[arg-type]
    )  # fmt: skip


def succeeded(done: subprocess.CompletedProcess[str]) -> None:
    """What fetches packages has ended well; the test is skipped where no index can be reached."""
    said = done.stdout + done.stderr
    if done.returncode and "Failed to establish a new connection" in said:
        pytest.skip("no package index can be reached from here")
    assert done.returncode == 0, said


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder that `make wheel` has filled."""
    tools = Path(sysconfig.get_path("scripts"))
    if shutil.which("make") is None or not (tools / "auditwheel").exists():
        pytest.skip("needs make, and the tools of the extra dev")
    folder = tmp_path_factory.mktemp("dist")
    # -o: the tests run in what is set up, whatever its age
    old = f"{sys.prefix}/dev"
    done = run("make", "-o", old, "wheel", f"VENV={sys.prefix}", f"DIST={folder}", cwd=ROOT)
    succeeded(done)
    return folder


@pytest.fixture(scope="module")
def wheel(made: Path) -> Path:
    (found,) = made.glob("*.whl")
    return found


@pytest.mark.skipif(sys.platform != "linux", reason="manylinux is for Linux")
def test_the_wheel_says_where_it_runs(wheel: Path) -> None:
    # as old as the C library's versions of what the plugin calls: exp, log and pow of glibc 2.29
    assert "-py3-none-manylinux_2_" in wheel.name or "-py3-none-musllinux_" in wheel.name
    if "manylinux" in wheel.name:
        assert int(wheel.name.split("manylinux_2_")[1].split("_")[0]) <= 35


def test_the_wheel_holds_our_libraries_and_not_mujocos(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    engines = runpy.run_path(str(ROOT / "plugin_c" / "packaging" / "engines.py"))["ENGINES"]
    found = {Path(name) for name in names if Path(name).suffix in (".so", ".dylib")}
    libraries = {str(path.relative_to("inerter/lib").with_suffix("")) for path in found}
    assert libraries == {
        "libinerter_core", "libinerter_exudyn",
        *(f"{version}/libinerter_mujoco" for version in engines),
    }  # fmt: skip
    assert not [name for name in names if "libmujoco" in name or "/tests/" in name]
    assert "inerter/mjcf_models/quarter_car/model.xml" in names


def test_the_sources_are_all_there_and_nothing_built(made: Path) -> None:
    (sources,) = made.glob("*.tar.gz")
    with tarfile.open(sources) as archive:
        names = ["/".join(name.split("/")[1:]) for name in archive.getnames()]
    for name in ("pyproject.toml", "CMakeLists.txt", "LICENSE", "plugin_c/core/device.c"):
        assert name in names
    assert not [name for name in names if name.endswith((".so", ".dylib", ".o", ".pyc", ".whl"))]


def test_the_wheel_runs_where_there_is_only_mujoco(
    wheel: Path, tmp_path: Path, long_run: bool
) -> None:
    where = tmp_path / "clean"
    assert run(sys.executable, "-m", "venv", "--without-pip", where).returncode == 0
    python, tools = where / "bin" / "python", where / "bin"

    def install(what: str) -> None:
        pip = [sys.executable, "-m", "pip", "--python", python, "--disable-pip-version-check"]
        done = run(*pip, "install", "--quiet", "--no-compile", what)
        succeeded(done)

    install(str(wheel))
    bare = {"PATH": str(tools), "HOME": str(tmp_path)}
    assert shutil.which("cc", path=bare["PATH"]) is None

    # no compiler, no lab
    done = run(python, "-I", "-W", "error", "-c", FALLS, env=bare, cwd=tmp_path)
    assert done.stdout.strip() == "True", done.stderr
    assert done.stderr == ""
    path = run(tools / "inerter", "plugin-path", env=bare).stdout.strip()
    assert Path(path).is_relative_to(where)
    listed = run(tools / "inerter", "parameters", "series", env=bare)
    assert "series_stiffness\tN/m" in listed.stdout
    refused = run(tools / "inerter", "diagnose", "r.csv", env=bare)
    assert refused.returncode == 2
    assert "extra `lab`" in refused.stderr

    # with the lab: `make test ARGS="--long -k only_mujoco"`
    if long_run:
        install(f"{wheel}[lab]")
        done = run(tools / "inerter", "demo", "--out", tmp_path / "out", env=bare, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert (tmp_path / "out" / "report.html").is_file()
