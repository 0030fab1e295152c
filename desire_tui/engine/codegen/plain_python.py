"""Compiles functions written in a small part of Python, so that an algorithm has one readable text.

`integration.bdf` is that text: it runs as it stands in Python (the tests do so) and natively, compiled here.
Known are: numbers, pointers to doubles and whole numbers, one kind of C structure with its fields; `=`, `+=`
and the like, `while`, `for … in range`, `if`, `break`, `continue`, `return`; arithmetic, comparisons, `and`,
`or`, `not` (all operands are evaluated), conditional expressions, `abs`, `min`, `max`, `sqrt`; calls of each
other and of function pointers in the structure. Argument and result types come from the annotations. Anything
else is a programmer's mistake: an assertion fails.
"""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Any, NamedTuple

from desire_tui.engine.codegen.stiff_builder import FLAG, INT, POINTER, REAL, VOID, Function

if TYPE_CHECKING:
    import ctypes
    from collections.abc import Mapping, Sequence

    from llvmlite import ir

_KINDS = {"int": INT, "float": REAL}
_ARITHMETIC = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul"}
_COMPARISONS = {ast.Eq: "==", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}


class _Array(NamedTuple):
    """A pointer and what it points at."""

    address: Any
    of: Any


class _Variable(NamedTuple):
    place: Any
    type: Any
    of: Any = None
    """Of an array's elements."""


class PlainPython:
    """The functions of some texts, each with its constants, added to an IR module as `prefix` + name.

    `natives`: for a function pointer of the structure the IR function that it always points at;
    `known`: whole-numbered fields that always have this value.
    """

    def __init__(
        self,
        module: ir.Module,
        sources: Mapping[bytes, dict[str, Any]],
        structure: type[ctypes.Structure],
        prefix: str,
        natives: Mapping[str, Any],
        known: Mapping[str, int],
    ) -> None:
        self.module, self.structure, self.prefix = module, structure, prefix
        self.natives, self.known = natives, known
        found = [
            (node, constants)
            for text, constants in sources.items()
            for node in ast.parse(text).body
            if isinstance(node, ast.FunctionDef)
        ]
        self.functions = {node.name: self._declare(node) for node, _ in found}
        for node, constants in found:
            _Body(self, self.functions[node.name], constants).write(node)

    def _declare(self, node: ast.FunctionDef) -> Function:
        arguments = [_KINDS.get(_name(argument.annotation), POINTER) for argument in node.args.args]
        return Function(
            self.module, self.prefix + node.name, _KINDS.get(_name(node.returns), VOID), arguments
        )


class _Body:
    """Writes one function."""

    def __init__(self, library: PlainPython, function: Function, constants: dict[str, Any]) -> None:
        self._library, self._f, self._constants = library, function, constants
        self._build = function.build
        self._variables: dict[str, _Variable] = {}
        self._structures: dict[str, Any] = {}
        self._loops: list[tuple[Any, Any]] = []

    def write(self, node: ast.FunctionDef) -> None:
        """Write all of it."""
        for argument, value in zip(node.args.args, self._f.arguments, strict=True):
            kind = _name(argument.annotation)
            if kind == self._library.structure.__name__:
                self._structures[argument.arg] = value
            elif kind in _KINDS:
                self._assign(ast.Name(argument.arg), value)
            else:
                self._assign(ast.Name(argument.arg), _Array(value, REAL if kind == "Reals" else INT))
        self._block(node.body)
        if not self._build.block.is_terminated:
            self._end()

    def _end(self) -> None:
        if self._f.function.function_type.return_type == VOID:
            self._build.ret_void()
        else:
            self._build.unreachable()

    def _block(self, statements: Sequence[ast.stmt]) -> None:
        for statement in statements:
            getattr(self, f"_do_{type(statement).__name__.lower()}")(statement)

    def _do_expr(self, node: ast.Expr) -> None:
        if not isinstance(node.value, ast.Constant):  # a docstring
            self._value(node.value)

    def _do_assign(self, node: ast.Assign) -> None:
        (target,) = node.targets
        if not isinstance(target, ast.Tuple):
            self._assign(target, self._value(node.value))
            return
        assert isinstance(node.value, ast.Tuple)
        values = [self._value(value) for value in node.value.elts]
        for part, value in zip(target.elts, values, strict=True):
            self._assign(part, value)

    def _do_annassign(self, node: ast.AnnAssign) -> None:
        assert node.value is not None
        self._assign(node.target, self._as(self._value(node.value), _KINDS[_name(node.annotation)]))

    def _do_augassign(self, node: ast.AugAssign) -> None:
        old = self._value(node.target)
        self._assign(node.target, self._operate(node.op, old, self._value(node.value)))

    def _do_return(self, node: ast.Return) -> None:
        if node.value is None:
            self._build.ret_void()
            return
        self._build.ret(self._as(self._value(node.value), self._f.function.function_type.return_type))

    def _do_if(self, node: ast.If) -> None:
        then, otherwise, end = self._blocks("then", "else", "end")
        self._build.cbranch(self._truth(self._value(node.test)), then, otherwise)
        for block, statements in ((then, node.body), (otherwise, node.orelse)):
            self._build.position_at_end(block)
            self._block(statements)
            self._go(end)
        self._build.position_at_end(end)

    def _do_while(self, node: ast.While) -> None:
        head, body, end = self._blocks("while", "do", "end")
        self._build.branch(head)
        self._build.position_at_end(head)
        self._build.cbranch(self._truth(self._value(node.test)), body, end)
        self._loop(body, node.body, head, end)
        self._build.position_at_end(end)

    def _do_for(self, node: ast.For) -> None:
        head, body, again, end = self._blocks("for", "do", "next", "end")
        assert isinstance(node.iter, ast.Call)
        bounds = [self._value(argument) for argument in node.iter.args]
        start, stop = bounds if len(bounds) == 2 else (INT(0), bounds[0])
        self._assign(node.target, start)
        self._build.branch(head)
        self._build.position_at_end(head)
        self._build.cbranch(self._build.icmp_signed("<", self._value(node.target), stop), body, end)
        self._loop(body, node.body, again, end)
        self._build.position_at_end(again)
        self._assign(node.target, self._build.add(self._value(node.target), INT(1)))
        self._build.branch(head)
        self._build.position_at_end(end)

    def _loop(self, body: Any, statements: Sequence[ast.stmt], again: Any, end: Any) -> None:
        self._build.position_at_end(body)
        self._loops.append((again, end))
        self._block(statements)
        self._loops.pop()
        self._go(again)

    def _do_break(self, _node: ast.Break) -> None:
        self._build.branch(self._loops[-1][1])

    def _do_continue(self, _node: ast.Continue) -> None:
        self._build.branch(self._loops[-1][0])

    def _blocks(self, *names: str) -> list[Any]:
        return [self._f.function.append_basic_block(name) for name in names]

    def _go(self, block: Any) -> None:
        if not self._build.block.is_terminated:
            self._build.branch(block)

    def _assign(self, target: ast.expr, value: Any) -> None:
        if isinstance(target, ast.Name):
            if target.id not in self._variables:
                of = value.of if isinstance(value, _Array) else None
                kind = POINTER if of else REAL if value.type == REAL else INT
                with self._build.goto_entry_block():
                    self._variables[target.id] = _Variable(self._build.alloca(kind), kind, of)
            variable = self._variables[target.id]
            value = value.address if isinstance(value, _Array) else self._as(value, variable.type)
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
            return self._get_constant(ast.Constant(self._constants[node.id]))
        variable = self._variables[node.id]
        value = self._build.load(variable.place, typ=variable.type)
        return _Array(value, variable.of) if variable.of else value

    def _get_attribute(self, node: ast.Attribute) -> Any:
        if node.attr in self._library.known:
            return INT(self._library.known[node.attr])
        place, kind = self._field(node)
        declared = dict(self._library.structure._fields_)[node.attr]  # type: ignore[arg-type] # ctypes' own
        if hasattr(declared, "_length_"):
            return _Array(place, REAL)
        value = self._build.load(place, typ=kind)
        code = getattr(getattr(declared, "_type_", None), "_type_", None)
        return _Array(value, {"d": REAL, "l": INT}[code]) if code else value

    def _field(self, node: ast.Attribute) -> tuple[Any, Any]:
        assert isinstance(node.value, ast.Name)
        return self._f.field(self._structures[node.value.id], node.attr, self._library.structure)

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
            return self._build.sext(self._build.call(self._library.natives[node.func.attr], arguments), INT)
        assert isinstance(node.func, ast.Name)
        name = node.func.id
        if name in {"abs", "sqrt"}:
            return self._f.intrinsic({"abs": "llvm.fabs", "sqrt": "llvm.sqrt"}[name], *arguments)
        if name in {"min", "max"}:
            best, *others = arguments
            for other in others:
                best = self._better("<" if name == "min" else ">", best, other)
            return best
        callee = self._library.functions[name].function
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
        return value.address if isinstance(value, _Array) else value

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


def _name(annotation: ast.expr | None) -> str:
    """Return the name of a type; None's is empty."""
    return annotation.id if isinstance(annotation, ast.Name) else ""
