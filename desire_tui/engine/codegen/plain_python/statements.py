"""Statements of plain Python as LLVM's blocks, and which variables have a value where."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.codegen.plain_python.calls import Calls
from desire_tui.engine.codegen.plain_python.expressions import Variable
from desire_tui.engine.codegen.plain_python.kinds import ADDRESS, INT, INT32, NUMBERS, Kind, Value

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import Any

_AUGMENTED = (ast.Add, ast.Sub, ast.Mult, ast.Div)


class _Loop(NamedTuple):
    """Where `continue` and `break` go, and what has a value there."""

    again: str
    end: str
    continued: list[set[str]]
    broken: list[set[str]]


class Statements(Calls):
    """Writes one function's body; `result` is the type that it returns."""

    result: Kind | None = None
    _reached = True
    """Whether control can come to where the text ends."""

    def write_body(self, node: ast.FunctionDef) -> None:
        """Write all statements, and the end."""
        self._loops: list[_Loop] = []
        self._counters: list[str] = []
        """Variables of the loops around."""
        self._block(node.body)
        if not self._reached:
            return
        if self.result is not None:
            self.refuse(node, "an end without 'return'")
        self.text.do("ret void")

    def _block(self, statements: Sequence[ast.stmt]) -> None:
        for statement in statements:
            if not self._reached:
                self.refuse(statement, "a statement that is never reached")
            write: Callable[[Any], None] | None = getattr(
                self, f"_do_{type(statement).__name__.lower()}", None
            )
            if write is None:
                self.refuse(statement, f"the statement {type(statement).__name__}")
            write(statement)

    def _do_pass(self, _node: ast.Pass) -> None:
        """Write nothing."""

    def _do_expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Call):
            self.write_call(node.value)
        elif not (isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)):  # a docstring
            self.refuse(node, f"'{ast.unparse(node)}' as a statement")

    # ------------------------------------------------------------------ assignments

    def _do_assign(self, node: ast.Assign) -> None:
        if len(node.targets) != 1:
            self.refuse(node, "several targets of one '='")
        (target,) = node.targets
        if not isinstance(target, ast.Tuple):
            self._assign(target, self.value(node.value), node.value)
            return
        if not isinstance(node.value, ast.Tuple) or len(node.value.elts) != len(target.elts):
            self.refuse(node, "an assignment to a tuple from something else")
        values = [self.value(value) for value in node.value.elts]
        for part, value, source in zip(target.elts, values, node.value.elts, strict=True):
            self._assign(part, value, source)

    def _do_annassign(self, node: ast.AnnAssign) -> None:
        kind = self.around.outside.kind(node.annotation)
        if node.value is None or not isinstance(node.target, ast.Name) or kind is None or kind == INT32:
            self.refuse(node, f"the annotation '{ast.unparse(node)}'")
        value = self.value(node.value)
        if value.kind == ADDRESS and kind.ir == "ptr":
            value = Value(value.text, kind)  # says what is there
        elif value.kind in NUMBERS and kind in NUMBERS:
            value = Value(self.convert(value, kind, node.value), kind)
        self._assign(node.target, value, node.value, kind)

    def _do_augassign(self, node: ast.AugAssign) -> None:
        if type(node.op) not in _AUGMENTED:
            self.refuse(node, f"the operator {type(node.op).__name__} with '='")
        if any(isinstance(part, ast.Call) for part in ast.walk(node.target)):
            self.refuse(node, "a call in the target of an assignment")
        old = self.number(node.target)
        self._assign(node.target, self.operate(node, node.op, old, self.number(node.value)), node)

    def _assign(
        self, target: ast.expr, value: Value, source: ast.expr | ast.stmt, kind: Kind | None = None
    ) -> None:
        """Write an assignment; `kind`: what the target must be."""
        if isinstance(target, ast.Name):
            if target.id in self._counters:
                self.refuse(target, f"an assignment to the loop's variable '{target.id}'")
            cell, known = self._cell(target, kind or value.kind)
            if kind not in {None, known}:
                self.refuse(target, f"'{target.id}' as {kind}, it is {known}")
            self.text.do(f"store {known.ir} {self.convert(value, known, source)}, ptr {cell}")
            self.assigned.add(target.id)
            return
        if isinstance(target, ast.Attribute):
            place, field, inside = self.field(target)
            if inside or target.attr in self.around.outside.known:
                self.refuse(target, f"an assignment to '{ast.unparse(target)}', which is fixed")
        elif isinstance(target, ast.Subscript):
            place, field = self.element(target)
        else:
            self.refuse(target, f"an assignment to '{ast.unparse(target)}'")
        self.text.do(f"store {field.ir} {self.convert(value, field, source)}, ptr {place}")

    def _cell(self, target: ast.Name, kind: Kind) -> tuple[str, Kind]:
        if target.id not in self.variables:
            self.variables[target.id] = Variable(self.text.alloca(kind.ir), "", kind)
        variable = self.variables[target.id]
        return variable.cell, variable.kind

    # ------------------------------------------------------------------ control

    def _do_return(self, node: ast.Return) -> None:
        if (node.value is None) != (self.result is None):
            self.refuse(node, f"'{ast.unparse(node)}' from a function with another result")
        if node.value is None or self.result is None:
            self.text.do("ret void")
        else:
            found = self.convert(self.value(node.value), self.result, node.value)
            self.text.do(f"ret {self.result.ir} {found}")
        self._reached = False

    def _do_if(self, node: ast.If) -> None:
        text, stem = self.text, self.text.fresh()
        text.branch(self.condition(node.test), f"{stem}.then", f"{stem}.else")
        before, ends = self.assigned, []
        for way, statements in (("then", node.body), ("else", node.orelse)):
            text.begin(f"{stem}.{way}")
            self.assigned, self._reached = set(before), True
            self._block(statements)
            if self._reached:
                text.jump(f"{stem}.end")
                ends.append(self.assigned)
        self._join(f"{stem}.end", ends)

    def _do_while(self, node: ast.While) -> None:
        if node.orelse:
            self.refuse(node, "'else' after a loop")
        text, stem = self.text, self.text.fresh()
        self.assigned = self.assigned - _counted(node.body)
        text.jump(f"{stem}.while")
        text.begin(f"{stem}.while")
        endless = isinstance(node.test, ast.Constant) and node.test.value is True
        before = [] if endless else [set(self.assigned)]
        if endless:
            text.jump(f"{stem}.do")
        else:
            text.branch(self.condition(node.test), f"{stem}.do", f"{stem}.end")
        loop = self._loop(node.body, stem, f"{stem}.while")
        if self._reached:
            text.jump(f"{stem}.while")
        ends = [] if endless else [*loop.continued, *([self.assigned] if self._reached else [])]
        self._join(f"{stem}.end", [*before, *ends, *loop.broken])

    def _do_for(self, node: ast.For) -> None:
        target = node.target
        if node.orelse:
            self.refuse(node, "'else' after a loop")
        if not isinstance(target, ast.Name) or target.id in self._counters:
            self.refuse(node, f"'{ast.unparse(target)}' as a loop's variable")
        start, stop = self._range(node.iter)
        text, stem = self.text, self.text.fresh()
        cell, kind = self._cell(target, INT)
        if kind != INT or not cell:
            self.refuse(node, f"'{target.id}' as a loop's variable, it is {kind}")
        text.do(f"store i64 {start}, ptr {cell}")
        self.assigned = self.assigned - _counted(node.body) - {target.id}
        before = set(self.assigned)
        text.jump(f"{stem}.for")
        text.begin(f"{stem}.for")
        index = text.op(f"load i64, ptr {cell}")
        text.branch(text.op(f"icmp slt i64 {index}, {stop}"), f"{stem}.do", f"{stem}.end")
        self._counters.append(target.id)
        self.assigned.add(target.id)
        loop = self._loop(node.body, stem, f"{stem}.next")
        self._counters.pop()
        ends = [*loop.continued, *([self.assigned] if self._reached else [])]
        if self._reached:
            text.jump(f"{stem}.next")
        if ends:
            text.begin(f"{stem}.next")
            following = text.op(f"add i64 {text.op(f'load i64, ptr {cell}')}, 1")
            text.do(f"store i64 {following}, ptr {cell}")
            text.jump(f"{stem}.for")
        self._join(f"{stem}.end", [before, *ends, *loop.broken])
        self.assigned.discard(target.id)  # its last value in Python is one less

    def _range(self, node: ast.expr) -> tuple[str, str]:
        """Return the bounds of `range(…)`, which are found once."""
        name = node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else ""
        known = name == "range" and name not in self.local and self.around.builtin(name)
        if not (known and isinstance(node, ast.Call)) or name in self.around.functions or node.keywords:
            self.refuse(node, f"a loop over '{ast.unparse(node)}'")
        if len(node.args) not in {1, 2}:
            self.refuse(node, f"'{ast.unparse(node)}' with {len(node.args)} arguments")
        bounds = [self.whole(argument).text for argument in node.args]
        return (bounds[0], bounds[1]) if len(bounds) == 2 else ("0", bounds[0])

    def _loop(self, statements: Sequence[ast.stmt], stem: str, again: str) -> _Loop:
        self.text.begin(f"{stem}.do")
        loop = _Loop(again, f"{stem}.end", [], [])
        self._loops.append(loop)
        self._block(statements)
        self._loops.pop()
        return loop

    def _join(self, label: str, ends: list[set[str]]) -> None:
        """Go on where several ways meet: what has a value on each of them has one here."""
        self._reached = bool(ends)
        if ends:
            self.text.begin(label)
            self.assigned = set.intersection(*ends)

    def _do_break(self, _node: ast.Break) -> None:
        self._loops[-1].broken.append(set(self.assigned))
        self.text.jump(self._loops[-1].end)
        self._reached = False

    def _do_continue(self, _node: ast.Continue) -> None:
        self._loops[-1].continued.append(set(self.assigned))
        self.text.jump(self._loops[-1].again)
        self._reached = False


def _counted(statements: Sequence[ast.stmt]) -> set[str]:
    """Return the variables of loops among statements: after those they have no value."""
    return {
        node.target.id
        for statement in statements
        for node in ast.walk(statement)
        if isinstance(node, ast.For) and isinstance(node.target, ast.Name)
    }
