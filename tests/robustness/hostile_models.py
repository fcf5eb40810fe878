"""Models built to cost time or memory, to end the process, or to say nothing.

    python hostile_models.py FOLDER [NAME ...]

makes each and tells what `inerter simulate` says of it, and what that costs.
"""

from __future__ import annotations

import os
import struct
import sys
import zlib
from collections.abc import Callable
from pathlib import Path

from hostile_files import cost

BODY = (
    '<body name="b"><joint name="a" type="slide" axis="0 0 1"/><geom size="0.1" mass="1"/>{}</body>'
)
DEVICE = """<actuator><plugin name="strut" plugin="inerter.device" joint="a">
<config key="inertance" value="{}"/></plugin></actuator>"""


def _model(
    top: str = "", inside: str = "", body: str = BODY, device: str = DEVICE.format(2)
) -> str:
    return f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>{top}
<worldbody>{body.format(inside)}</worldbody>{device}</mujoco>"""


def _itself(path: Path) -> str:
    return _model(f'<include file="{path.name}"/>')


def _deep_includes(path: Path) -> str:
    for number in range(300):
        within = f'<include file="part_{number + 1}.xml"/>' if number < 299 else ""
        (path.parent / f"part_{number}.xml").write_text(f"<mujocoinclude>{within}</mujocoinclude>")
    return _model('<include file="part_0.xml"/>')


def _mesh(path: Path) -> str:
    """Four thousand million triangles are stated, one is there."""
    (path.parent / "mesh.stl").write_bytes(bytes(80) + struct.pack("<I", 2**32 - 1) + bytes(50))
    return _model('<asset><mesh name="m" file="mesh.stl"/></asset>')


def _picture(path: Path) -> str:
    """A PNG that states 60000 x 60000 points."""
    head = struct.pack(">IIBBBBB", 60000, 60000, 8, 2, 0, 0, 0)

    def chunk(kind: bytes, data: bytes) -> bytes:
        check = zlib.crc32(kind + data)
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", check)

    (path.parent / "sky.png").write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head)
        + chunk(b"IDAT", zlib.compress(bytes(10**6))) + chunk(b"IEND", b"")
    )  # fmt: skip
    return _model('<asset><texture name="t" type="2d" file="sky.png"/></asset>')


def _pipe(path: Path) -> str:
    """A pipe that nobody writes into: whoever reads it waits."""
    os.mkfifo(path.parent / "mesh.stl")
    return _model('<asset><mesh name="m" file="mesh.stl"/></asset>')


def _asset(text: str) -> Callable[[Path], str]:
    return lambda _: _model(f"<asset>{text}</asset>")


def _top(text: str) -> Callable[[Path], str]:
    return lambda _: _model(text)


def _inside(text: str) -> Callable[[Path], str]:
    return lambda _: _model(inside=text)


MODELS: dict[str, Callable[[Path], str]] = {
    "timestep_tiny": _top('<option timestep="1e-300"/>'),
    "timestep_small": _top('<option timestep="1e-12"/>'),
    "timestep_zero": _top('<option timestep="0"/>'),
    "timestep_negative": _top('<option timestep="-1"/>'),
    "timestep_nan": _top('<option timestep="nan"/>'),
    "timestep_huge": _top('<option timestep="1e300"/>'),
    "gravity_huge": _top('<option gravity="0 0 1e308"/>'),
    "gravity_nan": _top('<option gravity="0 0 nan"/>'),
    "mass_huge": lambda _: _model(body=BODY.replace('"1"', '"1e308"')),
    "mass_tiny": lambda _: _model(body=BODY.replace('"1"', '"1e-308"')),
    "mass_nan": lambda _: _model(body=BODY.replace('"1"', '"nan"')),
    "size_huge": lambda _: _model(body=BODY.replace('size="0.1"', 'size="1e308"')),
    "position_nan": _inside('<site pos="nan 0 0"/>'),
    "inertance_huge": lambda _: _model(device=DEVICE.format("1e308")),
    "inertance_nan": lambda _: _model(device=DEVICE.format("nan")),
    "memory_stated": _top('<size memory="900T"/>'),
    "users_stated": _top('<size nuser_body="2000000000"/>'),
    "includes_itself": _itself,
    "includes_deep": _deep_includes,
    "includes_endless": _top('<include file="/dev/zero"/>'),
    "includes_folder": _top('<include file="/tmp"/>'),
    "mesh_stated": _mesh,
    "mesh_endless": _asset('<mesh name="m" file="/dev/zero" content_type="model/stl"/>'),
    "texture_stated": _asset(
        '<texture name="t" type="2d" builtin="flat" width="1000000" height="1000000"/>'
    ),
    "texture_picture": _picture,
    "field_stated": _asset('<hfield name="h" nrow="100000" ncol="100000" size="1 1 1 1"/>'),
    "names_pipe": _pipe,
    "replicated": _inside('<replicate count="2000000000" offset="0 0 1"><site/></replicate>'),
    "replicated_twice": _inside(
        '<replicate count="9999"><replicate count="9999"><site/></replicate></replicate>'
    ),
    "flexible": _inside(
        '<flexcomp name="f" type="grid" count="9999 9999 99" spacing="1 1 1" mass="1" radius="1"/>'
    ),
    "sphere_fine": _asset('<mesh name="m" builtin="sphere" params="40"/>'),
    "numeric_stated": _top('<custom><numeric name="n" size="2000000000"/></custom>'),
    "nested": _inside("<body>" * 20_000 + "</body>" * 20_000),
    "entities": lambda _: (
        '<!DOCTYPE m [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]>' + _model("&b;")
    ),
    "not_xml": lambda _: "\0" * 1000,
    "empty": lambda _: "",
}


def made(name: str, folder: Path) -> Path:
    """Make one, in a folder of its own."""
    path = folder / name / "model.xml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(MODELS[name](path))
    return path


def arguments(path: Path) -> list[str]:
    """Of `inerter`: a short run."""
    return ["simulate", str(path), "--duration", "0.01", "--out", str(path.parent / "out")]


def main(folder: Path, *names: str) -> None:
    """Tell what each says and costs."""
    for name in names or MODELS:
        found = cost(arguments(made(name, folder)), limit=2 << 30, patience=30)
        print(
            f"{name:18} status {found.status}  {found.seconds:4.1f} s  {found.memory / 1e6:5.0f} MB"
            f"  {found.said.strip()[:300]}",
            flush=True,
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:])
