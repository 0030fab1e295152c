"""`FUNCTION f(a$, b$) = expression`: compiled once for each combination of argument kinds.

The body may use program variables, evaluated at call time; dummies are local. An argument may be a whole
array where the body uses its dummy as one (`func1`, subscripts).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.name_resolution import Local, Meaning, NameScope
from desire_tui.engine.interpreter.python_ast import Typed, at
from desire_tui.engine.nodes.declarations import Function
from desire_tui.engine.nodes.expressions import Call, Element, Name
from desire_tui.engine.nodes.walk import walk
from desire_tui.engine.values import Kind, Quantity

if TYPE_CHECKING:
    import ast
    from collections.abc import Callable

    from desire_tui.engine.interpreter.compile_python import PythonCompiler
    from desire_tui.engine.interpreter.scalar_translator import ScalarTranslator
    from desire_tui.engine.nodes.expressions import Expr
    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.source import Source

NUMBERS_OF_TABLE_FUNCTIONS = {"func1": 1, "func2": 2}
"""Table functions, with how many of their arguments are numbers: the others are tables."""


class UserFunctions:
    """The program's FUNCTIONs."""

    def __init__(
        self, definitions: dict[str, Placed], scope: NameScope, build: PythonCompiler, source: Source | None
    ) -> None:
        self.definitions = definitions
        self._sources: dict[str, Source | None] = dict.fromkeys(definitions, source)
        self._scope = scope
        self._build = build
        self._compiled: dict[tuple[object, ...], tuple[str, Kind]] = {}
        self._open: list[str] = []

    def define(self, definitions: dict[str, Placed], source: Source | None) -> None:
        """Add FUNCTIONs, or replace those of the same name."""
        self.definitions.update(definitions)
        self._sources.update(dict.fromkeys(definitions, source))
        self.forget()

    def forget(self) -> None:
        """Forget compiled code: all names were cleared, or a FUNCTION was defined anew."""
        self._compiled.clear()

    def call(self, node: Call, translator: ScalarTranslator) -> Typed:
        """Translate a call; error 56 for a wrong number of arguments, 52 for recursion."""
        definition, placed = self._definition(node)
        args: list[ast.expr] = []
        meanings: list[Meaning] = []
        for number, argument in enumerate(node.args):
            whole = _whole_array(argument, translator.scope)
            if whole is not None:
                meanings.append(whole)
                continue
            code, kind = translator.finite(argument)
            args.append(code)
            meanings.append(Local(f"p{number}", kind))
        name, kind = self._function(definition, placed, meanings, translator)
        return Typed(at(py.call(name, *args), node), kind)

    def of_elements(
        self, node: Call, translator: ScalarTranslator
    ) -> tuple[Callable[..., float], list[bool]]:
        """Return a FUNCTION of real numbers, for calls element by element, and which arguments it wants.

        Where its body uses a dummy as an array, that array belongs to the function and is no argument.
        Errors 56, 52, and 84 for a COMPLEX result.
        """
        definition, placed = self._definition(node)
        meanings: list[Meaning] = []
        for number, (argument, dummy) in enumerate(zip(node.args, definition.dummies, strict=True)):
            whole = (
                _whole_array(argument, translator.scope) if is_used_as_array(dummy, definition.body) else None
            )
            meanings.append(whole if whole is not None else Local(f"p{number}", Kind.REAL))
        name, kind = self._function(definition, placed, meanings, translator)
        if kind is Kind.COMPLEX:
            raise ScriptFault("complex-not-possible", node)
        made: Callable[..., float] = self._build.names[name]
        return made, [isinstance(meaning, Local) for meaning in meanings]

    def _definition(self, node: Call) -> tuple[Function, Placed]:
        placed = self.definitions[node.name]
        definition = placed.node
        assert isinstance(definition, Function)
        if len(node.args) != len(definition.dummies):
            facts = {"given": len(node.args), "needed": len(definition.dummies), "where": ""}
            raise ScriptFault("arguments-do-not-match", node, name=node.name, **facts)
        if node.name in self._open:
            raise ScriptFault("script-function-recursion", node, name=node.name)
        return definition, placed

    def _function(
        self, definition: Function, placed: Placed, meanings: list[Meaning], translator: ScalarTranslator
    ) -> tuple[str, Kind]:
        key = (definition.name, *(m.kind if isinstance(m, Local) else m for m in meanings))
        known = self._compiled.get(key)
        if known is not None:
            return known
        scope = self._scope.inner(dict(zip(definition.dummies, meanings, strict=True)))
        source = self._sources[definition.name]
        self._open.append(definition.name)
        try:
            code, kind = translator.within(scope).expression(definition.body)
        except ScriptFault as fault:
            if fault.placed is None:
                fault.placed, fault.source = placed, source
            raise
        finally:
            self._open.pop()
        if self._calls_in(definition.body) > 1:  # such FUNCTIONs may take for ever: 2, 4, 8 … calls
            code = py.last_of([py.call("check"), code])
        parameters = tuple(m.variable for m in meanings if isinstance(m, Local))
        made = self._build.function([py.return_value(code)], placed, source, parameters)
        name = self._build.share("u", made)
        self._compiled[key] = name, kind
        return name, kind

    def _calls_in(self, body: Expr) -> int:
        """Return how often an expression calls the program's FUNCTIONs."""
        return sum(isinstance(part, Call) and part.name in self.definitions for part in walk(body))


def is_used_as_array(dummy: str, body: Expr) -> bool:
    """Whether an expression subscripts a name or passes it to a table function."""
    for part in walk(body):
        if isinstance(part, Element) and part.name == dummy:
            return True
        if isinstance(part, Call):
            numbers = NUMBERS_OF_TABLE_FUNCTIONS.get(part.name, len(part.args))
            if Name(dummy) in part.args[numbers:]:
                return True
    return False


def _whole_array(node: Expr, scope: NameScope) -> Quantity | None:
    if not isinstance(node, Name):
        return None
    meaning = scope.find(node.name)
    return meaning if isinstance(meaning, Quantity) and meaning.shape else None
