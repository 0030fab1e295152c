"""`x = e`, `x[i] = e`, and storing single values read from data lists, files and the console."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.name_resolution import Reference
from desire_tui.engine.interpreter.python_ast import at
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.nodes.signs import literal
from desire_tui.engine.nodes.walk import walk
from desire_tui.engine.values import SCALAR_SLOTS, Kind

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.interpreter.code_table import Operation
    from desire_tui.engine.interpreter.statement_context import StatementContext
    from desire_tui.engine.nodes.assignments import Assign
    from desire_tui.engine.nodes.expressions import Expr, Target
    from desire_tui.engine.nodes.record import Node


def assign(context: StatementContext, node: Assign) -> Operation:
    """Make the operation of an assignment. A new name counts as 0 on its own right side."""
    slot, kind = context.slot_code(node.target)
    fresh = _fresh_slot(context, slot)
    if fresh is None:
        return _assignment(context, node.target, slot, kind, node.value)
    values = context.values
    values.assign(fresh, 0.0)
    try:
        operation = _assignment(context, node.target, slot, kind, node.value)
    except BaseException:
        values.defined[fresh] = 0
        raise

    def once() -> int:
        """Leave a target undefined that never got its value."""
        try:
            following = operation()
        except BaseException:
            values.defined[fresh] = 0
            raise
        values.defined[fresh] = 1
        context.machine.code_table.replace_operation(context.address, operation)
        return following

    return once


def _fresh_slot(context: StatementContext, slot: ast.expr) -> int | None:
    if not isinstance(slot, ast.Constant):
        return None
    number = py.constant_slot(slot)
    return number if number < SCALAR_SLOTS and not context.values.defined[number] else None


def _assignment(
    context: StatementContext, target: Target, slot: ast.expr, kind: Kind, value: Expr
) -> Operation:
    number = literal(value)
    if number is not None and kind is Kind.REAL and isinstance(slot, ast.Constant):
        cells, place, following = context.values.cells, py.constant_slot(slot), context.next

        def constant() -> int:
            cells[place] = number
            return following

        return constant
    body = store_code(context, target, slot, kind, value)
    return context.function([*body, py.return_value(py.number(context.next))])


def store_code(
    context: StatementContext, target: Target, slot: ast.expr, kind: Kind, value: Expr
) -> list[ast.stmt]:
    """Return code that evaluates an expression and stores it as the target's kind asks for."""
    code, given = context.translator.expression(value)
    if given is Kind.COMPLEX and kind is not Kind.COMPLEX:
        raise ScriptFault("complex-to-real", value, name=target.name)
    if kind is Kind.COMPLEX:
        body: list[ast.stmt] = [py.expression_statement(at(py.call("set_complex", slot, code), value))]
    elif kind is Kind.INTEGER:
        body = [py.set_cell(slot, at(py.call("to_integer", code), value))]
    elif literal(value) is not None:
        body = [py.set_cell(slot, code)]
    else:
        difference = py.binary(py.load("v"), py.SUBTRACT, py.load("v"))  # 0 but for inf and nan
        failed: ast.stmt = py.expression_statement(at(py.call("overflow"), value))
        body = [py.store("v", code), py.if_statement(difference, failed), py.set_cell(slot, py.load("v"))]
    meaning = context.scope.dummies.get(target.name)
    if isinstance(target, Name) and isinstance(meaning, Reference):
        body.append(py.expression_statement(py.call("mark", py.load(meaning.variable))))
        if _mentions(value, target.name):
            body.insert(0, py.expression_statement(py.call("count_as_zero", py.load(meaning.variable))))
    return body


def _mentions(node: Node, name: str) -> bool:
    """Whether an expression reads a name."""
    return any(getattr(part, "name", None) == name for part in walk(node))


def storer(context: StatementContext, target: Target) -> Callable[[complex], None]:
    """Return a function that stores one value in a scalar target, as an assignment would."""
    slot_of, kind = context.slot(target)
    cells = context.values.cells
    helpers = context.machine.build.names

    def store(value: complex) -> None:
        if kind is Kind.COMPLEX:
            helpers["set_complex"](slot_of(), complex(value))
            return
        if value.imag != 0.0:
            raise ScriptFault("complex-to-real", target, name=target.name)
        number = value.real
        if number - number != 0.0:
            raise ScriptFault("overflow", target)
        cells[slot_of()] = helpers["to_integer"](number) if kind is Kind.INTEGER else number

    return store
