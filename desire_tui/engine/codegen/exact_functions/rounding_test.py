"""Ziv's rounding test: which elements another library, of known accuracy, must have rounded in the same way.

Be |value - (high + low)| ≤ e, and the library's result the rounding of a number that is within d of the
value. If everything within e + d of high + low rounds to the same double, that is the library's result.
Else the element is in doubt, and the library itself is asked (A. Ziv, "Fast evaluation of elementary
mathematical functions with correctly rounded last bit", ACM TOMS 17, 1991).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from desire_tui.engine.codegen.exact_functions.pairs import Pair
    from desire_tui.engine.codegen.ir.lanes import Lanes


def rounded(lanes: Lanes, value: Pair, band: str) -> tuple[str, str]:
    """Return the rounded value and the flags of the elements in doubt; `band` is e + d."""
    above = lanes.add(value.high, lanes.add(value.low, band))
    below = lanes.add(value.high, lanes.sub(value.low, band))
    return below, lanes.compare("one", above, below)


def outside(lanes: Lanes, x: str, least: float, most: float) -> str:
    """Return the flags of elements that are not within [least, most]; nan is not outside."""
    low = lanes.compare("olt", x, lanes.const(least))
    high = lanes.compare("ogt", x, lanes.const(most))
    return lanes.text.op(f"or {lanes.flags} {low}, {high}")


def function_text(name: str, lanes: Lanes, results: Sequence[tuple[str, str]], library: Sequence[str]) -> str:
    """Return the function NAME: vectors computed for the argument `%x`, elements in doubt by the library.

    `results` are (values, flags in doubt); `library` the functions of one number that are asked. One result
    is returned as it is, several as a structure.
    """
    text = lanes.text
    finished = []
    for number, ((value, doubt), function) in enumerate(zip(results, library, strict=True)):
        bits = text.op(f"bitcast {lanes.flags} {doubt} to i{lanes.width}")
        some = text.op(f"icmp ne i{lanes.width} {bits}, 0")
        before = f"seen{number}"
        text.jump(before)
        text.begin(before)
        text.branch(some, f"ask{number}", f"known{number}")
        text.begin(f"ask{number}")
        text.declarations.add(_asking(function, lanes.width))
        asked = text.op(
            f"call {lanes.kind} @asked.{function}.{lanes.width}({lanes.kind} %x, {lanes.kind} {value},"
            f" i{lanes.width} {bits})"
        )
        text.jump(f"known{number}")
        text.begin(f"known{number}")
        finished.append(text.op(f"phi {lanes.kind} [ {value}, %{before} ], [ {asked}, %ask{number} ]"))
    if len(finished) == 1:
        kind, result = lanes.kind, finished[0]
    else:
        kind = f"{{ {', '.join([lanes.kind] * len(finished))} }}"
        result = "poison"
        for number, value in enumerate(finished):
            result = text.op(f"insertvalue {kind} {result}, {lanes.kind} {value}, {number}")
    text.do(f"ret {kind} {result}")
    return f"define {kind} @{name}({lanes.kind} %x) #1 {{\n{text.body()}\n}}"


def _asking(function: str, width: int) -> str:
    """Return a function that puts the library's results where a bit is set."""
    kind, bits, whole = f"<{width} x double>", f"i{width}", f"<{width} x i32>"
    places = ", ".join(f"i32 {place}" for place in range(width))
    head = f"define internal {kind} @asked.{function}.{width}({kind} %x, {kind} %y, {bits} %which)"
    return f"""{head} noinline #1 {{
entry:
  %arguments = alloca {kind}
  store {kind} %x, ptr %arguments
  br label %next
next:
  %left = phi {bits} [ %which, %entry ], [ %rest, %next ]
  %known = phi {kind} [ %y, %entry ], [ %more, %next ]
  %at = call {bits} @llvm.cttz.{bits}({bits} %left, i1 true)
  %place = zext {bits} %at to i64
  %from = getelementptr double, ptr %arguments, i64 %place
  %argument = load double, ptr %from
  %result = call double @desire.{function}.1(double %argument)
  %short = trunc i64 %place to i32
  %one = insertelement {whole} poison, i32 %short, i64 0
  %all = shufflevector {whole} %one, {whole} poison, {whole} zeroinitializer
  %here = icmp eq {whole} %all, <{places}>
  %first = insertelement {kind} poison, double %result, i64 0
  %results = shufflevector {kind} %first, {kind} poison, {whole} zeroinitializer
  %more = select <{width} x i1> %here, {kind} %results, {kind} %known
  %less = sub {bits} %left, 1
  %rest = and {bits} %left, %less
  %none = icmp eq {bits} %rest, 0
  br i1 %none, label %done, label %next
done:
  ret {kind} %more
}}"""
