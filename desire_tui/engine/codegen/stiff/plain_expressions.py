"""Expressions of plain Python as LLVM instructions (`plain_python` has the statements, and what is known)."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Any, NamedTuple

from desire_tui.engine.codegen.stiff.ir_builder import FLAG, INT, POINTER, REAL, FixedFunction

if TYPE_CHECKING:
    import ctypes
    from collections.abc import Mapping

_ARITHMETIC = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}
_COMPARISONS = {ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}


class Array(NamedTuple):
    """A pointer and what it points at."""

    address: Any
    of: Any


class _Variable(NamedTuple):
    place: Any
    type: Any
    of: Any = None
    """Of an array's elements."""


class Surroundings(NamedTuple):
    """What a function's text may refer to besides its own names."""

    structure: type[ctypes.Structure]
    natives: Mapping[str, Any]
    """For a function pointer of the structure the IR function that it always points at."""
    known: Mapping[str, int]
    """Whole-numbered fields that always have this value."""
    functions: Mapping[str, FixedFunction]
    constants: Mapping[str, Any]


class PlainExpressions:
    """Writes one function's expressions, and the assignments that make its variables."""

    def __init__(self, around: Surroundings, function: FixedFunction) -> None:
        self._around, self._f = around, function
        self._build = function.build
        self._variables: dict[str, _Variable] = {}
        self._structures: dict[str, Any] = {}

    def _assign(self, target: ast.expr, value: Any) -> None:
        if isinstance(target, ast.Name):
            if target.id not in self._variables:
                of = value.of if isinstance(value, Array) else None
                kind = POINTER if of else REAL if value.type == REAL else INT
                with self._build.goto_entry_block():
                    self._variables[target.id] = _Variable(self._build.alloca(kind), kind, of)
            variable = self._variables[target.id]
            value = value.address if isinstance(value, Array) else self._as(value, variable.type)
            self._build.store(value, variable.place)
        elif isinstance(target, ast.Attribute):
            place, kind = self._field(target)
            self._build.store(self._as(value, kind), place)
        else:
            assert isinstance(target, ast.Subscript)
            place, kind = self._element(target)
            self._build.store(self._as(value, kind), place)

    def _value(self, node: ast.expr) -> Any:
        return getattr(self, f"_get_{type(node).__name__.lower()}")(node)

    def _get_constant(self, node: ast.Constant) -> Any:
        assert isinstance(node.value, int | float)  # bool is an int
        return REAL(node.value) if isinstance(node.value, float) else INT(int(node.value))

    def _get_name(self, node: ast.Name) -> Any:
        if node.id not in self._variables:
            return self._get_constant(ast.Constant(self._around.constants[node.id]))
        variable = self._variables[node.id]
        value = self._build.load(variable.place, typ=variable.type)
        return Array(value, variable.of) if variable.of else value

    def _get_attribute(self, node: ast.Attribute) -> Any:
        if node.attr in self._around.known:
            return INT(self._around.known[node.attr])
        place, kind = self._field(node)
        declared = dict(self._around.structure._fields_)[node.attr]  # type: ignore[arg-type] # ctypes' own
        if hasattr(declared, "_length_"):
            return Array(place, REAL)
        value = self._build.load(place, typ=kind)
        code = getattr(getattr(declared, "_type_", None), "_type_", None)
        return Array(value, {"d": REAL, "l": INT}[code]) if code else value

    def _field(self, node: ast.Attribute) -> tuple[Any, Any]:
        assert isinstance(node.value, ast.Name)
        return self._f.field(self._structures[node.value.id], node.attr, self._around.structure)

    def _element(self, node: ast.Subscript) -> tuple[Any, Any]:
        array = self._value(node.value)
        return self._f.at(array.address, self._value(node.slice), array.of), array.of

    def _get_subscript(self, node: ast.Subscript) -> Any:
        place, kind = self._element(node)
        return self._build.load(place, typ=kind)

    def _get_binop(self, node: ast.BinOp) -> Any:
        return self._operate(node.op, self._value(node.left), self._value(node.right))

    def _operate(self, op: ast.operator, left: Any, right: Any) -> Any:
        if isinstance(op, ast.Pow):
            return self._f.intrinsic("llvm.pow", self._as(left, REAL), self._as(right, REAL))
        if isinstance(op, ast.Div):
            return self._build.fdiv(self._as(left, REAL), self._as(right, REAL))
        left, right, real = self._alike(left, right)
        return getattr(self._build, ("f" if real else "") + _ARITHMETIC[type(op)])(left, right)

    def _get_unaryop(self, node: ast.UnaryOp) -> Any:
        value = self._value(node.operand)
        if isinstance(node.op, ast.Not):
            return self._build.not_(self._truth(value))
        assert isinstance(node.op, ast.USub)
        return self._build.fneg(value) if value.type == REAL else self._build.neg(value)

    def _get_compare(self, node: ast.Compare) -> Any:
        left, right, real = self._alike(self._value(node.left), self._value(node.comparators[0]))
        sign = _COMPARISONS[type(node.ops[0])]
        if not real:
            return self._build.icmp_signed(sign, left, right)
        # NaN is unequal to everything and compares with nothing, as in Python
        compare = self._build.fcmp_unordered if sign == "!=" else self._build.fcmp_ordered
        return compare(sign, left, right)

    def _get_boolop(self, node: ast.BoolOp) -> Any:
        first, *others = (self._truth(self._value(value)) for value in node.values)
        for other in others:
            first = (self._build.and_ if isinstance(node.op, ast.And) else self._build.or_)(first, other)
        return first

    def _get_ifexp(self, node: ast.IfExp) -> Any:
        left, right, _ = self._alike(self._value(node.body), self._value(node.orelse))
        return self._build.select(self._truth(self._value(node.test)), left, right)

    def _get_call(self, node: ast.Call) -> Any:
        arguments = [self._argument(argument) for argument in node.args]
        if isinstance(node.func, ast.Attribute):
            return self._build.sext(self._build.call(self._around.natives[node.func.attr], arguments), INT)
        assert isinstance(node.func, ast.Name)
        name = node.func.id
        if name in {"abs", "sqrt"}:
            return self._f.intrinsic({"abs": "llvm.fabs", "sqrt": "llvm.sqrt"}[name], *arguments)
        if name in {"min", "max"}:
            best, *others = arguments
            for other in others:
                best = self._better("<" if name == "min" else ">", best, other)
            return best
        callee = self._around.functions[name].function
        cast = [self._as(a, k.type) for a, k in zip(arguments, callee.args, strict=True)]
        return self._build.call(callee, cast)

    def _better(self, sign: str, best: Any, other: Any) -> Any:
        """Return `best` unless `other` is truly better, as Python does."""
        best, other, real = self._alike(best, other)
        compare = self._build.fcmp_ordered if real else self._build.icmp_signed
        return self._build.select(compare(sign, other, best), other, best)

    def _argument(self, node: ast.expr) -> Any:
        if isinstance(node, ast.Name) and node.id in self._structures:
            return self._structures[node.id]
        value = self._value(node)
        return value.address if isinstance(value, Array) else value

    def _alike(self, left: Any, right: Any) -> tuple[Any, Any, bool]:
        kind = REAL if REAL in {left.type, right.type} else INT
        return self._as(left, kind), self._as(right, kind), kind == REAL

    def _as(self, value: Any, kind: Any) -> Any:
        if value.type == kind:
            return value
        if value.type == FLAG:
            value = self._build.zext(value, INT)
        assert kind in {INT, REAL}, f"{value.type} is no {kind}"
        assert value.type == INT, f"{value.type} would be rounded"
        return self._build.sitofp(value, REAL) if kind == REAL else value

    def _truth(self, value: Any) -> Any:
        return value if value.type == FLAG else self._build.icmp_signed("!=", value, INT(0))
