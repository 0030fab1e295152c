"""`FUNCTION f(a$, b$) = expression`: compiled once for each combination of argument kinds.

The body may use program variables, evaluated at call time; dummies are local. An argument may be a whole
array where the body uses its dummy as one (`func1`, subscripts).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from desire_tui.engine.interpreter import tree as py
from desire_tui.engine.interpreter.faults import Fault
from desire_tui.engine.interpreter.scope import Local, Meaning, Scope
from desire_tui.engine.interpreter.tree import Typed, at
from desire_tui.engine.nodes import Function, Name
from desire_tui.engine.values import Quantity

if TYPE_CHECKING:
    import ast

    from desire_tui.engine.interpreter.builder import Builder
    from desire_tui.engine.interpreter.translate import Translator
    from desire_tui.engine.nodes import Call, Expr, Placed
    from desire_tui.engine.source import Source
    from desire_tui.engine.values import Kind


class Functions:
    """The program's FUNCTIONs."""

    def __init__(
        self, definitions: dict[str, Placed], scope: Scope, build: Builder, source: Source | None
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

    def call(self, node: Call, translator: Translator) -> Typed:
        """Translate a call; error 56 for a wrong number of arguments, 52 for recursion."""
        placed = self.definitions[node.name]
        definition = placed.node
        assert isinstance(definition, Function)
        if len(node.args) != len(definition.dummies):
            facts = {"given": len(node.args), "needed": len(definition.dummies)}
            raise Fault("arguments-do-not-match", node, name=node.name, **facts)
        if node.name in self._open:
            raise Fault("script-function-recursion", node, name=node.name)
        args: list[ast.expr] = []
        meanings: list[Meaning] = []
        for number, argument in enumerate(node.args):
            whole = _whole_array(argument, translator.scope)
            if whole is not None:
                meanings.append(whole)
                continue
            code, kind = translator.expression(argument)
            args.append(code)
            meanings.append(Local(f"p{number}", kind))
        name, kind = self._function(definition, placed, meanings)
        return Typed(at(py.call(name, *args), node), kind)

    def _function(self, definition: Function, placed: Placed, meanings: list[Meaning]) -> tuple[str, Kind]:
        from desire_tui.engine.interpreter.translate import Translator

        key = (definition.name, *(m.kind if isinstance(m, Local) else m for m in meanings))
        known = self._compiled.get(key)
        if known is not None:
            return known
        scope = self._scope.inner(dict(zip(definition.dummies, meanings, strict=True)))
        source = self._sources[definition.name]
        self._open.append(definition.name)
        try:
            code, kind = Translator(scope, self._build, self).expression(definition.body)
        except Fault as fault:
            if fault.placed is None:
                fault.placed, fault.source = placed, source
            raise
        finally:
            self._open.pop()
        parameters = tuple(m.variable for m in meanings if isinstance(m, Local))
        made = self._build.function([py.give(code)], placed, source, parameters)
        name = self._build.share("u", made)
        self._compiled[key] = name, kind
        return name, kind


def _whole_array(node: Expr, scope: Scope) -> Quantity | None:
    if not isinstance(node, Name):
        return None
    meaning = scope.find(node.name)
    return meaning if isinstance(meaning, Quantity) and meaning.shape else None
