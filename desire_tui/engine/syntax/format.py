"""Writes nodes as text that parses back to the same nodes.

Used by `list` and `edit`, and by tests: `parse(format(x)) == x` for every tree.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine import nodes as n
from desire_tui.engine.chains import chain

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

INDENT = "  "
_BINDS = {"+": 1, "-": 1, "*": 2, "/": 2, "&": 2, "^": 4}
_SIGN = 3
_CLOSING = frozenset({"else", "proceed", "next", "end while", "end", "end if"})
_ATOM = 5


def format_program(program: n.Program) -> str:
    """Return a program's canonical text: a statement a line, blocks indented. Comments are lost: no nodes."""
    lines: list[str] = []
    depth = 0
    for placed in program.script:
        node = placed.node
        depth -= _closes(node)
        shown = placed.number is not None and not _repeats(program.script, placed)
        number = f"{placed.number} " if shown else ""
        lines.append(number + INDENT * max(0, depth) + format_statement(node))
        depth += _opens(node)
    for i, segment in enumerate(program.segments):
        if i == 0:
            lines.append("DYNAMIC")
        if segment.label is not None:
            lines.append(f"label {segment.label}")
        lines += [INDENT + format_statement(placed.node) for placed in segment.body]
        if segment.jacobian:
            lines.append("JACOBIAN")
            lines += [INDENT + format_statement(placed.node) for placed in segment.jacobian]
    return "".join(f"{line}\n" for line in lines)


def format_statement(node: n.Node) -> str:
    """Return a statement's (or an expression's) canonical text."""
    writer = _WRITERS.get(type(node))
    if writer is not None:
        return writer(node)
    return _condition(node) if isinstance(node, (n.Relation, n.Logical, n.Not)) else _expr(node)


def _repeats(script: Sequence[n.Placed], placed: n.Placed) -> bool:
    """Whether an earlier statement of the same line has shown its number."""
    return next(other for other in script if other.number == placed.number) is not placed


def _opens(node: n.Statement) -> bool:
    if isinstance(node, (n.If, n.For, n.While, n.Procedure, n.Submodel)):
        return True
    return isinstance(node, n.Simple) and node.word in ("repeat", "else")


def _closes(node: n.Statement) -> bool:
    if isinstance(node, n.Until):
        return True
    return isinstance(node, n.Simple) and node.word in _CLOSING


# --------------------------------------------------------------------------------------------- expressions


def _expr(node: n.Node, binds: int = 0) -> str:
    """Write an expression, in parentheses where its operator binds less tightly than `binds`."""
    text, own = _bare_expr(node)
    return f"({text})" if own < binds else text


def _bare_expr(node: n.Node) -> tuple[str, int]:
    match node:
        case n.Number(value):
            return format_number(value), _ATOM
        case n.Text(value):
            return _quoted(value), _ATOM
        case n.Name(name):
            return name, _ATOM
        case n.Element(name, subscripts):
            return f"{name}[{_list(subscripts)}]", _ATOM
        case n.Call(name, args):
            return f"{name}({_list(args)})", _ATOM
        case n.Transposed(name):
            return f"{name}%", _ATOM
        case n.RowOf(name):
            return f"{name}#", _ATOM
        case n.Shifted(name, by):
            return f"{name}{{{_expr(by)}}}", _ATOM
        case n.Pair(re, im):
            return f"[{_expr(re)}, {_expr(im)}]", _ATOM
        case n.Unary(op, operand):
            return f"{op}{_operand(op, _expr(operand, _SIGN))}", _SIGN
        case n.Binary("^", left, right):
            # A sign may follow `^` without parentheses, a sign before it belongs to the whole power.
            exponent = _expr(right, _SIGN)
            return f"{_expr(left, _ATOM)}^{exponent}", _BINDS["^"]
        case n.Binary():
            return _chain(node)
    raise TypeError(node)


def _chain(node: n.Binary) -> tuple[str, int]:
    """Write a sum or product; a sum on the left of `*` needs parentheses, the other way round it does not."""
    first, steps = chain(node)
    text, binds = _bare_expr(first)
    pieces, opened = [text], 0
    for step in steps:
        own = _BINDS[step.op]
        if binds < own:
            opened += 1
            pieces.append(")")
        pieces.append(f" {step.op} {_expr(step.right, own + 1)}")
        binds = own
    return "(" * opened + "".join(pieces), binds


def _operand(sign: str, text: str) -> str:
    """Keep two minus signs apart: `--` would begin a comment."""
    return f" {text}" if sign == "-" and text.startswith("-") else text


def _condition(node: n.Node, binds: int = 0) -> str:
    match node:
        case n.Relation(op, left, right):
            return f"{_expr(left, 1)} {op} {_expr(right, 1)}"
        case n.Not(operand):
            inner = _condition(operand, 3)
            # `not` is a word only before a name, a number or a parenthesis.
            return f"not {inner}" if inner.startswith("(") else f"not ({_condition(operand)})"
        case n.Logical(op, left, right):
            own = 2 if op == "and" else 1
            text = f"{_condition(left, own)} {op} {_condition(right, own + 1)}"
            return f"({text})" if own < binds else text
    raise TypeError(node)


def format_number(value: float) -> str:
    """Return the shortest text that reads back as the same number.

    Only hexadecimal literals are negative (`&&FFFF` is −1); infinite values cannot be written.
    """
    if value < 0 and value == int(value):
        return f"&&{int(value) + 0x10000:X}"
    if value == int(value) and abs(value) < 1e16:  # repr changes to exponents there
        return str(int(value))
    return repr(value)


def _quoted(text: str) -> str:
    return f'"{text}"' if "'" in text else f"'{text}'"


def _list(items: Iterable[n.Node]) -> str:
    return ", ".join(map(_expr, items))


# --------------------------------------------------------------------------------------------- statements


def _if(node: n.If) -> str:
    if node.condition is not None:
        return f"if {_condition(node.condition)} then"
    assert node.value is not None
    return f"if {_expr(node.value)}"


def _for(node: n.For) -> str:
    step = f" step {_expr(node.by)}" if node.by is not None else ""
    return f"for {_expr(node.variable)} = {_expr(node.first)} to {_expr(node.last)}{step}"


def _with(word: str, argument: str | None) -> str:
    return word if not argument else f"{word} {argument}"


def _call(name: str, args: Sequence[str], references: Sequence[str] = ()) -> str:
    second = f"; {', '.join(references)}" if references else ""
    return f"{name}({', '.join(args)}{second})"


def _texts(items: Iterable[n.Node]) -> list[str]:
    return list(map(_expr, items))


def _declare(node: n.Declare) -> str:
    groups = []
    for group in node.groups:
        parts = [p.name + (f"[{_list(p.dimensions)}]" if p.dimensions else "") for p in group.parts]
        groups.append(" + ".join(parts) + (f" = {group.whole}" if group.whole else ""))
    return f"{node.kind} {', '.join(groups)}"


def _items(items: Iterable[n.WriteItem]) -> str:
    return " ".join(f"{item.form}{_expr(item.value)}{item.separator}" for item in items)


def _write(node: n.Write) -> str:
    channel = "" if node.channel is None else f"{'##' if node.raw else '#'}{_expr(node.channel)}"
    if channel and node.items:
        channel += ", "
    return _with("write", channel + _items(node.items))


def _channel(channel: n.Expr | None) -> str:
    return "" if channel is None else f"#{_expr(channel)}, "


def _drun(node: n.Drun) -> str:
    return _with("drunr" if node.reset else "drun", "*" if node.star else node.label)


def _file(node: n.FileCommand) -> str:
    argument = node.argument
    if argument is None:
        return node.word
    return f"{node.word} {_quoted(argument)}"


def _display(node: n.Display) -> str:
    return _with(f"display {node.mode}", _list(node.args))


def _mask(mask: str | None) -> str:
    return f"[{mask}] " if mask else ""


def _matrix(node: n.MatrixAssign) -> str:
    bounds = ""
    if node.lower is not None and node.upper is not None:
        bounds = f"; {_expr(node.lower)}, {_expr(node.upper)}"
    return (
        f"{'DELTA' if node.delta else 'MATRIX'} {node.name} = {_mask(node.mask)}{_expr(node.value)}{bounds}"
    )


def _vector(node: n.VectorAssign) -> str:
    head = "Vectr delta" if node.delta else "Vector"
    return f"{head} {node.name}{'^' if node.largest else ''} = {_mask(node.mask)}{_expr(node.value)}"


def _delay(node: n.Delay) -> str:
    word = "tdelay" if node.per_step else "delay"
    return f"{word} {_expr(node.variable)} = {node.buffer}({_expr(node.source)}, {_expr(node.tau)})"


def _table(node: n.FunctionTable) -> str:
    args = _texts(node.call.args)
    if node.call.name == "func1":
        return f"func {_expr(node.target)} = {args[1]}({args[0]})"
    x, y, array, xs, ys = args
    return f"func2 {_expr(node.target)} = {array}({x}, {y}; {xs}, {ys})"


def _learn(node: n.Learn) -> str:
    if node.kind != "CLEARN":
        return f"{node.kind} {node.output} = {node.weights} * {node.input}; {_expr(node.rate)}"
    assert node.criterion is not None
    mark = " #" if node.conscience else ""
    head = f"CLEARN {node.output} = {node.weights}({node.input})"
    return f"{head} {_expr(node.rate)}, {_expr(node.criterion)}{mark}"


_WRITERS: dict[type[n.Node], Callable[..., str]] = {
    n.Assign: lambda s: f"{_expr(s.target)} = {_expr(s.value)}",
    n.Bare: lambda s: _expr(s.value),
    n.If: _if,
    n.For: _for,
    n.While: lambda s: f"while {_condition(s.condition)}",
    n.Until: lambda s: f"until {_condition(s.condition)}",
    n.Simple: lambda s: s.word,
    n.FileCommand: _file,
    n.Label: lambda s: f"label {s.name}",
    n.GoTo: lambda s: f"go to {s.target}",
    n.Procedure: lambda s: f"PROCEDURE {_call(s.name, s.values, s.references)}",
    n.CallProcedure: lambda s: f"call {_call(s.name, _texts(s.values), _texts(s.references))}",
    n.Submodel: lambda s: f"SUBMODEL {_call(s.name, s.dummies)}",
    n.Invoke: lambda s: f"invoke {_call(s.name, _texts(s.args))}",
    n.Function: lambda s: f"FUNCTION {_call(s.name, s.dummies)} = {_expr(s.body)}",
    n.Declare: _declare,
    n.Data: lambda s: f"data {_list(s.items)}",
    n.Read: lambda s: f"read {_list(s.targets)}",
    n.Restore: lambda s: _with("restore", s.target),
    n.Input: lambda s: f"input {_channel(s.channel)}{_list(s.targets)}",
    n.Write: _write,
    n.Connect: lambda s: f"connect {_expr(s.file)} as {s.mode} {_expr(s.channel)}",
    n.Disconnect: lambda s: f"disconnect {_list(s.channels)}",
    n.Dump: lambda s: _with("dump", "run" if s.what == "run" else s.channel and f"#{_expr(s.channel)}"),
    n.Note: lambda s: _with("note", _items(s.items)),
    n.Irule: lambda s: _with("irule", s.rule and _expr(s.rule)),
    n.Seed: lambda s: f"SEED {_expr(s.value)}",
    n.Drun: _drun,
    n.Fft: lambda s: f"FFT {s.kind}, {_list(s.args)}",
    n.Display: _display,
    n.Plot: lambda s: f"plot {_list(s.args)}",
    n.Show: lambda s: f"SHOW {s.name}" + (f", {_expr(s.columns)}" if s.columns is not None else ""),
    n.MatrixAssign: _matrix,
    n.VectorAssign: _vector,
    n.Dot: lambda s: f"{'AVG' if s.average else 'DOT'} {_expr(s.target)} = {_expr(s.value)}",
    n.Derivative: lambda s: f"d/dt {_expr(s.target)} = {_expr(s.value)}",
    n.VectorDerivative: lambda s: f"Vectr d/dt {s.name} = {_expr(s.value)}",
    n.Store: lambda s: f"store {s.array} = {_expr(s.variable)}",
    n.Get: lambda s: f"get {_expr(s.variable)} = {s.array}",
    n.Delay: _delay,
    n.TrackHold: lambda s: (
        f"trkhld {_expr(s.held)}, {_expr(s.tracked)} = {_expr(s.control)}, {_expr(s.value)}"
    ),
    n.FunctionTable: _table,
    n.Term: lambda s: f"term {_expr(s.value)}",
    n.Sample: lambda s: f"SAMPLE {_expr(s.every)}",
    n.Request: lambda s: f"{s.kind} {_channel(s.channel)}{_list(s.items)}",
    n.Learn: _learn,
}
