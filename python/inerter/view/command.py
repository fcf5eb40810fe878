"""`inerter view`."""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from inerter.console import number, out, refuse

if TYPE_CHECKING:
    from inerter.view.session import Session
    from inerter.view.shake import Shake


def view_command(
    model: Annotated[
        Path,
        typer.Argument(
            help="A MuJoCo model file (MJCF) with a device, or the name of a shipped one, see "
            "`inerter models`."
        ),
    ],
    device: Annotated[
        str | None, typer.Option(help="Name of the device to begin with; default: the first.")
    ] = None,
    keyframe: Annotated[
        str | None, typer.Option(help="Name or index of the keyframe to start from.")
    ] = None,
    shake: Annotated[
        str | None,
        typer.Option(help="A sine on a control, as in road=0.01@1.5 (amplitude@Hz)."),
    ] = None,
    port: Annotated[int, typer.Option(min=1, max=65535, help="Port of the page.")] = 8080,
    picture: Annotated[
        Path | None,
        typer.Option(help="Write the scene and the loops to this .png instead; needs no display."),
    ] = None,
    duration: Annotated[float, number("seconds", "With --picture: seconds to run.", 1e-3)] = 5.0,
    shown: Annotated[
        float, number("seconds", "With --picture: last seconds of it in the loops.", 1e-3)
    ] = 2.0,
) -> None:
    """Show a model and the loops of a device as they arise, with sliders for its parameters.

    The page is in your browser. Its address has a token, without which no other page or user of
    this machine gets in. Ctrl-C ends, and prints what was changed.

    \b
    Examples:
      inerter view half_car
      inerter view car.xml --shake road=0.01@1.5 --picture view.png
    """
    from inerter.engine_errors import SimulationError
    from inerter.folder import refuse_file
    from inerter.models import model_file
    from inerter.view.picture import write_picture
    from inerter.view.session import Session
    from inerter.view.shake import read_shake, usual_shake

    try:
        session = Session(model_file(model), keyframe)
        if device is not None and device not in session.devices:
            listed = ", ".join(session.devices)
            raise SimulationError(f"--device {device!r}: the model's devices are {listed}")
        shaken = usual_shake(session.model) if shake is None else read_shake(shake, session.model)
        first = device or next(iter(session.devices))
        if picture is not None:
            refuse_file(picture)
        else:
            _serve(session, first, shaken, port)
            return
        notes = write_picture(session, first, shaken, picture, duration, shown)
    except ValueError as error:
        refuse(str(error))
    except OSError as error:
        refuse(f"{error.filename or picture}: cannot be written ({error.strerror})")
    for note in notes:
        out.print(note)
    out.print(f"Written: {picture}")


def _serve(session: Session, device: str, shake: Shake | None, port: int) -> None:
    from inerter.engine_errors import SimulationError

    try:
        from inerter.view.browser import run
    except ImportError as error:
        raise SimulationError(
            f"mujoco.studio cannot be loaded ({error}); reinstall mujoco, or write a picture: "
            "--picture view.png"
        ) from None
    if _taken(port):
        raise SimulationError(f"--port {port} is taken; choose another")
    display = has_display()
    if not display:
        out.print(
            f"No display here. From the machine you sit at: ssh -L {port}:localhost:{port} "
            f"{socket.gethostname()}, then open the address below in a browser there; or write a "
            "picture: --picture view.png"
        )
    run(session, device, shake, port, open_page=display)
    for name, values in session.changes().items():
        out.print(f"\nchanged of {name}:")
        for key, value in values.items():
            text = value if isinstance(value, str) else f"{value:.6g}"
            print(f'  <config key="{key}" value="{text}"/>')


def has_display() -> bool:
    """Whether a browser can be opened here."""
    if sys.platform != "linux":
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def _taken(port: int) -> bool:
    with socket.socket() as trial:
        trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            trial.bind(("127.0.0.1", port))
        except OSError:
            return True
    return False
