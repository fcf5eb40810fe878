"""Options that take a number: one that carries a unit is told how it is to be written."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from typing import Any, get_args

import pytest
import typer
from inerter.commands import app
from typer.testing import CliRunner


def callbacks(group: typer.Typer, names: tuple[str, ...] = ()) -> Iterator[tuple[Any, Callable]]:
    """Every command of a group and below, with its words."""
    for command in group.registered_commands:
        if command.callback is not None:
            word = command.name or command.callback.__name__
            yield (*names, word), command.callback
    for inner in group.registered_groups:
        if inner.typer_instance is not None:
            yield from callbacks(inner.typer_instance, (*names, str(inner.name)))


def options() -> list[tuple[tuple[str, ...], str]]:
    """Command and option of every number that may have a fraction."""
    found = []
    for words, callback in callbacks(app):
        for name, parameter in inspect.signature(callback, eval_str=True).parameters.items():
            kind = (get_args(parameter.annotation) or (None,))[0]
            if kind is float or float in get_args(kind):
                found.append((words, "--" + name.replace("_", "-")))
    return found


@pytest.mark.parametrize(("words", "option"), options(), ids=lambda part: str(part))
def test_a_unit_is_told_to_be_none_of_the_number(words: tuple[str, ...], option: str) -> None:
    done = CliRunner().invoke(app, [*words, option, "2s"])
    assert done.exit_code == 2
    said = " ".join(done.stderr.split())
    assert f"'{option}': '2s' is not a number; give a" in said
    assert "without a unit" in said or "a plain number" in said


def test_there_are_such_options() -> None:
    assert (("simulate",), "--duration") in options()
    assert len(options()) > 20


def test_seconds_are_named() -> None:
    done = CliRunner().invoke(app, ["simulate", "model.xml", "--duration", "2s"])
    assert "give a number of seconds, without a unit" in " ".join(done.stderr.split())


def test_a_bound_is_told() -> None:
    done = CliRunner().invoke(app, ["view", "model.xml", "--duration", "0"])
    assert "0 is out of range; give at least 0.001 seconds" in " ".join(done.stderr.split())
