"""The effects of a vehicle that a diagnosis can name, beside those of the device."""

from __future__ import annotations

from inerter.diagnose.effects import EFFECTS, Effect

VEHICLE_EFFECTS = {
    effect.name: effect
    for effect in (
        Effect(
            "tyre_damping",
            (),
            ("tyre_damping",),
            "damping of the tyre",
            "c_t (road rate - wheel velocity), beside the tyre's stiffness",
            "hysteresis of rubber and carcass",
            "friction of the suspension",
            "lock the suspension and drive the wheel alone",
        ),
        Effect(
            "tyre_liftoff",
            (),
            ("tyre_static_load",),
            "a tyre that leaves the road",
            "the tyre cannot pull: its force ends at the static load",
            "a wheel without contact",
            "a softer tyre",
            "repeat at half the amplitude, where the wheel stays on the road",
        ),
        Effect(
            "tyre_stiffness_error",
            (),
            ("tyre_stiffness",),
            "a tyre stiffness other than stated",
            "k_t differs from what the model states",
            "another pressure, load or tyre",
            "wheel mass",
            "weigh the wheel, or load the tyre statically",
            ("wheel_mass_error",),
        ),
        Effect(
            "damper_asymmetry",
            (),
            ("rebound_damping", "bump_damping"),
            "a damper that differs between rebound and bump",
            "c_r v in rebound, c_b v in bump",
            "valves with different openings in the two directions",
            "a constant force",
            "measure the damper alone, at several speeds",
            ("force_offset",),
        ),
        Effect(
            "spring_hardening",
            (),
            ("stiffness_cubic",),
            "a suspension spring that grows stiffer with its travel",
            "k3 x^3",
            "progressive winding, bump rubbers, air springs",
            "hardening of the device itself",
            "the same force between the same bodies, test the device alone",
        ),
        Effect(
            "body_mass_error",
            (),
            ("body_mass",),
            "a body mass other than stated",
            "the sprung mass differs from what the model states",
            "payload, fuel, equipment that the model leaves out",
            "suspension stiffness",
            "weigh the vehicle",
        ),
        Effect(
            "wheel_mass_error",
            (),
            ("wheel_mass",),
            "a wheel mass other than stated",
            "the unsprung mass differs from what the model states",
            "brake, hub and links that the model leaves out",
            "tyre stiffness",
            "weigh the wheel",
            ("tyre_stiffness_error",),
        ),
    )
}
KNOWN = {**EFFECTS, **VEHICLE_EFFECTS}
