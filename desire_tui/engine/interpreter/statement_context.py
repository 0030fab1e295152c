"""A statement being made into an operation: what the makers of all statements need."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Any

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.expression_translation import scalar_quantity
from desire_tui.engine.interpreter.name_resolution import Reference
from desire_tui.engine.interpreter.python_ast import at
from desire_tui.engine.interpreter.subscripts import element_slot
from desire_tui.engine.nodes.expressions import Element, Name
from desire_tui.engine.nodes.signs import literal
from desire_tui.engine.values import SCALAR_SLOTS, Kind
from desire_tui.engine.whole_numbers import whole

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from desire_tui.engine.interpreter.code_table import Operation, ScriptCode
    from desire_tui.engine.interpreter.machine import ScriptMachine
    from desire_tui.engine.nodes.expressions import Expr, Target
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.nodes.record import Node
    from desire_tui.engine.nodes.statements import Statement
    from desire_tui.engine.values import Quantity


class StatementContext:
    """One statement of some code."""

    def __init__(self, machine: ScriptMachine, code: ScriptCode, place: int) -> None:
        self.machine = machine
        self.code = code
        self.place = place
        self.address = code.base + place
        self.placed: Placed = code.text.placed[place]
        self.node: Statement = self.placed.node
        self.next = self.address + 1
        self.host = machine.host
        self.values = machine.values
        self.scope = code.scope
        self.translator = code.translator

    def function(self, body: list[ast.stmt]) -> Callable[..., Any]:
        """Compile statements that belong to this statement."""
        return self.machine.build.function(body, self.placed, self.code.text.source)

    def then(self, action: Callable[[], object]) -> Operation:
        """Return the operation that carries out `action` and goes on with the next statement."""
        following = self.next

        def operation() -> int:
            action()
            return following

        return operation

    def jump(self, address: int) -> Operation:
        """Return the operation that only goes on elsewhere."""
        return lambda: address

    @property
    def partner(self) -> int:
        """Address of the statement that closes, divides or opens the block of this one."""
        return self.code.base + self.code.text.structure.partner[self.place]

    def real(self, node: Expr) -> Callable[[], float]:
        """Return a function that evaluates a real expression."""
        value = literal(node)
        if value is not None:
            return lambda: value
        quantity = scalar_quantity(self.scope, node)
        if quantity is not None:
            cells, slot = self.values.cells, quantity.slot
            return lambda: cells[slot]
        return self.function([py.return_value(self.translator.real(node))])

    def value(self, node: Expr) -> tuple[Callable[[], complex], Kind]:
        """Return a function that evaluates any scalar expression, and the kind of its value."""
        if literal(node) is not None:
            return self.real(node), Kind.REAL
        code, kind = self.translator.finite(node)
        return self.function([py.return_value(code)]), kind

    def truncated(self, node: Expr) -> Callable[[], int]:
        """Return a function that evaluates an expression and truncates its value."""
        value = self.real(node)

        def evaluate() -> int:
            number = value()
            truncated = whole(number)
            if truncated is None:
                raise ScriptFault("integer-overflow", node, value=f"{number:g}")
            return truncated

        return evaluate

    def slot(self, target: Target) -> tuple[Callable[[], int], Kind]:
        """Return a function that gives a scalar target's slot (marking it defined), and the target's kind."""
        code, kind = self.slot_code(target)
        if isinstance(code, ast.Constant):
            slot = py.constant_slot(code)
            defined = self.values.defined

            def constant() -> int:
                if slot < SCALAR_SLOTS:
                    defined[slot] = 1
                return slot

            return constant, kind
        body: list[ast.stmt] = [py.return_value(code)]
        meaning = self.scope.dummies.get(target.name)
        if isinstance(meaning, Reference):
            body.insert(0, py.expression_statement(py.call("mark", py.load(meaning.variable))))
        return self.function(body), kind

    def slot_code(self, target: Target) -> tuple[ast.expr, Kind]:
        """Return code for the slot of a scalar or an element that is assigned, and its kind."""
        if isinstance(target, Element):
            quantity = self.scope.array(target)
            return element_slot(self.translator, target, quantity), quantity.kind
        meaning = self.scope.assigned(target)
        if isinstance(meaning, Reference):
            box = py.index(meaning.variable, py.number(0))
            return at(box, target), meaning.kind
        if meaning.shape:
            raise self.scope.whole_array(target, meaning)
        return py.number(meaning.slot), meaning.kind

    def require_memory(self, numbers: int, part: Node) -> None:
        """Refuse a statement that would fill the machine's memory for a moment (error 40)."""
        if numbers > self.values.spare:
            raise ScriptFault("out-of-memory", part, elements=numbers)

    def numbers(self, quantity: Quantity) -> NDArray[np.float64]:
        """Return a real array's numbers in its shape, sharing memory."""
        slot = quantity.slot
        return self.values.data[slot : slot + quantity.size].reshape(quantity.shape)

    def array(self, node: Expr, *, real: bool = True) -> Quantity:
        """Return the array that an argument names; errors 19 and 84."""
        if not isinstance(node, Name):
            raise ScriptFault("array-name-expected", node)
        quantity = self.scope.array(node)
        if real and quantity.kind is Kind.COMPLEX:
            raise ScriptFault("complex-not-possible", node)
        return quantity
