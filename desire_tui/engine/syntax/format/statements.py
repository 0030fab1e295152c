"""Statements as text: a writer for each class."""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine import nodes as n
from desire_tui.engine.syntax.format.expressions import condition, expression, listed, quoted

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence


def format_statement(node: n.Node) -> str:
    """Return a statement's (or an expression's) canonical text."""
    writer = _WRITERS.get(type(node))
    if writer is not None:
        return writer(node)
    return condition(node) if isinstance(node, (n.Relation, n.Logical, n.Not)) else expression(node)


def _if(node: n.If) -> str:
    if node.condition is not None:
        return f"if {condition(node.condition)} then"
    assert node.value is not None
    return f"if {expression(node.value)}"


def _for(node: n.For) -> str:
    step = f" step {expression(node.by)}" if node.by is not None else ""
    return f"for {expression(node.variable)} = {expression(node.first)} to {expression(node.last)}{step}"


def _with(word: str, argument: str | None) -> str:
    return word if not argument else f"{word} {argument}"


def _call(name: str, args: Sequence[str], references: Sequence[str] = ()) -> str:
    second = f"; {', '.join(references)}" if references else ""
    return f"{name}({', '.join(args)}{second})"


def _texts(items: Iterable[n.Node]) -> list[str]:
    return list(map(expression, items))


def _declare(node: n.Declare) -> str:
    groups = []
    for group in node.groups:
        parts = [p.name + (f"[{listed(p.dimensions)}]" if p.dimensions else "") for p in group.parts]
        groups.append(" + ".join(parts) + (f" = {group.whole}" if group.whole else ""))
    return f"{node.kind} {', '.join(groups)}"


def _items(items: Iterable[n.WriteItem]) -> str:
    return " ".join(f"{item.form}{expression(item.value)}{item.separator}" for item in items)


def _write(node: n.Write) -> str:
    channel = "" if node.channel is None else f"{'##' if node.raw else '#'}{expression(node.channel)}"
    if channel and node.items:
        channel += ", "
    return _with("write", channel + _items(node.items))


def _channel(channel: n.Expr | None) -> str:
    return "" if channel is None else f"#{expression(channel)}, "


def _drun(node: n.Drun) -> str:
    return _with("drunr" if node.reset else "drun", "*" if node.star else node.label)


def _file(node: n.FileCommand) -> str:
    argument = node.argument
    if argument is None:
        return node.word
    return f"{node.word} {quoted(argument)}"


def _display(node: n.Display) -> str:
    return _with(f"display {node.mode}", listed(node.args))


def _mask(mask: str | None) -> str:
    return f"[{mask}] " if mask else ""


def _matrix(node: n.MatrixAssign) -> str:
    bounds = ""
    if node.lower is not None and node.upper is not None:
        bounds = f"; {expression(node.lower)}, {expression(node.upper)}"
    word = "DELTA" if node.delta else "MATRIX"
    return f"{word} {node.name} = {_mask(node.mask)}{expression(node.value)}{bounds}"


def _vector(node: n.VectorAssign) -> str:
    head = "Vectr delta" if node.delta else "Vector"
    return f"{head} {node.name}{'^' if node.largest else ''} = {_mask(node.mask)}{expression(node.value)}"


def _delay(node: n.Delay) -> str:
    word = "tdelay" if node.per_step else "delay"
    return f"{word} {expression(node.variable)} = {node.buffer}({listed((node.source, node.tau))})"


def _table(node: n.FunctionTable) -> str:
    args = _texts(node.call.args)
    if node.call.name == "func1":
        return f"func {expression(node.target)} = {args[1]}({args[0]})"
    x, y, array, xs, ys = args
    return f"func2 {expression(node.target)} = {array}({x}, {y}; {xs}, {ys})"


def _learn(node: n.Learn) -> str:
    if node.kind != "CLEARN":
        return f"{node.kind} {node.output} = {node.weights} * {node.input}; {expression(node.rate)}"
    assert node.criterion is not None
    mark = " #" if node.conscience else ""
    head = f"CLEARN {node.output} = {node.weights}({node.input})"
    return f"{head} {expression(node.rate)}, {expression(node.criterion)}{mark}"


_WRITERS: dict[type[n.Node], Callable[..., str]] = {
    n.Assign: lambda s: f"{expression(s.target)} = {expression(s.value)}",
    n.Bare: lambda s: expression(s.value),
    n.If: _if,
    n.For: _for,
    n.While: lambda s: f"while {condition(s.condition)}",
    n.Until: lambda s: f"until {condition(s.condition)}",
    n.Simple: lambda s: s.word,
    n.FileCommand: _file,
    n.Label: lambda s: f"label {s.name}",
    n.GoTo: lambda s: f"go to {s.target}",
    n.Procedure: lambda s: f"PROCEDURE {_call(s.name, s.values, s.references)}",
    n.CallProcedure: lambda s: f"call {_call(s.name, _texts(s.values), _texts(s.references))}",
    n.Submodel: lambda s: f"SUBMODEL {_call(s.name, s.dummies)}",
    n.Invoke: lambda s: f"invoke {_call(s.name, _texts(s.args))}",
    n.Function: lambda s: f"FUNCTION {_call(s.name, s.dummies)} = {expression(s.body)}",
    n.Declare: _declare,
    n.Data: lambda s: f"data {listed(s.items)}",
    n.Read: lambda s: f"read {listed(s.targets)}",
    n.Restore: lambda s: _with("restore", s.target),
    n.Input: lambda s: f"input {_channel(s.channel)}{listed(s.targets)}",
    n.Write: _write,
    n.Connect: lambda s: f"connect {expression(s.file)} as {s.mode} {expression(s.channel)}",
    n.Disconnect: lambda s: f"disconnect {listed(s.channels)}",
    n.Dump: lambda s: _with("dump", "run" if s.what == "run" else s.channel and f"#{expression(s.channel)}"),
    n.Note: lambda s: _with("note", _items(s.items)),
    n.Irule: lambda s: _with("irule", s.rule and expression(s.rule)),
    n.Seed: lambda s: f"SEED {expression(s.value)}",
    n.Drun: _drun,
    n.Fft: lambda s: f"FFT {s.kind}, {listed(s.args)}",
    n.Display: _display,
    n.Plot: lambda s: f"plot {listed(s.args)}",
    n.Show: lambda s: f"SHOW {s.name}" + (f", {expression(s.columns)}" if s.columns is not None else ""),
    n.MatrixAssign: _matrix,
    n.VectorAssign: _vector,
    n.Dot: lambda s: f"{'AVG' if s.average else 'DOT'} {expression(s.target)} = {expression(s.value)}",
    n.Derivative: lambda s: f"d/dt {expression(s.target)} = {expression(s.value)}",
    n.VectorDerivative: lambda s: f"Vectr d/dt {s.name} = {expression(s.value)}",
    n.Store: lambda s: f"store {s.array} = {expression(s.variable)}",
    n.Get: lambda s: f"get {expression(s.variable)} = {s.array}",
    n.Delay: _delay,
    n.TrackHold: lambda s: f"trkhld {listed((s.held, s.tracked))} = {listed((s.control, s.value))}",
    n.FunctionTable: _table,
    n.Term: lambda s: f"term {expression(s.value)}",
    n.Sample: lambda s: f"SAMPLE {expression(s.every)}",
    n.Request: lambda s: f"{s.kind} {_channel(s.channel)}{listed(s.items)}",
    n.Learn: _learn,
}
