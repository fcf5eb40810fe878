"""The simulation's side of the panel: shakes, records loops, changes devices."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import mujoco
from mujoco.studio import (
    messages,
    plugin,
    sim,  # pyright: ignore[reportAttributeAccessIssue]  (compiled)
)

from inerter.core import DeviceError, friction_laws
from inerter.view.loop import Array, Axes, Loop, instant
from inerter.view.session import Session
from inerter.view.shake import Shake, controls_of, usual_shake
from inerter.view.sliders import Slider

FRAME = 1 / 30  # seconds of the clock between two pictures
BUDGET = 1 / 60  # seconds of the clock that steps may take before the viewer is heard again


@dataclass(frozen=True)
class SetParameter(messages.Event):
    """A slider was moved."""

    device: str
    key: str
    value: float


@dataclass(frozen=True)
class SetLaw(messages.Event):
    """Another friction law was chosen."""

    device: str
    law: str


@dataclass(frozen=True)
class SetShake(messages.Event):
    """The shaking was changed."""

    shake: Shake


@dataclass(frozen=True)
class Watch(messages.Event):
    """Another device or another length of time is to be shown."""

    device: str
    seconds: float


@dataclass(frozen=True, eq=False)
class PanelSnapshot(messages.Snapshot):
    """Everything that the panel shows.

    loop: time, displacement, velocity, force of the last seconds, (4, n); axes: their units.
    refusal: why the last change could not be, or empty.
    """

    device: str
    devices: list[str]
    law: str
    laws: list[str]
    sliders: list[Slider]
    loop: Array
    axes: Axes
    seconds: float
    shake: Shake | None
    controls: list[str]
    refusal: str = ""


@dataclass(eq=False)
class DeviceControl(plugin.SimPlugin):
    """Runs a session inside a studio viewer."""

    session: Session
    device: str
    shake: Shake | None = None
    seconds: float = 2.0
    loop: Loop = field(default_factory=Loop)
    refusal: str = ""
    sent: float = 0.0
    # a slider that is dragged asks more often than the picture is made
    waiting: dict[tuple[str, str], float] = field(default_factory=dict)
    paused: bool = False
    speed: float = 1.0
    # an instant of the clock and of the run that belong together
    pace: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        self.shake = self.shake or usual_shake(self.session.model)

    @messages.handler
    def on_load(self, event: messages.LoadModelEvent) -> bool:
        """Show the session's model, whatever file was asked for."""
        self.session.restart()
        self._publish()
        return True

    @messages.handler
    def on_post_model(self, event: messages.PostModelEvent) -> None:
        """Begin the loop anew with a model."""
        self.loop.clear()

    @messages.handler
    def on_parameter(self, event: SetParameter) -> None:
        """Keep the latest value of a slider for the next step."""
        self.waiting[event.device, event.key] = event.value

    @messages.handler
    def on_law(self, event: SetLaw) -> None:
        """Compile with another law; the run goes on."""
        self.session.data = self.handle.data
        with self._telling():
            self.session.set_law(event.device, event.law)
            self._publish()

    @messages.handler
    def on_shake(self, event: SetShake) -> None:
        """Let go of the control that was shaken, take the next."""
        if self.shake and self.handle.data is not None:
            Shake(self.shake.control, 0.0, 0.0).apply(self.handle.model, self.handle.data)
        self.shake = event.shake

    @messages.handler
    def on_watch(self, event: Watch) -> None:
        """Show another device, or a longer time."""
        if event.device != self.device:
            self.device = event.device
            self.loop.clear()
        self.seconds = event.seconds

    @messages.handler
    def on_step_control(self, event: messages.StepControlSnapshot) -> None:
        """Follow the viewer's pause and speed."""
        self.paused = event.pause_state != sim.PauseState.UNPAUSED
        self.speed = event.speed / 100
        self.pace = None

    @messages.handler
    def on_pause(self, event: messages.RequestPauseEvent) -> None:
        """Follow a pause that was asked for on this side."""
        self.paused = event.pause_state != sim.PauseState.UNPAUSED
        self.pace = None

    @messages.handler
    def on_pre_step(self, event: messages.PreStepEvent) -> None:
        """Take over what the sliders say."""
        for (device, key), value in self.waiting.items():
            with self._telling():
                self.session.set(device, key, value)
        self.waiting.clear()

    @messages.handler
    def on_step(self, event: messages.StepEvent) -> bool:
        """Step as the clock goes, shaking and recording at every step; the viewer's own does not.

        A paused run is left to the viewer's stepper, which knows single steps.
        """
        if self.paused:
            return False
        now = time.monotonic()
        if self.pace is None or event.data.time < self.pace[1]:
            self.pace = now, event.data.time
        target = self.pace[1] + self.speed * (now - self.pace[0])
        while event.data.time < target and time.monotonic() < now + BUDGET:
            self.step(event.model, event.data)
        if event.data.time < target - BUDGET:
            self.pace = None  # too slow a machine: go on from here
        time.sleep(1e-3)
        return True

    @messages.handler
    def on_post_step(self, _: messages.PostStepEvent) -> None:
        """Tell the panel, now and then."""
        now = time.monotonic()
        if now - self.sent >= FRAME:
            self.sent = now
            self.handle.send_to_viewer(self.snapshot())

    def step(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """One step, shaken and recorded."""
        if self.shake:
            self.shake.apply(model, data)
        mujoco.mj_step(model, data)
        self.loop.append(*instant(self.session.devices[self.device], model, data))

    def snapshot(self) -> PanelSnapshot:
        """What the panel is to show now."""
        return PanelSnapshot(
            device=self.device,
            devices=list(self.session.devices),
            law=self.session.device(self.device).friction,
            laws=list(friction_laws()),
            sliders=self.session.sliders(self.device),
            loop=self.loop.last(self.seconds),
            axes=Axes.of(self.session.motion(self.device)),
            seconds=self.seconds,
            shake=self.shake,
            controls=controls_of(self.session.model),
            refusal=self.refusal,
        )

    @contextmanager
    def _telling(self) -> Iterator[None]:
        """What cannot be is told in the panel; the run goes on."""
        self.refusal = ""
        try:
            yield
        except DeviceError as error:
            self.refusal = str(error)

    def _publish(self) -> None:
        session = self.session
        self.handle.set_model(session.model, path=str(session.path), data=session.data)
