"""The element makes Exudyn print no warning: those that remain can be switched off."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip("exudyn.itemInterface")

import exudyn.solver
from element_systems import ELASTIC, LUGRE, System, bodies, exu, line, settings, solve
from inerter.exudyn import CreateInerter

SOLVERS = pytest.mark.parametrize("solver", ["RK44", "GeneralizedAlpha"])


def build(kind: str) -> System:
    system = line([2.0, 3.0], [0.3, 0.0], 100.0) if kind == "line" else bodies(kind)
    device: dict[str, Any] = {"inertance": 4.0, "inertance_gradient": 1.0, **LUGRE, **ELASTIC}
    inerter = CreateInerter(system.mbs, "d", system.parts, dissipatedEnergy=True, **device)
    for quantity in ("forces", "states", "dissipated_energy"):
        inerter.AddSensor(quantity)
    return system


@SOLVERS
@pytest.mark.parametrize("kind", ["line", "RigidBodyRxyz"])
def test_nothing_is_printed(kind: str, solver: str, capfd: pytest.CaptureFixture[str]) -> None:
    system = build(kind)
    system.mbs.Assemble()
    assert system.mbs.SolveDynamic(
        settings(0.01, 1e-3), solverType=getattr(exu.DynamicSolverType, solver)
    )
    said = capfd.readouterr()
    assert said.out.strip() == ""
    assert said.err.strip() == ""


@SOLVERS
def test_the_remark_on_memory_can_be_switched_off(
    solver: str, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Exudyn counts what any user function hands over; `solve` raises the number it minds."""
    chosen = settings(0.01, 1e-3)
    monkeypatch.setattr(exudyn.solver, "solverCheckMemoryAllocationsThreshold", 10)
    system = build("line")
    system.mbs.Assemble()
    system.mbs.SolveDynamic(chosen, solverType=getattr(exu.DynamicSolverType, solver))
    assert "memory allocations" in capfd.readouterr().out
    solve(system.mbs, chosen, solver)
    assert capfd.readouterr().out.strip() == ""
