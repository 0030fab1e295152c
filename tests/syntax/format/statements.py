"""Statements as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.nodes.assignments import Assign, Bare, Dot, MatrixAssign, VectorAssign
from desire_tui.engine.nodes.commands import Drun, Fft, FileCommand, Irule, Seed, Simple
from desire_tui.engine.nodes.control import CallProcedure, For, GoTo, If, Label, Procedure, Until, While
from desire_tui.engine.nodes.declarations import Declare, Function, Submodel
from desire_tui.engine.nodes.display import Display, GraphText, Plot, Request, Show, ShowArea
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
    WriteItem,
)
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
from tests.syntax.format.expressions import condition, expression, listed, quoted

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.statements import Statement


def format_statement(node: Statement) -> str:
    """Return a statement's canonical text."""
    match node:
        case Assign():
            return f"{expression(node.target)} = {expression(node.value)}"
        case Bare():
            return expression(node.value)
        case If():
            return _if(node)
        case For():
            return _for(node)
        case While():
            return f"while {condition(node.condition)}"
        case Until():
            return f"until {condition(node.condition)}"
        case Simple():
            return node.word
        case FileCommand():
            return _file(node)
        case Label():
            return f"label {node.name}"
        case GoTo():
            return f"go to {node.target}"
        case Procedure():
            return f"PROCEDURE {_call(node.name, node.values, node.references)}"
        case CallProcedure():
            return f"call {_call(node.name, _texts(node.values), _texts(node.references))}"
        case Submodel():
            return f"SUBMODEL {_call(node.name, node.dummies)}"
        case Invoke():
            return f"invoke {_call(node.name, _texts(node.args))}"
        case Function():
            return f"FUNCTION {_call(node.name, node.dummies)} = {expression(node.body)}"
        case Declare():
            return _declare(node)
        case Data():
            return f"data {listed(node.items)}"
        case LoadData(file):
            return f"data {quoted(file)}"
        case Read():
            return f"read {listed(node.targets)}"
        case Restore():
            return _with("restore", node.target)
        case Input():
            return f"input {_channel(node.channel)}{listed(node.targets)}"
        case Write():
            return _write(node)
        case Connect():
            return f"connect {expression(node.file)} as {node.mode} {expression(node.channel)}"
        case Disconnect():
            return f"disconnect {listed(node.channels)}"
        case Dump():
            return _dump(node)
        case Note():
            return _with("note", _items(node.items))
        case Irule():
            return _with("irule", None if node.rule is None else expression(node.rule))
        case Seed():
            return f"SEED {expression(node.value)}"
        case Drun():
            return _drun(node)
        case Fft():
            return f"FFT {node.kind}, {listed(node.args)}"
        case Display():
            return _display(node)
        case GraphText():
            return f"{node.part} {quoted(node.text)}"
        case Plot():
            return f"plot {listed(node.args)}"
        case Show():
            return f"SHOW {node.name}" + (f", {expression(node.columns)}" if node.columns is not None else "")
        case ShowArea():
            return "SHOW *" if node.by_size else "SHOW"
        case MatrixAssign():
            return _matrix(node)
        case VectorAssign():
            return _vector(node)
        case Dot():
            return f"{'AVG' if node.average else 'DOT'} {expression(node.target)} = {expression(node.value)}"
        case Derivative():
            return f"d/dt {expression(node.target)} = {expression(node.value)}"
        case VectorDerivative():
            return f"Vectr d/dt {node.name} = {expression(node.value)}"
        case Store():
            return f"store {node.array} = {expression(node.variable)}"
        case Get():
            return f"get {expression(node.variable)} = {node.array}"
        case Delay():
            return _delay(node)
        case TrackHold():
            return f"trkhld {listed((node.held, node.tracked))} = {listed((node.control, node.value))}"
        case FunctionTable():
            return _table(node)
        case Term():
            return f"term {expression(node.value)}"
        case Sample():
            return f"SAMPLE {expression(node.every)}"
        case Event():
            return f"event {expression(node.value)}"
        case Every():
            return f"every {listed((node.period,) if node.first is None else (node.period, node.first))}"
        case Fast():
            return "fast"
        case Request():
            return f"{node.kind} {_channel(node.channel)}{listed(node.items)}"
        case Learn():
            return _learn(node)
    assert_never(node)


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


def _texts(items: Iterable[Expr]) -> list[str]:
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


def _dump(node: Dump) -> str:
    if node.what == "run":
        return "dump run"
    return "dump" if node.channel is None else f"dump #{expression(node.channel)}"


def _channel(channel: Expr | None) -> str:
    return "" if channel is None else f"#{expression(channel)}, "


def _drun(node: Drun) -> str:
    return _with("drunr" if node.reset else "drun", "*" if node.star else node.label)


def _file(node: FileCommand) -> str:
    argument = node.argument
    if argument is None:
        return node.word
    if node.word in ("edit", "ed", "list", "list+", "auto"):
        return f"{node.word} {argument}"
    if node.word == "note":
        return f"note #{argument}"
    return f"{node.word} {quoted(argument)}"


def _display(node: Display) -> str:
    return _with(f"display {node.mode}", listed(node.args))


def _mask(mask: str | None) -> str:
    return f"[{mask}] " if mask else ""


def _matrix(node: MatrixAssign) -> str:
    word = "DELTA" if node.delta else "MATRIX"
    return f"{word} {node.name} = {_mask(node.mask)}{expression(node.value)}{_bounds(node)}"


def _bounds(node: MatrixAssign | VectorAssign) -> str:
    if node.lower is None or node.upper is None:
        return ""
    return f"; {expression(node.lower)}, {expression(node.upper)}"


def _vector(node: VectorAssign) -> str:
    head = "Vectr delta" if node.delta else "Vector"
    return f"{head} {node.name}{'^' if node.largest else ''} = {_mask(node.mask)}{expression(node.value)}{_bounds(node)}"


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
    mark = " #" if node.fast else ""
    head = f"CLEARN {node.output} = {node.weights}({node.input})"
    return f"{head} {expression(node.rate)}, {expression(node.criterion)}{mark}"
