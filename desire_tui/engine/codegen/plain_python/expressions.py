"""Expressions of plain Python as LLVM instructions."""

from __future__ import annotations

import ast
import enum
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn

from desire_tui.engine.codegen.ir.text import IrText, literal
from desire_tui.engine.codegen.plain_python.kinds import (
    ADDRESS,
    FLAG,
    INT,
    INT32,
    NUMBERS,
    REAL,
    Kind,
    Value,
    of_field,
)
from desire_tui.engine.codegen.plain_python.refusal import PlainPythonError

if TYPE_CHECKING:
    from collections.abc import Callable

    from desire_tui.engine.codegen.plain_python.surroundings import Surroundings

_ARITHMETIC = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}
WHOLE = {ast.Eq: "eq", ast.NotEq: "ne", ast.Lt: "slt", ast.LtE: "sle", ast.Gt: "sgt", ast.GtE: "sge"}
FLOATING = {ast.Eq: "oeq", ast.NotEq: "une", ast.Lt: "olt", ast.LtE: "ole", ast.Gt: "ogt", ast.GtE: "oge"}
"""NaN is unequal to everything and compares with nothing, as in Python."""
_BITS = 63


class Variable(NamedTuple):
    """A local variable: its cell, or the value of an argument that never changes."""

    cell: str
    value: str
    kind: Kind


class Expressions:
    """Writes one function's expressions, but for calls."""

    def __init__(self, around: Surroundings, function: str, text: IrText) -> None:
        self.around, self.function, self.text = around, function, text
        self.variables: dict[str, Variable] = {}
        self.local: set[str] = set()
        """Names that the function assigns anywhere: Python looks nowhere else for them."""
        self.assigned: set[str] = set()
        """Those that have a value here on every way."""

    def refuse(self, node: ast.AST, what: str) -> NoReturn:
        """Report a construct."""
        place = f"{self.around.constants.get('__name__', '')} line {getattr(node, 'lineno', '?')}"
        raise PlainPythonError(f"{place}, {self.function}: {what}".strip())

    def value(self, node: ast.expr) -> Value:
        """Write an expression that has a value."""
        write: Callable[[Any], Value] | None = getattr(self, f"_get_{type(node).__name__.lower()}", None)
        if write is None:
            self.refuse(node, f"the expression '{ast.unparse(node)}' ({type(node).__name__})")
        return write(node)

    def number(self, node: ast.expr) -> Value:
        """Write an expression whose value is a number."""
        found = self.value(node)
        if found.kind not in NUMBERS:
            self.refuse(node, f"'{ast.unparse(node)}' is {found.kind}, no number")
        return found

    def whole(self, node: ast.expr) -> Value:
        """Write an expression whose value is a whole number."""
        found = self.value(node)
        if found.kind != INT:
            self.refuse(node, f"'{ast.unparse(node)}' is {found.kind}, no whole number")
        return found

    def condition(self, node: ast.expr) -> str:
        """Write a test; return an i1."""
        if isinstance(node, ast.BoolOp):
            return self._short_circuit(node, self.condition)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            return self.text.op(f"xor i1 {self.condition(node.operand)}, true")
        found = self.value(node)
        if found.kind == FLAG:
            return found.text
        if found.kind != INT:
            self.refuse(node, f"the truth of '{ast.unparse(node)}', which is {found.kind}")
        return self.text.op(f"icmp ne i64 {found.text}, 0")

    def convert(self, value: Value, kind: Kind, node: ast.expr | ast.stmt) -> str:
        """Return the value as another type that holds it exactly."""
        if value.kind == kind or (value.kind.ir == kind.ir == "ptr" and kind == ADDRESS):
            return value.text
        if value.kind == FLAG and kind in {INT, REAL, INT32}:
            value = Value(self.text.op(f"zext i1 {value.text} to i64"), INT)
        if value.kind == kind:
            return value.text
        if (value.kind, kind) == (INT, REAL):
            return self.text.op(f"sitofp i64 {value.text} to double")
        if (value.kind, kind) == (INT, INT32):
            return self.text.op(f"trunc i64 {value.text} to i32")
        return self.refuse(node, f"'{ast.unparse(node)}' is {value.kind}, wanted is {kind}")

    def load(self, place: str, kind: Kind) -> Value:
        """Read memory."""
        return self.widened(Value(self.text.op(f"load {kind.ir}, ptr {place}"), kind))

    def widened(self, value: Value) -> Value:
        """Return short whole numbers as long ones."""
        if value.kind != INT32:
            return value
        return Value(self.text.op(f"sext i32 {value.text} to i64"), INT)

    # ------------------------------------------------------------------ names and places

    def _get_constant(self, node: ast.Constant) -> Value:
        found = self._constant(node.value)
        return found or self.refuse(node, f"the constant {node.value!r}")

    @staticmethod
    def _constant(value: object) -> Value | None:
        if isinstance(value, bool):
            return Value("true" if value else "false", FLAG)
        if isinstance(value, int):
            return Value(str(int(value)), INT) if -(2**_BITS) <= value < 2**_BITS else None
        return Value(literal(value), REAL) if isinstance(value, float) else None

    def _get_name(self, node: ast.Name) -> Value:
        if node.id in self.local:
            if node.id not in self.assigned:
                self.refuse(node, f"'{node.id}' may be read before it is set")
            variable = self.variables[node.id]
            if not variable.cell:
                return Value(variable.value, variable.kind)
            return Value(self.text.op(f"load {variable.kind.ir}, ptr {variable.cell}"), variable.kind)
        if node.id not in self.around.constants:
            self.refuse(node, f"unknown name '{node.id}'")
        found = self._constant(self.around.constants[node.id])
        return found or self.refuse(node, f"'{node.id}' is no constant number")

    def _get_attribute(self, node: ast.Attribute) -> Value:
        if isinstance(node.value, ast.Name) and node.value.id not in self.local:
            group = self.around.constants.get(node.value.id)
            if isinstance(group, type) and issubclass(group, enum.IntEnum) and node.attr in group.__members__:
                return Value(str(int(group[node.attr])), INT)
        place, kind, inside = self.field(node)
        known = self.around.outside.known.get(node.attr)
        if known is not None:
            return Value("null", kind) if kind.ir == "ptr" and known == 0 else Value(str(known), INT)
        return Value(place, kind) if inside else self.load(place, kind)

    def field(self, node: ast.Attribute) -> tuple[str, Kind, bool]:
        """Return a field's place and type, and whether it is an array that stands in the structure itself."""
        base = self.value(node.value)
        structure = base.kind.structure
        if structure is None:
            self.refuse(node, f"'{ast.unparse(node.value)}' is no structure")
        declared = {entry[0]: entry[1] for entry in structure._fields_}.get(node.attr)
        kind = of_field(declared)
        if kind is None:
            self.refuse(node, f"the field '{ast.unparse(node)}'")
        offset = getattr(structure, node.attr).offset
        place = self.text.op(f"getelementptr i8, ptr {base.text}, i64 {offset}")
        return place, kind, hasattr(declared, "_length_")

    def element(self, node: ast.Subscript) -> tuple[str, Kind]:
        """Return an array element's place and type."""
        array = self.value(node.value)
        if not array.kind.of:
            self.refuse(node, f"'{ast.unparse(node.value)}' is {array.kind}, no array")
        if isinstance(node.slice, ast.UnaryOp):
            self.refuse(node, "an index from the array's end")
        index = self.whole(node.slice)
        kind = Kind(array.kind.of)
        return self.text.op(f"getelementptr {kind.ir}, ptr {array.text}, i64 {index.text}"), kind

    def _get_subscript(self, node: ast.Subscript) -> Value:
        return self.load(*self.element(node))

    # ------------------------------------------------------------------ operations

    def _get_binop(self, node: ast.BinOp) -> Value:
        return self.operate(node, node.op, self.number(node.left), self.number(node.right))

    def operate(self, node: ast.AST, op: ast.operator, left: Value, right: Value) -> Value:
        """Write an operation between two numbers."""
        if isinstance(op, ast.Pow):
            if left.kind != REAL:
                self.refuse(node, "a power of a whole number")
            self.text.declarations.add("declare double @llvm.pow.f64(double, double)")
            arguments = f"double {left.text}, double {self.as_real(right)}"
            return Value(self.text.op(f"call double @llvm.pow.f64({arguments})"), REAL)
        if isinstance(op, ast.Div):
            return Value(self.text.op(f"fdiv double {self.as_real(left)}, {self.as_real(right)}"), REAL)
        name = _ARITHMETIC.get(type(op))
        if name is None:
            self.refuse(node, f"the operator {type(op).__name__}")
        first, second, kind = self.alike(left, right)
        return Value(self.text.op(f"{'f' * (kind == REAL)}{name} {kind.ir} {first}, {second}"), kind)

    def alike(self, left: Value, right: Value) -> tuple[str, str, Kind]:
        """Return both as the same type, REAL or INT."""
        if REAL in {left.kind, right.kind}:
            return self.as_real(left), self.as_real(right), REAL
        return self.as_int(left), self.as_int(right), INT

    def as_int(self, value: Value) -> str:
        """Return a whole number or a truth value as a whole number."""
        return self.text.op(f"zext i1 {value.text} to i64") if value.kind == FLAG else value.text

    def as_real(self, value: Value) -> str:
        """Return a number as a float."""
        if value.kind == REAL:
            return value.text
        return self.text.op(f"sitofp i64 {self.as_int(value)} to double")

    def _get_unaryop(self, node: ast.UnaryOp) -> Value:
        if isinstance(node.op, ast.Not):
            return Value(self.condition(node), FLAG)
        if not isinstance(node.op, ast.USub):
            self.refuse(node, f"the operator {type(node.op).__name__}")
        value = self.number(node.operand)
        if value.kind == REAL:
            return Value(self.text.op(f"fneg double {value.text}"), REAL)
        return Value(self.text.op(f"sub i64 0, {self.as_int(value)}"), INT)

    def _get_compare(self, node: ast.Compare) -> Value:
        if len(node.ops) != 1:
            self.refuse(node, f"the chained comparison '{ast.unparse(node)}'")
        (op,), (right_node,) = node.ops, node.comparators
        if type(op) not in WHOLE:
            self.refuse(node, f"the comparison {type(op).__name__}")
        left = self.value(node.left)
        if left.kind == ADDRESS and isinstance(op, ast.Eq | ast.NotEq) and _is_zero(right_node):
            return Value(self.text.op(f"icmp {WHOLE[type(op)]} ptr {left.text}, null"), FLAG)
        if left.kind not in NUMBERS:
            self.refuse(node, f"a comparison of {left.kind}")
        first, second, kind = self.alike(left, self.number(right_node))
        if kind == REAL:
            return Value(self.text.op(f"fcmp {FLOATING[type(op)]} double {first}, {second}"), FLAG)
        return Value(self.text.op(f"icmp {WHOLE[type(op)]} i64 {first}, {second}"), FLAG)

    def _get_boolop(self, node: ast.BoolOp) -> Value:
        return Value(self._short_circuit(node, self._flag), FLAG)

    def _flag(self, node: ast.expr) -> str:
        """Write an operand where a value is wanted: of other things `and` returns one of them."""
        found = self.value(node)
        if found.kind != FLAG:
            self.refuse(node, f"'{ast.unparse(node)}' in 'and' or 'or' is {found.kind}, no truth value")
        return found.text

    def _short_circuit(self, node: ast.BoolOp, write: Callable[[ast.expr], str]) -> str:
        """Write operands until one decides."""
        text = self.text
        end = f"{text.fresh()}.decided"
        decides = "false" if isinstance(node.op, ast.And) else "true"
        incoming = []
        for operand in node.values[:-1]:
            found, following = write(operand), f"{text.fresh()}.next"
            incoming.append(f"[ {decides}, %{text.label} ]")
            text.branch(found, *((following, end) if decides == "false" else (end, following)))
            text.begin(following)
        found = write(node.values[-1])
        incoming.append(f"[ {found}, %{text.label} ]")
        text.jump(end)
        text.begin(end)
        return text.op(f"phi i1 {', '.join(incoming)}")

    def _get_ifexp(self, node: ast.IfExp) -> Value:
        text = self.text
        stem = text.fresh()
        text.branch(self.condition(node.test), f"{stem}.yes", f"{stem}.no")
        incoming, kinds = [], []
        for way, part in (("yes", node.body), ("no", node.orelse)):
            text.begin(f"{stem}.{way}")
            found = self.number(part)
            kinds.append(found.kind)
            incoming.append(f"[ {found.text}, %{text.label} ]")
            text.jump(f"{stem}.chosen")
        if kinds[0] != kinds[1]:
            self.refuse(node, f"'{ast.unparse(node)}' is {kinds[0]} or {kinds[1]}")
        text.begin(f"{stem}.chosen")
        return Value(text.op(f"phi {kinds[0].ir} {', '.join(incoming)}"), kinds[0])


def _is_zero(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value == 0 and isinstance(node.value, int)
