"""The parts of a `for` in a function made from a whole loop."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.run_count import loop_count
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.values import SCALAR_SLOTS, Kind

if TYPE_CHECKING:
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.control import For
    from desire_tui.engine.nodes.expressions import Expr


class CountedLoop(NamedTuple):
    """Code before the first pass, whether that is made, code behind a pass, and what saves the count."""

    prelude: list[ast.stmt]
    entered: ast.expr
    following: list[ast.stmt]
    saves: str


def counted_loop(context: StatementContext, node: For, *, is_outermost: bool) -> CountedLoop | None:
    """Write a `for`; None if its variable is no real or whole scalar.

    Its variables are `k` (passes made), `m` (their number), `a` and `s` (first value, step), with its place
    as their number. The outermost loop is under way already: the operations share its state.
    """
    if not isinstance(node.variable, Name):
        return None
    slot, kind = context.slot_code(node.variable)
    if kind is Kind.COMPLEX or not isinstance(slot, ast.Constant) or py.constant_slot(slot) >= SCALAR_SLOTS:
        return None
    number, n = py.constant_slot(slot), context.place
    loop = context.machine.build.share("l", context.code.loops.setdefault(n, [0, 0, 0.0, 1.0, 0]))
    stored = f"c[{number}] = to_integer({{}})" if kind is Kind.INTEGER else f"c[{number}] = {{}}"
    entered: ast.expr = ast.Constant(True, **py.NO_PLACE)
    if is_outermost:
        prelude = py.parsed(f"k_{n}, m_{n}, a_{n}, s_{n} = {loop}[0], {loop}[1], {loop}[2], {loop}[3]")
    else:
        prelude = _bounds(context, node) + py.parsed(stored.format(f"a_{n}"))
        entered = py.compare(py.load(f"m_{n}"), [ast.Gt()], [py.number(0)])
    following = py.parsed(f"k_{n} += 1\nif k_{n} >= m_{n}: pass\n" + stored.format(f"a_{n} + k_{n}*s_{n}"))
    over = following[1]
    assert isinstance(over, ast.If)
    over.body = [ast.Break(**py.NO_PLACE)]
    saves = f"{loop}[:] = k_{n}, m_{n}, a_{n}, s_{n}, {number}"
    return CountedLoop(prelude, entered, following, saves)


def _bounds(context: StatementContext, node: For) -> list[ast.stmt]:
    """Evaluate a loop's bounds and step, and count its passes."""
    n = context.place
    names = context.machine.build.names
    names.setdefault("loop_count", loop_count)
    names.setdefault("step_is_zero", step_is_zero)

    def real(name: str, expression: Expr) -> ast.stmt:
        return py.store(f"{name}_{n}", context.translator.real(expression))

    bounds = [real("a", node.first), real("b", node.last)]
    if node.by is None:
        bounds += py.parsed(f"s_{n} = 1.0")
    else:
        is_zero = py.compare(py.load(f"s_{n}"), [py.EQUAL], [py.number(0.0)])
        fault = py.expression_statement(py.at(py.call("step_is_zero"), node.by))
        bounds += [real("s", node.by), py.if_statement(is_zero, fault)]
    return [*bounds, *py.parsed(f"k_{n} = 0\nm_{n} = loop_count(a_{n}, b_{n}, s_{n})")]


def step_is_zero() -> None:
    """Refuse a `for` that would not end."""
    raise ScriptFault("step-is-zero")
