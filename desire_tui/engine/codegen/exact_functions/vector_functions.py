"""The text of functions of many numbers whose results have the bits of the C library's."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.exact_functions.decimal_logarithm import decimal_logarithm
from desire_tui.engine.codegen.exact_functions.exponential import exponential
from desire_tui.engine.codegen.exact_functions.hyperbolic_tangent import hyperbolic_tangent
from desire_tui.engine.codegen.exact_functions.logarithm import logarithm
from desire_tui.engine.codegen.exact_functions.rounding_test import Result, function_text
from desire_tui.engine.codegen.exact_functions.sine_and_cosine import sine_and_cosine
from desire_tui.engine.codegen.ir.lanes import Lanes
from desire_tui.engine.codegen.ir.text import IrText

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

NAMES = ("sin", "cos", "sincos", "exp", "log", "log10", "tanh")
"""By their C names; `sincos` returns both, as a structure."""


class Written(NamedTuple):
    """The text of an LLVM function, what it calls, and which functions of the library it stands for."""

    text: str
    needs: frozenset[str]
    library: tuple[str, ...]


def ways(name: str) -> Sequence[Callable[[Lanes], list[Result]]]:
    """Return the ways to compute a function: C libraries differ in what they compute."""
    if name == "exp":
        return (lambda lanes: [exponential(lanes)],)
    if name == "log":
        return (lambda lanes: [logarithm(lanes, "%x")],)
    if name == "log10":
        return tuple(
            lambda lanes, fused=fused: [decimal_logarithm(lanes, fused=fused)] for fused in (True, False)
        )
    if name == "tanh":
        return tuple(
            lambda lanes, fused=fused: [Result(hyperbolic_tangent(lanes, fused=fused), "zeroinitializer")]
            for fused in (True, False)
        )
    return (lambda lanes: sine_and_cosine(lanes, _library(name)),)


def written(name: str, symbol: str, width: int, way: Callable[[Lanes], list[Result]]) -> Written:
    """Return the function `symbol`, computed in a way."""
    lanes = Lanes(IrText(), width)
    library = _library(name)
    text = function_text(symbol, lanes, way(lanes), library)
    needs = {f"declare double @desire.{each}.1(double) #1" for each in library}
    needs.add(f"declare i{width} @llvm.cttz.i{width}(i{width}, i1)")
    return Written(text, frozenset(lanes.text.declarations | needs), library)


def _library(name: str) -> tuple[str, ...]:
    return ("sin", "cos") if name == "sincos" else (name,)
