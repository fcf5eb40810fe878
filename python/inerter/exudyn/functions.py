"""The elementary functions of the laws, on numbers and on Exudyn's symbolic expressions.

A law is written once with these names; `NUMBERS` evaluates it, `expressions()` and a `Tape` record
it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from inerter.exudyn.engine import exudyn

Value = Any
"""A float, or an `exudyn.symbolic.Real`."""

Function = Callable[[Value], Value]


@dataclass(frozen=True)
class Functions:
    """Elementary functions; `choose(condition, yes, no)` evaluates as the condition says."""

    abs: Function
    sign: Function
    sqrt: Function
    sin: Function
    cos: Function
    exp: Function
    log: Function
    log1p: Function
    expm1: Function
    tanh: Function
    round: Function
    power: Callable[[Value, Value], Value]
    arctan2: Callable[[Value, Value], Value]
    least: Callable[[Value, Value], Value]
    greatest: Callable[[Value, Value], Value]
    choose: Callable[[Value, Value, Value], Value]


def _sign(value: float) -> float:
    return float((value > 0.0) - (value < 0.0))


def _exp(value: float) -> float:
    # laws only call it with what decays
    return math.exp(value) if value > -745.0 else 0.0


def _choose(condition: bool, yes: float, no: float) -> float:
    return yes if condition else no


NUMBERS = Functions(
    abs=abs,
    sign=_sign,
    sqrt=math.sqrt,
    sin=math.sin,
    cos=math.cos,
    exp=_exp,
    log=math.log,
    log1p=math.log1p,
    expm1=math.expm1,
    tanh=math.tanh,
    round=round,
    power=math.pow,
    arctan2=math.atan2,
    least=min,
    greatest=max,
    choose=_choose,
)


def expressions() -> Functions:
    """The same functions, recorded as expressions that Exudyn evaluates in C++."""
    symbolic = exudyn("symbolic")

    def real(value: Value) -> Value:
        return value if isinstance(value, symbolic.Real) else symbolic.Real(value)

    def choose(condition: Value, yes: Value, no: Value) -> Value:
        return symbolic.IfThenElse(condition, real(yes), real(no))

    return Functions(
        abs=symbolic.abs,
        sign=symbolic.sign,
        sqrt=symbolic.sqrt,
        sin=symbolic.sin,
        cos=symbolic.cos,
        exp=symbolic.exp,
        log=symbolic.log,
        # nothing that Exudyn evaluates needs them exact near 0
        log1p=lambda value: symbolic.log(1.0 + value),
        expm1=lambda value: symbolic.exp(value) - 1.0,
        tanh=symbolic.tanh,
        round=symbolic.round,
        power=symbolic.pow,
        arctan2=symbolic.atan2,
        least=symbolic.min,
        greatest=symbolic.max,
        choose=choose,
    )
