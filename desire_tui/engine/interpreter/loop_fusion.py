"""A whole loop of plain statements as one Python function: what a script's loop becomes once it is hot.

Assignments, `if` and loops are written into one function, in their order and with the same arithmetic: a pass
then costs no calls. Whatever else a branch holds, and what was not reached yet, is a way out: the function
saves the loops' counts and returns the address of the statement, where the operations go on one by one.
"""

from __future__ import annotations

import ast
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

from desire_tui.engine.interpreter import python_ast as py
from desire_tui.engine.interpreter.assignment import store_code
from desire_tui.engine.interpreter.counted_loops import counted_loop
from desire_tui.engine.interpreter.exception_mapping import ScriptFault
from desire_tui.engine.interpreter.fast_cells import cells_as_variables
from desire_tui.engine.interpreter.name_resolution import Reference
from desire_tui.engine.interpreter.statement_context import StatementContext
from desire_tui.engine.nodes.assignments import Assign
from desire_tui.engine.nodes.commands import Simple
from desire_tui.engine.nodes.control import For, If, Label, Until, While

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from desire_tui.engine.interpreter.code_table import ScriptCode, StatementList
    from desire_tui.engine.interpreter.machine import ScriptMachine
    from desire_tui.engine.nodes.statements import Statement

STATEMENTS_MOST = 2000
"""In a loop: Python's compiler needs 50 µs for each."""
DEPTH_MOST = 15
"""Of loops and `if`s in each other: Python allows 20 blocks."""
PASSES_UNASKED = 256
"""Passes between two looks whether the user wants in; a power of 2."""


class NotFusible(Exception):  # noqa: N818 - control flow
    """The loop holds something that is no plain statement, on the way of every pass."""


class _OpenLoop(NamedTuple):
    """A loop around the code being written: the address where a pass begins, and what saves its count."""

    begins: int
    saves: str


def fuse(machine: ScriptMachine, code: ScriptCode, opening: int, passes: list[int]) -> Callable[[], int]:
    """Return a function that carries out a loop from the beginning of a pass on, and returns what comes next.

    `opening` is the place of its `for`, `while` or `repeat`; `passes[0]` is increased by the passes made.
    Raises NotFusible.
    """
    closing = code.text.structure.partner[opening]
    if closing - opening > STATEMENTS_MOST:
        raise NotFusible
    try:
        return _Fusion(machine, code, opening, closing).function(passes)
    except ScriptFault:
        raise NotFusible from None


def may_be_fused(text: StatementList, opening: int) -> bool:
    """Whether no statement stands in the way that every pass comes to: a short look, `fuse` knows."""
    partner, place = text.structure.partner, opening + 1
    while place < partner[opening]:
        match text.placed[place].node:
            case Simple("exit"):
                return True
            case If():
                place = partner[place]
                match text.placed[place].node:
                    case Simple("else"):
                        place = partner[place]
            case For() | While() | Simple("repeat"):
                place = partner[place]
            case Assign() | Label() | Simple("proceed"):
                pass
            case _:
                return False
        place += 1
    return True


class _Fusion:
    """Writes one loop."""

    def __init__(self, machine: ScriptMachine, code: ScriptCode, opening: int, closing: int) -> None:
        self._machine, self._code, self._build = machine, code, machine.build
        self._opening, self._closing = opening, closing
        self._partner = code.text.structure.partner
        self._open: list[_OpenLoop] = []
        self._asked: list[list[ast.stmt]] = []
        self._branches = 0
        self._depth = 0
        first = code.base + opening
        last = code.base + closing
        self._must_leave = self._build.share("u", lambda: machine.must_leave(first, last))

    def function(self, passes: list[int]) -> Callable[[], int]:
        """Return the function."""
        counted = self._build.share("n", passes)
        prelude, loop = self._loop(self._opening, is_outermost=True)
        body = [*prelude, loop]
        self._in_line(body, self._opening)
        read, written = self._cells(body)
        begin = py.parsed("\n".join(["n = 0", *read]))
        end = py.parsed("\n".join([*written, f"{counted}[0] += n"]))
        for asked in self._asked:
            asked[:0] = py.parsed("\n".join(written))
        leave = py.return_value(py.number(self._code.base + self._closing + 1))
        guarded = ast.Try([*body, leave], [], [], end, lineno=1, col_offset=0, end_lineno=1, end_col_offset=0)
        text = self._code.text
        statements = text.placed[self._opening : self._closing + 1]
        return self._build.function([*begin, guarded], list(statements), text.source)

    def _cells(self, body: list[ast.stmt]) -> tuple[list[str], list[str]]:
        """Keep scalars in variables, if the code reaches them under no other name."""
        if any(isinstance(dummy, Reference) for dummy in self._code.scope.dummies.values()):
            return [], []
        return cells_as_variables(body, {self._must_leave})

    # --------------------------------------------------------------------------- statements

    def _block(self, first: int, last: int) -> list[ast.stmt]:
        """Write the statements of places `first` … `last - 1`."""
        body: list[ast.stmt] = []
        place = first
        while place < last:
            made, following = self._statement(place)
            self._in_line(made, place)
            body += made
            if made and isinstance(made[-1], ast.Return | ast.Break):
                break
            place = following
        return body or [ast.Pass(**py.NO_PLACE)]

    def _statement(self, place: int) -> tuple[list[ast.stmt], int]:
        """Write the statement at a place; return it and the place behind it."""
        node: Statement = self._code.text.placed[place].node
        match node:
            case Label() | Simple("proceed"):
                return [], place + 1
            case _ if not self._machine.code_table.is_made(self._code.base + place):
                # its names may mean nothing yet
                return self._way_out(place, not_reached=len(self._open) > 1), place + 1
            case Assign():
                return self._assignment(place, node), place + 1
            case If():
                return self._if(place, node)
            case For() | While() | Simple("repeat"):
                with self._deeper():
                    prelude, loop = self._loop(place, is_outermost=False)
                return [*prelude, loop], self._partner[place] + 1
            case Simple("exit"):
                return [ast.Break(**py.NO_PLACE)], place + 1
        return self._way_out(place), place + 1

    def _way_out(self, place: int, *, not_reached: bool = False) -> list[ast.stmt]:
        """Leave the function for the statement at a place, unless every pass would come to it."""
        if not (self._branches or not_reached):
            raise NotFusible
        return [*self._saved(), py.return_value(py.number(self._code.base + place))]

    def _saved(self) -> list[ast.stmt]:
        """Save the counts of all open loops, where the operations expect them."""
        return [statement for loop in self._open for statement in py.parsed(loop.saves)]

    def _assignment(self, place: int, node: Assign) -> list[ast.stmt]:
        context = self._context(place)
        slot, kind = context.slot_code(node.target)
        return store_code(context, node.target, slot, kind, node.value)

    def _if(self, place: int, node: If) -> tuple[list[ast.stmt], int]:
        if node.condition is None:
            raise NotFusible
        middle = end = self._partner[place]
        otherwise: list[ast.stmt] = []
        condition = self._code.translator.condition(node.condition)
        with self._deeper():
            self._branches += 1
            then = self._block(place + 1, middle)
            if self._node(middle) == "else":
                end = self._partner[middle]
                otherwise = self._block(middle + 1, end)
            self._branches -= 1
        return [ast.If(condition, then, otherwise, **py.NO_PLACE)], end + 1

    # --------------------------------------------------------------------------- loops

    def _loop(self, place: int, *, is_outermost: bool) -> tuple[list[ast.stmt], ast.stmt]:
        """Write what comes before a loop's first pass, and the loop."""
        node = self._code.text.placed[place].node
        closing = self._partner[place]
        begins = self._code.base + place
        if isinstance(node, For):
            return self._for(place, node, is_outermost=is_outermost)
        condition: ast.expr = ast.Constant(True, **py.NO_PLACE)
        if isinstance(node, While):
            condition = self._code.translator.condition(node.condition)
        until = self._code.text.placed[closing].node
        self._open.append(_OpenLoop(begins, ""))
        body = self._block(place + 1, closing)
        if isinstance(until, Until):
            over = self._code.translator.condition(until.condition)
            leave = [py.if_statement(over, ast.Break(**py.NO_PLACE))]
            self._in_line(leave, closing)
            body += leave
        body += self._next_pass()
        self._open.pop()
        return [], ast.While(condition, body, [], **py.NO_PLACE)

    def _for(self, place: int, node: For, *, is_outermost: bool) -> tuple[list[ast.stmt], ast.stmt]:
        loop = counted_loop(self._context(place), node, is_outermost=is_outermost)
        if loop is None:
            raise NotFusible
        self._open.append(_OpenLoop(self._code.base + place + 1, loop.saves))
        self._in_line(loop.following, self._partner[place])
        body = [*self._block(place + 1, self._partner[place]), *loop.following, *self._next_pass()]
        self._open.pop()
        return loop.prelude, ast.While(loop.entered, body, [], **py.NO_PLACE)

    def _next_pass(self) -> list[ast.stmt]:
        """Count a pass; from time to time, let the user in."""
        leave = [
            *self._saved(),
            py.if_statement(py.call(self._must_leave), py.return_value(py.number(self._open[-1].begins))),
        ]
        counted = py.parsed(f"n += 1\nif not n & {PASSES_UNASKED - 1}: pass")
        asked = counted[1]
        assert isinstance(asked, ast.If)
        asked.body = leave
        self._asked.append(leave)
        return counted

    # --------------------------------------------------------------------------- places

    def _context(self, place: int) -> StatementContext:
        return StatementContext(self._machine, self._code, place)

    def _node(self, place: int) -> Any:
        node = self._code.text.placed[place].node
        return node.word if isinstance(node, Simple) else node

    def _in_line(self, statements: list[ast.stmt], place: int) -> None:
        """Let errors in code say which statement it was made from: the function's line is its number."""
        for statement in statements:
            for part in ast.walk(statement):
                if getattr(part, "lineno", None) == 1:
                    part.lineno = part.end_lineno = place - self._opening + 2  # type: ignore[attr-defined]

    @contextmanager
    def _deeper(self) -> Iterator[None]:
        self._depth += 1
        if self._depth > DEPTH_MOST:
            raise NotFusible
        yield
        self._depth -= 1
