"""Calls in expressions: library functions, FUNCTIONs, table functions, random numbers."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

from desire_tui.engine.breakpoints import falling_facts
from desire_tui.engine.diagnostics import closest
from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.python_ast import Typed, at
from desire_tui.engine.library import LIBRARY, LibraryFunction
from desire_tui.engine.nodes.expressions import Name
from desire_tui.engine.values import Kind

if TYPE_CHECKING:
    import ast
    from collections.abc import Callable

    from desire_tui.engine.interpreter.scalar_translator import ScalarTranslator
    from desire_tui.engine.interpreter.user_functions import UserFunctions
    from desire_tui.engine.nodes.expressions import Call, Expr
    from desire_tui.engine.values import Quantity


class CallTranslator:
    """Translates calls for the translator of an expression."""

    def __init__(self, translator: ScalarTranslator, functions: UserFunctions) -> None:
        self.translator = translator
        self.build = translator.build
        self.functions = functions

    def call(self, node: Call) -> Typed:
        """Translate a call; a program's own FUNCTION wins over the library."""
        if node.name in self.functions.definitions:
            return self.functions.call(node, self.translator)
        entry = LIBRARY.get(node.name)
        if entry is None:
            known = [*LIBRARY, *self.functions.definitions]
            raise ScriptFault("undefined-function", node, name=node.name, close=closest(node.name, known))
        if "S" not in entry.where:
            raise ScriptFault("segment-function", node, name=node.name)
        if not entry.fewest <= len(node.args) <= entry.most:
            facts = {"given": len(node.args), "needed": entry.parameters}
            raise ScriptFault("argument-count", node, name=node.name, **facts)
        match entry.kind:
            case "random":
                return Typed(at(py.call(node.name), node), Kind.REAL)
            case "time":
                self.build.names.setdefault("tim", time.process_time)
                return Typed(at(py.call("tim"), node), Kind.REAL)
            case "table":
                return Typed(self._table(node, entry), Kind.REAL)
            case "complex":
                return self._complex(node, entry)
        args = [self.translator.real(arg) for arg in node.args]
        return Typed(at(py.call(self._shared(entry), *args), node), Kind.REAL)

    def _shared(self, entry: LibraryFunction) -> str:
        name = f"f_{entry.name}"
        self.build.names.setdefault(name, entry.value)
        return name

    def _complex(self, node: Call, entry: LibraryFunction) -> Typed:
        argument, kind = self.translator.finite(node.args[0])
        result = Kind.COMPLEX if entry.gives_complex else Kind.REAL
        if node.name == "exp" and kind is not Kind.COMPLEX:
            self.build.names.setdefault("real_exp", math.exp)
            return Typed(at(py.call("real_exp", argument), node), Kind.REAL)
        if node.name == "exp":
            result = Kind.COMPLEX
        return Typed(at(py.call(self._shared(entry), argument), node), result)

    def _table(self, node: Call, entry: LibraryFunction) -> ast.expr:
        tables = 1 if node.name == "func1" else 3
        args = [self.translator.real(arg) for arg in node.args[:-tables]]
        arrays = [self._array(arg) for arg in node.args[-tables:]]
        if node.name == "func1":
            table = arrays[0]
            if len(table.shape) != 1 or table.size % 2:
                raise ScriptFault("table-shape", node.args[-1], name=table.name)
        else:
            f, x, y = arrays
            if f.shape != (x.size, y.size):
                raise ScriptFault("table2-shape", node, name=f.name, rows=x.size, columns=y.size)
        cells = self.build.values.cells
        views = [py.load(self.build.share("a", cells[q.slot : q.slot + q.slots])) for q in arrays]
        function = self.build.share("f", self._checked(entry, node, arrays))
        return at(py.call(function, *args, *views), node)

    def _checked(self, entry: LibraryFunction, node: Call, arrays: list[Quantity]) -> Callable[..., complex]:
        """Return the table function that refuses breakpoints which fall."""
        data, function = self.build.values.data, entry.value
        assert function is not None
        of_one = len(arrays) == 1
        points = [
            (argument, q.name, data[q.slot : q.slot + (q.size // 2 if of_one else q.size)])
            for q, argument in zip(arrays, node.args[-len(arrays) :], strict=True)
        ]
        points = points if of_one else points[1:]

        def look_up(*numbers: object) -> complex:
            for argument, name, numbers_of_it in points:
                facts = falling_facts(name, numbers_of_it)
                if facts is not None:
                    raise ScriptFault("table-falling", argument, **facts)
            return function(*numbers)

        return look_up

    def _array(self, node: Expr) -> Quantity:
        if not isinstance(node, Name):
            raise ScriptFault("array-name-expected", node)
        quantity = self.translator.scope.array(node)
        if quantity.kind is Kind.COMPLEX:
            raise ScriptFault("complex-not-possible", node)
        return quantity
