"""From a Python exception inside generated code to the user's message and the exact place in the source.

Generated code carries the offsets of the nodes it was made from as its column numbers (see
`expression_translation`), so the traceback itself says which part of a statement failed: that costs nothing
while nothing fails.
"""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, NamedTuple

from desire_tui.engine.diagnostics import DesireError, Diagnostic
from desire_tui.engine.library import LIBRARY
from desire_tui.engine.nodes.expressions import Binary, Call, Name
from desire_tui.engine.nodes.record import Node

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import CodeType, TracebackType

    from desire_tui.engine.nodes.program import Placed
    from desire_tui.engine.source import Source

MARK = "<desire "
"""How the file names of generated code begin; the number behind is an index into `Origins`."""


class ScriptFault(Exception):  # noqa: N818 - becomes a DesireError once its place is known
    """A user's mistake noticed where the place is not known, or known only as a node of some statement."""

    def __init__(self, key: str, node: Node | None = None, **facts: object) -> None:
        super().__init__(key)
        self.key = key
        self.node = node
        self.facts = facts
        self.placed: Placed | None = None
        self.source: Source | None = None


class Origins:
    """Which statement each piece of generated code was made from."""

    def __init__(self) -> None:
        self._statements: list[list[Placed]] = []
        self._sources: list[Source | None] = []

    def file_name(self, placed: Placed | list[Placed], source: Source | None) -> str:
        """Return the file name under which code made from a statement, or several, is compiled."""
        self._statements.append(placed if isinstance(placed, list) else [placed])
        self._sources.append(source)
        return f"{MARK}{len(self._statements) - 1}>"

    def __len__(self) -> int:
        return len(self._statements)

    def forget_from(self, number: int) -> None:
        """Forget code that is gone, such as an entry that was evaluated once."""
        del self._statements[number:], self._sources[number:]

    def statement(self, code: CodeType, line: int) -> tuple[Placed, Source | None]:
        """Return the statement (and its source) that a line of a code object was made from."""
        number = int(code.co_filename[len(MARK) : -1])
        return self._statements[number][max(line - 2, 0)], self._sources[number]

    def is_loop(self, code: CodeType) -> bool:
        """Whether a code object was made from several statements."""
        return len(self._statements[int(code.co_filename[len(MARK) : -1])]) > 1


Way = tuple["Placed", "Source | None"]
"""A statement and the text it stands in."""


def explain(
    error: Exception, placed: Placed, source: Source | None, origins: Origins, callers: Sequence[Way] = ()
) -> DesireError:
    """Return the message for an exception that left the statement `placed`.

    The related places are the statement that used the FUNCTION or data item at fault, and `callers`: the
    `call` lines of the PROCEDUREs being executed, the innermost first.
    """
    if isinstance(error, DesireError):
        return error.placed(placed.span(), source)
    node: Node | None = None
    frames = _generated_frames(error.__traceback__)
    if frames and origins.is_loop(frames[0].code):  # the operation was a whole loop
        placed, source = origins.statement(frames[0].code, frames[0].line)
    reached = placed, source
    if frames:
        code, line, start, end = frames[-1]
        placed, source = origins.statement(code, line)
        node = _node_at(placed.node, start, end)
    if isinstance(error, ScriptFault):
        if error.placed is not None:
            placed, source = error.placed, error.source
        key, facts, node = error.key, error.facts, error.node or node
    else:
        key, facts = _key_of(error, node)
        if isinstance(node, Binary) and node.op == "/" and key == "division-by-zero":
            node = node.right
    span = placed.span(node if node is not None and node.end > node.start else None)
    if isinstance(node, Name) and source is not None and span.end - span.start > len(node.name):
        span = source.name_within(span, node.name)  # a statement that keeps the name alone
    ways = [reached, *callers] if reached[0] is not placed else [*callers]
    related = tuple(Diagnostic("reached-from-here", p.span(), {}, s) for p, s in ways)
    return DesireError(Diagnostic(key, span, facts, source, related=related))


def _key_of(error: Exception, node: Node | None) -> tuple[str, dict[str, object]]:
    if isinstance(error, ZeroDivisionError):
        return "division-by-zero", {}
    if isinstance(error, OverflowError):
        return "overflow", {}
    if isinstance(error, MemoryError):
        return "out-of-memory", {"elements": "so many"}
    if isinstance(error, RecursionError):
        return "too-deep", {}
    if isinstance(error, ValueError):
        if isinstance(node, Call) and node.name in LIBRARY:
            return LIBRARY[node.name].domain_error, {"function": node.name}
        if isinstance(node, Binary):
            return "power-argument", {}
        return "argument-out-of-domain", {"function": "the function"}
    raise error  # a programmer's mistake: never dress it up as the user's


class _Frame(NamedTuple):
    """Where a piece of generated code failed: its line there, and the offsets of the failing node."""

    code: CodeType
    line: int
    start: int
    end: int


def _generated_frames(traceback: TracebackType | None) -> list[_Frame]:
    """Return the frames of generated code, the innermost last."""
    found = []
    while traceback is not None:
        code = traceback.tb_frame.f_code
        if code.co_filename.startswith(MARK):
            line, _, start, end = next(islice(code.co_positions(), traceback.tb_lasti // 2, None), (0,) * 4)
            found.append(_Frame(code, line or 0, start or 0, end or 0))
        traceback = traceback.tb_next
    return found


def _node_at(root: Node, start: int, end: int) -> Node | None:
    """Return the innermost node that covers exactly these offsets, or a bare span where none does."""
    best: Node | None = None
    todo: list[object] = [root]
    while todo:
        item = todo.pop()
        if isinstance(item, tuple):
            todo.extend(item)
        elif isinstance(item, Node):
            if (item.start, item.end) == (start, end):
                best = item
            parts: tuple[str, ...] = type(item).__slots__
            todo.extend(getattr(item, part) for part in parts if part not in {"start", "end"})
    return best
