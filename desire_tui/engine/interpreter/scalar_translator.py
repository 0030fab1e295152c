"""What a translator of scalar expressions offers to the parts that translate calls and subscripts for it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.python_ast import Typed, at
from desire_tui.engine.nodes.expressions import Binary, Call, Unary
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    import ast

    from desire_tui.engine.interpreter.compile_python import PythonCompiler
    from desire_tui.engine.interpreter.name_resolution import NameScope
    from desire_tui.engine.nodes.expressions import Expr


class ScalarTranslator(ABC):
    """Translates expressions to Python within one scope."""

    def __init__(self, scope: NameScope, build: PythonCompiler) -> None:
        self.scope = scope
        self.build = build

    @abstractmethod
    def within(self, scope: NameScope) -> ScalarTranslator:
        """Return a translator of the same program within another scope."""

    @abstractmethod
    def expression(self, node: Expr) -> Typed:
        """Translate an expression."""

    def real(self, node: Expr) -> ast.expr:
        """Translate an expression that must be real; error 84 for a COMPLEX one."""
        code, kind = self.finite(node)
        if kind is Kind.COMPLEX:
            raise ScriptFault("complex-not-possible", node)
        return code

    def finite(self, node: Expr) -> Typed:
        """Translate an expression whose value goes where an infinite one would vanish; error 3 then.

        Divisors, arguments and relations are such places: `1/(x*y)` must not be 0 because x*y is too large.
        """
        code, kind = self.expression(node)
        if not self._may_overflow(node):
            return Typed(code, kind)
        value = self.build.fresh("v")
        difference = py.binary(
            py.assign_inline(value, code), py.SUBTRACT, py.load(value)
        )  # 0 but for inf and nan
        fits = py.compare(difference, [py.EQUAL], [py.number(0.0)])
        return Typed(py.if_else(fits, py.load(value), at(py.call("overflow"), node)), kind)

    def _may_overflow(self, node: Expr) -> bool:
        match node:
            case Unary(_, operand):
                return self._may_overflow(operand)
            case Call(name):
                return name in self.scope.functions
        return isinstance(node, Binary)
