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
from typing import TYPE_CHECKING, Any

from desire_tui.engine.codegen.stiff.ir_builder import INT, POINTER, REAL, VOID, FixedFunction
from desire_tui.engine.codegen.stiff.plain_expressions import Array, PlainExpressions, Surroundings

if TYPE_CHECKING:
    import ctypes
    from collections.abc import Mapping, Sequence

    from llvmlite import ir

_KINDS = {"int": INT, "float": REAL}


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
        self._module, self._prefix = module, prefix
        found = [
            (node, constants)
            for text, constants in sources.items()
            for node in ast.parse(text).body
            if isinstance(node, ast.FunctionDef)
        ]
        self.functions = {node.name: self._declare(node) for node, _ in found}
        for node, constants in found:
            around = Surroundings(structure, natives, known, self.functions, constants)
            _Body(around, self.functions[node.name]).write(node)

    def _declare(self, node: ast.FunctionDef) -> FixedFunction:
        arguments = [_KINDS.get(_name(argument.annotation), POINTER) for argument in node.args.args]
        return FixedFunction(
            self._module, self._prefix + node.name, _KINDS.get(_name(node.returns), VOID), arguments
        )


class _Body(PlainExpressions):
    """Writes one function."""

    def __init__(self, around: Surroundings, function: FixedFunction) -> None:
        super().__init__(around, function)
        self._loops: list[tuple[Any, Any]] = []

    def write(self, node: ast.FunctionDef) -> None:
        """Write all of it."""
        for argument, value in zip(node.args.args, self._f.arguments, strict=True):
            kind = _name(argument.annotation)
            if kind == self._around.structure.__name__:
                self._structures[argument.arg] = value
            elif kind in _KINDS:
                self._assign(ast.Name(argument.arg), value)
            else:
                self._assign(ast.Name(argument.arg), Array(value, REAL if kind == "Reals" else INT))
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


def _name(annotation: ast.expr | None) -> str:
    """Return the name of a type; None's is empty."""
    return annotation.id if isinstance(annotation, ast.Name) else ""
