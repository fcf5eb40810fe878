"""The viewer's side: a window with the loops of a device and its sliders."""

from __future__ import annotations

import mujoco
import numpy as np
from mujoco.studio import messages, plugin
from mujoco.studio.dear_imgui import dear_imgui as imgui
from mujoco.studio.implot import implot

from inerter.view.control import PanelSnapshot, SetLaw, SetParameter, SetShake, Watch
from inerter.view.loop import Array
from inerter.view.shake import Shake

POINTS = 600  # of a curve: more cannot be seen, and all of them go to the browser
WIDTH, HEIGHT = 400, 760


class DevicePanel(plugin.ViewerPlugin):
    """Draws what `DeviceControl` sends, sends back what the user changes."""

    def __init__(self) -> None:
        self.shown: PanelSnapshot | None = None
        self.dragged: dict[str, float] = {}
        self.frozen: tuple[str, Array, Array] | None = None
        self.scene: mujoco.MjvScene | None = None

    @messages.handler
    def on_snapshot(self, snapshot: PanelSnapshot) -> None:
        """Keep the latest."""
        self.shown = snapshot

    @messages.handler
    def on_post_model(self, event: messages.PostModelEvent) -> None:
        """A scene of the new model."""
        self.scene = mujoco.MjvScene(event.model, maxgeom=2000)

    @messages.handler
    def on_update(self, _: messages.UpdateEvent) -> None:
        """Draw the devices: the viewer's own scene is made where there is no plugin to do it."""
        viewer = self.viewer
        viewer.extra_geoms.clear()
        if self.scene is None or viewer.model.nplugin == 0:
            return
        option, camera, nothing = mujoco.MjvOption(), mujoco.MjvCamera(), mujoco.MjvPerturb()
        decor = int(mujoco.mjtCatBit.mjCAT_DECOR)
        mujoco.mjv_updateScene(
            viewer.model, viewer.data, option, nothing, camera, decor, self.scene
        )
        kind = int(mujoco.mjtObj.mjOBJ_ACTUATOR)
        geoms = (self.scene.geoms[i] for i in range(self.scene.ngeom))
        viewer.extra_geoms.extend(copied(geom) for geom in geoms if geom.objtype == kind)

    @messages.handler
    def on_build_gui(self, _: messages.BuildGuiEvent) -> None:
        """Submit the window."""
        if self.shown is None:
            return
        imgui.SetNextWindowPos(imgui.Vec2(225, 30), int(imgui.Cond.FirstUseEver))
        imgui.SetNextWindowSize(imgui.Vec2(WIDTH, HEIGHT), int(imgui.Cond.FirstUseEver))
        if imgui.Begin("Inerter device"):
            self._choice(self.shown)
            self._loops(self.shown)
            self._shake(self.shown)
            self._sliders(self.shown)
        imgui.End()

    def _choice(self, shown: PanelSnapshot) -> None:
        changed, index = imgui.Combo("device", shown.devices.index(shown.device), shown.devices)
        if changed:
            self.frozen = None
            self.viewer.send_to_sim(Watch(shown.devices[index], shown.seconds))
        changed, index = imgui.Combo("friction", shown.laws.index(shown.law), shown.laws)
        if changed:
            self.viewer.send_to_sim(SetLaw(shown.device, shown.laws[index]))
        changed, seconds = imgui.SliderFloat("shown [s]", shown.seconds, 0.2, 10.0, "%.1f")
        if changed:
            self.viewer.send_to_sim(Watch(shown.device, seconds))
        if shown.refusal:
            imgui.TextWrapped(shown.refusal)

    def _loops(self, shown: PanelSnapshot) -> None:
        x, v, force = thinned(shown.loop)
        axes = shown.axes
        if imgui.Button("keep this loop to compare"):
            self.frozen = (shown.device, x, np.vstack([v, force]))
        for name, axis, across, kept in (
            (f"{axes.force} over displacement", f"x [{axes.length}]", axes.per_length * x, 0),
            (f"{axes.force} over velocity", f"v [{axes.speed}]", v, 1),
        ):
            implot.SetNextAxesToFit()
            if implot.BeginPlot(name, imgui.Vec2(-1, 190)):
                implot.SetupAxes(axis, f"F [{axes.newton}]")
                if self.frozen and self.frozen[0] == shown.device:
                    before = axes.per_length * self.frozen[1] if kept == 0 else self.frozen[2][0]
                    implot.PlotLine("kept", before, self.frozen[2][1])
                implot.PlotLine("now", across, force)
                implot.EndPlot()

    def _shake(self, shown: PanelSnapshot) -> None:
        shake = shown.shake
        if shake is None or not imgui.CollapsingHeader("shake"):
            return
        changed = [False] * 3
        changed[0], index = imgui.Combo(
            "control", shown.controls.index(shake.control), shown.controls
        )
        changed[1], amplitude = imgui.InputDouble("amplitude", shake.amplitude, 0.0, 0.0, "%.6g")
        changed[2], frequency = imgui.SliderFloat("frequency [Hz]", shake.frequency, 0.0, 10.0)
        if any(changed):
            self.viewer.send_to_sim(SetShake(Shake(shown.controls[index], amplitude, frequency)))

    def _sliders(self, shown: PanelSnapshot) -> None:
        if not imgui.CollapsingHeader("parameters", int(imgui.TreeNodeFlags.DefaultOpen)):
            return
        for each in shown.sliders:
            name = f"{each.key} [{each.unit}]"
            value = self.dragged.get(each.key, each.value)
            changed, value = imgui.SliderFloat(name, value, each.low, each.high, "%.4g")
            if imgui.IsItemHovered():
                imgui.SetItemTooltip(each.meaning)
            if changed:
                # until the run has it, so that the knob stays under the pointer
                self.dragged[each.key] = value
                self.viewer.send_to_sim(SetParameter(shown.device, each.key, value))
            elif not imgui.IsItemActive():
                self.dragged.pop(each.key, None)


def thinned(loop: Array, points: int = POINTS) -> tuple[Array, Array, Array]:
    """Displacement, velocity and force of at most so many samples, the newest among them."""
    step = max(1, -(-loop.shape[1] // points))
    last = loop[:, ::-1][:, ::step][:, ::-1]
    return last[1].copy(), last[2].copy(), last[3].copy()


def copied(geom: mujoco.MjvGeom) -> mujoco.MjvGeom:
    """A geom of a scene that outlives it."""
    new = mujoco.MjvGeom()
    mujoco.mjv_initGeom(
        new, geom.type, np.array(geom.size, float), np.array(geom.pos, float),
        np.array(geom.mat, float).ravel(), np.array(geom.rgba, np.float32),
    )  # fmt: skip
    new.size[:] = geom.size  # as it is drawn, not as a model states it
    return new
