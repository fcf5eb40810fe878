"""The rack-and-pinion calculator against energy, torques shaft by shaft and virtual work."""

import math

import pytest
from inerter.design import DesignError, design_rack_pinion

STAGES = [
    {"ratio": 3.0, "inertia": 2e-5, "efficiency": 0.97, "stiffness": 500.0, "play": 1e-3},
    {"ratio": 2.5, "inertia": 1e-4, "efficiency": 0.99, "play": 2e-3},
]


def train(**changes: float | str):
    inputs: dict = {
        "pinion_radius": 0.012, "pinion_inertia": 3e-6, "rack_efficiency": 0.98,
        "pinion_stiffness": 800.0, "rack_play": 4e-5,
    }  # fmt: skip
    return design_rack_pinion(stages=STAGES, **(inputs | changes))


def test_one_stage_as_smith_prints_it() -> None:
    # b = m (gamma / r3)^2 (r2 / r1)^2
    m, gamma, r1, r2, r3 = 0.3, 0.02, 0.008, 0.05, 0.01
    stage = {"ratio": r2 / r3, "inertia": m * gamma**2}
    design = design_rack_pinion(stages=[stage], pinion_radius=r1)
    assert design.value("inertance") == pytest.approx(m * (gamma / r3) ** 2 * (r2 / r1) ** 2)


def test_energy() -> None:
    speed = 0.7
    pinion = speed / 0.012
    energy = 0.5 * (3e-6 * pinion**2 + 2e-5 * (3 * pinion) ** 2 + 1e-4 * (7.5 * pinion) ** 2)
    assert train().value("inertance") == pytest.approx(2 * energy / speed**2, rel=1e-12)


def test_driving_force_from_the_torques_of_each_shaft() -> None:
    # from the last shaft back to the rack, at 2 m/s^2
    alpha = 2.0 / 0.012
    last = 1e-4 * 7.5 * alpha / 0.99
    first = (2e-5 * 3 * alpha + 2.5 * last) / 0.97
    force = (3e-6 * alpha + 3 * first) / 0.98 / 0.012
    device = train(rack_play=0).device
    rigid = type(device)(**{k: device.given[k] for k in ("inertance", "load_friction")})
    assert rigid.evaluate(0.0, 1.0, 2.0, 0.0)["total"][0] == pytest.approx(force, rel=1e-12)


def test_play_and_stiffness_by_virtual_work() -> None:
    design = train()
    # half of: rack, first stage at 3 turns, second at 7.5
    gap = 0.5 * (4e-5 + 0.012 * 1e-3 / 3 + 0.012 * 2e-3 / 7.5)
    assert design.value("backlash") == pytest.approx(gap, rel=1e-12)
    # deflection at the rack per force: torque F r / n on each shaft, angle times r / n
    softness = 0.012**2 / 800 + (0.012 / 3) ** 2 / 500
    assert design.value("series_stiffness") == pytest.approx(1 / softness, rel=1e-12)
    b = design.value("inertance")
    expected = math.sqrt(1 / softness / b) / (2 * math.pi)
    assert design.value("antiresonance") == pytest.approx(expected)


def test_texts_and_mappings_are_the_same() -> None:
    text = ["ratio=3, inertia=20 kg*mm^2, play=0.2 deg, stiffness=500 N*m/rad"]
    mapping = [{"ratio": 3, "inertia": 2e-5, "play": math.radians(0.2), "stiffness": 500}]
    one, other = (design_rack_pinion(stages=s, pinion_radius="12 mm") for s in (text, mapping))
    assert one.device.given == pytest.approx(other.device.given)


def test_no_losses_no_friction() -> None:
    design = design_rack_pinion(pinion_radius=0.01, pinion_inertia=1e-4, rack_efficiency=1)
    assert design.device.given == {"inertance": pytest.approx(1.0)}


@pytest.mark.parametrize(
    ("stages", "inputs", "words"),
    [
        ([], {}, ["pinion_radius is not given"]),
        ([], {"pinion_radius": 0.01}, ["nothing turns"]),
        (["ratio=3"], {"pinion_radius": 0.01}, ["stage 1", "inertia is not given"]),
        (["3:1e-4"], {"pinion_radius": 0.01}, ["stage 1", "ratio=4,inertia=1e-4"]),
        (["ratio=3,ratio=3"], {"pinion_radius": 0.01}, ["each key once"]),
        (
            ["ratio=3,inertia=1e-4"], {"pinion_radius": 0.01, "rack_play": "0.1 mm"},
            ["every shaft is rigid", "pinion_stiffness"],
        ),
        (
            ["ratio=3,inertia=1e-4,efficiency=0.4"], {"pinion_radius": 0.01},
            ["meshes take", "higher efficiencies"],
        ),
    ],
)  # fmt: skip
def test_refusals(stages: list[str], inputs: dict, words: list[str]) -> None:
    with pytest.raises(DesignError) as caught:
        design_rack_pinion(stages=stages, **inputs)
    assert all(word in str(caught.value) for word in words)
