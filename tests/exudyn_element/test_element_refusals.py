"""What cannot be is refused with one message that names the thing and what to do."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest
from inerter.core import DeviceError

pytest.importorskip("exudyn.itemInterface")

from element_systems import LUGRE, System, bodies, coordinate, empty, exu, line, settings, solve
from exudyn import itemInterface
from inerter.exudyn import CreateInerter


@pytest.mark.parametrize(
    ("device", "message"),
    [
        ({"inertanse": 1.0}, r'"inertanse" is not a parameter .* did you mean inertance'),
        ({"inertance": float("nan")}, 'inertance is "nan": out of range; give a finite number'),
        ({"inertance": -1.0}, 'inertance is "-1.0": out of range'),
        ({"inertance": 1.0, "friction": "lugr"}, "friction"),
        ({}, "inertance is not given, nor is anything else that acts; give inertance="),
        ({"rest_length": 1.0}, "inertance is not given, nor is anything else that acts"),
        ({"inertance": 1.0, "coulomb_force": 1.0}, "coulomb_force is given, but friction"),
    ],
)
def test_parameters(device: dict[str, Any], message: str) -> None:
    """As everywhere in this package: the core says it."""
    system = line([1.0], [0.0])
    before = str(system.mbs)
    with pytest.raises(DeviceError, match=message):
        CreateInerter(system.mbs, "d", [None, system.parts[0]], **device)
    # nothing has been added
    assert str(system.mbs) == before
    CreateInerter(system.mbs, "d", [None, system.parts[0]], inertance=1.0)
    assert str(system.mbs) != before


# terminals

Ends = Callable[[Any], list[Any]]


def ffrf(mbs: Any) -> Any:
    """An object of several nodes, which carries no point that an inerter knows."""
    node = mbs.AddNode(itemInterface.NodeGenericODE2(
        referenceCoordinates=[0.0] * 2, initialCoordinates=[0.0] * 2,
        initialCoordinates_t=[0.0] * 2, numberOfODE2Coordinates=2,
    ))  # fmt: skip
    return mbs.AddObject(
        itemInterface.ObjectGenericODE2(nodeNumbers=[node], massMatrix=[[1.0, 0.0], [0.0, 1.0]])
    )


def node_1d(mbs: Any) -> Any:
    return mbs.AddNode(itemInterface.Node1D(referenceCoordinates=[0.0]))


def mass(mbs: Any) -> Any:
    return mbs.CreateMassPoint(mass=1.0, referencePosition=[1.0, 0.0, 0.0])


def all_coordinates(mbs: Any) -> Any:
    return mbs.AddMarker(itemInterface.MarkerNodeCoordinates(nodeNumber=node_1d(mbs)))


TERMINALS: dict[str, tuple[Ends, str]] = {
    "two grounds": (lambda m: [None, None], "both are the ground; give at least one body or node"),
    "two ground objects": (lambda m: [m.CreateGround(), None], "both are the ground"),
    "three": (lambda m: [None, mass(m), mass(m)], "3 given; an inerter has two terminals"),
    "a number": (lambda m: [None, 3], "3 is no body, node or marker of Exudyn; give what mbs.Add"),
    "a name": (lambda m: [None, "wheel"], "'wheel' is no body, node or marker"),
    "a coordinate and a point": (
        lambda m: [node_1d(m), mass(m)], "one terminal is a coordinate, the other a point",
    ),
    "a ground at a place and a coordinate": (
        lambda m: [m.CreateGround(referencePosition=[0.7, 0.0, 0.0]), node_1d(m)],
        r"point of the ground at \[0.7, 0.0, 0.0\], .*give None for the ground",
    ),
    "an object of nodes": (lambda m: [None, ffrf(m)], "object 0 is a GenericODE2; .*MassPoint"),
    "a second coordinate": (
        lambda m: [None, coordinate(m, node_1d(m), 1)], "coordinate 1 of node 0, which has 1, c",
    ),
    "all coordinates": (
        lambda m: [None, all_coordinates(m)], "marker 0 is a MarkerNodeCoordinates; .* takes",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", TERMINALS)
def test_terminals(name: str) -> None:
    ends, message = TERMINALS[name]
    mbs = empty()
    with pytest.raises(ValueError, match=f"itemNumbers: .*{message}"):
        CreateInerter(mbs.mbs, "d", ends(mbs.mbs), inertance=1.0)


def test_items_that_do_not_exist() -> None:
    """Exudyn's own message, which has the number."""
    mbs = empty()
    for item in (exu.NodeIndex(9), exu.ObjectIndex(9), exu.MarkerIndex(9)):
        with pytest.raises(Exception, match=r"invalid .* number 9"):
            CreateInerter(mbs.mbs, "d", [None, item], inertance=1.0)


def points(mbs: Any) -> dict[str, Any]:
    body = mass(mbs)
    return {
        "body": body,
        "node": exu.NodeIndex(int(mbs.GetObject(body)["nodeNumber"])),
        "marker": mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=body)),
        "ground node": mbs.AddNode(itemInterface.NodePointGround()),
    }


@pytest.mark.parametrize(
    ("which", "point", "message"),
    [
        ("body", [1.0, 0.0, 0.0], r"NodePoint, which does not turn; give \[0, 0, 0\]"),
        ("node", [1.0, 0.0, 0.0], r"localPosition: \[1.0, 0.0, 0.0\] on node 0, a NodePoint"),
        ("ground node", [1.0, 0.0, 0.0], "a NodePointGround, which does not turn"),
        ("marker", [1.0, 0.0, 0.0], "beside marker 0, which has a place of its own"),
        ("body", [1.0, 0.0], r"localPosition1: \[1.0, 0.0\] is not three finite numbers"),
        ("body", [1.0, 0.0, float("nan")], "localPosition1: .* is not three finite numbers"),
        ("body", "top", "localPosition1: 'top' is not three finite numbers"),
    ],
)
def test_local_positions(which: str, point: Any, message: str) -> None:
    made = empty()
    found = points(made.mbs)
    first = None if which != "ground node" else found["body"]
    with pytest.raises(ValueError, match=message):
        CreateInerter(made.mbs, "d", [first, found[which]], localPosition1=point, inertance=1.0)


@pytest.mark.parametrize(
    ("device", "start", "message"),
    [
        ({}, {"friction_state": 1.0}, "'friction_state' is no state of this device; it has none"),
        (LUGRE, {"bristle": 1.0}, "'bristle' is no state of this device; it has friction_state"),
        (LUGRE, {"friction_state": float("inf")}, "friction_state is inf; give a finite number"),
        (LUGRE, {"friction_state": "low"}, "friction_state is 'low'; give a finite number"),
        (LUGRE, [1.0], r"\[1.0\] is no dict; give {name: value}"),
    ],
)
def test_initial_states(device: dict[str, Any], start: Any, message: str) -> None:
    system = line([1.0], [0.0])
    with pytest.raises(ValueError, match=f"initialStates: {message}"):
        CreateInerter(
            system.mbs, "d", [None, system.parts[0]], inertance=1.0, initialStates=start, **device
        )


@pytest.mark.parametrize(
    ("system", "device"),
    [
        (lambda: bodies("Point"), {}),
        (lambda: line([1.0, 1.0], [0.0, 0.0]), {"load_friction": 0.1}),
    ],
)
def test_symbolic_where_it_cannot_be(system: Callable[[], System], device: dict[str, Any]) -> None:
    made = system()
    with pytest.raises(ValueError, match=r"symbolic: True, but .* leave it None or set it False"):
        CreateInerter(made.mbs, "d", made.parts, inertance=1.0, symbolic=True, **device)


def test_a_sensor_of_nothing() -> None:
    system = line([1.0], [0.0])
    inerter = CreateInerter(system.mbs, "d", [None, system.parts[0]], inertance=1.0)
    with pytest.raises(ValueError, match="quantity: 'force' is none of displacement, velocity"):
        inerter.AddSensor("force")


# at run time


@pytest.mark.parametrize("device", [{"inertance": 1.0}, {"viscous": 1.0}])
def test_terminals_at_one_point(device: dict[str, Any]) -> None:
    """It is refused when it is made, and when the system is assembled."""
    made = empty()
    pair = [made.mbs.CreateMassPoint(mass=1.0, initialVelocity=[v, 0.0, 0.0]) for v in (0.0, 1.0)]
    message = r'inerter "front strut": its terminals are 0 m apart, .* put them apart, or use 1D'
    with pytest.raises(ValueError, match=message):
        CreateInerter(made.mbs, "front strut", pair, **device)
    far = made.mbs.CreateMassPoint(mass=1.0, referencePosition=[1.0, 0.0, 0.0])
    CreateInerter(made.mbs, "front strut", [pair[0], far], **device)
    node = made.mbs.GetObject(far)["nodeNumber"]
    made.mbs.SetNodeParameter(node, "referenceCoordinates", [0.0, 0.0, 0.0])
    with pytest.raises(ValueError, match=message):
        made.mbs.Assemble()


@pytest.mark.parametrize("solver", ["RK44", "GeneralizedAlpha"])
@pytest.mark.parametrize("device", [{"inertance": 1.0}, {"viscous": 1e-6}])
def test_terminals_that_meet(device: dict[str, Any], solver: str) -> None:
    """Exudyn hands the message on, with the name of the inerter and what to do."""
    made = empty()
    ends = ((0.0, 1.0), (2e-3, -1.0))
    pair = [
        made.mbs.CreateMassPoint(
            mass=1.0, referencePosition=[x, 0.0, 0.0], initialVelocity=[v, 0.0, 0.0]
        )
        for x, v in ends
    ]
    CreateInerter(made.mbs, "front strut", pair, **device)
    message = r'inerter "front strut": its terminals are less than 1e-09 m apart'
    with pytest.raises(Exception, match=message):
        solve(made.mbs, settings(2e-3, 1e-3), solver)


def test_a_run_that_diverged() -> None:
    """A bristle far too stiff for the step."""
    system = line([1.0], [1.0])
    inerter = CreateInerter(
        system.mbs, "strut", [None, system.parts[0]], inertance=1.0, viscous=1e5
    )
    solve(system.mbs, settings(1.0, 1e-2))
    message = 'inerter "strut": its coordinates are not finite; the run has diverged. Shorten'
    with pytest.raises(ValueError, match=message):
        inerter.Evaluate()


# where Exudyn is not installed


def without_exudyn(code: str) -> subprocess.CompletedProcess[str]:
    """Run Python code in a process that has no Exudyn."""
    code = f"import sys; sys.modules['exudyn'] = None\n{code}"
    return subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_exudyn_is_not_installed() -> None:
    """The package imports; the first use says how to install what is missing."""
    done = without_exudyn("from inerter.exudyn import CreateInerter; print('imported')")
    assert (done.stdout.strip(), done.returncode) == ("imported", 0), done.stderr
    done = without_exudyn(
        "from inerter.exudyn import CreateInerter\nCreateInerter(None, itemNumbers=[None, None])"
    )
    assert done.returncode == 1
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith("ImportError: Exudyn is not installed")
    assert "pip install exudyn" in last


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"color": "red"}, "color: 'red' is no color; give red, green, blue and opacity"),
        ({"color": [1, 0, 0]}, "color: .* is no color"),
        ({"drawSize": "big"}, "drawSize: 'big' is no finite number"),
        ({"drawSize": float("nan")}, "drawSize: nan is no finite number"),
    ],
)
def test_drawing(given: dict[str, Any], message: str) -> None:
    """Before anything is added."""
    system = bodies("Point")
    before = str(system.mbs)
    with pytest.raises(ValueError, match=message):
        CreateInerter(system.mbs, "d", system.parts, inertance=1.0, **given)
    assert str(system.mbs) == before


def test_no_system() -> None:
    with pytest.raises(ValueError, match="mbs: a SystemContainer is no MainSystem; make one by"):
        CreateInerter(exu.SystemContainer(), "d", inertance=1.0)


def test_attributes_are_not_set() -> None:
    """What looks like a change of a parameter is one, or is refused."""
    system = bodies("Point")
    made = CreateInerter(system.mbs, "d", markerNumbers=system.parts, inertance=1.0)
    with pytest.raises(AttributeError, match=r"strut\.set\(inertance=3\)"):
        made.inertance = 3
    made.set(damping=2.0)
    assert made.device.viscous == 2.0
    system.mbs.SetObjectParameter(made.objectNumber, "damping", 4.0)
    assert made.device.viscous == 4.0
    with pytest.raises(DeviceError, match="damping: is viscous, which is given as well"):
        made.set(damping=1.0, viscous=2.0)
