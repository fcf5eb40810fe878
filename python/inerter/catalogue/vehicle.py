"""The effects of a vehicle that a diagnosis can name, beside those of the device."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from inerter.catalogue.effect import Effect
from inerter.catalogue.effects import EFFECTS

_ALL = (
    Effect(
        name="tyre_damping", reported=("tyre_damping",), plain="damping of the tyre",
        meaning="c_t (road rate - wheel velocity), beside the tyre's stiffness",
        cause="hysteresis of rubber and carcass", taken_for="friction of the suspension",
        experiment="lock the suspension and drive the wheel alone",
    ),
    Effect(
        name="tyre_liftoff", reported=("tyre_static_load",), local=True,
        plain="a tyre that leaves the road",
        meaning="the tyre cannot pull: its force ends at the static load",
        cause="a wheel without contact", taken_for="a softer tyre",
        experiment="repeat at half the amplitude, where the wheel stays on the road",
    ),
    Effect(
        name="tyre_stiffness_error", reported=("tyre_stiffness",),
        plain="a tyre stiffness other than stated",
        meaning="k_t differs from what the model states", cause="another pressure, load or tyre",
        taken_for="wheel mass", experiment="weigh the wheel, or load the tyre statically",
        rivals=("wheel_mass_error",),
    ),
    Effect(
        name="damper_asymmetry", reported=("rebound_damping", "bump_damping"),
        plain="a damper that differs between rebound and bump",
        meaning="c_r v in rebound, c_b v in bump",
        cause="valves with different openings in the two directions", taken_for="a constant force",
        experiment="measure the damper alone, at several speeds", rivals=("force_offset",),
    ),
    Effect(
        name="spring_hardening", reported=("stiffness_cubic",),
        plain="a suspension spring that grows stiffer with its travel", meaning="k3 x^3",
        cause="progressive winding, bump rubbers, air springs",
        taken_for="hardening of the device itself",
        experiment="the same force between the same bodies, test the device alone",
    ),
    Effect(
        name="body_mass_error", reported=("body_mass",), plain="a body mass other than stated",
        meaning="the sprung mass differs from what the model states",
        cause="payload, fuel, equipment that the model leaves out",
        taken_for="suspension stiffness", experiment="weigh the vehicle",
    ),
    Effect(
        name="wheel_mass_error", reported=("wheel_mass",),
        plain="a wheel mass other than stated",
        meaning="the unsprung mass differs from what the model states",
        cause="brake, hub and links that the model leaves out", taken_for="tyre stiffness",
        experiment="weigh the wheel", rivals=("tyre_stiffness_error",),
    ),
    Effect(
        name="tyre_enveloping", reported=("patch_length", "patch_time"),
        plain="tyres that average the road over their length of contact",
        meaning="a tyre feels the mean of the road over a length, not a point of it",
        cause="a contact patch and a belt that bridge what is short; a profile measured finer than "
        "tyres feel",
        taken_for="a softer tyre, or a delay",
        experiment="drive at another speed, the length stays",
        rivals=("tyre_stiffness_error", "sensor_filter"),
    ),
    Effect(
        name="position_dependent_damping", reported=("damping_gradient",),
        plain="damping that changes along the stroke", meaning="c (1 + g x) v",
        cause="bypass grooves and zones of a damper, a lever whose ratio changes",
        taken_for="a damper that differs between rebound and bump",
        experiment="strokes of one speed about two places",
        rivals=("damper_asymmetry", "viscous_friction"),
    ),
    Effect(
        name="sensor_compliance", reported=("mount_frequency", "mount_loss"),
        plain="a sensor that swings on its mount",
        meaning="the channel shows its quantity behind a spring with a loss",
        cause="a soft bracket, tape, a panel of the frame between sensor and body",
        taken_for="a low-pass filter of the channel, where the loss is near 0.7",
        experiment="knock on the bracket and look at the channel alone",
        rivals=("sensor_filter", "sensor_delay"),
    ),
    Effect(
        name="mounting_angle", reported=("angle_toward_x", "angle_toward_y", "angle_toward_z"),
        plain="an accelerometer that is not mounted straight",
        meaning="a channel shows s cos(a) of its own axis and s sin(a) of another one",
        cause="a bracket or a panel that leans, a sensor turned in its holder",
        taken_for="a scale of the channel, or another centre of mass",
        experiment="turn the sensor by a known angle and record the same road once more",
        rivals=("sensor_compliance",),
    ),
    Effect(
        name="sensor_gain_error", reported=("gain",),
        plain="a wrong scale of a channel",
        meaning="a channel shows its quantity times a gain; the road's: what is recorded of it",
        cause="a calibration, the range of an amplifier, a sensor on a lever or at another place "
        "than the model says",
        taken_for="a mass, a stiffness and damping that are all off",
        experiment="check the channel alone: a length against a gauge, an accelerometer turned "
        "over in gravity",
        rivals=("mounting_angle", "tyre_stiffness_error"),
    ),
    Effect(
        name="joint_friction", reported=("joint_friction",),
        plain="dry friction of a joint of the vehicle",
        meaning="f sign(v) between a wheel or body and its guide",
        cause="guides, bushes and seals beside the device",
        taken_for="friction of the device",
        experiment="move the body by hand without spring and device",
        rivals=("coulomb_friction", "joint_damping"),
    ),
    Effect(
        name="joint_damping", reported=("joint_damping",),
        plain="damping of a joint of the vehicle",
        meaning="c v between a wheel or body and its guide",
        cause="grease and seals of guides, rubber bushes", taken_for="damping of the suspension",
        experiment="move the body by hand without spring and device",
        rivals=("viscous_friction", "joint_friction"),
    ),
    Effect(
        name="actuator_gain_error", reported=("actuator_gain",),
        plain="a driven force of another size than recorded",
        meaning="the force that acts is the recorded one times a gain",
        cause="a motor constant, a gear or a calibration other than stated; a command recorded in "
        "place of a force",
        taken_for="masses and stiffnesses that are all off alike",
        experiment="push against a load cell",
    ),
    Effect(
        name="actuator_lag", reported=("actuator_lag",),
        plain="a driven force that comes late",
        meaning="the force follows the recorded one through a first-order lag",
        cause="current loop, hydraulics, a command recorded in place of a force",
        taken_for="a delay of all other channels", experiment="a step against a load cell",
        rivals=("sensor_delay",),
    ),
)  # fmt: skip

VEHICLE_EFFECTS: Mapping[str, Effect] = MappingProxyType({effect.name: effect for effect in _ALL})
"""Every effect of a vehicle by its name."""
KNOWN: Mapping[str, Effect] = MappingProxyType({**EFFECTS, **VEHICLE_EFFECTS})
"""Every effect."""
