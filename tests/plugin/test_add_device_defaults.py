"""No default class of the user's model reaches what `add_device` adds.

The settings are those of the engine's own schema of MJCF, so that a setting of a later engine is
tested too: each element and attribute that `<default>` may hold, with the first text of a few that
the bare model compiles with.
"""

from __future__ import annotations

import functools

import mujoco
import numpy as np
import pytest
from inerter import add_device

# what a default may set that can be of an added element's kind, or of what it hangs on
SKIPPED = {"mesh", "texture", "material", "layer", "geom", "camera", "light", "pair"}
# the first that compiles is taken; words for attributes that are no numbers
TEXTS = (
    "0.3", "3", "0.3 0.7", "0.3 0.7 0.2", "0.3 0.7 0.2 0.4", "0.1 0.2 0.3 0.4 0.5 0.6",
    "true", "box", "integrator", "muscle", "affine", "linear", "dull", "1 0 0 0 1 0", "voltage",
    "position", "0.1 0.2 0.3 0.4 0.5", "hinge", "force", "axisangle", "0.9 0.95 0.001 0.5 2",
)  # fmt: skip
# what an attribute, or any attribute of an element, needs beside it
BESIDE = {
    "ctrllimited": {"ctrlrange": "-1 2"},
    "forcelimited": {"forcerange": "-1 2"},
    "actlimited": {"actrange": "-1 2"},
    "limited": {"range": "0.1 0.2"},
    "actuatorfrclimited": {"actuatorfrcrange": "-1 2"},
    "delay": {"nsample": "20"},
    "interp": {"nsample": "20", "delay": "0.01"},
    "nsample": {"delay": "0.01"},
    "actdim": {"dyntype": "user"},
    "actearly": {"dyntype": "integrator"},
    "springyield": {"stiffness": "3"},
}
NEEDED = {
    "damper": {"kv": "1", "ctrlrange": "0 1"},
    "adhesion": {"ctrlrange": "0 1"},
    "dcmotor": {"motorconst": "1 1", "resistance": "1"},
}

MODEL = """
<mujoco>
  <size nuser_tendon="4" nuser_actuator="4" nuser_site="4" nuser_sensor="4"/>
  <default>{main}<default class="inner">{inner}</default></default>
  <asset><material name="dull" rgba="1 0 0 1"/></asset>
  <worldbody>
    <body name="left" pos="0 0 0.4" {child}>
      <joint name="left" type="slide"/><geom size="0.1" mass="2"/>
    </body>
    <body name="right" pos="0 0.3 0.5" {child}>
      <joint name="right" type="hinge"/><geom size="0.1" pos="0.2 0 0" mass="3"/>
      <site name="tip" pos="0.2 0 0.1"/>
    </body>
  </worldbody>
</mujoco>"""


@functools.cache
def schema() -> dict[str, tuple[str, ...]]:
    """Attributes by element of `<default>`, from the engine's table of its schema."""
    text = mujoco.mj_printSchema(False, True)
    found: dict[str, list[str]] = {}
    inside, name = False, ""
    for line in text.splitlines():
        head = line[:30].split()
        depth = (len(line) - len(line.lstrip())) // 3
        if head and line[:3].isspace() and not line[3].isspace():
            inside = head[0] == "default"
        elif inside and head and depth >= 2:
            name = head[0]
        if inside and name and name not in SKIPPED:
            found.setdefault(name, []).extend(line[30:].split())
    return {name: tuple(attributes) for name, attributes in found.items()}


def spec_of(setting: str, where: str) -> mujoco.MjSpec:
    """The model with a default in the main class, or in the class of its bodies."""
    inner = where == "inner"
    return mujoco.MjSpec.from_string(
        MODEL.format(
            main="" if inner else setting,
            inner=setting if inner else "",
            child='childclass="inner"' if inner else "",
        )
    )


@functools.cache
def settings(kind: str) -> list[str]:
    """A default for each attribute of an element that the bare model compiles with."""
    found = []
    for attribute in schema()[kind]:
        beside = {**NEEDED.get(kind, {}), **BESIDE.get(attribute, {})}
        for text in TEXTS:
            written = {**beside, attribute: text}
            texts = " ".join(f'{key}="{value}"' for key, value in written.items())
            setting = f"<{kind} {texts}/>"
            if bare_compiles(kind, setting):
                found.append(setting)
                break
    return found


def bare_compiles(kind: str, setting: str) -> bool:
    """Whether the user's model compiles with this default, with an element that it reaches."""
    try:
        spec = spec_of(setting, "main")
        if kind == "tendon":
            spec.add_tendon(name="t").wrap_joint("left", 1.0)
        elif kind == "general":
            joint = mujoco.mjtTrn.mjTRN_JOINT
            spec.add_actuator(name="a", target="left", trntype=joint)
        spec.compile()
    except ValueError:
        return False
    return True


def with_devices(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Devices of every placement added."""
    add_device(
        spec, "strut", between=(("left", (0, 0, 0.1)), "tip"), rest_length="initial",
        inertance=3.0, friction="lugre", coulomb_force=2.0, viscous=0.5, live=("coulomb_force",),
    )  # fmt: skip
    add_device(spec, "slide", joint="left", inertance=2.0, rest_length="initial")
    add_device(spec, "post", between=(("world", (0, 0, 0)), ("left", (0, 0, 0))), inertance=1.0)
    return spec.compile()


def added(model: mujoco.MjModel) -> dict[str, np.ndarray]:
    """Every compiled value of the elements that `add_device` made, by the field's name."""
    rows = {
        "actuator": [model.actuator(name).id for name in ("strut", "slide", "post")],
        "tendon": [model.tendon(name).id for name in ("strut", "post")],
        "site": [model.site(name).id for name in ("strut_1", "post_1", "post_2")],
        "sensor": [model.sensor(name).id for name in ("strut", "slide", "post")],
    }
    sizes = {"actuator": model.nactuator, "tendon": model.ntendon, "site": model.nsite,
             "sensor": model.nsensor}  # fmt: skip
    found = {}
    for kind, ids in rows.items():
        for field in dir(model):
            value = getattr(model, field)
            if field.startswith(f"{kind}_") and isinstance(value, np.ndarray):
                if len(value) == sizes[kind]:
                    value = value[ids]
                found[field] = value
    return found | {"nu": np.array(model.nu), "na": np.array(model.na)}


@functools.cache
def untouched() -> dict[str, np.ndarray]:
    return added(with_devices(spec_of("", "main")))


def differing(model: mujoco.MjModel) -> list[str]:
    """Fields whose values are not those of the model without defaults."""
    found = added(model)
    return [
        field
        for field, value in untouched().items()
        if not np.allclose(found[field], value, rtol=2e-5, atol=1e-9, equal_nan=True)
    ]


# the terminals' own inertia and place follow the user's joints and sites, as they must
OF_THE_USER = {
    "joint": {"actuator_acc0", "actuator_length0", "actuator_lengthrange", "tendon_length0",
              "tendon_invweight0", "tendon_lengthspring", "site_sameframe"},
    "site": set(),
}  # fmt: skip


@pytest.mark.often("general", "motor", "position", "muscle")
@pytest.mark.parametrize("kind", schema())
def test_no_default_reaches_a_device(kind: str) -> None:
    tried = settings(kind)
    assert len(tried) >= 0.8 * len(schema()[kind]), f"too few of {schema()[kind]}: {tried}"
    for setting in tried:
        wrong = set(differing(with_devices(spec_of(setting, "main"))))
        assert not wrong - OF_THE_USER.get(kind, set()), f"{setting}: {wrong}"


@pytest.mark.parametrize("kind", ["joint", "site", "tendon"])
def test_no_class_of_the_bodies_reaches_a_device(kind: str) -> None:
    for setting in settings(kind):
        wrong = set(differing(with_devices(spec_of(setting, "inner"))))
        assert not wrong - OF_THE_USER.get(kind, set()), f"{setting}: {wrong}"
