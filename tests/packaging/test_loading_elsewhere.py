"""Libraries built for another MuJoCo, installations that cannot be written to, programs in C."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path

import inerter
import inerter.core_library
import mujoco
import pytest
from falling_model import MODEL

ROOT = Path(__file__).resolve().parents[2]
VERSION = mujoco.mj_versionString()
LINUX = pytest.mark.skipif(sys.platform != "linux", reason="builds shared libraries as on Linux")

# the plugin from another folder, as a process finds it that knows nothing of this test
IMPORT = f"""
import pathlib, sys
import inerter.core_library
inerter.core_library.LIBRARY_FOLDER = pathlib.Path(sys.argv[1])
import mujoco
try:
    inerter.load_plugin()
except ImportError as error:
    print("ImportError:", error)
try:
    mujoco.MjModel.from_xml_string('''{MODEL}''')
    print("simulates")
except ValueError as error:
    print("ValueError:", error)
"""

# a program in C: load the plugin from a file or a folder, as `simulate` does, and let 3 kg fall
PROGRAM = """
#include <mujoco/mujoco.h>
#include <stdio.h>
#include <string.h>

static void warn(const char* text) {
  printf("warning: %s\\n", text);
}

int main(int argc, char** argv) {
  char error[1000] = "";
  mju_user_warning = warn;
  if (strstr(argv[1], ".so")) {
    mj_loadPluginLibrary(argv[1]);
  } else {
    mj_loadAllPluginLibraries(argv[1], NULL);
  }
  mjModel* m = mj_loadXML(argv[2], NULL, error, sizeof(error));
  if (!m) {
    printf("%s\\n", error);
    return argc - 2;
  }
  mjData* d = mj_makeData(m);
  for (int i = 0; i < 100; i++) mj_step(m, d);
  printf("falls with %.6f m/s\\n", d->qvel[0]);
  mj_deleteData(d);
  mj_deleteModel(m);
  return 0;
}
"""


def run(*command: str | Path, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        list(map(str, command)), capture_output=True, text=True, check=False, timeout=300,
        **options,  # type: ignore[arg-type]
    )  # fmt: skip


def compile_c(*arguments: str | Path) -> None:
    command = shlex.split(os.environ.get("CC") or "cc")
    if not shutil.which(command[0]):
        pytest.skip("needs a C compiler (cc, or the one that CC names)")
    done = run(*command, "-std=gnu17", *arguments)
    assert done.returncode == 0, done.stderr


def mujoco_folder() -> Path:
    found = find_spec("mujoco")
    assert found is not None
    assert found.submodule_search_locations is not None
    return Path(found.submodule_search_locations[0])


def engine() -> Path:
    (library,) = mujoco_folder().glob("libmujoco.so.*")
    return library


def library_in(folder: Path) -> Path:
    """Where the package looks for the plugin, `folder` being its lib; the folder is made."""
    place = folder / VERSION / "libinerter_mujoco.so"
    place.parent.mkdir(exist_ok=True)
    return place


def imported(folder: Path) -> tuple[str, str]:
    """What a fresh process prints, and what it warns of, with the libraries of a folder."""
    done = run(sys.executable, "-c", IMPORT, folder, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout, done.stderr


@pytest.fixture(scope="module")
def for_another(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a plugin that was compiled with the headers of MuJoCo 4.1.0."""
    folder = tmp_path_factory.mktemp("for_another")
    shutil.copytree(mujoco_folder() / "include", folder / "include")
    header = folder / "include" / "mujoco" / "mujoco.h"
    text = header.read_text(encoding="utf-8")
    number = mujoco.mj_version()
    assert f"#define mjVERSION_HEADER {number}" in text
    header.write_text(text.replace(f"HEADER {number}", "HEADER 4001000"), encoding="utf-8")
    sources = [*ROOT.glob("plugin_c/core/*.c"), *ROOT.glob("plugin_c/mujoco/*.c")]
    compile_c(
        "-shared", "-fPIC", f"-I{ROOT / 'plugin_c'}", f"-isystem{folder / 'include'}", *sources,
        engine(), f"-Wl,-rpath,{mujoco_folder()}", "-lm", "-o", library_in(folder),
    )  # fmt: skip
    return folder


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """The program in C, its model beside it, linked with a libmujoco that lies elsewhere."""
    shutil.copy(engine(), tmp_path)
    (tmp_path / "program.c").write_text(PROGRAM)
    (tmp_path / "model.xml").write_text(MODEL)
    compile_c(
        f"-isystem{mujoco_folder() / 'include'}", tmp_path / "program.c", tmp_path / engine().name,
        f"-Wl,-rpath,{tmp_path}", "-lm", "-o", tmp_path / "program",
    )  # fmt: skip
    return tmp_path / "program"


# ------------------------------ another MuJoCo ------------------------------


@LINUX
def test_a_library_compiled_for_another_mujoco(for_another: Path) -> None:
    printed, warned = imported(for_another)
    assert "simulates" not in printed
    assert "plugin inerter.device not found" in printed
    for text in (printed, warned):
        assert "compiled for MuJoCo 4.1.0" in text
        assert f"MuJoCo {VERSION}" in text
        assert "pip install" in text
    # said at `import mujoco`, too
    assert "Failed to load mujoco plugin entry point inerter" in warned


@LINUX
def test_a_library_that_needs_the_engine_of_another_mujoco(tmp_path: Path) -> None:
    (tmp_path / "empty.c").write_text("int nothing_of_mujoco(void) { return 0; }\n")
    (tmp_path / "plugin.c").write_text(
        "int nothing_of_mujoco(void); int use(void) { return nothing_of_mujoco(); }\n"
    )
    other = tmp_path / "gone" / "libmujoco.so.4.1.0"
    other.parent.mkdir()
    flags = ("-shared", "-fPIC")
    compile_c(*flags, f"-Wl,-soname,{other.name}", tmp_path / "empty.c", "-o", other)
    compile_c(*flags, tmp_path / "plugin.c", other, "-o", library_in(tmp_path))
    shutil.rmtree(other.parent)
    printed, warned = imported(tmp_path)
    for text in (printed, warned):
        assert "libmujoco.so.4.1.0" in text
        assert f"not compiled for MuJoCo {VERSION}" in text
        assert "pip install --force-reinstall" in text


@LINUX
def test_what_is_no_library_of_ours(tmp_path: Path) -> None:
    library = library_in(tmp_path)
    library.write_text("half a download")
    assert "pip install --force-reinstall" in imported(tmp_path)[0]
    (tmp_path / "empty.c").write_text("int nothing(void) { return 0; }\n")
    compile_c("-shared", "-fPIC", tmp_path / "empty.c", "-o", library)
    assert "pip install --force-reinstall" in imported(tmp_path)[0]


# ------------------------------ where and how it is installed ------------------------------


@LINUX
def test_an_installation_that_cannot_be_written_to() -> None:
    source = Path(inerter.__file__).parent
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        package = folder / "inerter"
        shutil.copytree(source, package, ignore=shutil.ignore_patterns("__pycache__"))
        # an installation in place has its libraries elsewhere
        shutil.copytree(inerter.core_library.LIBRARY_FOLDER, package / "lib", dirs_exist_ok=True)
        for path in (folder, *folder.rglob("*")):
            path.chmod(0o555 if path.is_dir() else 0o444)

        # root may write anywhere, but for what it gives up
        python = [sys.executable]
        if os.getuid() == 0:
            if shutil.which("setpriv") is None:
                pytest.skip("root may write anywhere, and there is no setpriv to change that")
            python = ["setpriv", "--bounding-set=-dac_override", *python]
        # an installation in place, as developers may have it, would be found before it
        script = (
            "import pathlib, sys\n"
            "sys.meta_path[:] = [each for each in sys.meta_path if 'ditable' not in repr(each)]\n"
            "import inerter, mujoco\n"
            "here = pathlib.Path(inerter.__file__).parent\n"
            f"assert here == pathlib.Path({str(package)!r}), here\n"
            "try:\n    (here / 'written').touch()\nexcept OSError:\n    print('cannot write')\n"
            f"model = mujoco.MjModel.from_xml_string('''{MODEL}''')\n"
            "mujoco.mj_step(model, mujoco.MjData(model), 10)\n"
            "print(inerter.Device(inertance=2.0).inertance)\n"
        )
        environment = {"PYTHONPATH": name, "PATH": os.environ["PATH"]}
        done = run(*python, "-W", "error", "-c", script, cwd="/", env=environment)
        folder.chmod(0o755)
        for path in folder.rglob("*"):
            path.chmod(0o755)
    assert done.stdout.split("\n") == ["cannot write", "2.0", ""], done.stderr
    assert done.stderr == ""


def test_sources_without_a_compiler(tmp_path: Path) -> None:
    cmake = shutil.which("cmake")
    if cmake is None:
        pytest.skip("no cmake on this machine")
    tools = tmp_path / "tools"
    tools.mkdir()
    for tool in ("make", "uname"):
        if found := shutil.which(tool):
            (tools / tool).symlink_to(found)
    done = run(cmake, "-S", ROOT, "-B", tmp_path / "build", env={"PATH": str(tools)})
    assert done.returncode != 0
    for word in ("no C compiler", "apt install gcc", "install a wheel"):
        assert word in " ".join(done.stderr.split())


# ------------------------------ programs in C ------------------------------


@LINUX
@pytest.mark.parametrize("whole_folder", [False, True])
def test_a_program_in_c(program: Path, whole_folder: bool) -> None:
    path = inerter.plugin_path()
    done = run(program, path.parent if whole_folder else path, program.parent / "model.xml")
    # 1 kg and 2 kg of inertance
    assert done.stdout == f"falls with {-9.81 * 0.2 / 3:.6f} m/s\n"
    assert done.returncode == 0


@LINUX
def test_a_program_in_c_with_a_library_for_another_mujoco(program: Path, for_another: Path) -> None:
    model = program.parent / "model.xml"
    done = run(program, library_in(for_another), model)
    words = ("warning: ", "compiled for MuJoCo 4.1.0", f"loaded is MuJoCo {VERSION}", "not found")
    for word in words:
        assert word in done.stdout
    assert done.returncode == 1
