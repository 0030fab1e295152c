"""Expressions and conditions become Python syntax trees that read the values directly.

Names are looked up once, when a statement runs for the first time: a name that has a value keeps it until all
names are cleared, so generated code need not ask again. The place of each node goes along
(see `exception_mapping`).
"""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, assert_never

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.calls import CallTranslator
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.name_resolution import Local, NameScope, Reference
from desire_tui.engine.interpreter.python_ast import Typed, at
from desire_tui.engine.interpreter.scalar_translator import ScalarTranslator
from desire_tui.engine.interpreter.subscripts import element_slot
from desire_tui.engine.left_chains import LONG, PIECE, chain, is_long
from desire_tui.engine.nodes.expressions import (
    Binary,
    Call,
    Element,
    Logical,
    Name,
    Not,
    Number,
    Pair,
    Relation,
    RowOf,
    Shifted,
    Text,
    Transposed,
    Truth,
    Unary,
)
from desire_tui.engine.nodes.signs import whole_power
from desire_tui.engine.values import Kind, Quantity

if TYPE_CHECKING:
    from desire_tui.engine.interpreter.compile_python import PythonCompiler
    from desire_tui.engine.interpreter.user_functions import UserFunctions
    from desire_tui.engine.nodes.expressions import Condition, Expr
    from desire_tui.engine.nodes.record import Node

_ARITHMETIC: dict[str, ast.operator] = {"+": py.ADD, "-": py.SUBTRACT, "*": py.MULTIPLY, "/": py.DIVIDE}
_RELATIONS: dict[str, ast.cmpop] = {
    "=": py.EQUAL, "<": ast.Lt(), ">": ast.Gt(), "<=": ast.LtE(), ">=": ast.GtE(), "<>": ast.NotEq(),
}  # fmt: skip


class ExpressionTranslator(ScalarTranslator):
    """Translates within one scope."""

    def __init__(self, scope: NameScope, build: PythonCompiler, functions: UserFunctions) -> None:
        super().__init__(scope, build)
        self._functions = functions
        self._calls = CallTranslator(self, functions)

    def within(self, scope: NameScope) -> ExpressionTranslator:
        """Return a translator of the same program within another scope."""
        return ExpressionTranslator(scope, self.build, self._functions)

    def expression(self, node: Expr) -> Typed:
        """Translate an expression."""
        match node:
            case Number(value):
                return Typed(py.number(value), Kind.REAL)
            case Name():
                return self._name(node)
            case Element():
                return self._element(node)
            case Binary(op="^"):
                return self._power(node)
            case Binary():
                return self._chain(node)
            case Unary(op, operand):
                code, kind = self.expression(operand)
                return Typed(code if op == "+" else at(py.unary(py.MINUS, code), node), kind)
            case Pair(re, im):
                return Typed(at(py.call("complex", self.real(re), self.real(im)), node), Kind.COMPLEX)
            case Call():
                return self._calls.call(node)
            case Truth(condition):
                one_or_zero = py.if_else(self.condition(condition), py.number(1.0), py.number(0.0))
                return Typed(at(one_or_zero, node), Kind.REAL)
            case Text() | Transposed() | Shifted() | RowOf():
                raise ScriptFault("not-in-scalar-expression", node)
        assert_never(node)

    def condition(self, node: Condition) -> ast.expr:
        """Translate a condition; `and` and `or` stop as soon as the answer is known."""
        match node:
            case Relation(op, left, right):
                (a, kind_a), (b, kind_b) = self.finite(left), self.finite(right)
                if Kind.COMPLEX in {kind_a, kind_b} and op not in {"=", "<>"}:
                    raise ScriptFault("complex-not-ordered", node, operator=op)
                return at(py.compare(a, [_RELATIONS[op]], [b]), node)
            case Logical(op, first, second):
                joint: ast.boolop = ast.And() if op == "and" else ast.Or()
                return at(py.and_or(joint, [self.condition(first), self.condition(second)]), node)
            case Not(operand):
                return at(py.unary(py.NOT, self.condition(operand)), node)

    def _name(self, node: Name) -> Typed:
        meaning = self.scope.read(node)
        if isinstance(meaning, Local):
            return Typed(py.load(meaning.variable), meaning.kind)
        if isinstance(meaning, Reference):
            return self._reference(node, meaning)
        if meaning.shape:
            raise self.scope.whole_array(node, meaning)
        return self.stored(node, py.number(meaning.slot), meaning.kind)

    def _reference(self, node: Name, meaning: Reference) -> Typed:
        slot = py.index(meaning.variable, py.number(0))
        flag = py.index(meaning.variable, py.number(1))
        missing = at(py.call("undefined", py.text(node.name)), node)
        value, kind = self.stored(node, slot, meaning.kind)
        return Typed(at(py.if_else(flag, value, missing), node), kind)

    def _element(self, node: Element) -> Typed:
        quantity = self.scope.array(node)
        return self.stored(node, element_slot(self, node, quantity), quantity.kind)

    def stored(self, node: Node, slot: ast.expr, kind: Kind) -> Typed:
        """Return code that reads a number, or two that make a complex number."""
        if kind is Kind.COMPLEX:
            return Typed(at(py.call("complex_at", slot), node), kind)
        return Typed(at(py.cell(slot), node), kind)

    def _chain(self, node: Binary) -> Typed:
        """Translate sums and products. Python compiles no deep trees: a long chain is computed in pieces.

        The pieces are items of a tuple, `(v := a + b + …, v + c + …)[-1]`: evaluated in their order.
        """
        first, steps = chain(node)
        result = self.expression(first)
        pieces: list[ast.expr] = []
        levels = LONG if is_long(first) else 0
        for step in steps:
            deep = is_long(step.right)
            if step.op == "&":
                raise ScriptFault("matrix-operator", step, operator="&")
            if levels >= PIECE or (deep and levels):
                name = self.build.fresh("v")
                pieces.append(py.assign_inline(name, result.code))
                result, levels = Typed(py.load(name), result.kind), 0
            right = self.finite(step.right) if step.op == "/" else self.expression(step.right)
            result = self._arithmetic(step, step.op, result, right)
            levels = LONG if deep else levels + 1
        return Typed(py.last_of([*pieces, result.code]), result.kind) if pieces else result

    def _arithmetic(self, node: Node, op: str, left: Typed, right: Typed) -> Typed:
        kinds = {left.kind, right.kind}
        kind = Kind.REAL
        if Kind.COMPLEX in kinds:
            kind = Kind.COMPLEX
        elif kinds == {Kind.INTEGER} and op != "/":
            kind = Kind.INTEGER
        return Typed(at(py.binary(left.code, _ARITHMETIC[op], right.code), node), kind)

    def _power(self, node: Binary) -> Typed:
        base, kind = self.finite(node.left)
        exponent = whole_power(node.right)
        if exponent is not None:
            if exponent == 1:
                return Typed(base, kind)
            if exponent == 2:
                once = self.build.fresh("v")
                first = py.assign_inline(once, base)
                return Typed(at(py.binary(first, py.MULTIPLY, py.load(once)), node), kind)
            result = kind if exponent > 0 else Kind.COMPLEX if kind is Kind.COMPLEX else Kind.REAL
            return Typed(at(py.call("integer_power", base, py.number(exponent)), node), result)
        if kind is Kind.COMPLEX:
            raise ScriptFault("complex-power", node)
        return Typed(at(py.call("power", base, self.real(node.right)), node), Kind.REAL)


def scalar_quantity(scope: NameScope, node: Expr) -> Quantity | None:
    """Return the real scalar that an expression consists of, None for anything else."""
    if not isinstance(node, Name):
        return None
    meaning = scope.find(node.name)
    simple = isinstance(meaning, Quantity) and not meaning.shape and meaning.kind is not Kind.COMPLEX
    return meaning if simple and isinstance(meaning, Quantity) else None
