"""Python syntax trees made by hand, each carrying the place of the Desire node it comes from.

Every node gets a place when it is made (`ast.fix_missing_locations` would take longer than compiling).
"""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

if TYPE_CHECKING:
    from desire_tui.engine.nodes.record import Node
    from desire_tui.engine.values import Kind

Expression = TypeVar("Expression", bound=ast.expr)

_LOAD, _STORE = ast.Load(), ast.Store()
NO_PLACE: dict[str, Any] = {"lineno": 1, "col_offset": 0, "end_lineno": 1, "end_col_offset": 0}
"""No place: a fault there is reported for the whole statement."""

ADD, SUBTRACT, MULTIPLY, DIVIDE = ast.Add(), ast.Sub(), ast.Mult(), ast.Div()
NOT, MINUS = ast.Not(), ast.USub()
AT_MOST, EQUAL = ast.LtE(), ast.Eq()


class Typed(NamedTuple):
    """A translated expression and the kind of its value."""

    code: ast.expr
    kind: Kind


def at(made: Expression, node: Node) -> Expression:
    """Give generated code its place in the statement (offsets as columns) and return it."""
    made.col_offset, made.end_col_offset = node.start, node.end
    return made


def number(value: float) -> ast.expr:
    """Return a constant."""
    return ast.Constant(value, **NO_PLACE)


def text(value: str) -> ast.expr:
    """Return a constant string."""
    return ast.Constant(value, **NO_PLACE)


def constant_slot(slot: ast.Constant) -> int:
    """Return the slot that a constant expression stands for."""
    assert isinstance(slot.value, int)
    return slot.value


def load(variable: str) -> ast.expr:
    """Return a variable that is read."""
    return ast.Name(variable, _LOAD, **NO_PLACE)


def call(function: str, *args: ast.expr) -> ast.Call:
    """Return a call."""
    return ast.Call(load(function), list(args), [], **NO_PLACE)


def index(variable: str, place: ast.expr) -> ast.expr:
    """Return `variable[place]`."""
    return ast.Subscript(load(variable), place, _LOAD, **NO_PLACE)


def cell(slot: ast.expr) -> ast.expr:
    """Return `c[slot]`, the number in a slot."""
    return index("c", slot)


def binary(left: ast.expr, operator: ast.operator, right: ast.expr) -> ast.expr:
    """Return an arithmetic operation."""
    return ast.BinOp(left, operator, right, **NO_PLACE)


def unary(operator: ast.unaryop, operand: ast.expr) -> ast.expr:
    """Return a sign or `not`."""
    return ast.UnaryOp(operator, operand, **NO_PLACE)


def compare(left: ast.expr, operators: list[ast.cmpop], right: list[ast.expr]) -> ast.expr:
    """Return a (chained) comparison."""
    return ast.Compare(left, operators, right, **NO_PLACE)


def and_or(operator: ast.boolop, parts: list[ast.expr]) -> ast.expr:
    """Return conditions joined by `and` or `or`."""
    return ast.BoolOp(operator, parts, **NO_PLACE)


def if_else(condition: ast.expr, yes: ast.expr, no: ast.expr) -> ast.expr:
    """Return `yes if condition else no`."""
    return ast.IfExp(condition, yes, no, **NO_PLACE)


def assign_inline(variable: str, value: ast.expr) -> ast.expr:
    """Return `(variable := value)`."""
    return ast.NamedExpr(ast.Name(variable, _STORE, **NO_PLACE), value, **NO_PLACE)


def last_of(values: list[ast.expr]) -> ast.expr:
    """Return `(a, b, …)[-1]`: all are evaluated in their order, the last is the value."""
    return ast.Subscript(ast.Tuple(values, _LOAD, **NO_PLACE), number(-1), _LOAD, **NO_PLACE)


def store(variable: str, value: ast.expr) -> ast.stmt:
    """Return `variable = value`."""
    return ast.Assign([ast.Name(variable, _STORE, **NO_PLACE)], value, **NO_PLACE)


def set_cell(slot: ast.expr, value: ast.expr) -> ast.stmt:
    """Return `c[slot] = value`."""
    return ast.Assign([ast.Subscript(load("c"), slot, _STORE, **NO_PLACE)], value, **NO_PLACE)


def expression_statement(expression: ast.expr) -> ast.stmt:
    """Return an expression as a statement."""
    return ast.Expr(expression, **NO_PLACE)


def return_value(value: ast.expr) -> ast.stmt:
    """Return `return value`."""
    return ast.Return(value, **NO_PLACE)


def if_statement(condition: ast.expr, *body: ast.stmt) -> ast.stmt:
    """Return `if condition: body`."""
    return ast.If(condition, list(body), [], **NO_PLACE)


def function(name: str, parameters: tuple[str, ...], body: list[ast.stmt]) -> ast.Module:
    """Return a module that defines one function."""
    arguments = ast.arguments([], [ast.arg(p, **NO_PLACE) for p in parameters], None, [], [], None, [])
    return ast.Module([ast.FunctionDef(name, arguments, body, [], None, **NO_PLACE)], [])


def parsed(code: str) -> list[ast.stmt]:
    """Return statements written as Python, without places."""
    module = ast.parse(code)
    for part in ast.walk(module):
        if isinstance(part, ast.stmt | ast.expr):
            part.lineno = part.end_lineno = 1
            part.col_offset = part.end_col_offset = 0
    return module.body
