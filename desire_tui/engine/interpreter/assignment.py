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
    from desire_tui.engine.interpreter.statement_context import Site
    from desire_tui.engine.nodes.assignments import Assign
    from desire_tui.engine.nodes.expressions import Expr, Target
    from desire_tui.engine.nodes.record import Node


def assign(site: Site, node: Assign) -> Operation:
    """Make the operation of an assignment. A new name counts as 0 on its own right side."""
    slot, kind = site.slot_code(node.target)
    fresh = _fresh_slot(site, slot)
    if fresh is None:
        return _assignment(site, node.target, slot, kind, node.value)
    values = site.values
    values.assign(fresh, 0.0)
    try:
        operation = _assignment(site, node.target, slot, kind, node.value)
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
        site.machine.codes.improve(site.address, operation)
        return following

    return once


def _fresh_slot(site: Site, slot: ast.expr) -> int | None:
    if not isinstance(slot, ast.Constant):
        return None
    number = py.constant_slot(slot)
    return number if number < SCALAR_SLOTS and not site.values.defined[number] else None


def _assignment(site: Site, target: Target, slot: ast.expr, kind: Kind, value: Expr) -> Operation:
    number = literal(value)
    if number is not None and kind is Kind.REAL and isinstance(slot, ast.Constant):
        cells, place, following = site.values.cells, py.constant_slot(slot), site.next

        def constant() -> int:
            cells[place] = number
            return following

        return constant
    body = store_code(site, target, slot, kind, value)
    return site.function([*body, py.give(py.number(site.next))])


def store_code(site: Site, target: Target, slot: ast.expr, kind: Kind, value: Expr) -> list[ast.stmt]:
    """Return code that evaluates an expression and stores it as the target's kind asks for."""
    code, given = site.translator.expression(value)
    if given is Kind.COMPLEX and kind is not Kind.COMPLEX:
        raise ScriptFault("complex-to-real", value, name=target.name)
    if kind is Kind.COMPLEX:
        body: list[ast.stmt] = [py.carry_out(at(py.call("set_complex", slot, code), value))]
    elif kind is Kind.INTEGER:
        body = [py.set_cell(slot, at(py.call("to_integer", code), value))]
    elif literal(value) is not None:
        body = [py.set_cell(slot, code)]
    else:
        difference = py.binary(py.load("v"), py.SUBTRACT, py.load("v"))  # 0 but for inf and nan
        failed: ast.stmt = py.carry_out(at(py.call("overflow"), value))
        body = [py.store("v", code), py.when(difference, failed), py.set_cell(slot, py.load("v"))]
    meaning = site.scope.dummies.get(target.name)
    if isinstance(target, Name) and isinstance(meaning, Reference):
        body.append(py.carry_out(py.call("mark", py.load(meaning.variable))))
        if _mentions(value, target.name):
            body.insert(0, py.carry_out(py.call("count_as_zero", py.load(meaning.variable))))
    return body


def _mentions(node: Node, name: str) -> bool:
    """Whether an expression reads a name."""
    return any(getattr(part, "name", None) == name for part in walk(node))


def storer(site: Site, target: Target) -> Callable[[complex], None]:
    """Return a function that stores one value in a scalar target, as an assignment would."""
    slot_of, kind = site.slot(target)
    cells = site.values.cells
    helpers = site.machine.build.names

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
