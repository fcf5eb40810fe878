"""A studio viewer in a browser, for models with devices.

Why the browser: the wheel's own window (MuJoCo 4.0.0) does not start: on Python 3.11 it cannot be
imported, and later ones end with "Target not found". The browser's needs no graphics on this side.
The browser runs MuJoCo of its own, without the plugin. It gets the model of `Session.shown`, and
the devices' pictures are sent beside it.
"""

from __future__ import annotations

import threading
import webbrowser
from typing import Any

from mujoco.studio import (
    app,
    endpoints,
    launch_thread,
    messages,
    viewer_handle,
    viewer_protocol,
    web_viewer,
)
from mujoco.studio.web import (
    state_payload,  # pyright: ignore[reportAttributeAccessIssue]  (compiled)
)

from inerter.view.control import DeviceControl
from inerter.view.guard import Guard, put_before
from inerter.view.panel import DevicePanel
from inerter.view.session import Session
from inerter.view.shake import Shake


def run(session: Session, device: str, shake: Shake | None, port: int, open_page: bool) -> None:
    """Serve a session to the user's browser until Ctrl-C.

    Raises
    ------
    OSError
        The port is taken.
    """
    guard = Guard()
    put_before(guard)
    config = viewer_protocol.ViewerConfig(title=session.path.stem, http_port=port, gfx="web")
    panels = [app.App(app.Config(show_inspector=False)), DevicePanel()]

    def serve(endpoint: endpoints.ViewerEndpoint) -> None:
        viewer = _LocalViewer(session, config, endpoint, panels)
        print(f"The page: {guard.address(port)}\n(Ctrl-C ends)", flush=True)
        if open_page:
            once = guard.address(port, once=True)
            threading.Thread(target=webbrowser.open, args=(once, 2), daemon=True).start()
        viewer_protocol.run_viewer_loop(viewer)

    control = DeviceControl(session, device, shake)
    with launch_thread.launch_thread(serve, sim_plugins=[*app.SIM_PLUGINS, control]) as handle:
        handle.dispatch(messages.LoadModelEvent(path=str(session.path)))
        viewer_handle.run_sim_loop(handle)


class _LocalViewer(web_viewer.WebViewer):
    """Reachable from this machine only, and by whom its guard lets in."""

    def __init__(
        self,
        session: Session,
        config: viewer_protocol.ViewerConfig,
        endpoint: endpoints.ViewerEndpoint,
        plugins: list[Any],
    ) -> None:
        self.session = session  # the server begins in there, and asks for the model
        super().__init__(config, endpoint, plugins=plugins)

    @property
    def _host(self) -> str:
        return "127.0.0.1"

    @_host.setter
    def _host(self, value: str) -> None:
        del value  # the wheel's viewer listens everywhere

    def _start_server(self) -> None:
        # heard before the address is told
        self._http_sock.listen()
        super()._start_server()

    def get_drop_file(self) -> str:
        """No model is taken from a page."""
        return ""

    def _serialize_model(self) -> bytes:
        empty = self.model.nbody == 1
        return state_payload.serialize_model_bundle(self.model if empty else self.session.shown)
