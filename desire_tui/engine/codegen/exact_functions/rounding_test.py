"""Ziv's rounding test: which elements another library, of known accuracy, must have rounded in the same way.

Be |value - (high + low)| ≤ e, and the library's result the rounding of a number that is within d of the
value. If everything within e + d of high + low rounds to the same double, that is the library's result.
Else the element is in doubt, and the library itself is asked (A. Ziv, "Fast evaluation of elementary
mathematical functions with correctly rounded last bit", ACM TOMS 17, 1991).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.jit.compiler import machine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.exact_functions.pairs import Pair
    from desire_tui.engine.codegen.ir.lanes import Lanes


class Result(NamedTuple):
    """What a function gives, as vectors."""

    value: str
    doubt: str
    """Integers; not 0 where the element is in doubt."""


def rounded(lanes: Lanes, value: Pair, rest: str, band: str) -> Result:
    """Return value + rest, rounded; `band` is e + d."""
    text = lanes.text
    above = lanes.add(value.high, lanes.add(rest, lanes.add(value.low, band)))
    below = lanes.add(value.high, lanes.add(rest, lanes.sub(value.low, band)))
    bits = [text.op(f"bitcast {lanes.kind} {end} to {lanes.integers}") for end in (above, below)]
    return Result(below, text.op(f"xor {lanes.integers} {bits[0]}, {bits[1]}"))


def beyond(lanes: Lanes, size: str, most: float) -> str:
    """Return integers that are not 0 where a number is larger than `most`; nan is not."""
    limit = lanes.const(most)
    excess = lanes.sub(lanes.larger(size, limit), limit)
    return lanes.text.op(f"bitcast {lanes.kind} {excess} to {lanes.integers}")


def function_text(name: str, lanes: Lanes, results: Sequence[Result], library: Sequence[str]) -> str:
    """Return the function NAME: vectors computed for the argument `%x`, elements in doubt by the library.

    `library` are the functions of one number that are asked. One result is returned as it is, several as a
    structure.
    """
    text = lanes.text
    text.branch(_any(lanes, [result.doubt for result in results]), "ask", "known")
    text.begin("ask")
    asked = []
    for result, function in zip(results, library, strict=True):
        flags = text.op(f"icmp ne {lanes.integers} {result.doubt}, {lanes.integer(0)}")
        bits = text.op(f"bitcast {lanes.flags} {flags} to i{lanes.width}")
        text.declarations.add(_asking(function, lanes.width))
        given = f"{lanes.kind} %x, {lanes.kind} {result.value}, i{lanes.width} {bits}"
        asked.append(text.op(f"call {lanes.kind} @asked.{function}.{lanes.width}({given})"))
    _return(lanes, asked)
    text.begin("known")
    kind = _return(lanes, [result.value for result in results])
    return f"define {kind} @{name}({lanes.kind} %x) alignstack(64) #1 {{\n{text.body()}\n}}"


def _return(lanes: Lanes, values: Sequence[str]) -> str:
    """Return values; say of which kind they are together."""
    if len(values) == 1:
        lanes.text.do(f"ret {lanes.kind} {values[0]}")
        return lanes.kind
    kind = f"{{ {', '.join([lanes.kind] * len(values))} }}"
    whole = "poison"
    for number, value in enumerate(values):
        whole = lanes.text.op(f"insertvalue {kind} {whole}, {lanes.kind} {value}, {number}")
    lanes.text.do(f"ret {kind} {whole}")
    return kind


def _any(lanes: Lanes, doubts: Sequence[str]) -> str:
    """Return whether some element is in doubt: vectors are joined first, and looked at once."""
    text, width, kind = lanes.text, lanes.width, lanes.integers
    joined = doubts[0]
    for doubt in doubts[1:]:
        joined = text.op(f"or {kind} {joined}, {doubt}")
    while width > machine().width:
        whole, width = kind, width // 2
        kind = f"<{width} x i64>"
        parts = []
        for first in (0, width):
            places = ", ".join(f"i32 {first + k}" for k in range(width))
            parts.append(
                text.op(f"shufflevector {whole} {joined}, {whole} poison, <{width} x i32> <{places}>")
            )
        joined = text.op(f"or {kind} {parts[0]}, {parts[1]}")
    flags = text.op(f"icmp ne {kind} {joined}, zeroinitializer")
    bits = text.op(f"bitcast <{width} x i1> {flags} to i{width}")
    return text.op(f"icmp ne i{width} {bits}, 0")


def _asking(function: str, width: int) -> str:
    """Return a function that puts the library's results where a bit is set."""
    kind, bits, flags = f"<{width} x double>", f"i{width}", f"<{width} x i1>"
    head = f"define internal {kind} @asked.{function}.{width}({kind} %x, {kind} %y, {bits} %which)"
    return f"""{head} noinline #1 {{
entry:
  %arguments = alloca {kind}
  store {kind} %x, ptr %arguments
  br label %next
next:
  %left = phi {bits} [ %which, %entry ], [ %rest, %ask ]
  %known = phi {kind} [ %y, %entry ], [ %more, %ask ]
  %none = icmp eq {bits} %left, 0
  br i1 %none, label %done, label %ask
ask:
  %at = call {bits} @llvm.cttz.{bits}({bits} %left, i1 true)
  %place = zext {bits} %at to i64
  %from = getelementptr double, ptr %arguments, i64 %place
  %argument = load double, ptr %from
  %result = call double @desire.{function}.1(double %argument)
  %first = insertelement {kind} poison, double %result, i64 0
  %results = shufflevector {kind} %first, {kind} poison, <{width} x i32> zeroinitializer
  %less = sub {bits} %left, 1
  %rest = and {bits} %left, %less
  %one = xor {bits} %left, %rest
  %here = bitcast {bits} %one to {flags}
  %more = select {flags} %here, {kind} %results, {kind} %known
  br label %next
done:
  ret {kind} %known
}}"""
