"""Which statements, forms, functions and display codes a program uses: what the coverage table is made from."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.library import LIBRARY
from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, Irule, Seed, Simple
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Function, Submodel
from desire_tui.engine.nodes.display import Display, GraphText, Plot, Request, Show, ShowArea
from desire_tui.engine.nodes.expressions import (
    Binary,
    Call,
    Element,
    Expr,
    Logical,
    Name,
    Not,
    Number,
    Pair,
    RowOf,
    Shifted,
    Transposed,
    Truth,
)
from desire_tui.engine.nodes.files import (
    Connect,
    Data,
    Disconnect,
    Dump,
    Input,
    LoadData,
    Note,
    Read,
    Restore,
    Write,
)
from desire_tui.engine.nodes.record import Node
from desire_tui.engine.nodes.segment import (
    Delay,
    Derivative,
    Event,
    Every,
    Fast,
    FunctionTable,
    Get,
    Invoke,
    Learn,
    Sample,
    Store,
    Term,
    TrackHold,
    VectorDerivative,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from desire_tui.engine.nodes.program import Placed, Program

SCRIPT = (
    "x = e", "A[i] = e", "if … then … proceed", "else", "and", "or", "not",
    "for … next", "for … step", "while", "until", "exit", "label", "go to NAME", "go to number",
    "PROCEDURE", "call", "SUBMODEL", "FUNCTION", "data", "data 'f'", "read", "restore", "restore place",
    "ARRAY", "ARRAY a + b", "ARRAY W = v", "STATE", "INTEGER", "COMPLEX", "[a, b]", "(a > b)",
    "input", "input #n", "write", "write a, b", "write a; b", "write a;", "write $", "write %", "write %%",
    "write #n", "write ##n", "connect input", "connect output", "disconnect", "dump #n", "time", "note",
    "irule n", "irule", "SEED", "drun", "drun NAME", "drun *", "drunr", "reset", "clear", "STOP",
    "MATRIX", "MATRIX = number", "A%", "$In", "$Tr", "Vector", "DOT", "AVG", "FFT F", "FFT I", "FFT R", "FFT C",
    "title", "xlabel", "ylabel", "units", "plot x, y", "plot z", "SHOW", *(f"display {code}" for code in (*"012ABCFNQRWY", "fit", "logx", "logy", "loglog", "equal", "linear")),
)  # fmt: skip
"""Rows about the script; every one must be used by a program that checks something."""

DYNAMIC = (
    "y = e", "y[i] = e", "d/dt x", "d/dt x[i]", "Vectr d/dt", "Vector", "Vector delta", "Vector ^", "Vector [m]",
    "A*x", "A% * x", "x{k}", "P#", "MATRIX", "MATRIX [M]", "MATRIX ; bounds", "u & v", "DELTA", "DOT", "AVG", "u*A*v",
    "store", "get", "tdelay", "delay", "trkhld", "func", "func2", "invoke", "submodel call", "term", "if e", "else",
    "end if", "OUT", "SAMPLE", "step", "event", "every", "end event", "fast", "JACOBIAN", "dispt", "dispxy", "DISPXY", "type", "type #n", "stash", "recover",
    "SHOW", "CLEARN", "PLEARN", "INTP", *(f"rule {rule}" for rule in (*range(6), *range(7, 18))),
)  # fmt: skip
"""Rows about segments."""

FUNCTIONS = tuple(f"{name}()" for name in LIBRARY)

_ONE = {
    Until: "until", While: "while", Label: "label", Procedure: "PROCEDURE", CallProcedure: "call",
    Submodel: "SUBMODEL", Function: "FUNCTION", Data: "data", LoadData: "data 'f'", Read: "read", Disconnect: "disconnect",
    Note: "note", Seed: "SEED", Show: "SHOW", ShowArea: "SHOW alone", Pair: "[a, b]", Truth: "(a > b)", Store: "store", Get: "get",
    TrackHold: "trkhld", Invoke: "invoke", Term: "term", Sample: "SAMPLE", Event: "event", Every: "every", Fast: "fast",
    RowOf: "P#", Shifted: "x{k}",
    VectorDerivative: "Vectr d/dt", Not: "not", Transposed: "A%",
}  # fmt: skip
"""Nodes whose class says it all."""


def features(program: Program) -> tuple[set[str], set[str]]:
    """Return the rows of SCRIPT and of DYNAMIC (functions in both) that a program uses."""
    script = {name for placed in program.script for name in _of(placed)}
    dynamic: set[str] = set()
    for segment in program.segments:
        statements = [*segment.body, *segment.jacobian]
        dynamic |= {name for placed in statements for name in _of(placed)}
        if segment.jacobian:
            dynamic.add("JACOBIAN")
        if not any(isinstance(s.node, Derivative | VectorDerivative) for s in statements):
            dynamic.add("rule 0")
        elif not any(isinstance(s.node, Irule) for s in program.script):
            dynamic.add("rule 1")
    dynamic |= {f"rule {int(s.node.rule.value)}" for s in program.script
                if isinstance(s.node, Irule) and isinstance(s.node.rule, Number)}  # fmt: skip
    return script, dynamic


def _of(placed: Placed) -> Iterator[str]:
    for part in _walk(placed.node):
        yield from _names(part)
        if type(part) in _ONE:
            yield _ONE[type(part)]


def _walk(part: object) -> Iterator[object]:
    yield part
    if isinstance(part, tuple):
        for item in part:
            yield from _walk(item)
    elif isinstance(part, Node):
        for name in type(part).__match_args__:
            yield from _walk(getattr(part, name))


def _names(part: object) -> Iterator[str]:
    match part:
        case Simple(word=word):
            yield word
        case Call(name=name):
            yield f"{name}()" if name in LIBRARY else name
        case Assign(target=target):
            yield ("A[i] = e", "y[i] = e")[0] if isinstance(target, Element) else "x = e"
            yield "y[i] = e" if isinstance(target, Element) else "y = e"
        case If(condition=condition):
            yield "if e" if condition is None else "if … then … proceed"
        case Logical(op=op):
            yield op
        case For(by=by):
            yield "for … next"
            if by is not None:
                yield "for … step"
        case GoTo(target=target):
            yield "go to number" if target.isdigit() else "go to NAME"
        case Declare(kind=kind, groups=groups):
            yield kind
            if any(len(group.parts) > 1 for group in groups):
                yield "ARRAY a + b"
            if any(len(group.parts) == 1 and group.whole for group in groups):
                yield "ARRAY W = v"
        case Restore(target=target):
            yield "restore" if target is None else "restore place"
        case Input(channel=channel):
            yield "input" if channel is None else "input #n"
        case Write():
            yield from _write_forms(part)
        case Connect(mode=mode):
            yield f"connect {mode}"
        case Dump():
            yield "dump" if part.channel is None else "dump #n"
        case Irule(rule=rule):
            yield "irule" if rule is None else "irule n"
        case Drun():
            yield "drunr" if part.reset else "drun *" if part.star else "drun NAME" if part.label else "drun"
        case Fft(kind=kind):
            yield f"FFT {kind}"
        case Display(mode=mode):
            yield f"display {mode}"
        case GraphText(part=word):
            yield word
        case Plot(args=args):
            yield "plot x, y" if len(args) > 1 else "plot z"
        case Binary(op="&"):
            yield "u & v"
        case Derivative(target=target):
            yield "d/dt x[i]" if isinstance(target, Element) else "d/dt x"
        case Delay(per_step=per_step):
            yield "tdelay" if per_step else "delay"
        case FunctionTable(call=call):
            yield "func" if call.name == "func1" else "func2"
        case Bare(value=Call()):
            yield "submodel call"
        case Request(kind=kind, channel=channel):
            yield kind if channel is None else f"{kind} #n"
        case Learn(kind=kind):
            yield kind
        case _:
            yield from _vector_forms(part)


def _write_forms(part: Write) -> Iterator[str]:
    if part.channel is not None:
        yield "write ##n" if part.raw else "write #n"
    elif not part.items:
        yield "write"
    for item in part.items[:-1]:
        yield "write a, b" if item.separator == "," else "write a; b"
    if part.items and part.items[-1].separator:
        yield "write a;"
    for item in part.items:
        if item.form:
            yield f"write {item.form}"


def _vector_forms(part: object) -> Iterator[str]:
    match part:
        case VectorAssign():
            forms = (part.delta, "Vector delta"), (part.largest, "Vector ^"), (part.mask, "Vector [m]")
            yield from (name for used, name in forms if used)
            yield "Vector"
            yield from _products(part.value)
        case MatrixAssign():
            yield "DELTA" if part.delta else "MATRIX"
            yield from (
                name for used, name in ((part.mask, "MATRIX [M]"), (part.lower, "MATRIX ; bounds")) if used
            )
            if isinstance(part.value, Number):
                yield "MATRIX = number"
        case Dot(average=average, value=value):
            yield "AVG" if average else "DOT"
            if any(
                isinstance(p, Binary) and isinstance(p.left, Binary) and p.op == p.left.op == "*"
                for p in _walk(value)
            ):
                yield "u*A*v"


def _products(value: Expr) -> Iterator[str]:
    for part in _walk(value):
        if isinstance(part, Binary) and part.op == "*":
            if isinstance(part.left, Transposed):
                yield "A% * x"
            elif isinstance(part.left, Name) and isinstance(part.right, Name):
                yield "A*x"
