"""Statements as text: a writer for each class."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Seed, Simple
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Function, Submodel
from desire_tui.engine.nodes.display import Display, Plot, Request, Show
from desire_tui.engine.nodes.expressions import Expr, Logical, Not, Relation
from desire_tui.engine.nodes.files import (
    Connect,
    Data,
    Disconnect,
    Dump,
    Input,
    Note,
    Read,
    Restore,
    Write,
    WriteItem,
)
from desire_tui.engine.nodes.segment import (
    Delay,
    Derivative,
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
from desire_tui.engine.syntax.format.expressions import condition, expression, listed, quoted

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from desire_tui.engine.nodes.record import Node


def format_statement(node: Node) -> str:
    """Return a statement's (or an expression's) canonical text."""
    writer = _WRITERS.get(type(node))
    if writer is not None:
        return writer(node)
    return condition(node) if isinstance(node, (Relation, Logical, Not)) else expression(node)


def _if(node: If) -> str:
    if node.condition is not None:
        return f"if {condition(node.condition)} then"
    assert node.value is not None
    return f"if {expression(node.value)}"


def _for(node: For) -> str:
    step = f" step {expression(node.by)}" if node.by is not None else ""
    return f"for {expression(node.variable)} = {expression(node.first)} to {expression(node.last)}{step}"


def _with(word: str, argument: str | None) -> str:
    return word if not argument else f"{word} {argument}"


def _call(name: str, args: Sequence[str], references: Sequence[str] = ()) -> str:
    second = f"; {', '.join(references)}" if references else ""
    return f"{name}({', '.join(args)}{second})"


def _texts(items: Iterable[Node]) -> list[str]:
    return list(map(expression, items))


def _declare(node: Declare) -> str:
    groups = []
    for group in node.groups:
        parts = [p.name + (f"[{listed(p.dimensions)}]" if p.dimensions else "") for p in group.parts]
        groups.append(" + ".join(parts) + (f" = {group.whole}" if group.whole else ""))
    return f"{node.kind} {', '.join(groups)}"


def _items(items: Iterable[WriteItem]) -> str:
    return " ".join(f"{item.form}{expression(item.value)}{item.separator}" for item in items)


def _write(node: Write) -> str:
    channel = "" if node.channel is None else f"{'##' if node.raw else '#'}{expression(node.channel)}"
    if channel and node.items:
        channel += ", "
    return _with("write", channel + _items(node.items))


def _channel(channel: Expr | None) -> str:
    return "" if channel is None else f"#{expression(channel)}, "


def _drun(node: Drun) -> str:
    return _with("drunr" if node.reset else "drun", "*" if node.star else node.label)


def _file(node: FileCommand) -> str:
    argument = node.argument
    if argument is None:
        return node.word
    return f"{node.word} {quoted(argument)}"


def _display(node: Display) -> str:
    return _with(f"display {node.mode}", listed(node.args))


def _mask(mask: str | None) -> str:
    return f"[{mask}] " if mask else ""


def _matrix(node: MatrixAssign) -> str:
    bounds = ""
    if node.lower is not None and node.upper is not None:
        bounds = f"; {expression(node.lower)}, {expression(node.upper)}"
    word = "DELTA" if node.delta else "MATRIX"
    return f"{word} {node.name} = {_mask(node.mask)}{expression(node.value)}{bounds}"


def _vector(node: VectorAssign) -> str:
    head = "Vectr delta" if node.delta else "Vector"
    return f"{head} {node.name}{'^' if node.largest else ''} = {_mask(node.mask)}{expression(node.value)}"


def _delay(node: Delay) -> str:
    word = "tdelay" if node.per_step else "delay"
    return f"{word} {expression(node.variable)} = {node.buffer}({listed((node.source, node.tau))})"


def _table(node: FunctionTable) -> str:
    args = _texts(node.call.args)
    if node.call.name == "func1":
        return f"func {expression(node.target)} = {args[1]}({args[0]})"
    x, y, array, xs, ys = args
    return f"func2 {expression(node.target)} = {array}({x}, {y}; {xs}, {ys})"


def _learn(node: Learn) -> str:
    if node.kind != "CLEARN":
        return f"{node.kind} {node.output} = {node.weights} * {node.input}; {expression(node.rate)}"
    assert node.criterion is not None
    mark = " #" if node.conscience else ""
    head = f"CLEARN {node.output} = {node.weights}({node.input})"
    return f"{head} {expression(node.rate)}, {expression(node.criterion)}{mark}"


_WRITERS: dict[type[Node], Callable[..., str]] = {
    Assign: lambda s: f"{expression(s.target)} = {expression(s.value)}",
    Bare: lambda s: expression(s.value),
    If: _if,
    For: _for,
    While: lambda s: f"while {condition(s.condition)}",
    Until: lambda s: f"until {condition(s.condition)}",
    Simple: lambda s: s.word,
    FileCommand: _file,
    Label: lambda s: f"label {s.name}",
    GoTo: lambda s: f"go to {s.target}",
    Procedure: lambda s: f"PROCEDURE {_call(s.name, s.values, s.references)}",
    CallProcedure: lambda s: f"call {_call(s.name, _texts(s.values), _texts(s.references))}",
    Submodel: lambda s: f"SUBMODEL {_call(s.name, s.dummies)}",
    Invoke: lambda s: f"invoke {_call(s.name, _texts(s.args))}",
    Function: lambda s: f"FUNCTION {_call(s.name, s.dummies)} = {expression(s.body)}",
    Declare: _declare,
    Data: lambda s: f"data {listed(s.items)}",
    Read: lambda s: f"read {listed(s.targets)}",
    Restore: lambda s: _with("restore", s.target),
    Input: lambda s: f"input {_channel(s.channel)}{listed(s.targets)}",
    Write: _write,
    Connect: lambda s: f"connect {expression(s.file)} as {s.mode} {expression(s.channel)}",
    Disconnect: lambda s: f"disconnect {listed(s.channels)}",
    Dump: lambda s: _with("dump", "run" if s.what == "run" else s.channel and f"#{expression(s.channel)}"),
    Note: lambda s: _with("note", _items(s.items)),
    Irule: lambda s: _with("irule", s.rule and expression(s.rule)),
    Seed: lambda s: f"SEED {expression(s.value)}",
    Drun: _drun,
    Fft: lambda s: f"FFT {s.kind}, {listed(s.args)}",
    Display: _display,
    Plot: lambda s: f"plot {listed(s.args)}",
    Show: lambda s: f"SHOW {s.name}" + (f", {expression(s.columns)}" if s.columns is not None else ""),
    MatrixAssign: _matrix,
    VectorAssign: _vector,
    Dot: lambda s: f"{'AVG' if s.average else 'DOT'} {expression(s.target)} = {expression(s.value)}",
    Derivative: lambda s: f"d/dt {expression(s.target)} = {expression(s.value)}",
    VectorDerivative: lambda s: f"Vectr d/dt {s.name} = {expression(s.value)}",
    Store: lambda s: f"store {s.array} = {expression(s.variable)}",
    Get: lambda s: f"get {expression(s.variable)} = {s.array}",
    Delay: _delay,
    TrackHold: lambda s: f"trkhld {listed((s.held, s.tracked))} = {listed((s.control, s.value))}",
    FunctionTable: _table,
    Term: lambda s: f"term {expression(s.value)}",
    Sample: lambda s: f"SAMPLE {expression(s.every)}",
    Request: lambda s: f"{s.kind} {_channel(s.channel)}{listed(s.items)}",
    Learn: _learn,
}
